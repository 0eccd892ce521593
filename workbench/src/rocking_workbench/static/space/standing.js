/** Stable poses of a 3D body, the barriers between them, and the energy landscape. */

import { html, useRef, useSignal } from "/parts/preact.js";
import { number } from "/app/format.js";
import { Button, Choice } from "/parts/fields.js";
import { Rows } from "/parts/table.js";
import { Drawing } from "/questions/parts.js";
import { calm } from "/scene/theme.js";
import { Scene } from "/space/scene.js";
import { t } from "/app/words.js";

const SCANNED = /^file = ".*(?<!\.toml)"$/m; // matches a run with a scan, which has no axes of its own
/** @typedef {SpaceStage & { setIn: (pose: SpacePose) => void, settleIn: (pose: SpacePose) => void }} Setting */

const SETTLES = 700; // duration of the rotation into another pose [ms]
const FEW = 12; // number of listed poses
const MOST = 40; // largest number of marks of a kind; a rough scan has hundreds
const COLOURS = [["rise", "height of the centre of mass"], ["plain", "none"]];
// rounding errors are shown as 0
/** @param {number} value @param {number} most */
const joules = (value, most) => number(Math.abs(value) < 1e-9 * most ? 0 : value, 3);
/** @param {number | null | undefined} value */
const millimetres = (value) => (value === null || value === undefined ? "\u2013" : number(1000 * value, 3));

const ROLLS = "The body rolls freely with its axis {tilt}\u00b0 from the vertical. Height of the centre of mass: {height} mm.";
const BALANCES = "A ring of unstable equilibria: axis {tilt}\u00b0 from the vertical. Height of the centre of mass: {height} mm.";

/** Poses of the body of a run; `onPose` receives the attitude in the file for another pose.
 * @param {{ question: Server.WholeQuestion, answer: any, onPose: (pose: number, up: number[]) => unknown, children: any }} props */
