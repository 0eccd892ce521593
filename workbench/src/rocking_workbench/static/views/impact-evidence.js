/** Coefficients against measurements: a cloud over slenderness, and the intervals of this body. */

import { html } from "/parts/preact.js";
import { svg } from "/app/dom.js";
import { highest, lowest } from "/app/extremes.js";
import { GROUPS } from "/app/palette.js";
import { Pictured } from "/charts/pictured.js";
import { marker } from "/drawing/markers.js";
import { measuredPicture } from "/drawing/measured-picture.js";
import { rowPicture } from "/drawing/row-picture.js";
import { Drawn, Made } from "/parts/made.js";
import { Swatch, wordsOf } from "/views/response-labels.js";

/** Pictures and legend. @param {{ answer: Server.ImpactAnswered, foot: Foot, about: string }} props */
export const Evidence = ({ answer, foot, about }) => html`
  <div class="columns two">
    <div><${Pictured} title="Comparison with published measurements" about=${about}><${Drawn} draw=${cloudPicture} of=${[answer, foot]} />
      <ul class="legend">
        ${[...new Set(pointsOf(answer).map(({ group }) => group))].map((group) => html`
          <li key=${group}><${Made} node=${groupKey(group)} />${GROUPS[group]?.label ?? group}</li>`)}
        <li><${Made} node=${bodyKey()} />this body</li>
        ${(answer.curves ?? []).map(({ model }) => html`
          <li key=${model}><${Swatch} label=${model} />${wordsOf(model)}</li>`)}
      </ul><//></div>
    <div><${Pictured} title="Coefficient of restitution of this body" about=${about}><${Drawn} draw=${intervalPicture} of=${[answer, foot]} /><//></div>
  </div>
  <p class="field-help">${answer.measured.source}</p>`;

/** Slenderness ratio of the side about which the body rotates before the impact on a foot.
 * @param {Server.ImpactAnswered} answer @param {Foot} foot */
export const slendernessOf = ({ body: { sides } }, foot) => sides[foot === "right" ? "left" : "right"].slenderness_ratio;

/** @param {Server.ImpactAnswered} answer */
const pointsOf = ({ measured }) => measured.measurements;

/** @param {Server.ImpactAnswered} answer @param {Foot} foot */
const rowsOf = (answer, foot) => answer.coefficients[foot].map((row) => ({
  model: row.model, value: row.coefficient, low: row.coefficient_low, high: row.coefficient_high,
}));

/** @param {Server.ImpactAnswered} answer @param {Foot} foot @param {number} width */
const cloudPicture = (answer, foot, width) => measuredPicture({
  measured: pointsOf(answer), curves: answer.curves ?? [], rows: rowsOf(answer, foot),
  slenderness: slendernessOf(answer, foot),
}, { width });

/** @param {Server.ImpactAnswered} answer @param {Foot} foot @param {number} width */
const intervalPicture = (answer, foot, width) => {
  const rows = rowsOf(answer, foot);
  const low = lowest(rows.map((row) => row.low));
  const high = highest(rows.map((row) => row.high ?? row.value), 1);
  return rowPicture(rows, {
    width, domain: [Math.floor(low * 20) / 20, high + 0.002], label: "coefficient of restitution r, with its 95 % interval",
    title: "Coefficient of restitution of this body", testid: "interval-picture",
  });
};

/** @param {Child} mark */
const key = (mark) => svg("svg", { class: "picture key", width: 16, height: 16, viewBox: "0 0 16 16", "aria-hidden": "true" }, mark);
/** @param {string} group */
const groupKey = (group) => key(marker(GROUPS[group]?.marker ?? "circle", 8, 8));
const bodyKey = () => key([svg("path", { class: "thin dashed", d: "M8 0V16" }), svg("circle", { class: "ink-fill", cx: 8, cy: 8, r: 5 })]);
