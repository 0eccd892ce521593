/** Coefficients against measurements: a cloud over slenderness, and the intervals of this body. */

import { el, fill, svg } from "/app/dom.js";
import { highest, lowest } from "/app/extremes.js";
import { dashKey, GROUPS, modelStyle, modelWords } from "/app/palette.js";
import { marker } from "/drawing/markers.js";
import { measuredPicture } from "/drawing/measured-picture.js";
import { responsive } from "/drawing/responsive.js";
import { rowPicture } from "/drawing/row-picture.js";

/** Pictures and legend: {nodes, follow(answer, foot)}. */
export const evidenceParts = () => {
  let shown = null;
  const cloud = responsive((width) => (shown ? measuredPicture(shown, { width }) : null));
  const intervals = responsive((width) => (shown ? intervalPicture(shown, width) : null));
  const legend = el("div", {});
  const source = el("p", { class: "field-help" });
  const follow = (answer, foot) => {
    shown = evidenceOf(answer, foot);
    fill(legend, legendOf(shown));
    fill(source, answer.measured.source ?? "");
    cloud.redraw();
    intervals.redraw();
  };
  return {
    nodes: [
      el("div", { class: "columns two" }, el("div", { class: "stack" }, cloud, legend), intervals), source,
    ],
    follow,
  };
};

const evidenceOf = (answer, foot) => ({
  measured: answer.measured.points ?? answer.measured,
  curves: answer.curves ?? [],
  slenderness: answer.body.sides[foot === "right" ? "left" : "right"].slenderness_ratio,
  rows: answer.coefficients[foot].map((row) => ({
    model: row.model, value: row.coefficient_of_restitution, low: row.low_95, high: row.high_95,
  })),
});

const intervalPicture = ({ rows }, width) => {
  const low = lowest(rows.map((row) => row.low));
  const high = highest(rows.map((row) => row.value), 1);
  return rowPicture(rows, {
    width, domain: [Math.floor(low * 20) / 20, high + 0.002], label: "coefficient of restitution r",
    title: "Coefficient of restitution of this body", testid: "interval-picture",
  });
};

const legendOf = ({ measured, curves }) => {
  const groups = [...new Set(measured.map((each) => each.group))];
  return el("ul", { class: "legend" },
    groups.map((group) => el("li", {}, groupKey(group), GROUPS[group]?.words ?? group)),
    curves.map(({ model }) => el("li", {}, dashKey(modelStyle(model)), modelWords(model))));
};

const groupKey = (group) => svg(
  "svg", { class: "picture key", width: 16, height: 16, "aria-hidden": "true" },
  marker(GROUPS[group]?.marker ?? "circle", 8, 8),
);
