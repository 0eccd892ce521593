/** Implied impulse position of every model along the base. */

import { svg } from "/app/dom.js";
import { highest, lowest } from "/app/extremes.js";
import { rowPicture } from "/drawing/row-picture.js";
import { footMark } from "/drawing/symbols.js";

/** Rows of models over the base. @param {Server.ImpactAnswered} answer @param {Foot} foot @param {number} width */
export const impulseRows = (answer, foot, width) => {
  const rows = answer.coefficients[foot].map((row) => ({ model: row.model, value: row.impulse_ratio }));
  const values = rows.map((row) => row.value).filter((value) => value !== null);
  /** @type {Point} */
  const domain = [lowest(values, 0), highest(values, 1.22)];
  return rowPicture(rows.filter((row) => row.value !== null), {
    width, domain, label: "impulse position k, over half the base", title: "Implied impulse position",
    testid: "impulse-picture",
    extras: base, extraHeight: 34,
  });
};

/** @param {Axis} axis @param {{ top: number, rowsEnd: number }} frame */
const base = (axis, { top, rowsEnd }) => svg("g", {},
  svg("path", { class: "axis", d: `M${axis.at(1)} ${top}V${rowsEnd}` }),
  svg("path", { class: "base-bar", d: `M${axis.at(0)} ${rowsEnd + 12}H${axis.at(1)}` }),
  footMark(axis.at(1), rowsEnd + 15),
  svg(
    "text", { x: axis.at(1) - 10, y: rowsEnd + 30, "text-anchor": "end", class: "soft" }, "impact foot",
  ),
  svg("text", { x: axis.at(0) + 2, y: rowsEnd + 30, class: "soft" }, "middle"));