export const Standing = ({ question, answer, onPose, children }) => {
  const pose = useSignal(String(answer.stands_in));
  const colours = useSignal("rise");
  /** @type {{ current: Setting | null }} */
  const stage = useRef(null);
  const shown = Number(pose.value);
  // in order of decreasing energy barrier
  const poses = [...answer.stable].sort((first, other) => (other.barrier ?? Infinity) - (first.barrier ?? Infinity));
  /** @param {string} number_ */
  const settle = (number_) => {
    pose.value = number_;
    stage.current?.settleIn(stage.current.model.poses[Number(number_)]);
  };
  /** @param {SpaceStage} spaceStage */
  const built = (spaceStage) => {
    stage.current = settling(spaceStage);
    for (const kind of ["summit", "saddle", "stable"]) {
      const marks = spaceStage.model.marks.filter((mark) => mark.kind === kind);
      spaceStage.dots(marks.slice(0, MOST).map(({ position }) => before(position, spaceStage.size)), kind, `--space-${kind}`);
    }
    spaceStage.colourful(true);
    stage.current.setIn(spaceStage.model.poses[shown]);
  };
  const here = answer.stable[shown];
  const most = answer.stable.at(-1).energy;
  const low = answer.stable[0].centre_height;
  const stands = t("Pose {pose}: centre of mass {height} mm above the ground, {energy} J above the lowest pose. The plumb line is {edge} mm inside the nearest edge of the support polygon.", {
    pose: shown, height: millimetres(here.centre_height), energy: joules(here.energy, most), edge: millimetres(here.nearest_edge),
  });
  const leaves = here.barrier === null || !Number.isFinite(here.barrier) ? t("This is the only stable pose.")
    : t("The centre of mass must rise {rise} mm to leave this pose.", { rise: millimetres(here.barrier) });
  return html`
    <p class="verdict" data-testid="verdict">${t(
      ["The body has one stable pose. From the given orientation it settles in pose {pose}.", "The body has {count} stable poses. From the given orientation it settles in pose {pose}."],
      { count: answer.stable.length, pose: answer.stands_in })}</p>
    <${Scene} question=${question} description=${`${stands} ${leaves}`} onStage=${built} title="Stable poses" label="Body on its support polygon, with its equilibria"
      onSpace=${() => {}} legend=${[
        ["stable", t("{number} stable equilibria", { number: answer.stable.length })], ["saddle", t("{number} saddles: balanced on an edge", { number: answer.saddles })],
        ["summit", t("{number} summits: balanced on a corner", { number: answer.summits })], ["plumb", "centre of mass and plumb line"],
        ["rise", t("height of the centre of mass with this point at the bottom: dark is low (from {height} mm), bright is high", { height: millimetres(low) })]]} />
    <div class="space-choices">
      <${Choice} label="Stable pose" value=${{ get value() { return pose.value; }, set value(next) { settle(next); } }}
        options=${poses.filter((pose, k) => k < FEW || pose.pose === shown).map((pose) => [String(pose.pose),
          t("pose {pose}: energy barrier {rise} mm", { pose: pose.pose, rise: millimetres(pose.barrier) })])} />
      <${Choice} label="Colours" value=${{ get value() { return colours.value; }, set value(next) {
        colours.value = next;
        stage.current?.colourful(next === "rise");
      } }} options=${COLOURS} />
    </div>
    ${answer.rings.map((/** @type {any} */ ring) => html`<p key=${ring.tilt}>${t(ring.kind === "stable" ? ROLLS : BALANCES,
      { tilt: number((ring.tilt * 180) / Math.PI, 3), height: millimetres(ring.centre_height) })}</p>`)}
    ${SCANNED.test(question.toml) && html`<div class="toolbar"><${Button} onClick=${() => {
      const { up_in_file: up } = stage.current?.model.poses[shown] ?? {};
      if (up) onPose(shown, up);
    }}>${t("Use pose {pose}", { pose: shown })}<//></div>`}
    ${children}
    <${Drawing} question=${question} alt=${t("Rise of the centre of mass over tilt and azimuth from pose {pose}, and the support polygon", { pose: answer.stands_in })} />
    <h3>Toppling by direction</h3>
    <${Rows} caption="Directions" head=${["direction [\u00b0]", "direct rise of the centre of mass [mm]", "smallest rise of the centre of mass [mm]", "uplift at [m/s\u00b2]", "next pose"]}
      rows=${answer.directions.map((/** @type {any} */ direction) => [
        number((direction.azimuth * 180) / Math.PI, 3), millimetres(direction.straight_rise), millimetres(direction.lowest_rise),
        number(direction.uplift_acceleration, 3), direction.topples_into === null ? "\u2013" : String(direction.topples_into)])} />
    <h3>Poses, highest energy barrier first</h3>
    <${Rows} caption="Poses" head=${["pose", "energy barrier [mm]", "centre [mm]", "energy [J]", "distance to edge [mm]"]}
      rows=${poses.slice(0, FEW).map((pose) => [String(pose.pose), millimetres(pose.barrier), millimetres(pose.centre_height),
        joules(pose.energy, most), millimetres(pose.nearest_edge)])} />
    ${poses.length > FEW && html`<p class="field-help">${t("{count} more poses have an energy barrier of {rise} mm or less.",
      { count: poses.length - FEW, rise: millimetres(poses[FEW].barrier) })}</p>`}
    ${answer.notes.map((/** @type {string} */ note) => html`<p class="field-help" key=${note}>${note}</p>`)}`;
};

// Position slightly in front of the surface, so that the whole mark is visible.
/** @param {number[]} position @param {number} size */
const before = (position, size) => position.map((coordinate) => coordinate * (1 + (0.03 * size) / Math.hypot(...position)));

// Stage on which a body rotates into another pose.
/** @param {SpaceStage} spaceStage @returns {Setting} */
const settling = (spaceStage) => {
  const stage = /** @type {Setting} */ (spaceStage);
  const [from, to] = [new stage.three.Quaternion(), new stage.three.Quaternion()];
  let ticket = 0;
  stage.setIn = ({ turn, height, support }) => {
    stage.place(turn, [0, 0, height]);
    stage.standOn(support);
    stage.draw();
  };
  stage.settleIn = (pose) => {
    const mine = (ticket += 1);
    if (calm()) {
      stage.setIn(pose);
      return;
    }
    from.copy(stage.body.quaternion);
    to.fromArray(pose.turn);
    const [begun, before] = [performance.now(), stage.body.position.z];
    /** @param {number} stamp */
    const step = (stamp) => {
      const share = Math.min(1, Math.max(0, (stamp - begun) / SETTLES));
      if (mine !== ticket || !stage.canvas.isConnected) return;
      if (share >= 1) {
        stage.setIn(pose);
        return;
      }
      const lift = stage.size * Math.sin(Math.PI * share);
      const height = Math.max(before + (pose.height - before) * share, lift);
      stage.place(from.clone().slerp(to, share).toArray(), [0, 0, height]);
      stage.draw();
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  };
  return stage;
};
