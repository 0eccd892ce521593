/** A fragility: probability curves with their bands, the points they come from, and what the fit says. */
import { el, fill } from "/app/dom.js";
import { note, selectField, tableOf } from "/app/fields.js";
import { modelWords, seriesStyle } from "/app/palette.js";
import { lineChart } from "/charts/line.js";
import { pretty, quantity } from "/app/format.js";
import { greek, plainWords } from "/views/studies-words.js";

/** Show fragility curves inside a place; returns how to clear up. */
export const showFragility = (place, app, study, found, chosen) => {
  const box = el("div", { class: "study-result" });
  let charts = [];
  const draw = (k) => {
    chosen.restitution = k;
    charts.forEach((chart) => chart.destroy());
    fill(box);
    charts = drawAnalysis(box, found, found.analyses[k]);
  };
  if (found.analyses.length > 1) {
    const options = found.analyses.map(({ restitution }, value) => ({
      value,
      text: modelWords(restitution),
    }));
    place.append(selectField({ label: "Restitution", options, value: 0, onChange: draw }));
  }
  place.append(box);
  draw(0);
  return () => charts.forEach((chart) => chart.destroy());
};

const drawAnalysis = (box, found, analysis) => {
  const unit = found.measure.unit === "1" ? "" : found.measure.unit;
  const x = { label: found.measure.words, unit };
  // without a curve the points still show what was found
  const left = new Set(analysis.sentences);
  const charts = Object.entries(analysis.points).map(([state, points], index) => {
    const curve = analysis.curves[state];
    const chart = drawCurve(box, { state, curve: curve ?? NO_CURVE, points }, index, x);
    if (!curve) box.append(whyNone(left, state, found.uplift_threshold, unit));
    return chart;
  });
  if (analysis.resurrection) box.append(note(analysis.resurrection, "info"));
  for (const sentence of left) box.append(note(withUnit(sentence, unit), "info"));
  if (found.definition) box.append(el("p", { class: "quiet" }, plainWords(found.definition)));
  const rows = Object.entries(analysis.fits).map(([state, fit]) => rowOf(state, fit));
  box.append(tableOf(columnsOf(unit), rows, { caption: "Lognormal fits", testid: "fragility-fits" }));
  return charts;
};

// The reason stands under the points that have no curve, and not once more below.
const whyNone = (left, state, threshold, unit) => {
  const sentence = [...left].find((each) => each.startsWith(`${state}: `));
  left.delete(sentence);
  const why = sentence ? withUnit(sentence.slice(state.length + 2), unit) : stepWords(threshold, unit);
  const words = `No curve is drawn: ${why}.`.replace(/\.\.$/, ".");
  return el("div", { "data-testid": "no-curve" }, note(words, "info"));
};

/** Of uplift under a measure that decides it nothing is fitted: it is no matter of chance. */
const stepWords = (threshold, unit) => (threshold === null ? "these shares fit none"
  : `below ${quantity(threshold, unit)} the body cannot uplift and above it always does, a step from 0 to 1`);

const NO_CURVE = { x: [], probability: [], low: null, high: null };

const LEVEL = /\b(At|at|median) ([0-9][0-9.e+-]*[0-9]|[0-9])(?= |,|:|$)(?! levels?\b)/g;

/** The verdict of a fit names levels without a unit. */
const withUnit = (sentence, unit) =>
  plainWords(sentence)
    .replace(LEVEL, `$1 $2${unit && `\u00a0${pretty(unit)}`}`)
    .replace(/\b(between \S+ and \S*[0-9])/g, `$1${unit && `\u00a0${pretty(unit)}`}`);

const drawCurve = (box, { state, curve, points }, index, x) => {
  const { colour } = seriesStyle(index);
  const stage = el("div", { "data-testid": "fragility-chart" });
  box.append(stage);
  const band = Boolean(curve.low && curve.high);
  // the legend names what is drawn, and nothing else
  const drawn = [curve.x.length > 0, band, band, true];
  const series = [
    { label: "most likely", colour, width: 2.2 },
    { label: "95 % band, low", colour, dash: [3, 3], width: 1 },
    { label: "95 % band, high", colour, dash: [3, 3], width: 1 },
    { label: "share of the motions", colour: "--ink-soft", width: 0, points: true },
  ].filter((_, k) => drawn[k]);
  const chart = lineChart(stage, {
    title: `Probability: ${greek(state)}`,
    x,
    height: 260,
    y: { label: series.length > 1 ? "probability" : series[0].label, unit: "", range: [0, 1] },
    series,
    bands: band ? [{ series: [3, 2], fill: `${colour}22` }] : undefined,
  });
  chart.setData(joined(curve, points).filter((_, column) => column === 0 || drawn[column - 1]));
  return chart;
};

/** One abscissa for the curve and its points: null where one of them has no value. */
const joined = (curve, points) => {
  const onCurve = curve.x.map((at, k) => [at, ...NAMES.map((name) => curve[name]?.[k] ?? null), null]);
  const onPoints = points.x.map((at, k) => [at, ...between(curve, at), points.share[k]]);
  const all = [...onCurve, ...onPoints].sort((a, b) => a[0] - b[0]);
  return [0, 1, 2, 3, 4].map((column) => all.map((row) => row[column]));
};

const NAMES = ["probability", "low", "high"];

const between = (curve, at) => {
  const k = curve.x.findIndex((value) => value >= at);
  if (k < 1) return [null, null, null];
  const share = (at - curve.x[k - 1]) / (curve.x[k] - curve.x[k - 1]);
  return NAMES.map((name) =>
    curve[name] ? curve[name][k - 1] + share * (curve[name][k] - curve[name][k - 1]) : null,
  );
};

const columnsOf = (unit) => [
  "State",
  { label: "median", unit },
  { label: "its 95 % interval", unit },
  "dispersion",
  "its 95 % interval",
];

const rowOf = (state, fit) => {
  const pair = ([low, high]) =>
    low == null && high == null ? "\u2013" : `${shown(low)} to ${shown(high)}`;
  return [
    greek(state),
    fit.median ?? "\u2013",
    pair(fit.median_95),
    fit.dispersion ?? "\u2013",
    pair(fit.dispersion_95),
  ];
};

const shown = (value) => (value == null ? "unbounded" : Number(value.toPrecision(4)).toString());
