/** Points from a table or a file: two columns, any common separator, decimal commas allowed. */

import { parseNumber } from "/app/format.js";
import { t } from "/app/words.js";

/** Read points from text: {points, fault}. A first line with headings is ignored.
 * @param {string} text @returns {{ points: Ring, fault: string }} */
export const parsePoints = (text) => {
  /** @type {Ring} */
  const points = [];
  const lines = text.split(/\r?\n/).map(
    /** @returns {[string, number]} */ (line, index) => [line.trim().replace(/[[\](){}]/g, " ").replace(/[,;]\s*$/, "").trim(), index + 1]
  );
  for (const [line, at] of lines) {
    if (!line) continue;
    const pair = pairOf(line);
    if (pair) points.push(pair);
    else if (points.length || /\d/.test(line)) return {
      points: [], fault: t("Line {number}, \u201c{line}\u201d: two numbers are needed.", { number: at, line: line.slice(0, 40) }),
    };
  }
  const ring = open(points);
  return ring.length < 3 ? {
    points: [], fault: t("A polygon needs at least three points, got {count}.", { count: ring.length }),
  } : { points: ring, fault: "" };
};

// Separators are tried in order of certainty: semicolon or tab, then space, then comma.
/** @param {string} line @returns {Point | null} */
const pairOf = (line) => {
  for (const separator of [/\s*[;\t]\s*/, /,\s+|\s+/, /,/]) {
    const parts = line.split(separator).filter(Boolean);
    if (parts.length === 2) {
      const pair = parts.map(parseNumber);
      return pair.includes(null) ? null : /** @type {Point} */ (pair);
    }
    if (parts.length > 2) return null;
  }
  return null;
};

/** @param {Ring} points */
const open = (points) => {
  const [first, last] = [points[0], points[points.length - 1]];
  return points.length > 1 && first[0] === last[0] && first[1] === last[1] ? points.slice(0, -1) : points;
};
