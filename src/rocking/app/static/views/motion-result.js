/** What a motion is: facts, traces, spectrum and measures. */
import { lineChart } from "/charts/line.js";
import { detailed, dotsOf, zoomOf } from "/charts/zoom.js";
import { el, fill } from "/app/dom.js";
import { button, card, tableOf, toolbar } from "/app/fields.js";
import { pretty, quantity } from "/app/format.js";
import { spectrumChart } from "/views/motion-spectrum.js";
import { plainWords } from "/views/studies-words.js";

const TRACES = [
  { key: "acceleration", label: "acceleration", unit: "m/s2", colour: "#0070B2" },
  { key: "velocity", label: "velocity", unit: "m/s", colour: "#009960" },
  { key: "displacement", label: "displacement", unit: "m", colour: "#D96C00" },
];
const UP = { key: "vertical", label: "vertical acceleration", unit: "m/s2", colour: "#AC8191" };
const SYNC = "motion";
const G = 9.80665;
const LOOK = "Drag across a trace to look into it with every sample; a double click shows all of it again.";

const titled = (text) => text[0].toUpperCase() + text.slice(1);

/** Returns the part of the view that shows the answer of the server. */
export const resultOf = (app, onZoom) => new MotionResult(app, onZoom);

class MotionResult {
  constructor(app, onZoom) {
    this.app = app;
    this.zoom = zoomOf((window) => (window ? onZoom(window) : this.showTraces()));
    this.facts = el("dl", { class: "facts", "data-testid": "motion-facts" });
    this.name = el("p", { class: "motion-name", "data-testid": "motion-name" });
    this.note = el("p", { class: "field-help" });
    this.traces = el("div", { class: "motion-traces", "data-testid": "motion-traces" });
    this.spectrum = spectrumChart();
    this.measures = el("div", { "data-testid": "motion-measures" });
    this.charts = {};
    const cards = [this.summary(), this.curves(), this.response(), this.table()];
    this.element = el("div", { class: "motion-result", "data-testid": "motion-result" }, cards);
    this.element.hidden = true;
  }

  summary() {
    return card("In short", this.name, this.facts);
  }

  curves() {
    return card("Acceleration, velocity, displacement", this.traces, this.note, this.tools());
  }

  response() {
    const tools = toolbar(this.saver("CSV", "table/spectrum.csv", "Response spectrum as CSV"));
    return card("Response spectrum", this.spectrum.element, tools);
  }

  table() {
    return card("Intensity measures", this.measures);
  }

  tools() {
    return toolbar(
      this.saver("PNG", "picture/motion.png", "Motion as PNG"),
      this.saver("SVG", "picture/motion.svg", "Motion as SVG"),
      this.saver("CSV", "table/motion.csv", "Motion as CSV"),
    );
  }

  saver(text, path, label) {
    const name = path.replaceAll("/", "-");
    return button({ text, label, onClick: () => this.app.download(path, this.app.inputs.get(), name) });
  }

  /** Takes everything away. */
  clear() {
    this.element.hidden = true;
  }

  /** Shows an answer. */
  show(answer) {
    this.element.hidden = false;
    fill(this.name, plainWords(answer.name));
    fill(this.facts, ...factsOf(answer).flatMap(([word, text]) => [el("dt", {}, word), el("dd", {}, text)]));
    const { shown, of } = answer.series;
    fill(this.note, of > shown ? `${shown} of ${of} samples are drawn: the extremes of every dot. ${LOOK}` : "");
    this.series = answer.series;
    this.zoom.reset();
    this.showTraces();
    this.spectrum.show(answer.spectrum);
    this.showMeasures(answer.measures);
  }

  /** Over how many dots a trace is drawn. */
  get dots() {
    return dotsOf(this.traces);
  }

  /** Draws a part of the time in detail, or all of it. */
  showTraces(part = null, window = null) {
    const series = part ? detailed(this.series, part) : this.series;
    const wanted = [...TRACES, UP].filter(({ key }) => Array.isArray(series[key]));
    const shape = wanted.map(({ key }) => key).join();
    if (shape !== this.shape) {
      Object.values(this.charts).forEach((chart) => chart.destroy());
      this.charts = Object.fromEntries(wanted.map((one) => [one.key, this.trace(one)]));
      this.shape = shape;
    }
    for (const { key } of wanted) this.charts[key].setData([series.time, series[key]], window);
    this.traces.dataset.window = window?.join(" ") ?? "";
  }

  trace({ label, unit, colour }) {
    return lineChart(this.traces, {
      title: titled(label),
      x: { label: "time", unit: "s" },
      y: { label: "", unit },
      series: [{ label, colour, width: 1.4 }],
      height: 180,
      sync: SYNC,
      onZoom: this.zoom.look,
    });
  }

  showMeasures(measures) {
    const rows = measures.map(({ name, words, value, unit }) => {
      return [words || name, value, unit === "-" ? "" : pretty(unit)];
    });
    const columns = ["Measure", { label: "Value", digits: 4 }, { label: "Unit", numeric: false }];
    const csv = () => this.app.download("table/measures.csv", this.app.inputs.get(), "measures.csv");
    fill(this.measures, tableOf(columns, rows, { caption: "", csv, testid: "measures-table" }));
  }
}

const factsOf = (answer) => {
  const peak = answer.peak_acceleration_m_s2 ?? peakOf(answer.series.acceleration);
  const found = [
    ["Peak acceleration", `${quantity(peak, "m/s2", 4)} (${quantity(peak / G, "g", 3)})`],
    ["Duration", quantity(answer.duration_s, "s", 5)],
  ];
  if (answer.time_step_s) found.push(["Time step", quantity(answer.time_step_s, "s", 5)]);
  if (answer.samples) found.push(["Samples", String(answer.samples)]);
  for (const key of ["event", "station", "component", "format", "file_unit"]) {
    if (answer[key]) found.push([titled(key.replace("_", " ")), String(answer[key])]);
  }
  if (answer.peak_vertical_acceleration_m_s2) {
    found.push(["Peak vertical acceleration", quantity(answer.peak_vertical_acceleration_m_s2, "m/s2", 4)]);
  }
  return found;
};

const peakOf = (values) => values.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
