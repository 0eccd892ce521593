/** Time of the animation: with a speed, an end and a settable position. */

const LONGEST_FRAME = 0.1;

/** Time of the history, advanced by the time of the screen. */
export class Clock {
  constructor() {
    this.now = 0;
    this.end = 0;
    this.speed = 1;
    this.running = false;
    this.before = -1;
  }

  /** Start. At the end of the animation, start again from the beginning. */
  start() {
    if (this.now >= this.end) this.now = 0;
    this.running = this.end > 0;
    this.before = -1;
  }

  /** Stops at the present time. */
  stop() {
    this.running = false;
  }

  /** Advance by the time between two frames [ms]; without a jump after a hidden page. @param {number} stamp */
  tick(stamp) {
    if (this.before >= 0) this.now += Math.min((stamp - this.before) / 1000, LONGEST_FRAME) * this.speed;
    this.before = stamp;
    if (this.now >= this.end) {
      this.now = this.end;
      this.running = false;
    }
  }

  /** Goes to an instant [s]. @param {number} instant */
  seek(instant) {
    this.now = Math.min(Math.max(instant, 0), this.end);
    this.before = -1;
  }
}
