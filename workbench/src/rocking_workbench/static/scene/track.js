/** History in typed arrays with a value at any instant, without allocation.
 * @param {Float64Array} time */

const increasing = (time) => {
  for (let k = 1; k < time.length; k += 1) if (time[k] < time[k - 1]) return false;
  return true;
};

/** Values over time, linear between the samples and constant beyond the ends. */
export class Track {
  /** @param {ArrayLike<number>} time @param {ArrayLike<number>} values */
  constructor(time, values) {
    if (!time.length || time.length !== values.length) {
      throw new Error("times and values must have the same length, at least 1");
    }
    this.time = Float64Array.from(time);
    this.values = Float64Array.from(values);
    if (!increasing(this.time)) throw new Error("times must not decrease");
    this.place = 0;
  }

  /** Last instant [s]. */
  get end() {
    return this.time[this.time.length - 1];
  }

  /** Value at an instant; fast for consecutive instants.
   * @param {number} instant */
  at(instant) {
    const { time, values } = this;
    const last = time.length - 1;
    if (instant <= time[0]) return values[0];
    if (instant >= time[last]) return values[last];
    let k = this.place;
    if (time[k] > instant || (k + 8 < last && time[k + 8] < instant)) k = this.search(instant);
    while (time[k + 1] <= instant) k += 1;
    this.place = k;
    const width = time[k + 1] - time[k];
    return values[k] + ((values[k + 1] - values[k]) * (instant - time[k])) / width;
  }

  /** Returns the last sample that is not after an instant. @param {number} instant */
  search(instant) {
    let low = 0;
    let high = this.time.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (this.time[middle] <= instant) low = middle;
      else high = middle;
    }
    return low;
  }

  /** Returns the largest absolute value. */
  peak() {
    let most = 0;
    for (let k = 0; k < this.values.length; k += 1) most = Math.max(most, Math.abs(this.values[k]));
    return most;
  }
}

/** Returns the instant of the largest absolute value of a track [s]. @param {Track} track */
export const peakInstant = (track) => {
  let best = 0;
  for (let k = 1; k < track.values.length; k += 1) {
    if (Math.abs(track.values[k]) > Math.abs(track.values[best])) best = k;
  }
  return track.time[best];
};
