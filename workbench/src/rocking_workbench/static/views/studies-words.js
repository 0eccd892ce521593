/** Texts of the package in the notation of the page. */
import { pretty } from "/app/format.js";
import { t } from "/app/words.js";

/** @type {{ [name: string]: string }} */
const LETTERS = { alpha: "\u03b1", pi: "\u03c0", omega_p: "\u03c9\u209a", a_p: "a\u209a", T_p: "T\u209a" };
const UNITS = /\b(m\/s2|cm\/s2|rad\/s2|kg\/m3|m2|m3)\b/g;

/** Greek letters and indices in place of their names. @param {string} text */
export const greek = (text) => text.replace(/\b(alpha|pi|omega_p|a_p|T_p)\b/g, (name) => LETTERS[name]);

/** A sentence of the package with Greek letters and raised powers. @param {string} text */
export const plainWords = (text) => greek(t(text)).replace(UNITS, pretty);
