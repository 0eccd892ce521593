/** How the body rocks: verdict, animation, curves, impacts, for several restitution models at once. */
import { el, fill } from "/app/dom.js";
import { button, card, note } from "/app/fields.js";
import { onLook } from "/views/response-chosen.js";
import { chartsOf } from "/views/response-charts.js";
import { controlsOf } from "/views/response-controls.js";
import { filesOf } from "/views/response-files.js";
import { impactsOf } from "/views/response-impacts.js";
import { sceneOf } from "/views/response-scene.js";
import { verdictOf } from "/views/response-verdict.js";

const KEYS = ["body", "motion", "restitution", "response", "settings"];

/** Shows the view of the response in a section. */
export const mount = (section, app) => {
  const view = new ResponseView(app);
  section.append(...view.parts);
  view.mounted(section);
  return { shown: () => view.shown(), hidden: () => view.hidden() };
};

const shownOf = ({ answers }) => answers.filter((one) => one.series);

class ResponseView {
  constructor(app) {
    this.app = app;
    this.dirty = true;
    this.asked = false;
    this.verdict = verdictOf();
    this.scene = sceneOf();
    this.controls = controlsOf(app);
    this.charts = chartsOf((instant) => this.scene.glance(instant), (window) => this.lookInto(window));
    this.impacts = impactsOf(app);
    this.refusal = el("div", { "aria-live": "polite", "data-testid": "response-refusal" });
    this.results = el("div", { class: "response-results" });
    this.parts = [this.head(), this.refusal, this.verdict.element, this.stage(), this.details()];
  }

  head() {
    const lead = "The same body and motion with several models of the impact: does the choice matter?";
    return el("div", { class: "view-head" }, el("h1", {}, "Response"), el("p", { class: "lead" }, lead));
  }

  stage() {
    const scene = card("The body on the ground", this.scene.element);
    return el("div", { class: "columns response-columns" }, scene, this.controls.element);
  }

  details() {
    const curves = card("Curves", this.charts.element);
    const impacts = card("Impacts", this.impacts.element);
    return fill(this.results, curves, impacts, filesOf(this.app));
  }

  mounted(section) {
    this.app.inputs.subscribe((inputs, changed) => {
      if (!KEYS.some((key) => changed.has(key))) return;
      this.dirty = true;
      this.controls.show(inputs);
      if (this.visible) this.ask();
    });
    this.controls.show(this.app.inputs.get());
    onLook(() => this.follow());
    for (const kind of ["input", "change"]) section.addEventListener(kind, () => this.markStale());
    section.addEventListener("keydown", (event) => this.onKey(event));
  }

  /** What is drawn belongs to the last good numbers while a field is in error. */
  markStale() {
    const stale = this.controls.element.querySelector("[aria-invalid=true]") !== null;
    const parts = [this.verdict.element, this.scene.element, this.results];
    for (const part of parts) part.classList.toggle("stale", stale);
  }

  /** Several changes of one moment are one question. */
  ask() {
    if (this.asked) return;
    this.asked = true;
    queueMicrotask(() => {
      this.asked = false;
      this.refresh();
    });
  }

  async refresh() {
    const given = this.question();
    this.dirty = false;
    if (!given) return this.nothingMoves();
    try {
      this.show(await this.app.latest("response", "response", given));
    } catch (error) {
      if (!this.app.superseded(error)) this.refuse(error);
    }
    return undefined;
  }

  /** What is asked; null while nothing moves the body. */
  question() {
    const { body, motion, restitution, response, settings } = this.app.inputs.get();
    const free = response?.free !== undefined && response?.free !== null;
    if (!motion && !free) return null;
    const moved = free ? undefined : motion;
    return { body, motion: moved, restitution, response, settings, points: this.charts.dots };
  }

  /** Asks again for the part of the time that the charts show. */
  async lookInto(window) {
    const { answer } = this;
    try {
      const found = await this.app.latest("response-part", "response", { ...this.question(), window });
      if (answer === this.answer) this.charts.draw(window, shownOf(found));
    } catch (error) {
      if (!this.app.superseded(error)) this.app.say(error.message, "error");
    }
  }

  nothingMoves() {
    const choose = button({ text: "Choose a motion", kind: "primary", onClick: () => this.app.go("motion") });
    const lean = button({ text: "Let it go from a lean", onClick: () => this.controls.lean() });
    const words = note("Nothing moves the body yet: choose a motion, or let it go from a lean.");
    fill(this.refusal, words, el("div", { class: "toolbar" }, choose, lean));
    this.hideResults(true);
  }

  refuse(error) {
    fill(this.refusal, note(error.message, "error"));
    this.hideResults(true);
  }

  hideResults(hidden) {
    this.verdict.element.hidden = hidden;
    this.results.hidden = hidden;
    this.scene.element.hidden = hidden;
  }

  show(answer) {
    this.answer = answer;
    fill(this.refusal);
    this.hideResults(false);
    const shown = shownOf(answer);
    this.verdict.show(answer);
    this.scene.show(answer, shown);
    this.charts.show(shown, this.app.inputs.get().response?.assumed_friction ?? 0.5);
    this.impacts.show(shown);
    this.results.dataset.drawn = String(Number(this.results.dataset.drawn || 0) + 1);
  }

  /** Shows the model that is looked at in every part. */
  follow() {
    if (!this.answer) return;
    this.verdict.mark();
    this.scene.follow();
    this.charts.showFollowed();
    this.impacts.draw();
  }

  onKey(event) {
    if (event.key !== " " || event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.target.closest("button, select, summary, a, input:not([type=range]), textarea")) return;
    event.preventDefault();
    this.scene.toggle();
  }

  shown() {
    this.visible = true;
    if (this.dirty) this.ask();
  }

  hidden() {
    this.visible = false;
    this.scene.pause();
  }
}
