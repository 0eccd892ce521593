/** Bodies with the same shape and another size: all lengths of a body document times a factor. */

import { LENGTHS } from "/app/shape.js";

/** @type {{ [key: string]: number }} */
const POWERS = { mass: 3, moment_of_inertia: 5 };
const HOLDERS = new Set(["block", "trapezoid", "ellipse", "regular_polygon", "section", "mass_points"]);

/** @param {number} value */
const rounded = (value) => Number(value.toPrecision(7));

/** @param {any} sizes @param {number} factor @returns {any} */
const times = (sizes, factor) =>
  Array.isArray(sizes) ? sizes.map((item) => times(item, factor)) : rounded(sizes * factor);

/** @param {string} key @param {any} value @param {number} factor */
const scaledValue = (key, value, factor) => {
  if (key in POWERS) return rounded(value * factor ** POWERS[key]);
  return LENGTHS.has(key) ? times(value, factor) : value;
};

/** @param {any} table @param {number} factor @returns {any} */
const scaledTable = (table, factor) => {
  const entries = Object.entries(table).map(([key, value]) => {
    if (key === "region") return [key, value.map((/** @type {any} */ region) => scaledTable(region, factor))];
    if (key === "masses") return [key, value.map((/** @type {number} */ mass) => rounded(mass * factor ** 3))];
    return [key, scaledValue(key, value, factor)];
  });
  return Object.fromEntries(entries);
};

/** True if the size of a body can be changed here; regions without an outline, such as WKT text, are not scaled.
 * @param {Server.BodyInput} body */
export const canBeScaled = (body) => (body.section?.region || []).every(({ outline }) => outline !== undefined);

/** Returns a body document whose lengths are `factor` times as large; densities stay.
 * @param {Server.BodyInput} body @param {number} factor @returns {any} */
export const scaledBody = (body, factor) => {
  if (factor === 1) return body;
  const entries = Object.entries(body).map(([key, value]) => [
    key,
    HOLDERS.has(key) ? scaledTable(value, factor) : scaledValue(key, value, factor),
  ]);
  return Object.fromEntries(entries);
};
