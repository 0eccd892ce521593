/** Rocking spectra: peak rotation against the period of the block. */
import { html, useMemo, useSignal } from "/parts/preact.js";
import { Segmented } from "/parts/fields.js";
import { number } from "/app/format.js";
import { angleStyle, modelWords } from "/app/palette.js";
import { Figure } from "/charts/figure.js";
import { t } from "/app/words.js";

const SHOWN = [["median", "Median peak"], ["high", "84 % peak"], ["overturned", "Overturning fraction"]];

/** Spectra of peaks or of overturning probability. @param {{ result: Server.SpectrumResult }} props */
export const Spectrum = ({ result }) => {
  const quantity = useSignal("median");
  const periods = /** @type {number[]} */ (result.x.values);
  const count = result.motions.values.length;
  const share = quantity.value === "overturned";
  const data = useMemo(() => [periods, ...result.curves.map((curve) => curve[/** @type {"median" | "high" | "overturned"} */ (quantity.value)])], [quantity.value]);
  const marks = useMemo(() => ({
    description: count === 1 ? "A gap means that the block overturns." : t("{count} motions. A gap means that the block overturns.", { count }),
  }), []);
  const shape = {
    title: share ? "Fraction of the motions that overturn the block" : "Peak rotation over the slenderness angle",
    height: 340,
    x: { label: "period 2\u03c0/p", unit: "s", log: periods.length > 2 && periods[periods.length - 1] / periods[0] > 8 },
    y: { label: share ? "fraction" : "peak / \u03b1", unit: "" },
    series: result.curves.map((curve) => ({ label: labelOf(result, curve), ...lookOf(result, curve) })),
  };
  return html`
    ${count > 1 && html`<${Segmented} label="Show" options=${SHOWN} value=${quantity} />`}
    <div data-about=${result.restitutions.map(modelWords).join(", ")}>
      <${Figure} shape=${shape} data=${data} marks=${marks} testid="spectrum-chart" /></div>
    <p class="quiet">${marks.description}</p>`;
};

/** @param {Server.SpectrumResult} result @param {Server.SpectrumCurve} curve */
const lookOf = ({ curves, restitutions }, { angle, restitution }) => {
  const angles = [...new Set(curves.map((curve) => curve.angle))];
  const counts = { angles: angles.length, models: restitutions.length };
  return angleStyle(restitution, angles.indexOf(angle), counts);
};

/** @param {Server.SpectrumResult} result @param {Server.SpectrumCurve} curve */
const labelOf = (result, { angle, restitution }) => {
  const label = `\u03b1 = ${number(angle, 3)} rad`;
  return result.restitutions.length > 1 ? `${label}, ${t(modelWords(restitution))}` : label;
};
