/** The stage: a canvas with the rocking bodies on the moving ground. */
import { highest } from "/app/extremes.js";
import { fit, newCamera, pixelOf } from "/scene/camera.js";
import { boxOf } from "/scene/geometry.js";
import { drawBody, drawFlash, drawGhost, drawGround } from "/scene/pictures.js";
import { calm, readColours } from "/scene/theme.js";

const POSES = 160;
const FLASH = 0.4;
const FAR = 1.5;
const VISIBLE = 0.25;

/** @param {Actor[]} actors @param {Track} ground @param {number} factor @param {number} end */
const posesOf = (actors, ground, factor, end) => {
  const poses = [];
  for (const { rotation } of actors) {
    for (let k = 0; k <= POSES; k += 1) {
      const instant = (end * k) / POSES;
      poses.push({ rotation: rotation.at(instant), ground: factor * ground.at(instant) });
    }
  }
  return poses;
};

/** Magnification of the ground motion for visibility: 1, 2, 5, 10, ...
 * @param {number} travel @param {number} size */
export const visibleFactor = (travel, size) => {
  if (!(travel > 0)) return 1;
  const factor = (VISIBLE * size) / travel;
  if (factor <= 1) return 1;
  const tens = 10 ** Math.floor(Math.log10(factor));
  return ([5, 2].find((step) => step * tens <= factor) ?? 1) * tens;
};

/** Draws the scene of one instant. */
export class Stage {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    this.pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
    this.camera = newCamera();
    this.colours = /** @type {Colours} */ ({});
    this.play = /** @type {Play | null} */ (null);
    this.lead = 0;
    this.factor = 1;
    this.rides = false;
    this.box = /** @type {Reach} */ ({ left: 0, right: 0, low: 0, high: 0 });
    this.wide = 0;
  }

  /** Set {shape, actors, ground, end}, the solid actor, and the ground display.
   * @param {Play} play @param {number} lead @param {string} groundMode */
  show(play, lead, groundMode) {
    this.play = play;
    this.lead = lead;
    const size = highest(boxSize(boxOf(play.shape, [])));
    const travel = play.ground.peak();
    this.factor = groundMode === "magnified" ? visibleFactor(travel, size) : 1;
    this.rides = groundMode === "ride" || this.factor * travel > FAR * size;
    const poses = posesOf(play.actors, play.ground, this.rides ? 0 : this.factor, play.end);
    this.box = boxOf(play.shape, poses);
    this.resize();
  }

  /** Set the present size of the canvas. */
  resize() {
    const { clientWidth, clientHeight } = this.canvas;
    if (!this.play || !clientWidth) return;
    const ratio = window.devicePixelRatio || 1;
    readColours(this.canvas, this.colours);
    this.canvas.width = Math.round(clientWidth * ratio);
    this.canvas.height = Math.round(clientHeight * ratio);
    fit(this.camera, this.box, clientWidth, clientHeight, ratio);
    this.pen.font = "12px system-ui, sans-serif";
    this.pen.lineJoin = "round";
    this.wide = this.pen.measureText("r = 0.0000").width;
    for (const actor of this.play.actors) {
      actor.scaledDash = actor.dash.map((length) => length / this.camera.scale);
    }
  }

  /** Updates the colours from the page. */
  repaint() {
    readColours(this.canvas, this.colours);
  }

  /** Draws an instant [s]; the duration of flashes does not depend on the speed. @param {number} now @param {number} speed */
  draw(now, speed) {
    const { pen, camera, colours, play } = this;
    if (!play || !camera.width) return;
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    this.paint(pen, camera, colours, play, now);
    if (!calm()) this.flash(play, now, Math.max(FLASH * speed, 0.005));
  }

  /** Ground displacement on the screen at an instant [m]. @param {Play} play @param {number} now */
  movedAt(play, now) {
    return this.factor * play.ground.at(now);
  }

  /** Draws the ground and the bodies at an instant [s], with any pen.
   * @param {CanvasRenderingContext2D} pen @param {Camera} camera @param {Colours} colours @param {Play} play @param {number} now */
  paint(pen, camera, colours, play, now) {
    const moved = this.movedAt(play, now);
    const ridden = this.rides ? moved : 0;
    drawGround(pen, camera, colours, moved, ridden);
    for (let k = 0; k < play.actors.length; k += 1) {
      const actor = play.actors[k];
      if (k !== this.lead) drawGhost(pen, camera, play.shape, actor, actor.rotation.at(now), moved, ridden);
    }
    const lead = play.actors[this.lead];
    drawBody(pen, camera, play.shape, colours, lead.rotation.at(now), moved, ridden, lead.colour);
  }

  /** Draws the ring of the last impact, if it is recent.
   * @param {Play} play @param {number} now @param {number} lasts */
  flash(play, now, lasts) {
    const actor = play.actors[this.lead];
    const times = actor.impactTimes;
    let k = times.length - 1;
    while (k >= 0 && times[k] > now) k -= 1;
    if (k < 0 || now - times[k] > lasts) return;
    const foot = play.shape.feet[actor.impactFeet[k]];
    const moved = this.movedAt(play, now);
    const x = pixelOf(this.camera, foot + moved, this.rides ? moved : 0);
    const age = (now - times[k]) / lasts;
    drawFlash(this.pen, this.camera, this.colours, x, age, actor.impactWords[k], this.wide);
  }
}

/** @param {Reach} box */
const boxSize = (box) => [box.right - box.left, box.high - box.low];
