/** What one may turn while the answer follows: strength, size, a free start, friction, models. */
import { el } from "/app/dom.js";
import { card, numberField, slider, switchField } from "/app/fields.js";
import { motionBefore, rememberMotion } from "/views/motion-before.js";
import { modelsOf } from "/views/response-models.js";
import { canBeScaled, scaledBody } from "/views/response-size.js";

const LEAN = 0.5;

/** Returns the controls of the response. */
export const controlsOf = (app) => new ResponseControls(app);

class ResponseControls {
  constructor(app) {
    this.app = app;
    this.models = modelsOf(app);
    this.size = this.sizeSlider();
    this.scale = this.scaleSlider();
    this.free = switchField({
      label: "Let it go from a lean instead",
      help: "Free rocking: the ground stands still.",
      onChange: (on) => (on ? this.lean() : this.shake()),
    });
    this.first = slider({
      label: "First rotation over slenderness angle",
      unit: "",
      min: -0.99,
      max: 0.99,
      step: 0.01,
      value: LEAN,
      onInput: (value) => app.inputs.set("response.free", value || 0.01),
    });
    this.friction = numberField({
      label: "Friction between body and ground",
      value: 0.5,
      min: 0.01,
      max: 10,
      step: 0.05,
      help: "Rocking that takes more would slide.",
      onChange: (value) => app.inputs.set("response.assumed_friction", value),
    });
    const turn = card("Turn and see", this.scale, this.size, this.free, this.first, this.friction);
    const models = card("Models of the impact", this.models.element);
    this.element = el("div", { class: "response-controls" }, turn, models);
  }

  sizeSlider() {
    return slider({
      label: "Size of the body, all lengths",
      unit: "",
      min: 0.2,
      max: 5,
      value: 1,
      log: true,
      help: "Against the body as it was drawn; larger ones are more stable.",
      onInput: (factor) => this.resize(factor),
    });
  }

  scaleSlider() {
    return slider({
      label: "Scale of the motion",
      unit: "",
      min: 0.1,
      max: 10,
      value: 1,
      log: true,
      onInput: (scale) => this.app.inputs.set("motion.scale", scale),
    });
  }

  /** Changes every length of the body, from the body as it was when the slider stood at one. */
  resize(factor) {
    this.made = JSON.stringify(scaledBody(this.drawn, factor));
    this.app.inputs.set("body", JSON.parse(this.made));
  }

  /** Lets the body go from a lean, on ground that stands still. */
  lean() {
    rememberMotion(this.app.inputs.get().motion);
    this.app.inputs.set("response.free", LEAN);
    this.app.inputs.set("motion", undefined);
  }

  /** Brings the motion back. */
  shake() {
    this.app.inputs.set("response.free", undefined);
    this.app.inputs.set("motion", motionBefore());
  }

  /** Shows what the inputs say. */
  show({ body, motion, restitution, response }) {
    if (JSON.stringify(body) !== this.made) {
      this.drawn = body;
      this.made = JSON.stringify(body);
      this.size.value = 1;
    }
    this.size.hidden = !canBeScaled(body);
    const free = response?.free ?? null;
    this.free.value = free !== null;
    this.first.hidden = free === null;
    if (free !== null && Math.abs(this.first.value - free) > 1e-9) this.first.value = free;
    this.scale.hidden = free !== null || !motion;
    if (motion && this.scale.value !== (motion.scale ?? 1)) this.scale.value = clipped(motion.scale ?? 1);
    this.friction.value = response?.assumed_friction ?? 0.5;
    this.models.show(restitution);
  }
}

const clipped = (value) => Math.min(Math.max(Math.abs(value), 0.1), 10);
