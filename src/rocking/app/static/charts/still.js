/** A picture of the page as an SVG of its own: the look that its classes give stands in it. */

import { set, svg } from "/app/dom.js";
import { colour } from "/charts/style.js";

const [HEAD, MARGIN] = [34, 16];
const LOOK = [
  "fill", "fill-opacity", "fill-rule", "stroke", "stroke-width", "stroke-dasharray", "stroke-linejoin",
  "opacity", "paint-order", "font-family", "font-size", "font-weight", "text-anchor", "color",
];

/** A copy of a drawn picture under its title, in the colours of the page as it is now.
 * @param {SVGSVGElement} picture @param {string} title */
export const stillOf = (picture, title) => {
  const { width, height } = picture.viewBox.baseVal;
  const inside = /** @type {SVGSVGElement} */ (picture.cloneNode(true));
  dress(picture, inside);
  inside.removeAttribute("aria-label");
  set(inside, { x: MARGIN, y: HEAD, width, height });
  const size = { width: width + 2 * MARGIN, height: height + HEAD + MARGIN };
  const viewBox = `0 0 ${size.width} ${size.height}`;
  return svg("svg", { ...size, viewBox, "font-family": "system-ui, sans-serif" },
    svg("title", {}, title),
    svg("desc", {}, picture.getAttribute("aria-label") ?? ""),
    svg("rect", { ...size, fill: colour("--surface") }),
    svg("text", { x: MARGIN, y: 22, "font-size": 14, "font-weight": 600, fill: colour("--ink") }, title),
    inside);
};

/** @param {Element} from @param {Element} to */
const dress = (from, to) => {
  const style = getComputedStyle(from);
  for (const name of LOOK) {
    const value = style.getPropertyValue(name);
    if (value) to.setAttribute(name, value.replace(/url\("(.*)"\)/, "url($1)"));
  }
  for (const name of ["class", "data-testid"]) to.removeAttribute(name);
  [...from.children].forEach((child, k) => dress(child, to.children[k]));
};
