/** Drawings of one frame of the scene. Frames allocate no memory. */
import { fixed } from "/app/format.js";
import { holdBody, pixelOf } from "/scene/camera.js";

const STEPS = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500];
const HATCH = 14;
/** @type {number[]} */
const NO_DASH = [];
const TICKS = new Map();

/** Distance of the ticks of the ruler in metres, for a scale in pixels per metre. @param {number} scale */
export const tickStep = (scale) => {
  for (let k = 0; k < STEPS.length; k += 1) if (STEPS[k] * scale > 72) return STEPS[k];
  return 5000;
};

/** Label of a tick of the ruler. @param {number} value @param {number} step */
export const tickText = (value, step) => {
  const key = Math.round(value / step) * step;
  let text = TICKS.get(key);
  if (text === undefined) {
    const digits = step < 0.01 ? 3 : step < 0.1 ? 2 : step < 1 ? 1 : 0;
    text = `${fixed(key, digits)} m`;
    if (TICKS.size > 2000) TICKS.clear();
    TICKS.set(key, text);
  }
  return text;
};

/** Sets the scale of a pen to CSS pixels. @param {CanvasRenderingContext2D} pen @param {Camera} camera */
export const holdScreen = (pen, camera) => pen.setTransform(camera.ratio, 0, 0, camera.ratio, 0, 0);

/** Draw the ground with moving hatches and a fixed ruler.
 * @param {CanvasRenderingContext2D} pen @param {Camera} camera @param {Colours} colours @param {number} moved @param {number} ridden */
export const drawGround = (pen, camera, colours, moved, ridden) => {
  holdScreen(pen, camera);
  const { width, height, floor, scale } = camera;
  pen.fillStyle = colours.ground;
  pen.fillRect(0, floor, width, height - floor);
  pen.strokeStyle = colours.hatch;
  pen.lineWidth = 1.2;
  pen.beginPath();
  const start = pixelOf(camera, moved, ridden) % HATCH;
  for (let x = start - HATCH; x < width + 2 * HATCH; x += HATCH) {
    pen.moveTo(x, floor + 1);
    pen.lineTo(x - 8, floor + 9);
  }
  pen.stroke();
  pen.strokeStyle = colours.ink;
  pen.lineWidth = 1.8;
  pen.beginPath();
  pen.moveTo(0, floor);
  pen.lineTo(width, floor);
  pen.stroke();
  drawRuler(pen, camera, colours, ridden, tickStep(scale));
};

/** @param {CanvasRenderingContext2D} pen @param {Camera} camera @param {Colours} colours @param {number} ridden @param {number} step */
const drawRuler = (pen, camera, colours, ridden, step) => {
  const half = (0.5 * camera.width) / camera.scale;
  const middle = camera.middle + ridden;
  const top = camera.height - 26;
  pen.fillStyle = colours.soft;
  pen.strokeStyle = colours.soft;
  pen.lineWidth = 1;
  pen.textAlign = "center";
  pen.beginPath();
  for (let k = Math.ceil((middle - half) / step); k * step < middle + half; k += 1) {
    const x = pixelOf(camera, k * step, ridden);
    pen.moveTo(x, top);
    pen.lineTo(x, top + 5);
    if (x > 26 && x < camera.width - 26) pen.fillText(tickText(k * step, step), x, top + 18);
  }
  pen.stroke();
};

/** Draws the body whose history is followed: filled, with its centre of mass.
 * @param {CanvasRenderingContext2D} pen @param {Camera} camera @param {Shape} shape @param {Colours} colours @param {number} rotation @param {number} moved @param {number} ridden @param {string} colour */
