/** Tables to the clipboard: tab-separated text with all digits, for Excel. */

import { say } from "/app/say.js";
import { t } from "/app/words.js";

/** Copy columns and rows as text, with a message of success or of the error.
 * @param {(string | Column)[]} columns @param {unknown[][]} rows */
export const copyTable = async (columns, rows) => {
  const text = asText(columns, rows);
  try {
    await navigator.clipboard.writeText(text);
    say(t("{count} rows copied. Paste them into a spreadsheet.", { count: rows.length }));
  } catch {
    say("This browser blocks copying. Use the CSV button.", "warning");
  }
};

/** The tab-separated text of a table. @param {(string | Column)[]} columns @param {unknown[][]} rows */
export const asText = (columns, rows) =>
  [columns.map(heading), ...rows.map((row) => row.map(cell))].map((line) => line.join("\t")).join("\r\n");

/** @param {string | Column} column */
const heading = (column) =>
  cell(typeof column === "string" ? column : column.unit ? `${column.label} [${column.unit}]` : column.label);

// A text that a spreadsheet would run as a formula gets an apostrophe before it.
/** @param {unknown} value */
const cell = (value) => {
  const plain = value instanceof Node ? value.textContent : value;
  if (typeof plain === "number") return Number.isFinite(plain) ? String(plain) : "";
  const text = String(plain ?? "").replace(/\s+/g, " ").trim();
  return /^[=+\-@]/.test(text) && !/^[+-]?[\d.]+(e[+-]?\d+)?$/i.test(text) ? `'${text}` : text;
};
