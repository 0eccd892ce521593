/** Markers of the published measurements, the same shapes as in print. */

import { svg } from "/app/dom.js";

/** @type {{ [shape: string]: (r: number) => string }} */
const SHAPES = {
  /** @param {number} r */
  square: (r) => `M${-r} ${-r}H${r}V${r}H${-r}Z`,
  /** @param {number} r */
  up: (r) => `M0 ${-1.2 * r}L${1.15 * r} ${0.9 * r}H${-1.15 * r}Z`,
  /** @param {number} r */
  down: (r) => `M0 ${1.2 * r}L${1.15 * r} ${-0.9 * r}H${-1.15 * r}Z`,
  /** @param {number} r */
  circle: (r) => `M${-r} 0A${r} ${r} 0 1 0 ${r} 0A${r} ${r} 0 1 0 ${-r} 0Z`,
};

/** Marker at a location.
 * @param {string} shape @param {number} x @param {number} y @param {number} [radius] @param {Attributes} [attributes] */
export const marker = (shape, x, y, radius = 4.5, attributes = {}) =>
  svg(
    "path", { class: "marker", d: SHAPES[shape](radius), transform: `translate(${x} ${y})`, ...attributes },
  );
