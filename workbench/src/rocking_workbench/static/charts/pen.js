/** Pen with the interface of a canvas that writes SVG, for figures on the screen and in files. */

import { freshId, svg } from "/app/dom.js";

/** @type {WeakMap<Path2D, string>} */
const written = new WeakMap();

/** A path for a canvas and for SVG. @param {string} d */
export const pathOf = (d) => {
  const path = new Path2D(d);
  written.set(path, d);
  return path;
};

/** @type {{ [word: string]: string | undefined }} */
const ANCHORS = { center: "middle", right: "end" };
/** @type {{ [word: string]: number | undefined }} */
const BELOW = { top: 0.8, middle: 0.35 }; // shift of the text / font size

// Numbers as text, with enough digits for metres of a small body and for pixels.
/** @param {...number} values */
const at = (...values) => values.map((value) => Number(value.toPrecision(7))).join(" ");

/** Draw into `node`, with the subset of the canvas interface used by the page. */
export class SvgPen {
  node = svg("g", { fill: "none" });
  place = this.node;
  matrix = new DOMMatrix();
  fillStyle = "#000";
  strokeStyle = "#000";
  lineWidth = 1;
  globalAlpha = 1;
  font = "12px system-ui, sans-serif";
  textAlign = "left";
  textBaseline = "alphabetic";
  dash = /** @type {number[]} */ ([]);
  d = "";
  kept = /** @type {any[]} */ ([]);

  save() { this.kept.push({ ...this }); }
  restore() { Object.assign(this, this.kept.pop()); }
  /** @param {...number} six */
  setTransform(...six) { this.matrix = new DOMMatrix(six); }
  /** @param {number} x @param {number} y */
  translate(x, y) { this.matrix = this.matrix.translate(x, y); }
  /** @param {number} angle */
  rotate(angle) { this.matrix = this.matrix.rotate((180 * angle) / Math.PI); }
  /** @param {number[]} dash */
  setLineDash(dash) { this.dash = dash; }

  beginPath() { this.d = ""; }
  closePath() { this.d += "Z"; }
  /** @param {number} x @param {number} y */
  moveTo(x, y) { this.d += `M${at(x, y)}`; }
  /** @param {number} x @param {number} y */
  lineTo(x, y) { this.d += `${this.d ? "L" : "M"}${at(x, y)}`; }
  /** @param {number} x @param {number} y @param {number} wide @param {number} high */
  rect(x, y, wide, high) { this.d += `M${at(x, y)}h${at(wide)}v${at(high)}h${at(-wide)}Z`; }
  /** A complete circle. @param {number} x @param {number} y @param {number} r */
  arc(x, y, r) { this.d += `M${at(x - r, y)}A${at(r, r)} 0 1 0 ${at(x + r, y)}A${at(r, r)} 0 1 0 ${at(x - r, y)}Z`; }

  /** Clip further drawing at the path. */
  clip() {
    const id = freshId("cut");
    const within = svg("g", { "clip-path": `url(#${id})` });
    this.place.append(svg("clipPath", { id }, svg("path", { d: this.d })), within);
    this.place = within;
  }

  /** @param {"path" | "text"} tag @param {Attributes} attributes @param {...Child} children */
  put(tag, attributes, ...children) {
    const { a, b, c, d, e, f, isIdentity } = this.matrix;
    const transform = isIdentity ? null : `matrix(${[a, b, c, d, e, f].join(" ")})`;
    this.place.append(svg(tag, { transform, ...attributes }, ...children));
  }

  /** @param {Path2D} [path] */
  textOf(path) { return path ? written.get(path) : this.d; }
  /** @param {Path2D} [path] @param {string} [rule] */
  fill(path, rule) {
    const [, paint, share] = /^(#.{6})(..)$/.exec(this.fillStyle) ?? [null, this.fillStyle, "ff"]; // SVG 1.1 does not support #rrggbbaa
    const opacity = at(this.globalAlpha * Number.parseInt(share, 16) / 255);
    this.put("path", { d: this.textOf(path), fill: paint, "fill-rule": rule, "fill-opacity": opacity });
  }

  /** @param {Path2D} [path] */
  stroke(path) {
    const look = { stroke: this.strokeStyle, "stroke-width": this.lineWidth, "stroke-linejoin": "round", "stroke-dasharray": this.dash.join(" ") || null };
    this.put("path", { d: this.textOf(path), ...look });
  }

  /** @param {number} x @param {number} y @param {number} wide @param {number} high */
  fillRect(x, y, wide, high) {
    this.beginPath();
    this.rect(x, y, wide, high);
    this.fill();
  }

  /** @param {string} text @param {number} x @param {number} y */
  fillText(text, x, y) {
    const [, size, family] = /(\d+)px (.*)$/.exec(this.font) ?? [];
    const look = { fill: this.fillStyle, "font-size": size, "font-family": family, "text-anchor": ANCHORS[this.textAlign] };
    this.put("text", { x: at(x), y: at(y + (BELOW[this.textBaseline] ?? 0) * Number(size)), ...look }, text);
  }
}
