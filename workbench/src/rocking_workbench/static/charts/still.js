/** Part of the page as an SVG with drawings, positioned text and computed styles. */

import { set, svg } from "/app/dom.js";
import { fontOf, measured } from "/charts/letters.js";

const LOOK = [
  "fill", "fill-opacity", "fill-rule", "stroke", "stroke-width", "stroke-dasharray", "stroke-linejoin",
  "opacity", "paint-order", "font-family", "font-size", "font-weight", "text-anchor", "color",
];
const OF_THE_PAGE = ["class", "data-testid", "aria-label", "aria-hidden", "role", "focusable"];
const ABOVE = { overflow: "visible" }; // text may extend beyond the edge of a drawing

/** @typedef {(rect: DOMRect) => { x: number, y: number, width: number, height: number }} Placing */

/** Copy of an element; `canvasOf` redraws the canvases in it.
 * @param {Element} root @param {(canvas: HTMLCanvasElement) => SVGElement} [canvasOf] */
export const stillOf = (root, canvasOf) => {
  const { left, top, width, height } = root.getBoundingClientRect();
  /** @type {Placing} */
  const at = (rect) => ({ x: round(rect.left - left), y: round(rect.top - top), width: round(rect.width), height: round(rect.height) });
  /** @param {Node} node @returns {Child} */
  const shown = (node) => {
    if (node instanceof Text) return linesOf(node, at);
    if (!(node instanceof Element) || !node.checkVisibility() || node.matches(".visually-hidden, .toolbar")) return null;
    const where = at(node.getBoundingClientRect());
    if (node instanceof SVGSVGElement) return svg("svg", { ...where, ...ABOVE, viewBox: node.getAttribute("viewBox") }, [...dressed(node).childNodes]);
    if (node instanceof HTMLCanvasElement) return canvasOf ? set(canvasOf(node), where) : null;
    return [node === root ? null : plateOf(getComputedStyle(node), where), ...[...node.childNodes].map(shown)];
  };
  const size = { width: Math.ceil(width), height: Math.ceil(height) };
  return svg("svg", { ...size, ...ABOVE, viewBox: `0 0 ${size.width} ${size.height}` }, [shown(root)]);
};

/** @param {number} value */
const round = (value) => Math.round(value * 100) / 100;

/** @param {SVGSVGElement} picture */
const dressed = (picture) => {
  const copy = /** @type {SVGSVGElement} */ (picture.cloneNode(true));
  dress(picture, copy);
  return copy;
};

/** @param {Element} from @param {Element} to */
const dress = (from, to) => {
  const style = getComputedStyle(from);
  for (const name of LOOK) {
    const value = style.getPropertyValue(name);
    if (value) to.setAttribute(name, value.replace(/url\("(.*)"\)/, "url($1)"));
  }
  for (const name of OF_THE_PAGE) to.removeAttribute(name);
  [...from.children].forEach((child, k) => dress(child, to.children[k]));
};

// Background and border of a box, if present.
/** @param {CSSStyleDeclaration} style @param {ReturnType<Placing>} where */
const plateOf = ({ backgroundColor: fill, borderTopWidth: width, borderTopColor: stroke, borderTopStyle: kind, borderRadius: r }, where) => {
  const [bare, edged] = [/^rgba\(.*, 0\)$/.test(fill), kind === "solid"];
  if (bare && !edged) return null;
  const edge = edged ? { stroke, "stroke-width": parseFloat(width) } : {};
  return svg("rect", { ...where, rx: Math.min(parseFloat(r) || 0, where.height / 2), fill: bare ? "none" : fill, ...edge });
};

const PIECES = /[\u2e80-\u9fff\uff00-\uffef]|[^\s\u2e80-\u9fff\uff00-\uffef]+/g; // a line may break between two of these pieces

/** Lines of a text, as on the page. @param {Text} node @param {Placing} at */
const linesOf = (node, at) => {
  /** @type {{ from: number, to: number, rect: DOMRect }[]} */
  const lines = [];
  const range = document.createRange();
  for (const { index, 0: piece } of node.data.matchAll(PIECES)) {
    range.setStart(node, index);
    range.setEnd(node, index + piece.length);
    const rect = range.getBoundingClientRect();
    const last = lines.at(-1);
    if (last && Math.abs(last.rect.top - rect.top) < rect.height / 2) last.to = index + piece.length;
    else if (rect.width) lines.push({ from: index, to: index + piece.length, rect });
  }
  const style = getComputedStyle(/** @type {Element} */ (node.parentElement));
  const look = { fill: style.color, "font-family": style.fontFamily, "font-size": style.fontSize, "font-weight": style.fontWeight };
  return lines.map(({ from, to, rect }) => {
    const { x, y } = at(rect);
    const text = node.data.slice(from, to).replace(/\s+/g, " ");
    return svg("text", { x, y: round(y + measured(text, fontOf(style)).fontBoundingBoxAscent), ...look }, text);
  });
};
