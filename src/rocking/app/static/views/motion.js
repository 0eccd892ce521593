/** What shakes the ground: a record file, a pulse, or a synthetic motion. */
import { el, fill } from "/app/dom.js";
import { card, note, segmented } from "/app/fields.js";
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

const wayOf = (motion) => Object.keys(EDITORS).find((way) => motion?.[way] !== undefined) || "pulse";

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
    this.refusal = el("div", { "aria-live": "polite", "data-testid": "motion-refusal" });
    this.result = resultOf(app);
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
    const right = el("div", { class: "motion-right" }, this.refusal, this.result.element);
    return el("div", { class: "columns narrow-wide" }, left, right);
  }

  mounted() {
    this.open(this.way);
    this.app.inputs.subscribe((inputs, changed) => {
      if (changed.has("motion") || changed.has("settings")) this.follow(inputs);
    });
  }

  /** Shows the editor of a way; its last choice becomes the motion if that was another. */
  choose(way) {
    const { motion } = this.app.inputs.get();
    if (motion) this.kept[wayOf(motion)] = motion;
    this.open(way);
    const next = this.kept[way] || this.editors[way].usual();
    if (next) this.set(next);
  }

  open(way) {
    this.way = way;
    this.ways.value = way;
    this.editors[way] ||= EDITORS[way](this.app, (motion) => this.set(motion));
    fill(this.place, this.editors[way].element);
    this.tell(this.app.inputs.get().motion);
  }

  tell(motion) {
    if (motion && wayOf(motion) === this.way) this.editors[this.way].show(motion);
    this.scale.show(motion?.scale ?? 1);
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
    if (motion && wayOf(motion) !== this.way) this.open(wayOf(motion));
    else this.tell(motion);
    if (this.visible) this.refresh();
  }

  async refresh() {
    const { motion, settings } = this.app.inputs.get();
    this.dirty = false;
    if (!motion) {
      const words = "No motion is chosen: the body is let go from a lean. Choose one here to shake it.";
      fill(this.refusal, note(words));
      this.result.clear();
      return;
    }
    try {
      const json = settings ? { motion, settings } : { motion };
      this.show(await this.app.latest("motion", "motion", json));
    } catch (error) {
      if (!this.app.superseded(error)) this.refuse(error);
    }
  }

  show(answer) {
    fill(this.refusal);
    this.result.show(answer);
  }

  refuse(error) {
    fill(this.refusal, note(error.message, "error"));
    this.result.clear();
    this.editors[this.way].refused?.(error);
  }

  shown() {
    this.visible = true;
    if (this.dirty) this.refresh();
  }

  hidden() {
    this.visible = false;
  }
}
