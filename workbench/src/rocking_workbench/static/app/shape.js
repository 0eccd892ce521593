/** Inputs from other sources: their types are checked before a view reads them. */

import { SHAPES } from "/app/shapes.js";

const UNITS = new Set(["m", "cm", "mm", "ft", "in"]);

/** Inputs of a document from another source, without empty tables; null if the document is not valid.
 * @param {unknown} document @returns {Server.Inputs | null} */
export const inputsOf = (document) => {
  if (!isTable(document)) return null;
  const { motion, ...tables } = document;
  const [response, settings] = [tables.response, tables.settings].map((table) => (isTable(table) && !Object.keys(table).length ? null : table));
  const inputs = withoutNulls({ ...tables, body: isTable(tables.body) ? withoutNulls(tables.body) : null, response, settings });
  const good = Object.keys(inputs).every((key) => CHECKS[key]?.(inputs[key])) && isBody(inputs.body);
  if (!good || !(motion === undefined || motion === null || isMotion(motion))) return null;
  return /** @type {any} */ (motion ? { ...inputs, motion: withoutNulls(motion) } : inputs);
};

/** Form values of a document from another source; invalid values are removed.
 * @param {any} forms @returns {Forms} */
export const formsOf = (forms) => (!isTable(forms) ? {} : Object.fromEntries(Object.entries(forms).filter(([, form]) => isTable(form)
  && maybe(isList((file) => isTable(file) && eachOf(file, ["name", "sha"], isText)))(form.files))));

/** @param {unknown} value @returns {value is { [key: string]: any }} */
const isTable = (value) => typeof value === "object" && value !== null && !Array.isArray(value);
/** @param {unknown} value */
const isNumber = (value) => typeof value === "number" && Number.isFinite(value);
/** @param {unknown} value */
const isText = (value) => typeof value === "string";
/** @param {(value: any) => boolean} isItem @returns {(value: any) => boolean} */
const isList = (isItem) => (value) => Array.isArray(value) && value.every(isItem);
/** @param {any} value */
const isPair = (value) => isList(isNumber)(value) && value.length === 2;
/** @param {any} value */
const isRing = (value) => isList(isPair)(value) && value.length > 2;
/** @param {unknown} value */
const none = (value) => value === undefined || value === null;
/** @param {(value: any) => boolean} check @returns {(value: any) => boolean} */
const maybe = (check) => (value) => none(value) || check(value);
/** @param {any} table @param {string[]} keys @param {(value: any) => boolean} check */
const eachOf = (table, keys, check) => keys.every((key) => maybe(check)(table[key]));

/** @param {{ [key: string]: any }} table */
const withoutNulls = (table) =>
  Object.fromEntries(Object.entries(table).filter(([, value]) => value !== null && value !== undefined));

const FIELDS = Object.values(SHAPES).flatMap(({ fields }) => fields);
const SIZES = [...FIELDS.filter(([, , more]) => more?.unit !== "").map(([key]) => key), "depth", "ground"];

/** Keys of a body that are lengths, or lists of them. */
export const LENGTHS = new Set([...SIZES, "feet", "outline", "holes", "points", "contact", "centre"]);
const NUMBERS = [...SIZES, "density", "sides", "mass", "moment_of_inertia"];

/** @param {any} table */
const isSized = (table) => isTable(table) && eachOf(table, NUMBERS, isNumber) && eachOf(table, ["feet", "centre"], isPair);

/** @param {any} region */
const isRegion = (region) =>
  isTable(region) && maybe(isRing)(region.outline) && maybe(isList(isRing))(region.holes)
  && maybe(isNumber)(region.density) && maybe(isText)(region.wkt);

/** @param {any} section */
const isSection = (section) =>
  isSized(section) && isList(isRegion)(section.region) && section.region.length > 0;

/** @param {any} body */
const isBody = (body) =>
  isSized(body) && UNITS.has(body.units) && maybe(isText)(body.name)
  && eachOf(body, Object.keys(SHAPES), isSized)
  && maybe(isSection)(body.section)
  && maybe((table) => isTable(table) && isList(isPair)(table.points))(body.mass_points);

/** @param {any} motion */
const isMotion = (motion) =>
  isTable(motion) && ["pulse", "record", "synthetic"].filter((key) => !none(motion[key])).length === 1
  && eachOf(motion, [
    "pulse", "record", "synthetic", "file_name", "format", "units", "component", "vertical",
  ], isText)
  && eachOf(motion, ["scale", "seed", "member", "pga", "pgv", "time_step"], isNumber);

/** @param {any} side */
const isSide = (side) =>
  isTable(side) && eachOf(side, ["model"], isText) && eachOf(side, ["value"], isNumber)
  && maybe(isList(isText))(side.models) && maybe(isList(isNumber))(side.values);

/** @param {any} table */
const isRestitution = (table) => isSide(table) && eachOf(table, ["left", "right"], isNumber);

/** @type {{ [key: string]: ((table: any) => boolean) | undefined }} */
const CHECKS = {
  body: isTable,
  restitution: isRestitution,
  /** @param {any} table */
  response: (table) => isTable(table) && eachOf(table, ["initial_rotation", "assumed_friction"], isNumber),
  settings: isTable,
};
