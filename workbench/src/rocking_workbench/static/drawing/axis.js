/** Straight axes for small pictures. */

import { svg } from "/app/dom.js";
import { number, tidy } from "/app/format.js";
import { multiples, roundStep } from "/drawing/viewport.js";

/** A map from values to pixels with ticks: {at, ticks, low, high}.
 * @param {number} low @param {number} high @param {number} from @param {number} to @param {number} [count] */
export const axisOf = (low, high, from, to, count = 5) => {
  const step = roundStep(high - low, count);
  /** @param {number} value */
  const at = (value) => Math.round((from + ((value - low) / (high - low)) * (to - from)) * 100) / 100;
  return { at, low, high, ticks: multiples(low, high, step).map((tick) => tidy(tick)) };
};

/** Grid lines and numbers under a picture.
 * @param {Axis} axis @param {{ top: number, bottom: number, label: string, unit?: string }} where */
export const bottomAxis = (axis, { top, bottom, label, unit = "" }) =>
  svg("g", { "aria-hidden": "true" },
    axis.ticks.map((value) => [
      svg("path", { class: "grid-line", d: `M${axis.at(value)} ${top}V${bottom}` }),
      svg(
        "text", { class: "soft", x: axis.at(value), y: bottom + 17, "text-anchor": "middle" },
        `${number(value)}${unit}`,
      ),
    ]),
    svg(
      "text",
      { class: "soft", x: axis.at((axis.low + axis.high) / 2), y: bottom + 36, "text-anchor": "middle" },
      label,
    ));

/** Grid lines and numbers left of a picture.
 * @param {Axis} axis @param {{ left: number, right: number, label: string }} where */
export const leftAxis = (axis, { left, right, label }) => {
  const middle = axis.at((axis.low + axis.high) / 2);
  return svg("g", { "aria-hidden": "true" },
    axis.ticks.map((value) => [
      svg("path", { class: "grid-line", d: `M${left} ${axis.at(value)}H${right}` }),
      svg("text", { class: "soft", x: left - 8, y: axis.at(value) + 4, "text-anchor": "end" }, number(value)),
    ]),
    svg(
      "text",
      { class: "soft", "text-anchor": "middle", transform: `translate(${left - 44} ${middle}) rotate(-90)` },
      label,
    ));
};
