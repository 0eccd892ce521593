/** Bodies of the same shape and another size: every length of a body document times a factor. */

const SIZES = ["width", "height", "depth", "base", "top", "lean", "radius", "ground"];
const LENGTHS = new Set([...SIZES, "feet", "outline", "holes", "points", "contact", "centre"]);
const POWERS = { mass: 3, moment_of_inertia: 5 };
const HOLDERS = new Set(["block", "trapezoid", "ellipse", "regular_polygon", "section", "mass_points"]);

const rounded = (value) => Number(value.toPrecision(7));

const times = (given, factor) =>
  Array.isArray(given) ? given.map((one) => times(one, factor)) : rounded(given * factor);

const scaledValue = (key, given, factor) => {
  if (key in POWERS) return rounded(given * factor ** POWERS[key]);
  return LENGTHS.has(key) ? times(given, factor) : given;
};

const scaledTable = (table, factor) => {
  const entries = Object.entries(table).map(([key, given]) => {
    if (key === "region") return [key, given.map((one) => scaledTable(one, factor))];
    if (key === "masses") return [key, given.map((mass) => rounded(mass * factor ** 3))];
    return [key, scaledValue(key, given, factor)];
  });
  return Object.fromEntries(entries);
};

/** Whether the size of a body can be changed here: text of a drawing is left as it is. */
export const canBeScaled = (body) => (body.section?.region || []).every(({ outline }) => outline !== undefined);

/** Returns a body document whose lengths are `factor` times as large; densities stay. */
export const scaledBody = (body, factor) => {
  if (factor === 1) return body;
  const entries = Object.entries(body).map(([key, given]) => [
    key,
    HOLDERS.has(key) ? scaledTable(given, factor) : scaledValue(key, given, factor),
  ]);
  return Object.fromEntries(entries);
};
