/** Number and script time of frames, for tests: `window.rockingFrames`. */

const KEPT = 4096;
const meter = { count: 0, lastMs: 0, meanMs: 0, worstMs: 0, times: new Float32Array(KEPT) };
window.rockingFrames = meter;

/** Records a frame and its script time in milliseconds. @param {number} milliseconds */
export const noteFrame = (milliseconds) => {
  meter.times[meter.count % KEPT] = milliseconds;
  meter.count += 1;
  meter.lastMs = milliseconds;
  meter.meanMs += (milliseconds - meter.meanMs) / meter.count;
  if (milliseconds > meter.worstMs) meter.worstMs = milliseconds;
};

/** Reset the counters. */
export const resetFrames = () => {
  meter.count = 0;
  meter.lastMs = 0;
  meter.meanMs = 0;
  meter.worstMs = 0;
};
