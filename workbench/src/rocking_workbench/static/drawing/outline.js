/** Regions of a body as SVG paths. */

import { svg } from "/app/dom.js";
import { highest } from "/app/extremes.js";

/** The path text of rings of points. @param {Ring[]} rings @param {Viewport} view */
export const pathOf = (rings, view) =>
  rings.map(
    (ring) => `M${ring.map(([x, y]) => `${round(view.x(x))} ${round(view.y(y))}`).join("L")}Z`
  ).join("");

/** One path per region; a region of lower density is lighter.
 * @param {Region[]} regions @param {Viewport} view @param {Attributes} [attributes] */
export const regionPaths = (regions, view, attributes = {}) => {
  const densest = highest(regions.map((region) => region.density ?? 1));
  return regions.map(({ outline, holes = [], density }) =>
    svg("path", {
      class: "region", d: pathOf([outline, ...(holes ?? [])], view), "fill-rule": "evenodd",
      "fill-opacity": round(0.45 + 0.55 * ((density ?? densest) / densest)), ...attributes,
    }));
};

/** Every point of every outline. @param {Region[]} regions */
export const pointsOf = (regions) => regions.flatMap((region) => region.outline);

/** @param {number} value */
const round = (value) => Math.round(value * 100) / 100;
