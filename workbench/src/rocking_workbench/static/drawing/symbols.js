/** Symbols of mechanics: centre of mass, feet, ground, arrows, angles. */

import { svg } from "/app/dom.js";

/** The quartered circle of a centre of mass. @param {number} x @param {number} y @param {number} [radius] */
export const centreMark = (x, y, radius = 7) =>
  svg("g", { transform: `translate(${x} ${y})`, class: "centre-mark" },
    svg("circle", { r: radius, class: "centre-paper" }),
    svg(
      "path",
      {
        class: "ink-fill",
        d: [1, -1].map((way) => quarter(way * radius, radius)).join(""),
      },
    ),
    svg("circle", { r: radius, class: "centre-ring" }));

/** @param {number} reach @param {number} radius */
const quarter = (reach, radius) => `M0 0H${reach}A${radius} ${radius} 0 0 0 0 ${-reach}Z`;

/** A triangle under a foot. @param {number} x @param {number} y @param {number} [size] */
export const footMark = (x, y, size = 8) =>
  svg("path", { class: "accent-fill", d: `M${x} ${y}l${size * 0.75} ${size * 1.3}h${-size * 1.5}Z` });

/** The line of the ground with its hatching. @param {number} left @param {number} right @param {number} y */
export const groundLine = (left, right, y) => {
  const hatches = [];
  for (let x = left + 4; x < right; x += 10) hatches.push(`M${x} ${y}l-6 7`);
  return svg("g", {},
    svg("path", { class: "ground-hatch", d: hatches.join("") }),
    svg("path", { class: "ground", d: `M${left} ${y}H${right}` }));
};

/** Arrow from a point along a vector; empty if the arrow is too short to be visible.
 * @param {number} x @param {number} y @param {number} dx @param {number} dy @param {Attributes} [attributes] */
export const arrow = (x, y, dx, dy, attributes = {}) => {
  const length = Math.hypot(dx, dy);
  if (length < 1.5) return svg("circle", { cx: x, cy: y, r: 1.5, class: "arrow-dot", ...attributes });
  const head = Math.min(6, length * 0.5);
  const [ux, uy] = [dx / length, dy / length];
  const [tipX, tipY] = [x + dx, y + dy];
  const [backX, backY] = [tipX - head * ux, tipY - head * uy];
  const half = head * 0.45;
  return svg("path", {
    class: "arrow",
    d: `M${coordinates(x, y)}L${coordinates(backX, backY)}M${coordinates(tipX, tipY)}`
      + `L${coordinates(backX - half * uy, backY + half * ux)}L${coordinates(backX + half * uy, backY - half * ux)}Z`,
    ...attributes,
  });
};

/** The arc of an angle measured from the vertical, at a corner.
 * @param {number} x @param {number} y @param {number} radius @param {number} angle */
export const arc = (x, y, radius, angle) => {
  const end = [x + radius * Math.sin(angle), y - radius * Math.cos(angle)];
  return svg(
    "path",
    {
      class: "accent-line",
      d: `M${r(x)} ${r(y - radius)}A${radius} ${radius} 0 0 ${angle > 0 ? 1 : 0} ${r(end[0])} ${r(end[1])}`,
    },
  );
};

/** Text next to a symbol, with a halo for legibility over lines.
 * @param {number} x @param {number} y @param {string} text @param {Attributes} [attributes] */
export const label = (x, y, text, attributes = {}) => svg(
  "text", { x: r(x), y: r(y), class: "halo", ...attributes }, text,
);

/** @param {number} x @param {number} y */
const coordinates = (x, y) => `${r(x)} ${r(y)}`;

/** @param {number} value */
const r = (value) => Math.round(value * 10) / 10;
