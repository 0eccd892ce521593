import { fixed } from "/app/format.js";
import { t } from "/app/words.js";
/** Motion of a 3D body: position and contact at an instant, and their description. */

const DEGREES = 180 / Math.PI;

/** Index of the last time that is not after an instant; -1 before all times.
 * @param {number} count @param {(k: number) => number} at @param {number} instant */
export const lastBefore = (count, at, instant) => {
  let [low, high] = [-1, count];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (at(middle) <= instant) low = middle;
    else high = middle;
  }
  return low;
};

/** Computed motion with its state at any instant, interpolated between poses. */
export class Played {
  /** @param {any} three @param {import("/space/stage.js").Stage} stage @param {any} answer */
  constructor(three, stage, answer) {
    this.stage = stage;
    this.motion = /** @type {SpaceMotion} */ (stage.model.motion);
    this.contacts = answer.intervals;
    this.fell = answer.outcome === "overturned" ? (answer.overturning_time ?? Infinity) : Infinity;
    this.end = this.motion.time.at(-1) ?? 0;
    this.tilt = 0;
    this.interval = /** @type {{ vertices: number[], sliding_vertices?: number[] } | null} */ (null);
    this.one = new three.Quaternion();
    this.other = new three.Quaternion();
    this.centre = [0, 0, 0];
    this.turn = [0, 0, 0, 1];
  }

  /** Draw the body at an instant [s]. @param {number} instant */
  show(instant) {
    const { time, turn, centre: positions, tilt } = this.motion;
    const last = time.length - 1;
    const k = Math.min(Math.max(0, lastBefore(time.length, (i) => time[i], instant)), Math.max(0, last - 1));
    const next = Math.min(k + 1, last);
    const share = next > k ? Math.min(1, Math.max(0, (instant - time[k]) / (time[next] - time[k]))) : 0;
    this.one.fromArray(turn, 4 * k).slerp(this.other.fromArray(turn, 4 * next), share).toArray(this.turn);
    for (let i = 0; i < 3; i += 1) this.centre[i] = between(positions[3 * k + i], positions[3 * next + i], share);
    this.tilt = between(tilt[k], tilt[next], share);
    this.stage.place(this.turn, this.centre);
    this.touch(instant);
    this.stage.draw();
  }

  /** @param {number} instant */
  touch(instant) {
    const interval = this.contacts[lastBefore(this.contacts.length, (i) => this.contacts[i].start, instant)] ?? null;
    if (interval === this.interval) return;
    this.interval = interval;
    const { vertices = [], sliding_vertices: sliding = [] } = interval ?? {};
    this.stage.touch(vertices.filter((/** @type {number} */ vertex) => !sliding.includes(vertex)), sliding);
  }

  /** State at a shown instant. @param {number} instant */
  describe(instant) {
    const { vertices = [], sliding_vertices: sliding = [] } = this.interval ?? {};
    const facts = { time: fixed(instant, 2), tilt: fixed(this.tilt * DEGREES, 2), contact: contactWords(vertices.length, sliding.length) };
    return instant >= this.fell ? t("At {time} s: tilt {tilt}\u00b0, {contact}; overturned.", facts)
      : t("At {time} s: tilt {tilt}\u00b0, {contact}.", facts);
  }
}

/** @param {number} count @param {number} sliding */
const contactWords = (count, sliding) => {
  if (!count) return t("in the air");
  if (!sliding) return t(["{count} contact point", "{count} contact points"], { count });
  return sliding === count ? t(["{count} contact point, sliding", "{count} contact points, all sliding"], { count })
    : t("{count} contact points, {sliding} sliding", { count, sliding });
};

/** @param {number} first @param {number} other @param {number} share */
const between = (first, other, share) => first + (other - first) * share;
