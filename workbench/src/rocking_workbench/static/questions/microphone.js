/** A sound from the microphone, as a WAV file of 16 bits: nothing leaves this computer. */

/** Begin to record; `end()` resolves to the file. */
export const record = async () => {
  const plain = { echoCancellation: false, noiseSuppression: false, autoGainControl: false, channelCount: 1 };
  const stream = await navigator.mediaDevices.getUserMedia({ audio: plain });
  const context = new AudioContext();
  await context.audioWorklet.addModule("/questions/microphone-worklet.js");
  const node = new AudioWorkletNode(context, "rocking-recorder");
  /** @type {Float32Array[]} */
  const pieces = [];
  node.port.onmessage = ({ data }) => pieces.push(data);
  context.createMediaStreamSource(stream).connect(node);
  return {
    end: async () => {
      stream.getTracks().forEach((track) => track.stop());
      const rate = context.sampleRate;
      await context.close();
      return new File([wave(pieces, rate)], "recording.wav", { type: "audio/wav" });
    },
  };
};

/** @param {Float32Array[]} pieces @param {number} rate */
const wave = (pieces, rate) => {
  const count = pieces.reduce((sum, piece) => sum + piece.length, 0);
  const view = new DataView(new ArrayBuffer(44 + 2 * count));
  /** @param {number} at @param {string} text */
  const putText = (at, text) => [...text].forEach((mark, k) => view.setUint8(at + k, mark.charCodeAt(0)));
  putText(0, "RIFF");
  view.setUint32(4, 36 + 2 * count, true);
  putText(8, "WAVEfmt ");
  for (const [at, value, bytes] of [
    [16, 16, 4], [20, 1, 2], [22, 1, 2], [24, rate, 4], [28, 2 * rate, 4], [32, 2, 2], [34, 16, 2],
  ]) view[bytes === 4 ? "setUint32" : "setUint16"](at, value, true);
  putText(36, "data");
  view.setUint32(40, 2 * count, true);
  let at = 44;
  for (const piece of pieces) {
    for (const value of piece) {
      view.setInt16(at, Math.round(32767 * Math.max(-1, Math.min(1, value))), true);
      at += 2;
    }
  }
  return view.buffer;
};
