/** From metres to pixels: position of the ground on the canvas, and scale. */

const MARGIN = 0.08;
const FLOOR = 40;
const HEADROOM = 14;

/** Returns a camera; `fit` sets its fields, which the drawing reads in each frame. */
export const newCamera = () => ({ width: 0, height: 0, ratio: 1, scale: 1, middle: 0, floor: 0 });

/** Sets the camera so that a box in metres fills a canvas, with its size in CSS pixels.
 * @param {Camera} camera @param {Reach} box @param {number} width @param {number} height @param {number} ratio */
export const fit = (camera, box, width, height, ratio) => {
  const wide = (box.right - box.left) * (1 + 2 * MARGIN);
  const tall = box.high * (1 + MARGIN) - Math.min(box.low, 0);
  camera.width = width;
  camera.height = height;
  camera.ratio = ratio;
  camera.scale = Math.min(width / wide, (height - FLOOR - HEADROOM) / tall);
  camera.middle = 0.5 * (box.left + box.right);
  camera.floor = height - FLOOR + Math.min(box.low, 0) * camera.scale;
};

/** Returns the horizontal pixel of a position [m], for a camera that moved by `ridden` [m].
 * @param {Camera} camera @param {number} metres @param {number} ridden */
export const pixelOf = (camera, metres, ridden) =>
  0.5 * camera.width + (metres - camera.middle - ridden) * camera.scale;

/** Sets a pen to the frame of a body that has turned about its foot on a ground that has moved.
 * @param {CanvasRenderingContext2D} pen @param {Camera} camera @param {number} rotation @param {number[]} feet @param {number} moved @param {number} ridden */
export const holdBody = (pen, camera, rotation, feet, moved, ridden) => {
  const pivot = rotation > 0 ? feet[1] : feet[0];
  const k = camera.scale * camera.ratio;
  const c = k * Math.cos(rotation);
  const s = k * Math.sin(rotation);
  const x = camera.ratio * pixelOf(camera, pivot + moved, ridden);
  pen.setTransform(c, s, s, -c, x - c * pivot, camera.ratio * camera.floor - s * pivot);
};
