/** Coefficients against measurements: a cloud over slenderness, and the intervals of this body. */

import { html } from "/parts/preact.js";
import { svg } from "/app/dom.js";
import { highest, lowest } from "/app/extremes.js";
import { GROUPS } from "/app/palette.js";
import { marker } from "/drawing/markers.js";
import { measuredPicture } from "/drawing/measured-picture.js";
import { rowPicture } from "/drawing/row-picture.js";
import { Drawn, Made } from "/parts/made.js";
import { Swatch, wordsOf } from "/views/response-labels.js";

/** Pictures and legend. @param {{ answer: Server.ImpactAnswered, foot: Foot }} props */
export const Evidence = ({ answer, foot }) => html`
  <div class="columns two">
    <div class="stack"><${Drawn} draw=${cloudPicture} of=${[answer, foot]} />
      <ul class="legend">
        ${[...new Set(pointsOf(answer).map(({ group }) => group))].map((group) => html`
          <li key=${group}><${Made} node=${groupKey(group)} />${GROUPS[group]?.words ?? group}</li>`)}
        ${(answer.curves ?? []).map(({ model }) => html`
          <li key=${model}><${Swatch} label=${model} />${wordsOf(model)}</li>`)}
      </ul></div>
    <${Drawn} draw=${intervalPicture} of=${[answer, foot]} />
  </div>
  <p class="field-help">${answer.measured.source}</p>`;

/** Of the side about which the body turns before it lands on a foot.
 * @param {Server.ImpactAnswered} answer @param {Foot} foot */
export const slendernessOf = ({ body: { sides } }, foot) => sides[foot === "right" ? "left" : "right"].slenderness_ratio;

/** @param {Server.ImpactAnswered} answer */
const pointsOf = ({ measured }) => measured.points ?? measured;

/** @param {Server.ImpactAnswered} answer @param {Foot} foot */
const rowsOf = (answer, foot) => answer.coefficients[foot].map((row) => ({
  model: row.model, value: row.coefficient_of_restitution, low: row.low_95, high: row.high_95,
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
    width, domain: [Math.floor(low * 20) / 20, high + 0.002], label: "coefficient of restitution r",
    title: "Coefficient of restitution of this body", testid: "interval-picture",
  });
};

/** @param {string} group */
const groupKey = (group) => svg(
  "svg", { class: "picture key", width: 16, height: 16, "aria-hidden": "true" },
  marker(GROUPS[group]?.marker ?? "circle", 8, 8),
);
