/** Motion: properties, time histories, spectrum and measures. */
import { html, useMemo } from "/parts/preact.js";
import { pretty, quantity } from "/app/format.js";
import { Figure } from "/charts/figure.js";
import { detailed } from "/charts/zoom.js";
import { Button, Card } from "/parts/fields.js";
import { Table } from "/parts/table.js";
import { aboutOf } from "/views/about.js";
import { Spectrum } from "/views/motion-spectrum.js";
import { plainWords } from "/views/studies-words.js";
import { t } from "/app/words.js";

const TRACES = [
  { key: "acceleration", label: "acceleration", unit: "m/s2", colour: "#0070B2" },
  { key: "velocity", label: "velocity", unit: "m/s", colour: "#009960" },
  { key: "displacement", label: "displacement", unit: "m", colour: "#D96C00" },
  { key: "vertical_acceleration", label: "vertical acceleration", unit: "m/s2", colour: "#AC8191" },
];
const G = 9.80665;
const LOOK = "Drag across a trace to zoom in. Double-click to show the whole trace.";
const MEASURE = ["Measure", { label: "Value", digits: 4 }, { label: "Unit", numeric: false }];

/** @param {string} text */
const titled = (text) => text[0].toUpperCase() + text.slice(1);

/** The results of the server; `closeup` has the visible interval with its detailed curves.
 * @param {{ app: App, answer: Server.MotionAnswered, closeup: any, time: Time, stale: boolean }} props */
export const Result = ({ app, answer, closeup, time, stale }) => {
  const { samples_shown: shown, samples: of } = answer.series;
  /** @type {any} */
  const series = useMemo(() => (closeup?.series ? detailed(answer.series, closeup.series) : answer.series), [answer, closeup]);
  const measures = answer.measures.map(({ name, description: text }) => [text, answer.intensity[name], answer.units[name] === "1" ? "" : pretty(answer.units[name])]);
  /** @param {string} path @param {string} [name] */
  const save = (path, name = path.replaceAll("/", "-")) => app.download(path, app.inputs.get(), name);
  /** @param {string} text @param {string} path @param {string} label */
  const saver = (text, path, label) => html`<${Button} aria-label=${label} onClick=${() => save(path)}>${text}<//>`;
  return html`
    <div class=${`motion-result ${stale ? "stale" : ""}`} data-testid="motion-result" ...${aboutOf({}, answer)}>
      <${Card} title="Summary"><p class="motion-name" data-testid="motion-name">${plainWords(answer.name)}</p>
        <dl class="facts" data-testid="motion-facts">
          ${factsOf(answer).map(([word, text]) => html`<dt key=${word}>${word}</dt><dd>${text}</dd>`)}</dl><//>
      <${Card} title="Acceleration, velocity, displacement">
        <div class="motion-traces" data-testid="motion-traces">
          ${TRACES.filter(({ key }) => Array.isArray(series[key])).map((trace) => html`
            <${Trace} key=${trace.key} trace=${trace} series=${series} interval=${closeup?.window ?? null} time=${time} />`)}</div>
        <p class="field-help">${of > shown && t("The curve shows {shown} of {count} samples: the extremes of each pixel. {hint}", { shown, count: of, hint: LOOK })}</p>
        <div class="toolbar">${saver("CSV", "table/motion.csv", "Motion as CSV")}</div><//>
      <${Card} title="Response spectrum"><${Spectrum} spectrum=${answer.spectrum} />
        <div class="toolbar">${saver("CSV", "table/spectrum.csv", "Response spectrum as CSV")}</div><//>
      <${Card} title="Intensity measures"><div data-testid="motion-measures">
        <${Table} columns=${MEASURE} rows=${measures} caption="" testid="measures-table"
          csv=${() => save("table/measures.csv", "measures.csv")} /></div><//>
    </div>`;
};

/** @param {{ trace: typeof TRACES[number], series: any, interval: Point | null, time: Time }} props */
const Trace = ({ trace: { key, label, unit, colour }, series, interval, time }) => {
  const data = useMemo(() => [series.time, series[key]], [series]);
  const shape = {
    title: titled(t(label)), x: { label: "time", unit: "s" }, y: { label: "", unit }, series: [{ label, colour, width: 1.4 }],
    height: 180,
  };
  return html`<${Figure} shape=${shape} data=${data} interval=${interval} time=${time} />`;
};

/** @param {Server.MotionAnswered} answer */
const factsOf = (answer) => {
  const peak = answer.peak_ground_acceleration;
  const rows = [
    ["Peak acceleration", `${quantity(peak, "m/s2", 4)} (${quantity(peak / G, "g", 3)})`],
    ["Duration", quantity(answer.duration, "s", 5)],
  ];
  if (answer.time_step) rows.push(["Time step", quantity(answer.time_step, "s", 5)]);
  if (answer.samples) rows.push(["Samples", String(answer.samples)]);
  for (const key of /** @type {const} */ (["event", "station", "component", "format", "file_unit"])) {
    if (answer[key]) rows.push([titled(t(key.replace("_", " "))), String(answer[key])]);
  }
  if (answer.peak_vertical_acceleration) {
    rows.push(["Peak vertical acceleration", quantity(answer.peak_vertical_acceleration, "m/s2", 4)]);
  }
  return rows;
};
