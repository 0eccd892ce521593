/** Numbers for readers: decimal mark of the language, minus sign, thin spaces, powers of ten.
 * Inputs, files, links and code use decimal points. */

import { language } from "/app/language.js";

const MINUS = "\u2212";
const THIN = "\u202f";
const NONE = "\u2013";
const MARK = new Intl.NumberFormat(language).formatToParts(0.5).find(({ type }) => type === "decimal")?.value ?? ".";
const SUPERSCRIPTS = "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079";

/** Number as text with a given number of significant digits.
 * @param {number | string | null | undefined} value @param {number} [digits] */
export const number = (value, digits = 4) => {
  if (value === null || value === undefined || !Number.isFinite(Number(value))) return NONE;
  const numeric = Number(value);
  if (numeric === 0) return "0";
  const size = Math.abs(numeric);
  const text = size >= 1e6 || size < 1e-4 ? scientific(size, digits) : plain(size, digits);
  return numeric < 0 ? MINUS + text : text;
};

/** Number as text with a given number of decimals. @param {number} value @param {number} digits */
export const fixed = (value, digits) => {
  const text = Math.abs(value).toFixed(digits);
  return (value < 0 && Number(text) > 0 ? MINUS : "") + text.replace(".", MARK);
};

/** Numbers in one line, with a separator that the numbers do not contain. @param {(number | string)[]} values */
export const numbers = (values) => values.map((value) => number(value)).join(MARK === "," ? "; " : ", ");

/** A number and its unit; a pure number has the unit "" or "-".
 * @param {number | null | undefined} value @param {string} [unit] @param {number} [digits] */
export const quantity = (value, unit, digits = 4) => {
  const text = number(value, digits);
  if (text === NONE || !unit || unit === "-" || unit === "1") return text;
  return unit === "%" || unit === "\u00b0" ? `${text}${THIN}${unit}` : `${text}\u00a0${pretty(unit)}`;
};

/** Fraction of 1 as a percentage. @param {number} share @param {number} [digits] */
export const percent = (share, digits = 3) => quantity(share * 100, "%", digits);

/** Unit as text: m/s2 becomes m/s with a superscript 2. @param {string} unit */
export const pretty = (unit) => unit.replace(
  /([a-z])(-?[0-9])\b/gi, (_, letter, power) => letter + raised(power),
);

/** Typed number, decimal comma allowed; null if it is not a number. @param {string | number} text */
export const parseNumber = (text) => {
  const clean = String(text).trim().replace(
    /[\s\u202f\u00a0]/g, "",
  ).replace(/\u2212/g, "-").replace(",", ".");
  if (!/^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(clean)) return null;
  const value = Number(clean);
  return Number.isFinite(value) ? value : null;
};

/** Number for an input box, with all digits.
 * @param {number | string | null | undefined} value */
export const editable = (value) => (value === null || value === undefined ? "" : String(value));

/** Round off the errors of binary arithmetic. @param {number} value @param {number} [digits] */
export const tidy = (value, digits = 12) => Number(Number(value).toPrecision(digits));

/** @param {number} size @param {number} digits */
const plain = (size, digits) => {
  const [integer, fraction = ""] = expanded(size, digits).split(".");
  const trimmed = fraction.replace(/0+$/, "");
  const grouped = integer.length > 4 ? integer.replace(/\B(?=(\d{3})+$)/g, THIN) : integer;
  return trimmed ? `${grouped}${MARK}${trimmed}` : grouped;
};

/** @param {number} size @param {number} digits */
const expanded = (size, digits) => {
  const decimals = digits - 1 - Math.floor(Math.log10(size));
  return decimals > 0 ? size.toFixed(Math.min(decimals, 20)) : String(Math.round(size));
};

/** @param {number} size @param {number} digits */
const scientific = (size, digits) => {
  const [mantissa, power] = size.toExponential(digits - 1).split("e");
  return `${String(Number(mantissa)).replace(".", MARK)}\u00d710${raised(String(Number(power)))}`;
};

/** @param {string} text */
const raised = (text) => [...text].map(
  (character) => (character === "-" ? "\u207b" : SUPERSCRIPTS[Number(character)])
).join("");
