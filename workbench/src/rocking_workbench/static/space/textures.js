/** Marks and numbers as pictures that three.js puts into a scene. */

import { svg } from "/app/dom.js";
import { SvgPen } from "/charts/pen.js";

const SIDE = 64;

/** @param {any} three @param {(pen: CanvasRenderingContext2D) => unknown} draw */
const drawn = (three, draw) => {
  const canvas = Object.assign(document.createElement("canvas"), { width: SIDE, height: SIDE });
  const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  pen.translate(SIDE / 2, SIDE / 2);
  pen.lineJoin = "round";
  draw(pen);
  const texture = new three.CanvasTexture(canvas);
  texture.colorSpace = three.SRGBColorSpace;
  return texture;
};

/** @param {CanvasRenderingContext2D} pen @param {Point[]} points */
const path = (pen, points) => {
  pen.beginPath();
  points.forEach((point) => pen.lineTo(...point));
  pen.closePath();
};

// Marks as in the picture of the equilibria; white is replaced by the colour of the material.
/** @type {{ [shape: string]: (pen: CanvasRenderingContext2D) => unknown }} */
const SHAPES = {
  /** @param {CanvasRenderingContext2D} pen */
  dot: (pen) => { pen.beginPath(); pen.arc(0, 0, 20, 0, 7); },
  /** @param {CanvasRenderingContext2D} pen */
  stable: (pen) => { pen.beginPath(); pen.arc(0, 0, 20, 0, 7); },
  /** @param {CanvasRenderingContext2D} pen */
  summit: (pen) => path(pen, [[0, -24], [23, 18], [-23, 18]]),
  /** @param {CanvasRenderingContext2D} pen */
  mended: (pen) => path(pen, [[-20, -20], [20, -20], [20, 20], [-20, 20]]),
  /** @param {CanvasRenderingContext2D} pen */
  saddle: (pen) => path(pen, [
    [-24, -15], [-15, -24], [0, -9], [15, -24], [24, -15], [9, 0], [24, 15], [15, 24], [0, 9], [-15, 24], [-24, 15], [-9, 0],
  ]),
};

/** A mark: dot, stable, saddle or summit. @param {any} three @param {string} shape */
export const markTexture = (three, shape) => drawn(three, (pen) => {
  SHAPES[shape](pen);
  pen.lineWidth = 8;
  pen.strokeStyle = "#1d1f1e";
  pen.stroke();
  pen.fillStyle = "#ffffff";
  pen.fill();
});

/** The mark next to text. @param {string} kind */
export const markKey = (kind) => {
  const pen = new SvgPen();
  const draw = SHAPES[kind] ?? SHAPES.dot;
  draw(/** @type {any} */ (pen));
  return svg("svg", { class: `space-key ${kind}`, width: 14, height: 14, viewBox: "-28 -28 56 56", "aria-hidden": "true" }, svg("path", { d: pen.d }));
};

const RISE = ["#00224e", "#434e6c", "#7d7c78", "#bcaf6f", "#fee838"];

/** The colours of a landscape, from low to high. */
export const riseKey = () => svg("svg", { class: "space-key", width: 60, height: 12, viewBox: "0 0 60 12", "aria-hidden": "true" },
  RISE.map((fill, k) => svg("rect", { x: 12 * k, width: 12.5, height: 12, fill })));

/** A number on a plate. @param {any} three @param {string} text */
export const labelTexture = (three, text) => drawn(three, (pen) => {
  pen.beginPath();
  pen.arc(0, 0, 28, 0, 7);
  pen.fillStyle = "#ffffff";
  pen.fill();
  pen.lineWidth = 4;
  pen.strokeStyle = "#1d1f1e";
  pen.stroke();
  pen.fillStyle = "#1d1f1e";
  pen.font = `bold ${text.length > 2 ? 18 : 32}px system-ui, sans-serif`;
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  pen.fillText(text, 0, 2);
});
