/** Shape of a body: its table, and an initial size from the previous body. */

import { spanOf } from "/app/extremes.js";
import { changedAt } from "/app/inputs.js";
import { SHAPES } from "/app/shapes.js";
import { fromMetres } from "/views/body-units.js";

/** Shape of a body of the inputs. @param {any} body @returns {string} */
export const shapeOf = (body) => Object.keys(SHAPES).find((shape) => body[shape]) ?? (
  body.mass_points ? "mass_points" : "block"
);

/** The table that holds the sizes: the body itself for a block in its short form. @param {any} body @returns {any} */
export const tableOfShape = (body) => body[shapeOf(body)] ?? body;

/** Body with a changed number of its table; an empty value removes it. Mass and density are alternatives:
 * the last typed one is used. Densities replaced by a mass are stored in `replaced` and restored without the mass.
 * @param {any} body @param {string} key @param {any} value @param {{ [shape: string]: any }} replaced */
export const withKey = (body, key, value, replaced) => {
  const shape = shapeOf(body);
  const newValue = value ?? undefined;
  // a block with feet needs the table [block], because the short form cannot contain feet
  if (key === "feet" && newValue && !body[shape]) return withFeet(body, newValue);
  const at = body[shape] ? [shape] : [];
  const next = changedAt(body, [...at, key], newValue);
  if (key === "density" && newValue) return changedAt(next, [...at, "mass"], undefined);
  if (key !== "mass") return next;
  if (newValue === undefined) return changedTable(next, (table) => withDensities(table, replaced[shape]));
  if (tableOfShape(body).mass === undefined) replaced[shape] = densitiesOf(tableOfShape(body));
  return changedTable(next, (table) => withDensities(table, []));
};

/** @param {any} body @param {(table: any) => any} change */
const changedTable = (body, change) => {
  const shape = shapeOf(body);
  return body[shape] ? { ...body, [shape]: change(body[shape]) } : change(body);
};

/** @param {any} table */
const densitiesOf = ({ density, region = [] }) => [density, ...region.map((/** @type {Region} */ item) => item.density)];

// Table with the given densities. The regions receive densities only if their number is the same.
/** @param {any} table @param {any[]} [densities] */
const withDensities = (table, [density, ...others] = []) => {
  const same = others.length === table.region?.length ? others : [];
  const region = table.region?.map((/** @type {Region} */ { density: _, ...fields }, /** @type {number} */ k) => clean({ ...fields, density: same[k] }));
  return clean({ ...table, density, region });
};

/** @param {any} body @param {any} feet */
const withFeet = ({ units, name, ...block }, feet) => ({ units, ...(name ? { name } : {}), block: { ...block, feet } });

/** Regions of a section; if the mass is given they have no densities.
 * @param {Region[]} regions @param {{ mass?: number }} section */
export const weighed = (regions, { mass }) => (mass === undefined ? regions : withDensities({ region: regions }).region);

/** The body in another shape of about the same size.
 * @param {any} body @param {string} shape @param {Server.DescribedBody | null} facts */
export const asShape = (body, shape, facts) => {
  const { units, name } = body;
  const from = tableOfShape(body);
  const [width, height] = spans(facts, units, from);
  const drawn = regionsOf(facts, units);
  const density = from.mass ? undefined : from.density ?? firstDensity(body);
  const common = { depth: from.depth, density, mass: from.mass };
  /** @type {{ [shape: string]: any }} */
  const sizes = {
    block: { width, height },
    trapezoid: { base: width, top: round(width * 0.6), height, lean: 0 },
    ellipse: { width, height, sides: 24 },
    regular_polygon: { sides: 6, radius: round(height / 2) },
    section: { region: weighed(drawn.length ? drawn : [rectangle(width, height)], from), depth: from.depth, mass: from.mass },
  };
  const table = clean(shape === "section" ? sizes.section : { ...sizes[shape], ...common });
  return clean(shape === "block" ? { units, name, ...table } : { units, name, [shape]: table });
};

/** Regions from the server as an editable section, in a unit.
 * @param {Server.DescribedBody | null} facts @param {Unit} units @returns {any[]} */
export const regionsOf = (facts, units) => {
  /** @param {Ring} points */
  const ring = (points) => points.map(([x, y]) => [fromMetres(x, units), fromMetres(y, units)]);
  const regions = facts?.outline ?? [];
  return regions.map(({ outline, holes, density }) =>
    clean(
      {
        outline: ring(outline), holes: holes?.length ? holes.map(ring) : undefined,
        density: density ?? undefined,
      }
    ));
};

/** @param {Server.BodyInput} body */
const firstDensity = (body) => body.section?.region?.[0]?.density;

/** @param {number} width @param {number} height */
const rectangle = (width, height) => ({ outline: [[0, 0], [width, 0], [width, height], [0, height]] });

// Before the first result the typed sizes are used.
/** @param {Server.DescribedBody | null} facts @param {Unit} units @param {any} table */
const spans = (facts, units, { width, height }) => {
  const points = (facts?.outline ?? []).flatMap((region) => region.outline);
  if (!points.length) return [width ?? fromMetres(0.5, units), height ?? fromMetres(2, units)];
  return [0, 1].map((axis) => {
    const values = points.map((point) => point[axis]);
    return round(fromMetres(spanOf(values), units));
  });
};

/** @param {number} value */
const round = (value) => Number(value.toPrecision(6));

/** @param {{ [key: string]: any }} table */
const clean = (table) => Object.fromEntries(
  Object.entries(table).filter(([, value]) => value !== undefined && value !== null)
);
