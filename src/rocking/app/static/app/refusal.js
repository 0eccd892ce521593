/** The server's refusals in the words of the page: names of fields, regions counted from one, its units. */

import { number, pretty } from "/app/format.js";

const METRES = { m: 1, cm: 0.01, mm: 0.001, ft: 0.3048, in: 0.0254 };

/** @type {{ [path: string]: string | undefined }} */
const FIELDS = {
  "settings.gravity": "Gravity", "body.name": "Name", "body.units": "The unit of length",
  time_step: "The time between two samples", units: "The unit",
};

/** A refusal in plain words; lengths in metres are told in the body's unit.
 * @param {string} message @param {Server.BodyInput} [body] */
export const plainWords = (message, body) => {
  const units = body && METRES[body.units] ? body.units : "m";
  return [withoutPlaces, withFields, withRegions, withLimits, withCurves, withMore, withChoices, capital]
    .reduce((words, change) => change(words), inUnits(message, units));
};

/** The key of the body's field that a refusal is about; nothing if it names none. @param {string} message */
export const fieldOf = (message) => message.match(/^body\.(?:[a-z_]+\.)?([a-z_]+) must /)?.[1]
  ?? (/ foot must lie /.test(message) ? "feet" : / centre of mass .*must lie /.test(message) ? "centre" : null);

/** Where in the drawing a refusal is: a point in metres (x or y may be unknown), regions and a hole by their index.
 * @param {string} message @param {Server.BodyInput} [body] */
export const placeOf = (message, body) => {
  if (!message.startsWith("body")) return null;
  /** @param {RegExp} pattern */
  const found = (pattern) => message.match(pattern)?.slice(1).map(Number);
  const [x, y] = found(/ x = (\S+) m, y = (\S+?) m\b/) ?? [
    found(/ foot must lie on the base, .*, got (\S+)$/)?.[0],
    found(/ lowest point is y = (\S+) m/)?.[0] ?? (/ foot must lie on the base/.test(message) ? METRES[body?.units ?? "m"] * (body?.section?.ground ?? 0) : undefined),
  ];
  const regions = found(/\bregions (\d+) and (\d+)\b/) ?? found(/section\.region\[(\d+)\]/) ?? [];
  const hole = found(/ hole (\d+)\b/)?.[0];
  return x === undefined && y === undefined && !regions.length ? null : { x, y, regions, hole };
};

/** @param {string} words */
const withoutPlaces = (words) =>
  words.replace(/^body: /, "")
    .replace(/^section\.region\[(\d+)\]: region: /, (_, index) => `Region ${Number(index) + 1}: `)
    .replace(/^(block|trapezoid|ellipse|regular_polygon|section|mass_points): /, "");

/** @param {string} words */
const withFields = (words) =>
  words.replace(/^body\.section\.region\[(\d+)\]\.(\w+)(\[\d+\])*/, (_, index, key) =>
    `The ${key} of region ${Number(index) + 1}`)
    .replace(/^[a-z]+(?:\.[a-z]+)?(?:_[a-z]+)*(?= must )/, (path) => FIELDS[path] ?? path)
    .replace(/^body\.(?:[a-z_]+\.)?([a-z]+)(?= must )/, (_, key) => `The ${key}`);

/** @param {string} words */
const withRegions = (words) =>
  words.replace(/\bregions (\d+) and (\d+)\b/g, (_, first, second) =>
    `regions ${Number(first) + 1} and ${Number(second) + 1}`);

/** @param {string} words */
const withLimits = (words) =>
  words.replace(/must be a number > 0\b/, "must be more than 0")
    .replace(/must be a number >= (\d+)/, "must be at least $1")
    .replace(/ \[([^\]\d][^\]]*)\](?=,|$)/, "")
    .replace(/(?<=must be .*), got '?(.*?)'?(?= \(and|$)/, (_, given) =>
      (/^[-\d.e]+$/.test(given) ? `; it is ${number(Number(given))}` : ""));

// What follows is an argument of scripts; the page has a button for it.
/** @param {string} words */
const withCurves = (words) => words.replace(/(; their dispersions differ): crossing=.*$/, "$1");

/** @param {string} words */
const withMore = (words) => words.replace(/ \(and \d+ more\)$/, "; more is wrong beside it");

/** @param {string} words */
const withChoices = (words) =>
  words.replace(/^(\S+): does not state its unit; give units=.*$/,
    "$1 does not say its unit: choose the unit of the file.");

/** @param {string} words */
const capital = (words) => words.replace(/^[a-z](?!\S*\.)(?![a-z]* ?[=[])/, (first) => first.toUpperCase());

// Lengths and areas of a sentence about a body are in metres, whatever the drawing is in.
/** @param {string} message @param {Server.BodyInput["units"]} units */
const inUnits = (message, units) => {
  if (units === "m" || !/^body: /.test(message)) return message;
  /** @param {string} value */
  const length = (value) => number(Number(value) / METRES[units]);
  return message
    .replace(/\[(-?[\d.e-]+), (-?[\d.e-]+)\] m, got (-?[\d.e-]+)$/, (_, low, high, given) =>
      `[${length(low)}, ${length(high)}] ${units}; it is ${length(given)} ${units}`)
    .replace(/\b(-?[\d.]+(?:e-?\d+)?) and (-?[\d.]+(?:e-?\d+)?) m\b(?!2)/g, (_, first, second) =>
      `${length(first)} and ${length(second)} ${units}`)
    .replace(/(-?\b[\d.]+(?:e-?\d+)?) m\b(?!2)/g, (_, value) => `${length(value)} ${units}`)
    .replace(/(\b[\d.]+(?:e-?\d+)?) m2\b/g, (_, value) =>
      `${number(Number(value) / METRES[units] ** 2)} ${pretty(`${units}2`)}`);
};
