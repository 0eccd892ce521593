/** Units of length, and the same body in another unit. */

import { tidy } from "/app/format.js";
import { LENGTHS } from "/app/shape.js";

/** Length of each unit in metres. */
export const METRES = { m: 1, cm: 0.01, mm: 0.001, ft: 0.3048, in: 0.0254 };

/** The body with its lengths in another unit.
 * @param {Server.BodyInput} body @param {Unit} units @returns {Server.BodyInput} */
export const inUnits = (body, units) => {
  if (body.units === units) return body;
  const factor = METRES[body.units] / METRES[units];
  return { ...rescaled(body, factor), units };
};

/** Convert a length in metres to a unit. @param {number} length @param {Unit} units */
export const fromMetres = (length, units) => exact(length, 1 / METRES[units]);

// Rounds off errors of binary arithmetic, if this does not change the value beyond these errors.
/** @param {number} value @param {number} factor */
const exact = (value, factor) => {
  const neat = tidy(value * factor);
  return Math.abs(neat / factor - value) <= 4 * Number.EPSILON * Math.abs(value) ? neat : value * factor;
};

/** @param {any} table @param {number} factor @returns {any} */
const rescaled = (table, factor) =>
  Object.fromEntries(Object.entries(table).map(([key, value]) => [
    key, LENGTHS.has(key) ? times(value, factor) : isTable(value) ? nested(value, factor) : value,
  ]));

/** @param {any} value @param {number} factor @returns {any} */
const nested = (value, factor) =>
  Array.isArray(value) ? value.map(
    (item) => (isTable(item) ? rescaled(item, factor) : item)
  ) : rescaled(value, factor);

/** @param {unknown} value */
const isTable = (value) => typeof value === "object" && value !== null;

/** @param {any} value @param {number} factor @returns {any} */
const times = (value, factor) => (
  Array.isArray(value) ? value.map((item) => times(item, factor)) : exact(value, factor)
);
