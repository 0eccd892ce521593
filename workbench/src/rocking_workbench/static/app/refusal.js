/** Errors of the server as texts of the page: names of fields, regions from 1, units of the page. */

import { number, numbers, pretty } from "/app/format.js";
import { t, messageText } from "/app/words.js";

const METRES = { m: 1, cm: 0.01, mm: 0.001, ft: 0.3048, in: 0.0254 };

/** @type {{ [path: string]: string | undefined }} */
const FIELDS = { "settings.gravity": "gravity", "body.units": "unit of length", "motion.time_step": "time between two samples", "motion.units": "unit",
  time_step: "time between two samples", units: "unit" };

/** Text of an error, its field of the body, and its location in the drawing; lengths are in the unit of the body.
 * @param {any} error @param {Server.BodyInput} [body] */
export const inPlainWords = (error, body) => {
  if (!error.text) error.message = capital(t(error.message));
  if (!error.text) return;
  const ofBody = error.places[0]?.name === "body" || error.parameter.startsWith("body.");
  const units = ofBody && body && METRES[body.units] ? body.units : "m";
  error.field = ofBody ? nameOf(error.parameter) : null;
  error.place = ofBody ? placeOf(error) : null;
  error.message = sentenceOf(error, units);
};

/** Controls of the page that replace the options named in a message.
 * @type {{ [path: string]: string | undefined }} */
const WAYS = {
  "motion.units": "enter it in the form", "motion.time_step": "enter it in the form", "motion.format": "enter it in the form",
  "measurement.unit": "enter it under \u201cUnit\u201d", "measurement.time_unit": "enter it under \u201cUnit\u201d",
  "identify.trend": "choose \u201cwith a trend\u201d under \u201cCoefficient of restitution\u201d",
};

/** Reason and remedy for a file that was excluded. @param {{ reason: string, hint?: string, to_state?: string }} leftOut */
export const whyLeftOut = ({ reason, hint, to_state: path }) => {
  const way = WAYS[path ?? ""];
  if (way) return t("{location}: {fault}", { location: reason, fault: way });
  return hint ? t("{fault}; {hint}", { fault: clause(reason), hint }) : t(reason);
};

/** Message with its values in the notation of the page. @param {any} message
 * @param {Server.BodyInput["units"]} [units] @returns {string} */
export const spelt = (message, units = "m") => {
  const kinds = Object.values(message.facts);
  if (kinds.some((fact) => fact?.kind === "writtenfile")) return ""; // the page has a button for this
  const way = kinds.map((fact) => (fact?.kind === "option" ? WAYS[fact.path] : undefined)).find(Boolean);
  return way ? t(way) : messageText(message, (fact) => spelling(fact, units));
};

/** Files with their lines, and steps, with errors. @param {Required<Server.Refusal>} refusal @returns {string[]} */
const outerPlaces = ({ places }) => places.filter(({ kind }) => kind === "file" || kind === "step")
  .map(({ name, kind, number: line }) => (kind === "file" && line ? `${name}, ${t("line {number}", { number: line })}` : name));

/** Rejection of a run as text; the missing values are fields of the form. @param {Required<Server.Refusal>} refusal */
export const refusalWords = (refusal) => {
  const places = outerPlaces(refusal);
  const hint = refusal.hint?.text ? spelt(refusal.hint) : "";
  const isWay = Object.values(refusal.hint?.facts ?? {}).some((fact) => fact?.kind === "option" && WAYS[fact.path]);
  const fault = within(places, spelt(inForm(refusal)));
  return hint && isWay ? t("{location}: {fault}", { location: fault, fault: hint }) : hint ? t("{fault}; {hint}", { fault: clause(fault), hint }) : fault;
};

/** Key of the form with the error. @param {Required<Server.Refusal>} refusal @returns {string | undefined} */
export const keyOf = (refusal) => {
  const ofOneFile = /^motions\[\d+\]\.files\.(.+\.\w+)$/.exec(refusal.parameter)?.[1]; // the error is in a field for one file
  return (ofOneFile ?? nameOf(refusal.parameter)).toLowerCase() || undefined;
};

/** @param {Required<Server.Refusal>} error @param {Server.BodyInput["units"]} units */
const sentenceOf = (error, units) => {
  const region = regionOf(error);
  const places = outerPlaces(error);
  const stated = inForm(error);
  const about = stated !== error && (error.parameter.startsWith("body.") || error.parameter in FIELDS);
  let fault = spelt(stated, units);
  if (region !== undefined) fault = t("Region {number}: {fault}", { number: region + 1, fault: about ? t("the {fault}", { fault }) : fault });
  else if (about) fault = places.length ? t("the {fault}", { fault }) : capital(t("The {fault}", { fault }));
  else if (!places.length) fault = capital(fault);
  fault = within(places, fault);
  if (error.hint?.text) fault = t("{fault}; {hint}", { fault: clause(fault), hint: spelt(error.hint, units) });
  return error.more ? t("{fault}; there are further errors", { fault }) : fault;
};

