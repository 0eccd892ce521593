/** What shakes the ground: a record file, a pulse, or a synthetic motion. */
import { el, fill } from "/app/dom.js";
import { button, card, note, segmented } from "/app/fields.js";
import { motionBefore, rememberMotion } from "/views/motion-before.js";
import { pulseEditor } from "/views/motion-pulse.js";
import { recordEditor } from "/views/motion-record.js";
import { resultOf } from "/views/motion-result.js";
import { scaleEditor } from "/views/motion-scale.js";
import { syntheticEditor } from "/views/motion-synthetic.js";

const WAYS = [
  { value: "record", text: "Record file" },
  { value: "pulse", text: "Pulse" },
  { value: "synthetic", text: "Synthetic" },
];
const EDITORS = { record: recordEditor, pulse: pulseEditor, synthetic: syntheticEditor };

const LEAN = "No motion is chosen: the body is let go from a lean. Choose one here to shake it.";

/** Way of a motion; none while nothing shakes the ground. */
const wayOf = (motion) => Object.keys(EDITORS).find((way) => motion?.[way] !== undefined) || "";

/** Shows the view of the motion in a section. */
export const mount = (section, app) => {
  const view = new MotionView(app);
  section.append(...view.parts);
  view.mounted();
  return { shown: () => view.shown(), hidden: () => view.hidden() };
};

class MotionView {
  constructor(app) {
    this.app = app;
    this.visible = false;
    this.dirty = true;
    this.kept = {};
    this.editors = {};
    this.way = wayOf(app.inputs.get().motion);
    this.place = el("div", { class: "motion-editor" });
    this.ways = segmented({
      label: "Where the motion comes from",
      options: WAYS,
      value: this.way,
      onChange: (way) => this.choose(way),
    });
    this.scale = scaleEditor((scale) => this.setScale(scale));
    this.pending = el("div", { "aria-live": "polite", "data-testid": "motion-pending" });
    this.refusal = el("div", { "aria-live": "polite", "data-testid": "motion-refusal" });
    this.result = resultOf(app, (window) => this.lookInto(window));
    this.parts = [this.head(), this.columns()];
  }

  head() {
    const lead = "Drop a record, choose a pulse or draw a synthetic motion; it is measured at once.";
    const title = el("h1", {}, "Motion of the ground");
    return el("div", { class: "view-head" }, title, el("p", { class: "lead" }, lead));
  }

  columns() {
    const form = card("The motion", this.ways, this.place, this.scale.element);
    const left = el("div", { class: "motion-left" }, form);
    const right = el("div", { class: "motion-right" }, this.refusal, this.pending, this.result.element);
    return el("div", { class: "columns narrow-wide" }, left, right);
  }

  mounted() {
    this.open(this.way);
    const parts = [this.place, this.scale.element];
    for (const part of parts) part.addEventListener("input", () => this.markStale());
    this.app.inputs.subscribe((inputs, changed) => {
      if (changed.has("motion") || changed.has("settings")) this.follow(inputs);
    });
  }

  /** Shows the editor of a way; its last choice becomes the motion if that was another. */
  choose(way) {
    const { motion } = this.app.inputs.get();
    if (motion) this.kept[wayOf(motion)] = motion;
    this.open(way);
    const before = motion ? null : motionBefore();
    const next = this.kept[way] || (wayOf(before) === way ? before : null) || this.editors[way].usual();
    if (next) this.set(next);
    this.markStale();
  }

  /** Shows an editor; without a motion none of them, so that each can be chosen. */
  open(way) {
    this.way = way;
    this.ways.value = way;
    const [onChange, onWait] = [(motion) => this.set(motion), () => this.markStale()];
    if (way) this.editors[way] ||= EDITORS[way](this.app, onChange, onWait);
    fill(this.place, way ? this.editors[way].element : null);
    this.tell(this.app.inputs.get().motion);
  }

  /** Says when what is measured is not what the form shows: another way, a file that waits, an error. */
  markStale() {
    const { motion } = this.app.inputs.get();
    const wrong = [this.place, this.scale.element].some((part) => part.querySelector("[aria-invalid=true]"));
    const waits = this.editors[this.way]?.waiting;
    const stale = Boolean(motion && (wrong || waits || wayOf(motion) !== this.way));
    const name = motion?.file_name ?? "the motion from before";
    const file = waits ? "The new file is not read yet" : "No file is chosen yet";
    const why = wrong && !waits ? "A number is marked as wrong" : file;
    const words = `${why}: what is measured below, and what shakes the body, is still ${name}.`;
    const told = stale ? words : "";
    if (told !== this.told) fill(this.pending, told ? note(told, "warning") : null);
    this.told = told;
    this.result.element.classList.toggle("stale", stale);
  }

  tell(motion) {
    if (motion && wayOf(motion) === this.way) this.editors[this.way].show(motion);
    this.scale.show(motion?.scale ?? 1);
    this.scale.element.hidden = !motion;
  }

  /** Makes a motion the motion; a motion and a free start exclude each other. */
  set(motion) {
    const { scale } = this.app.inputs.get().motion || {};
    const next = scale === undefined || motion.scale !== undefined ? motion : { ...motion, scale };
    this.app.inputs.set("response.free", undefined);
    this.app.inputs.set("motion", next);
  }

  setScale(scale) {
    const { motion } = this.app.inputs.get();
    if (motion) this.app.inputs.set("motion", { ...motion, scale });
  }

  follow({ motion }) {
    this.dirty = true;
    rememberMotion(motion);
    if (wayOf(motion) !== this.way) this.open(wayOf(motion));
    else this.tell(motion);
    this.markStale();
    if (this.visible) this.refresh();
  }

  async refresh() {
    const { motion, settings } = this.app.inputs.get();
    this.dirty = false;
    if (!motion) {
      const back = button({ text: "Back to the motion before", onClick: () => this.set(motionBefore()) });
      fill(this.refusal, note(LEAN), el("div", { class: "toolbar" }, back));
      this.result.clear();
      return;
    }
    try {
      this.show(await this.app.latest("motion", "motion", { motion, settings, points: this.result.dots }));
    } catch (error) {
      if (!this.app.superseded(error)) this.refuse(error);
    }
  }

  show(answer) {
    this.answer = answer;
    fill(this.refusal, ...(answer.warnings ?? []).map((each) => note(each, "warning")));
    this.result.show(answer);
  }

  /** Asks again for the part of the time that the traces show. */
  async lookInto(window) {
    const { answer } = this;
    const { motion, settings } = this.app.inputs.get();
    const asked = { motion, settings, points: this.result.dots, window, spectrum: false };
    try {
      const found = await this.app.latest("motion-part", "motion", asked);
      if (answer === this.answer) this.result.showTraces(found.series, window);
    } catch (error) {
      if (!this.app.superseded(error)) this.app.say(error.message, "error");
    }
  }

  refuse(error) {
    fill(this.refusal, note(error.message, "error"));
    this.result.clear();
    this.editors[this.way]?.refused?.(error);
  }

  shown() {
    this.visible = true;
    if (this.dirty) this.refresh();
  }

  hidden() {
    this.visible = false;
  }
}