export const drawBody = (pen, camera, shape, colours, rotation, moved, ridden, colour) => {
  holdBody(pen, camera, rotation, shape.feet, moved, ridden);
  pen.lineWidth = 1.8 / camera.scale;
  pen.strokeStyle = colour;
  pen.fillStyle = colours.body;
  for (let k = 0; k < shape.regions.length; k += 1) {
    const region = shape.regions[k];
    pen.globalAlpha = 0.4 + 0.6 * region.shade;
    pen.fill(region.path, "evenodd");
    pen.globalAlpha = 1;
    pen.stroke(region.path);
  }
  drawPoints(pen, camera, shape, colours);
  drawCentre(pen, camera, shape, colours);
};

/** @param {CanvasRenderingContext2D} pen @param {Camera} camera @param {Shape} shape @param {Colours} colours */
const drawPoints = (pen, camera, shape, colours) => {
  if (!shape.points.length) return;
  pen.beginPath();
  pen.moveTo(shape.feet[0], 0);
  pen.lineTo(shape.centre[0], shape.centre[1]);
  pen.lineTo(shape.feet[1], 0);
  pen.closePath();
  pen.stroke();
  pen.fillStyle = colours.ink;
  for (let k = 0; k < shape.points.length; k += 1) {
    const point = shape.points[k];
    pen.beginPath();
    pen.arc(point[0], point[1], (3 + 6 * Math.sqrt(point[2])) / camera.scale, 0, 2 * Math.PI);
    pen.fill();
  }
};

/** @param {CanvasRenderingContext2D} pen @param {Camera} camera @param {Shape} shape @param {Colours} colours */
const drawCentre = (pen, camera, shape, colours) => {
  const arm = 7 / camera.scale;
  const x = shape.centre[0];
  const y = shape.centre[1];
  pen.strokeStyle = colours.ink;
  pen.lineWidth = 1.5 / camera.scale;
  pen.beginPath();
  pen.moveTo(x - arm, y);
  pen.lineTo(x + arm, y);
  pen.moveTo(x, y - arm);
  pen.lineTo(x, y + arm);
  pen.stroke();
};

/** Draws another model's body as an outline in its colour and dash.
 * @param {CanvasRenderingContext2D} pen @param {Camera} camera @param {Shape} shape @param {Actor} ghost @param {number} rotation @param {number} moved @param {number} ridden */
export const drawGhost = (pen, camera, shape, ghost, rotation, moved, ridden) => {
  holdBody(pen, camera, rotation, shape.feet, moved, ridden);
  pen.strokeStyle = ghost.colour;
  pen.lineWidth = 1.6 / camera.scale;
  pen.setLineDash(ghost.scaledDash);
  for (let k = 0; k < shape.regions.length; k += 1) pen.stroke(shape.regions[k].path);
  if (!shape.regions.length) drawStick(pen, shape);
  pen.setLineDash(NO_DASH);
};

/** @param {CanvasRenderingContext2D} pen @param {Shape} shape */
const drawStick = (pen, shape) => {
  pen.beginPath();
  pen.moveTo(shape.feet[0], 0);
  pen.lineTo(shape.centre[0], shape.centre[1]);
  pen.lineTo(shape.feet[1], 0);
  pen.closePath();
  pen.stroke();
};

/** Draws the ring of an impact at a foot; `age` runs from 0 to 1.
 * @param {CanvasRenderingContext2D} pen @param {Camera} camera @param {Colours} colours @param {number} x @param {number} age @param {string} text @param {number} wide */
export const drawFlash = (pen, camera, colours, x, age, text, wide) => {
  holdScreen(pen, camera);
  pen.globalAlpha = 1 - 0.8 * age;
  pen.strokeStyle = colours.impact;
  pen.fillStyle = colours.impact;
  pen.lineWidth = 3;
  pen.beginPath();
  pen.arc(x, camera.floor, 6 + 22 * age, Math.PI, 2 * Math.PI);
  pen.stroke();
  const fits = x + 36 + wide < camera.width;
  pen.textAlign = fits ? "left" : "right";
  pen.fillText(text, fits ? x + 34 : x - 34, camera.floor - 8);
  pen.globalAlpha = 1;
};
