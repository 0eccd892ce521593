/** Fragility: probability curves with their bands, data points, and the quality of the fit. */
import { html, useMemo, useSignal } from "/parts/preact.js";
import { modelWords, seriesStyle } from "/app/palette.js";
import { Figure } from "/charts/figure.js";
import { Fetched } from "/charts/pictured.js";
import { number, quantity } from "/app/format.js";
import { Choice, Note, stopped } from "/parts/fields.js";
import { Table } from "/parts/table.js";
import { greek, plainWords } from "/views/studies-words.js";
import { t } from "/app/words.js";

/** Fragility curves, of one restitution at a time.
 * @param {{ study: Server.StudyFacts, result: Server.FragilityResult, chosen: { restitution: number } }} props */
export const Fragility = ({ study, result, chosen }) => {
  const k = useSignal("0");
  chosen.restitution = Number(k.value);
  const options = result.analyses.map(({ restitution }, value) => [String(value), modelWords(restitution)]);
  return html`
    ${options.length > 1 && html`<${Choice} label="Restitution" options=${options} value=${k} />`}
    <div data-about=${options[chosen.restitution][1]}>
      <${Analysis} key=${k.value} result=${result} analysis=${result.analyses[chosen.restitution]} />
      ${study.kind === "incremental" && html`<h3>Curves of the incremental analysis</h3><${Fetched} key=${`curves ${k.value}`} title="Curves of the incremental analysis"
        path=${`studies/${study.id}/export.svg?restitution=${k.value}`} alt="Intensity level against peak rotation, one curve per motion" />`}</div>`;
};

/** @param {{ result: Server.FragilityResult, analysis: Server.AnalysisFacts }} props */
const Analysis = ({ result, analysis }) => {
  const unit = result.im.unit === "1" ? "" : result.im.unit;
  const x = { label: result.im.description, unit };
  // without a curve the points still show the results; the reason is below them once
  const isDrawn = (/** @type {string} */ state) => state in analysis.curves;
  const fitted = Object.entries(analysis.verdicts).filter(([state]) => isDrawn(state) || !(state in analysis.points));
  return html`<div class="study-result">
    ${Object.entries(analysis.points).map(([state, points], index) => html`
      <${Curve} key=${state} state=${state} curve=${analysis.curves[state] ?? NO_CURVE} points=${points} index=${index} x=${x} />
      ${!isDrawn(state) && html`<div data-testid="no-curve">
        <${Note} text=${whyNone(analysis.verdicts[state], result.uplift_threshold, unit)} /></div>`}`)}
    ${analysis.adjusted && html`<div data-testid="adjusted"><${Note} text=${plainWords(t(analysis.adjusted))} /></div>`}
    ${analysis.resurrection && html`<${Note} text=${analysis.resurrection} />`}
    ${fitted.map(([state, verdict]) => html`<${Note} key=${state} text=${plainWords(t(analysis.common.includes(state)
      ? "{state} alone: {verdict}" : "{state}: {verdict}", { state, verdict }))} />`)}
    ${result.definition && html`<p class="quiet">${plainWords(result.definition)}</p>`}
    <${Table} columns=${columnsOf(unit)} rows=${Object.entries(analysis.fits).map(([state, fit]) => rowOf(state, fit))}
      caption="Lognormal fits" testid="fragility-fits" />
  </div>`;
};

/** @param {string | undefined} verdict @param {number | null} threshold @param {string} unit */
const whyNone = (verdict, threshold, unit) => stopped(t("No curve: {reason}", {
  reason: verdict ? plainWords(t(verdict)) : stepWords(threshold, unit),
}));

/** Text for uplift without a fit: the measure determines uplift exactly, so that there is no probability to fit.
 * @param {number | null} threshold @param {string} unit */
const stepWords = (threshold, unit) => (threshold === null ? "no curve can be fitted to these fractions"
  : t("no uplift below {acceleration}, always uplift above it: a step from 0 to 1", { acceleration: quantity(threshold, unit) }));

const NO_CURVE = { x: [], probability: [], low: null, high: null };

/** @param {{ state: string, curve: Server.CurveOfState, points: Server.PointsOfState, index: number, x: ChartAxis }} props */
const Curve = ({ state, curve, points, index, x }) => {
  const { colour } = seriesStyle(index);
  const band = Boolean(curve.low && curve.high);
  // the legend contains the visible curves only
  const drawn = [curve.x.length > 0, band, band, true];
  const series = [
    { label: "maximum likelihood", colour, width: 2.2 },
    { label: "95 % band, low", colour, dash: [3, 3], width: 1 },
    { label: "95 % band, high", colour, dash: [3, 3], width: 1 },
    { label: "fraction of the motions", colour: "--ink-soft", width: 0, points: true },
  ].filter((_, k) => drawn[k]);
  const shape = {
    title: t("Probability: {state}", { state: greek(state) }),
    x,
    height: 260,
    y: { label: series.length > 1 ? "probability" : series[0].label, unit: "", range: [0, 1] },
    series,
    bands: band ? [{ series: [3, 2], fill: `${colour}22` }] : undefined,
  };
  const data = useMemo(() => joined(curve, points).filter((_, column) => column === 0 || drawn[column - 1]), []);
  return html`<${Figure} shape=${shape} data=${data} testid="fragility-chart" />`;
};

/** One abscissa for the curve and its points: null where one of them has no value.
 * @param {Server.CurveOfState} curve @param {Server.PointsOfState} points */
const joined = (curve, points) => {
  /** @type {(number | null)[][]} */
  const onCurve = curve.x.map((at, k) => [at, ...NAMES.map((name) => curve[name]?.[k] ?? null), null]);
  const onPoints = points.x.map((at, k) => [at, ...between(curve, at), points.share[k]]);
  const all = [...onCurve, ...onPoints].sort(([a], [b]) => Number(a) - Number(b));
  return [0, 1, 2, 3, 4].map((column) => all.map((row) => row[column]));
};

const NAMES = /** @type {const} */ (["probability", "low", "high"]);

/** @param {Server.CurveOfState} curve @param {number} at */
const between = (curve, at) => {
  const k = curve.x.findIndex((value) => value >= at);
  if (k < 1) return [null, null, null];
  const share = (at - curve.x[k - 1]) / (curve.x[k] - curve.x[k - 1]);
  return NAMES.map((name) => {
    const values = curve[name];
    return values && values[k - 1] + share * (values[k] - values[k - 1]);
  });
};

/** @param {string} unit */
const columnsOf = (unit) => [
  "State",
  { label: "median", unit },
  { label: "95 % interval", unit },
  "dispersion",
  "95 % interval",
];

/** @param {string} state @param {Server.FitFacts} fit */
const rowOf = (state, fit) => {
  /** @param {(number | null)[]} pair */
  const pair = ([low, high]) =>
    low == null && high == null ? "\u2013" : t("{low} to {high}", { low: shown(low), high: shown(high) });
  return [
    greek(state),
    fit.median ?? "\u2013",
    pair(fit.median_95),
    fit.dispersion ?? "\u2013",
    pair(fit.dispersion_95),
  ];
};

/** @param {number | null} value */
const shown = (value) => (value == null ? "unbounded" : number(value));
