/** One row per model: a dot, its interval, and its value. */

import { svg } from "/app/dom.js";
import { number } from "/app/format.js";
import { modelStyle, modelWords } from "/app/palette.js";
import { axisOf, bottomAxis } from "/drawing/axis.js";
import { t } from "/app/words.js";

/** @typedef {{ model: string, value: number, low?: number, high?: number }} Row
 * @typedef {{ top: number, bottom: number, left: number, width: number, rowsEnd: number }} Frame
 * @typedef {{ width: number, domain: Point, label: string, testid?: string, title: string, extras?: (axis: Axis, frame: Frame) => Child,
 *   extraHeight?: number, digits?: number }} RowOptions */

const ROW = 34;

/** Rows {model, value, low?, high?} on one axis {low, high, label}; `extras(axis, frame)` draws below the rows.
 * @param {Row[]} rows @param {RowOptions} options */
export const rowPicture = (
  rows, { width, domain, label, testid, title, extras, extraHeight = 0, digits = 4 },
) => {
  const narrow = width < 560;
  const left = narrow ? 8 : 208;
  const rowHeight = narrow ? ROW + 18 : ROW;
  const bottom = 12 + rows.length * rowHeight + extraHeight;
  const height = bottom + 44;
  const axis = axisOf(...domain, left + 8, width - (narrow ? 10 : 70), narrow ? 4 : 7);
  const frame = { top: 8, bottom, left, width, rowsEnd: 12 + rows.length * rowHeight };
  return svg("svg", {
    class: "picture", viewBox: `0 0 ${width} ${height}`, width, height, role: "img", "data-testid": testid,
    "aria-label": `${t(title)}: ${rows.map((row) => `${modelWords(row.model)} ${inWords(row)}`).join("; ")}`,
  },
    bottomAxis(axis, { top: frame.top, bottom, label }),
    extras?.(axis, frame),
    rows.map(
      (row, index) => oneRow(
        row, axis, { narrow, width, left, y: 12 + index * rowHeight + (narrow ? 34 : ROW / 2), digits },
      )
    ));
};

/** @param {Row} row @param {Axis} axis @param {{ narrow: boolean, width: number, left: number, y: number, digits: number }} where */
const oneRow = ({ model, value, low, high }, axis, { narrow, width, left, y, digits }) => {
  const { colour, dash } = modelStyle(model);
  /** @param {number} value */
  const inside = (value) => axis.at(Math.min(axis.high, Math.max(axis.low, value)));
  return svg("g", {},
    svg(
      "text", narrow ? { x: 8, y: y - 15 } : { x: left - 12, y: y + 4, "text-anchor": "end" },
      modelWords(model),
    ),
    svg(
      "text", { x: width - 4, y: narrow ? y - 15 : y + 4, "text-anchor": "end", class: "figure halo" },
      number(value, digits),
    ),
    low === undefined ? null : svg("path", {
      d: `M${inside(low)} ${y}H${inside(Number(high))}`, stroke: colour, "stroke-width": 3,
      "stroke-dasharray": dash?.join(" "), fill: "none",
    }),
    low === undefined ? null : svg("path", {
      d: `M${inside(low)} ${y - 5}v10M${inside(Number(high))} ${y - 5}v10`, stroke: colour, "stroke-width": 1.5,
    }),
    svg("circle", { cx: inside(value), cy: y, r: 6, fill: colour, class: "dot-halo" }));
};

/** @param {Row} row */
const inWords = ({ value, low, high }) =>
  low === undefined ? number(value) : t("{value}, 95 % interval {low} to {high}", { value: number(value), low: number(low), high: number(high) });
