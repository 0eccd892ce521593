/** Layers of a map: outcome, peak rotation, impacts, and differences between two models. */
import { highest } from "/app/extremes.js";
import { number, quantity } from "/app/format.js";
import { modelWords } from "/app/palette.js";
import { greek } from "/views/studies-words.js";
import { t } from "/app/words.js";

const FAILED = "#999999";
const VERDICTS = [
  { paint: "#F2F0E8", label: "no uplift" },
  { paint: "#9CC9E8", label: "rocks, does not overturn" },
  { paint: "#B33D00", label: "overturns without an impact" },
  { paint: "#AC5B2B", label: "overturns after one impact" },
  { paint: "#F5DC57", label: "overturns after more impacts" },
  { paint: FAILED, label: "could not be computed" },
];
const RAMP = ["#F2F0E8", "#C6DDEE", "#8FBEDD", "#5A9BC7", "#2F77A8", "#1B557F", "#0C3557"];

/** @param {number} outcome @param {number} impacts */
const verdictOf = (outcome, impacts) => {
  if (outcome === 0 || outcome === 1) return outcome;
  if (outcome === 2) return impacts === 0 ? 2 : impacts === 1 ? 3 : 4;
  return 5;
};

/** @param {number | null} share */
const ramp = (share) => RAMP[Math.min(RAMP.length - 1, Math.max(0, Math.floor((share || 0) * RAMP.length)))];

/** The layers of one result: {value, text, paint(ix, iy), legend}.
 * @param {MapFound} result @param {number} k @param {number | null} other @returns {Layer[]} */
export const layersOf = (result, k, other) => {
  const outcome = result.outcome[k];
  const impacts = result.impacts[k];
  const peak = result.peak[k];
  const most = highest(impacts.map((row) => highest(row)), 1);
  const layers = [
    {
      value: "verdict",
      text: "Outcome",
      legend: VERDICTS,
      /** @param {number} ix @param {number} iy */
      paint: (ix, iy) => VERDICTS[verdictOf(outcome[iy][ix], impacts[iy][ix])].paint,
    },
    {
      value: "peak",
      text: "Peak rotation",
      legend: [
        ...RAMP.map((paint, n) => ({
          paint,
          label: `${number(n / RAMP.length, 2)}\u2013${number((n + 1) / RAMP.length, 2)} \u03b1`,
        })),
        { paint: "#B33D00", label: "overturns" },
        { paint: FAILED, label: "could not be computed" },
      ],
      /** @param {number} ix @param {number} iy */
      paint: (ix, iy) =>
        outcome[iy][ix] === 2 ? "#B33D00" : outcome[iy][ix] > 2 ? FAILED : ramp(peak[iy][ix] ?? 0),
    },
    {
      value: "impacts",
      text: "Impacts",
      legend: [
        { paint: RAMP[0], label: "none" },
        { paint: RAMP[RAMP.length - 1], label: `${most}` },
        { paint: FAILED, label: "could not be computed" },
      ],
      /** @param {number} ix @param {number} iy */
      paint: (ix, iy) => (outcome[iy][ix] > 2 ? FAILED : ramp(impacts[iy][ix] / (most + 1))),
    },
  ];
  if (other !== null) layers.push(difference(result, k, other));
  return layers;
};

/** @param {MapFound} result @param {number} k @param {number} other @returns {Layer} */
const difference = (result, k, other) => {
  const [mine, theirs] = [result.outcome[k], result.outcome[other]];
  const names = [k, other].map((index) => modelWords(result.restitutions[index]));
  const legend = [
    { paint: "#F2F0E8", label: "same outcome" },
    { paint: "#D96C00", label: t("overturns only with {model}", { model: names[0] }) },
    { paint: "#0070B2", label: t("overturns only with {model}", { model: names[1] }) },
  ];
  /** @param {number} ix @param {number} iy */
  const paint = (ix, iy) => {
    const [a, b] = [mine[iy][ix] === 2, theirs[iy][ix] === 2];
    return legend[a === b ? 0 : a ? 1 : 2].paint;
  };
  return { value: "difference", text: t("Difference to {model}", { model: names[1] }), legend, paint };
};

/** Description of one cell. @param {MapFound} result @param {number} k @param {Cell} cell */
export const cellWords = (result, k, { ix, iy }) => {
  const outcome = result.outcome[k][iy][ix];
  const impacts = result.impacts[k][iy][ix];
  /** @param {Server.Coordinate} axis @param {number} index */
  const named = ({ description: label, values, unit }, index) => `${t(greek(label))} = ${quantity(Number(values[index]), unit)}`;
  const where = `${named(result.x, ix)}; ${named(result.y, iy)}`;
  const verdict = outcome === 1 ? t("rocks, does not overturn, peak {rotation} \u03b1", { rotation: number(result.peak[k][iy][ix]) })
    : t(VERDICTS[verdictOf(outcome, impacts)].label);
  return `${where}: ${verdict}`;
};