/** Sentence without its final full stop. @param {string} text */
const clause = (text) => text.replace(/[.\u3002]$/, "");

/** @param {string[]} places @param {string} fault */
const within = (places, fault) => places.reduceRight((text, location) => t("{location}: {fault}", { location, fault: text }), fault);

// The message repeats the rejected number in the unit of its range, because the field shows this number.
const MUST = ["{parameter} must be {allowed}, got {value}", "{parameter} must be a number {allowed}, got {value}"];
/** @param {Required<Server.Refusal>} refusal @returns {Required<Server.Refusal>} */
const inForm = (refusal) => {
  const { text, facts, value, unit } = refusal;
  if (!MUST.includes(text) || facts.allowed?.kind !== "range") return refusal;
  const repeated = typeof value === "number" ? { kind: "amount", value, unit: unit === "m" ? "m" : "" } : facts.value;
  return { ...refusal, text: "{parameter} must be {allowed}; it is {value}", facts: { ...facts, value: repeated } };
};

/** @param {any} fact @param {Server.BodyInput["units"]} units @returns {string} */
const spelling = (fact, units) => {
  switch (fact?.kind) {
    case "parameter":
    case "option": return t(FIELDS[fact.path] ?? nameOf(fact.path).replaceAll("_", " "));
    case "index": return String(fact.number + 1);
    case "amount": return amount(fact.value, fact.unit, units);
    case "range": return range(fact, units);
    case "message": return spelt(fact, units);
    default:
      if (Array.isArray(fact)) return fact.map((item) => spelling(item, units)).join("; ");
      return typeof fact === "number" ? number(fact) : t(String(fact ?? ""));
  }
};

/** Number with unit; lengths and areas in metres are converted to the unit of the body.
 * @param {number} value @param {string} unit @param {Server.BodyInput["units"]} units */
const amount = (value, unit, units) => {
  const power = { m: 1, m2: 2 }[unit];
  if (!power) return `${number(value)}${unit ? ` ${pretty(unit)}` : ""}`;
  return `${number(value / METRES[units] ** power)} ${pretty(power === 1 ? units : `${units}2`)}`;
};

/** @param {any} range @param {Server.BodyInput["units"]} units */
const range = ({ low, high, low_open: lowOpen, high_open: highOpen, unit }, units) => {
  const [shown, scale] = unit === "m" ? [units, METRES[units]] : [unit, 1];
  const [from, to] = [low, high].map((end) => (end === null ? null : number(end / scale)));
  const behind = shown ? ` ${pretty(shown)}` : "";
  if (high === null) return t(lowOpen ? "more than {limit}" : "at least {limit}", { limit: low === 0 ? from : `${from}${behind}` });
  if (low === null) return t(highOpen ? "less than {limit}" : "at most {limit}", { limit: `${to}${behind}` });
  return t("in {interval}", { interval: `${lowOpen ? "(" : "["}${numbers([low / scale, high / scale])}${highOpen ? ")" : "]"}${behind}` });
};

/** Location of an error in the drawing: a point in metres (x or y may be unknown), regions and a hole by index.
 * @param {Required<Server.Refusal>} error */
const placeOf = (error) => {
  const { x, y, first, second, ring } = error.facts;
  const region = regionOf(error);
  const regions = first?.kind === "index" ? [first.number, second.number] : region === undefined ? [] : [region];
  const hole = ring?.facts?.hole?.number;
  const location = { x: x?.value, y: y?.value, regions, hole };
  return location.x === undefined && location.y === undefined && !regions.length ? null : location;
};

/** Region of a section with an error. @param {Required<Server.Refusal>} error @returns {number | undefined} */
const regionOf = (error) => {
  const index = [...error.places.map(({ name }) => name), error.parameter].map(indexOf).find((position) => position !== undefined);
  return index;
};

/** @param {string} path */
const indexOf = (path) => {
  const index = path.match(/section\.region\[(\d+)\]/)?.[1];
  return index === undefined ? undefined : Number(index);
};

/** The last key of a path. @param {string} path */
const nameOf = (path) => path.split(".").at(-1)?.replace(/(\[\d+\])+$/, "") ?? "";

/** @param {string} text */
const capital = (text) => text.replace(/^[a-z](?!\S*\.)(?![a-z]* ?[=[])/, (first) => first.toUpperCase());
