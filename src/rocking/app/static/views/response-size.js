/** Bodies of the same shape and another size: every length of a body document times a factor. */

import { LENGTHS } from "/app/shape.js";

/** @type {{ [key: string]: number }} */
const POWERS = { mass: 3, moment_of_inertia: 5 };
const HOLDERS = new Set(["block", "trapezoid", "ellipse", "regular_polygon", "section", "mass_points"]);

/** @param {number} value */
const rounded = (value) => Number(value.toPrecision(7));

/** @param {any} given @param {number} factor @returns {any} */
const times = (given, factor) =>
  Array.isArray(given) ? given.map((one) => times(one, factor)) : rounded(given * factor);

/** @param {string} key @param {any} given @param {number} factor */
const scaledValue = (key, given, factor) => {
  if (key in POWERS) return rounded(given * factor ** POWERS[key]);
  return LENGTHS.has(key) ? times(given, factor) : given;
};

/** @param {any} table @param {number} factor @returns {any} */
const scaledTable = (table, factor) => {
  const entries = Object.entries(table).map(([key, given]) => {
    if (key === "region") return [key, given.map((/** @type {any} */ one) => scaledTable(one, factor))];
    if (key === "masses") return [key, given.map((/** @type {number} */ mass) => rounded(mass * factor ** 3))];
    return [key, scaledValue(key, given, factor)];
  });
  return Object.fromEntries(entries);
};

/** Whether the size of a body can be changed here: text of a drawing is left as it is.
 * @param {Server.BodyInput} body */
export const canBeScaled = (body) => (body.section?.region || []).every(({ outline }) => outline !== undefined);

/** Returns a body document whose lengths are `factor` times as large; densities stay.
 * @param {Server.BodyInput} body @param {number} factor @returns {any} */
export const scaledBody = (body, factor) => {
  if (factor === 1) return body;
  const entries = Object.entries(body).map(([key, given]) => [
    key,
    HOLDERS.has(key) ? scaledTable(given, factor) : scaledValue(key, given, factor),
  ]);
  return Object.fromEntries(entries);
};
