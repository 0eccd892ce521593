/** Units of length, and the same body in another unit. */

import { tidy } from "/app/format.js";

/** Metres in each unit. */
export const METRES = { m: 1, cm: 0.01, mm: 0.001, ft: 0.3048, in: 0.0254 };

const LENGTHS = new Set([
  "width", "height", "depth", "base", "top", "lean", "radius", "feet", "ground", "outline",
  "holes", "points", "contact", "centre",
]);

/** The same body with its lengths in another unit. */
export const inUnits = (body, units) => {
  if (body.units === units) return body;
  const factor = METRES[body.units] / METRES[units];
  return { ...rescaled(body, factor), units };
};

/** A length in metres in a unit. */
export const fromMetres = (length, units) => exact(length, 1 / METRES[units]);

// What binary arithmetic left behind is rounded away only where that is all that is rounded away.
const exact = (value, factor) => {
  const neat = tidy(value * factor);
  return Math.abs(neat / factor - value) <= 4 * Number.EPSILON * Math.abs(value) ? neat : value * factor;
};

const rescaled = (table, factor) =>
  Object.fromEntries(Object.entries(table).map(([key, value]) => [
    key, LENGTHS.has(key) ? times(value, factor) : isTable(value) ? nested(value, factor) : value,
  ]));

const nested = (value, factor) =>
  Array.isArray(value) ? value.map(
    (each) => (isTable(each) ? rescaled(each, factor) : each)
  ) : rescaled(value, factor);

const isTable = (value) => typeof value === "object" && value !== null;

const times = (value, factor) => (
  Array.isArray(value) ? value.map((each) => times(each, factor)) : exact(value, factor)
);
