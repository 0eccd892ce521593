/** Sends the samples of the microphone to the page. */

class Recorder extends AudioWorkletProcessor {
  /** @param {Float32Array[][]} inputs */
  process([[samples]]) {
    if (samples) this.port.postMessage(samples.slice());
    return true;
  }
}

registerProcessor("rocking-recorder", Recorder);
