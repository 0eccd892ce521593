/** Rotation, angular velocity, energy and friction demand over time. */
import { lineChart } from "/charts/line.js";
import { detailed, dotsOf, zoomOf } from "/charts/zoom.js";
import { el, fill } from "/app/dom.js";
import { sharesOf } from "/scene/sampled.js";
import { chosenOf } from "/views/response-chosen.js";
import { curveKey, styleOf, wordsOf } from "/views/response-labels.js";
import { together } from "/views/response-series.js";

const SYNC = "response";
const TIME = { label: "time", unit: "s" };
const MOST_FRICTION = 3;
const FALL_SHOWN = 1.5;
const LOOK = "Drag across a chart to look into it with every sample; a double click shows all of it again.";

// what follows the point of no return is a fall to the ground, beside which no rocking could be seen
const untilFall = (answer, values) => {
  const shares = sharesOf(answer.series.rotation, answer.body);
  const falls = answer.outcome === "overturned";
  const fallen = falls ? shares.findIndex((share) => Math.abs(share) > FALL_SHOWN) : -1;
  return fallen < 0 ? values : values.map((value, k) => (k < fallen ? value : null));
};

const capped = (values) => values.map((value) => (value === null || value > MOST_FRICTION ? null : value));

// the lines of +1 and -1 are in sight unless the rocking is small beside them
const rotationRange = (_, low, high) => {
  const most = Math.max(Math.abs(low ?? 0), Math.abs(high ?? 0));
  const span = most > 0.25 ? Math.max(1.15, 1.05 * most) : 1.15 * most || 1;
  return [-span, span];
};

const CURVES = [
  {
    key: "rotation",
    title: "Rotation over slenderness angle",
    y: { label: "\u03b8/\u03b1", unit: "-", range: rotationRange },
    values: (answer) => untilFall(answer, sharesOf(answer.series.rotation, answer.body)),
  },
  {
    key: "velocity",
    title: "Angular velocity",
    y: { label: "", unit: "rad/s" },
    values: (answer) => untilFall(answer, answer.series.velocity),
  },
  {
    key: "friction",
    title: "Friction that rocking without slip takes",
    y: { label: "", unit: "-" },
    values: (answer) => untilFall(answer, capped(answer.series.friction_demand)),
  },
];
const ENERGIES = [
  { key: "kinetic", label: "kinetic", colour: "#0072B2", dash: [] },
  { key: "potential", label: "potential", colour: "#009E73", dash: [8, 3, 2, 3] },
  { key: "lost", label: "lost at impacts", colour: "#D55E00", dash: [6, 4] },
  { key: "work", label: "work of the ground", colour: "#8A8A8A", dash: [2, 3] },
];

/** Returns the charts of a response; a pointer on one shows that instant in the animation, a drag looks into them. */
export const chartsOf = (onInstant, onZoom) => new ResponseCharts(onInstant, onZoom);

class ResponseCharts {
  constructor(onInstant, onZoom) {
    this.onInstant = onInstant;
    this.zoom = zoomOf((window) => (window ? onZoom(window) : this.draw()));
    this.places = Object.fromEntries(["rotation", "velocity", "energy", "friction"].map(placeOf));
    const places = Object.values(this.places);
    this.about = el("p", { class: "field-help" });
    const grid = el("div", { class: "response-charts", "data-testid": "response-charts" }, places);
    this.element = el("div", {}, grid, this.about);
    this.charts = {};
  }

  /** Draws these answers; energy and impacts are those of the model that is followed. */
  show(answers, friction) {
    if (!answers.length) return;
    this.answers = this.whole = answers;
    this.zoom.reset();
    this.friction = friction;
    const labels = answers.map(({ label }) => curveKey(label)).join("|");
    if (labels !== this.labels) this.rebuild(answers);
    this.labels = labels;
    this.charts.friction.setMarks({ horizontal: [friction] });
    this.draw();
  }

  /** Draws a part of the time in detail, or all of it. */
  draw(window = null, parts = []) {
    this.answers = this.whole.map((answer, k) =>
      (parts[k] ? { ...answer, series: detailed(answer.series, parts[k].series) } : answer));
    for (const { key, values } of CURVES) this.charts[key].setData(together(this.answers, values), window);
    this.showFollowed();
    this.element.dataset.window = window?.join(" ") ?? "";
  }

  /** Over how many dots one of them is drawn. */
  get dots() {
    return dotsOf(this.places.rotation);
  }

  /** Shows energy and impacts of the model that is looked at. */
  showFollowed() {
    if (!this.answers) return;
    const chosen = chosenOf(this.answers.map(({ label }) => label));
    const answer = this.answers.find(({ label }) => label === chosen);
    if (curveKey(answer.label) !== this.followed) this.rebuildEnergy(answer.label);
    this.charts.energy.setData(energyOf(answer), this.zoom.window());
    const vertical = answer.impacts.map(({ time_s: time }) => time);
    this.charts.rotation.setMarks({ vertical, horizontal: [-1, 1] });
    const marks = `Dotted: impacts of ${wordsOf(answer.label)}; dashed: the slenderness angles.`;
    fill(this.about, marks, fallWords(this.answers), ` ${LOOK}`);
  }

  rebuild(answers) {
    for (const { key } of CURVES) this.charts[key]?.destroy();
    const series = answers.map(({ label }) => {
      return { label: wordsOf(label), ...styleOf(label), width: 1.6 };
    });
    // the friction that is given stays in sight
    const range = (_, low, high) => [0, 1.1 * Math.max(high ?? 0, this.friction)];
    for (const { key, title, y } of CURVES) {
      this.place(key, { title, y: key === "friction" ? { ...y, range } : y, series });
    }
  }

  rebuildEnergy(label) {
    this.charts.energy?.destroy();
    const series = ENERGIES.map((one) => ({ ...one, width: 1.6 }));
    this.place("energy", { title: `Energy (${wordsOf(label)})`, y: { label: "", unit: "J" }, series });
    this.followed = curveKey(label);
  }

  place(key, look) {
    this.charts[key] = lineChart(this.places[key], {
      x: TIME, height: 220, sync: SYNC, onZoom: this.zoom.look, ...look,
    });
    this.charts[key].setCursorHook((_, instant) => this.onInstant(instant));
  }
}

const placeOf = (key) => [key, el("div", { class: "response-chart", "data-testid": `chart-${key}` })];

const fallWords = (answers) =>
  answers.some(({ outcome }) => outcome === "overturned")
    ? ` Curves of a body that overturns end at ${FALL_SHOWN} \u03b1. The animation follows the fall, by the same equation, `
      + "until a corner meets the ground; there it stays, since a landing on a side is not computed."
    : "";

const energyOf = (answer) => {
  const { series } = answer;
  return [series.time, ...ENERGIES.map(({ key }) => untilFall(answer, series[key]))];
};
