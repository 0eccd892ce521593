/** Rocking spectra: peak rotation against the period of the block. */
import { el } from "/app/dom.js";
import { segmented } from "/app/fields.js";
import { number } from "/app/format.js";
import { angleStyle, modelWords } from "/app/palette.js";
import { lineChart } from "/charts/line.js";

const SHOWN = [
  { value: "median", text: "Median peak" },
  { value: "high", text: "84 % peak" },
  { value: "overturned", text: "Share that overturns" },
];

/** Show spectra inside a place; returns how to clear up. */
export const showSpectrum = (place, app, study, found) => {
  const box = el("div", { "data-testid": "spectrum-chart" });
  const periods = found.x.values;
  const one = found.motions.values.length === 1;
  const log = periods.length > 2 && periods.at(-1) / periods[0] > 8;
  let chart = null;
  const draw = (what) => {
    chart?.destroy();
    const share = what === "overturned";
    chart = lineChart(box, {
      title: share
        ? "Share of the motions that overturn the block"
        : "Peak rotation over the slenderness angle",
      height: 340,
      x: { label: "period 2\u03c0/p", unit: "s", log },
      y: { label: share ? "share" : "peak / \u03b1", unit: "" },
      series: found.curves.map((curve) => ({ label: labelOf(found, curve), ...lookOf(found, curve) })),
    });
    chart.setData([periods, ...found.curves.map((curve) => curve[what])]);
  };
  if (!one) place.append(segmented({ label: "Show", options: SHOWN, value: "median", onChange: draw }));
  const words = one
    ? "A gap is a block that overturns."
    : `Over ${found.motions.values.length} motions; a gap is where they overturn the block.`;
  place.append(box, el("p", { class: "quiet" }, words));
  draw("median");
  return () => chart?.destroy();
};

const lookOf = ({ curves, restitutions }, { angle, restitution }) => {
  const angles = [...new Set(curves.map((each) => each.angle))];
  const counts = { angles: angles.length, models: restitutions.length };
  return angleStyle(restitution, angles.indexOf(angle), counts);
};

const labelOf = (found, { angle, restitution }) => {
  const words = `\u03b1 = ${number(angle, 3)} rad`;
  return found.restitutions.length > 1 ? `${words}, ${modelWords(restitution)}` : words;
};
