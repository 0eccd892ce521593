/** Words of the package as a page prints them. */

const LETTERS = { alpha: "\u03b1", omega_p: "\u03c9\u209a", a_p: "a\u209a", T_p: "T\u209a" };

/** Greek letters and indices in place of their names. */
export const greek = (words) => words.replace(/\b(alpha|omega_p|a_p|T_p)\b/g, (name) => LETTERS[name]);
