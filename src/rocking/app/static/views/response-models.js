/** Which models of the impact are compared, with a coefficient of one's own beside them. */
import { el, fill } from "/app/dom.js";
import { numberField, selectField, slider, switchField } from "/app/fields.js";
import { look } from "/views/response-chosen.js";
import { swatch, wordsOf } from "/views/response-labels.js";
import { readRestitution, writeRestitution } from "/views/response-restitution.js";

const USUAL = 0.9;
const CALIBRATED = "The calibrated model is fitted to the published measurements; Impact shows its interval.";

/** Whether a model needs no number of one's own. */
export const complete = ({ parameters }) => Object.values(parameters).every((one) => one.default !== null);

/** Returns the choice of models. */
export const modelsOf = (app) => new ModelChoice(app);

class ModelChoice {
  constructor(app) {
    this.app = app;
    this.boxes = new Map();
    this.main = selectField({
      label: "Main model",
      options: [],
      help: "Its answer comes first: in the files, the report and on the command line.",
      onChange: (label) => this.lead(label),
    });
    this.about = el("p", { class: "field-help" }, CALIBRATED);
    this.list = el("fieldset", { class: "model-list" }, el("legend", { class: "visually-hidden" }, "Models"));
    this.own = switchField({
      label: "A coefficient of my own",
      onChange: (on) => this.change({ value: on ? USUAL : null }),
    });
    this.value = slider({
      label: "Coefficient of restitution r",
      unit: "",
      min: 0,
      max: 1,
      step: 0.005,
      value: USUAL,
      onInput: (value) => this.change({ value }),
    });
    this.apart = switchField({
      label: "One coefficient for each foot",
      help: "Stands alone, without models.",
      onChange: (on) => this.change({ feet: on ? [USUAL, USUAL] : null }),
    });
    this.left = this.footField("Onto the left foot", 0);
    this.right = this.footField("Onto the right foot", 1);
    this.feet = el("div", { class: "fields" }, this.left, this.right);
    const parts = [this.list, this.main, this.own, this.value, this.about, this.apart, this.feet];
    this.element = el("div", { class: "models" }, parts);
  }

  footField(label, index) {
    const onChange = (value) => {
      const feet = [...this.state.feet];
      feet[index] = value;
      this.change({ feet });
    };
    return numberField({ label, value: USUAL, min: 0, max: 10, step: 0.01, onChange });
  }

  change(changes) {
    const next = { ...this.state, ...changes };
    const table = writeRestitution(next);
    if (table === null) {
      this.app.say("At least one model or coefficient is needed.", "warning");
      this.show(this.app.inputs.get().restitution);
      return;
    }
    this.app.inputs.set("restitution", table);
  }

  toggle(label, on) {
    const others = this.state.models.filter((one) => one !== label);
    this.change({ models: on ? [...others, label] : others });
  }

  /** Puts a model first, and looks at it. */
  lead(label) {
    this.change({ models: [label, ...this.state.models.filter((one) => one !== label)] });
    look(label);
  }

  labels() {
    const known = this.app.info.models.filter(complete).map((one) => one.label);
    return [...new Set([...known, ...this.state.models])];
  }

  build() {
    const labels = this.labels();
    if (labels.length === this.boxes.size) return;
    this.boxes.clear();
    const rows = labels.map((label) => this.row(label));
    fill(this.list, el("legend", { class: "visually-hidden" }, "Models"), rows);
  }

  row(label) {
    const onchange = () => this.toggle(label, box.checked);
    const box = el("input", { type: "checkbox", value: label, onchange });
    this.boxes.set(label, box);
    const title = this.app.info.models.find((one) => one.label === label)?.title;
    return el("label", { class: "model-row", title }, box, swatch(label), el("span", {}, wordsOf(label)));
  }

  /** Shows what the inputs say. */
  show(table) {
    this.state = readRestitution(table);
    this.build();
    const { models, value, feet } = this.state;
    for (const [label, box] of this.boxes) {
      box.checked = models.includes(label);
      box.disabled = feet !== null;
    }
    this.main.hidden = models.length < 2 || feet !== null;
    this.main.setOptions(models.map((label) => ({ value: label, text: wordsOf(label) })));
    this.main.value = models[0];
    this.own.value = value !== null;
    this.own.hidden = feet !== null;
    this.value.hidden = value === null || feet !== null;
    if (value !== null && Math.abs(this.value.value - value) > 1e-9) this.value.value = Math.min(value, 1);
    this.apart.value = feet !== null;
    this.feet.hidden = feet === null;
    if (feet) [this.left.value, this.right.value] = feet;
  }
}
