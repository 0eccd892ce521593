/** Strip under the stage: all rotations / alpha, with a line at the present time. */
import { fixed } from "/app/format.js";
import { highest } from "/app/extremes.js";
import { t } from "/app/words.js";
import { readColours } from "/scene/theme.js";

const LEFT = 40;
const RIGHT = 10;
const TOP = 8;
const BOTTOM = 20;

/** Picture of the histories, with a movable time. */
export class Strip {
  /** @param {HTMLCanvasElement} canvas @param {(instant: number) => unknown} onSeek */
  constructor(canvas, onSeek) {
    this.canvas = canvas;
    this.pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
    this.still = document.createElement("canvas");
    this.colours = /** @type {Colours} */ ({});
    this.play = /** @type {Play} */ (/** @type {unknown} */ (null)); // until `show`
    this.lead = 0;
    this.span = 1;
    this.ratio = 1;
    this.width = 0;
    this.height = 0;
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      onSeek(this.instantOf(event));
    });
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons) onSeek(this.instantOf(event));
    });
  }

  /** Set the animation and the solid model. @param {Play} play @param {number} lead */
  show(play, lead) {
    this.play = play;
    this.lead = lead;
    const most = highest(play.actors.map((actor) => actor.share.peak()));
    const falls = play.actors.some((actor) => actor.falls);
    this.span = falls ? 1.5 : Math.max(1.15 * most, most > 0.15 ? 1.15 : 0, 1e-6);
    this.resize();
  }

  /** Set the present size of the canvas and draw the static part. */
  resize() {
    const { clientWidth, clientHeight } = this.canvas;
    if (!this.play || !clientWidth) return;
    this.ratio = window.devicePixelRatio || 1;
    readColours(this.canvas, this.colours);
    for (const canvas of [this.canvas, this.still]) {
      canvas.width = Math.round(clientWidth * this.ratio);
      canvas.height = Math.round(clientHeight * this.ratio);
    }
    this.width = clientWidth;
    this.height = clientHeight;
    this.drawStill();
  }

  /** Updates the colours from the page. */
  repaint() {
    readColours(this.canvas, this.colours);
    if (this.width) this.drawStill();
  }

  /** Returns the instant under a pointer [s]. @param {PointerEvent} event */
  instantOf(event) {
    const x = event.clientX - this.canvas.getBoundingClientRect().left;
    return ((x - LEFT) / (this.width - LEFT - RIGHT)) * this.play.end;
  }

  /** Returns the pixel of an instant. @param {number} time */
  across(time) {
    return LEFT + ((this.width - LEFT - RIGHT) * time) / this.play.end;
  }

  /** Pixel of a rotation / alpha. @param {number} share */
  up(share) {
    const half = 0.5 * (this.height - TOP - BOTTOM);
    return TOP + half - (half * share) / this.span;
  }

  drawStill() {
    const pen = /** @type {CanvasRenderingContext2D} */ (this.still.getContext("2d"));
    pen.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    pen.clearRect(0, 0, this.width, this.height);
    pen.font = "11px system-ui, sans-serif";
    this.drawAxes(pen);
    pen.save();
    pen.beginPath();
    pen.rect(LEFT, TOP - 4, this.width - LEFT - RIGHT, this.height - TOP - BOTTOM + 8);
    pen.clip();
    this.play.actors.forEach((actor, k) => k !== this.lead && this.drawTrace(pen, actor, 1.3));
    this.drawTrace(pen, this.play.actors[this.lead], 2.2);
    pen.restore();
  }

  /** @param {CanvasRenderingContext2D} pen */
  drawAxes(pen) {
    pen.fillStyle = this.colours.soft;
    pen.textAlign = "right";
    for (const share of [0, 1, -1]) {
      if (Math.abs(share) > this.span) continue;
      pen.strokeStyle = share ? this.colours.fall : this.colours.line;
      pen.setLineDash(share ? [5, 4] : []);
      pen.beginPath();
      pen.moveTo(LEFT, this.up(share));
      pen.lineTo(this.width - RIGHT, this.up(share));
      pen.stroke();
      pen.fillText(`${share < 0 ? "\u2212" : ""}${Math.abs(share)}`, LEFT - 6, this.up(share) + 4);
    }
    pen.setLineDash([]);
    const { end } = this.play;
    pen.fillText(`${fixed(end, end < 10 ? 2 : 1)} s`, this.width - RIGHT, this.height - 5);
    pen.textAlign = "left";
    pen.fillText("0 s", LEFT, this.height - 5);
    pen.textAlign = "center";
    const axis = this.width > 420 ? "rotation over slenderness angle, \u03b8/\u03b1" : "\u03b8/\u03b1";
    pen.fillText(t(axis), 0.5 * (LEFT + this.width), this.height - 5);
  }

  /** @param {CanvasRenderingContext2D} pen @param {Actor} actor @param {number} thick */
  drawTrace(pen, { share, colour, dash }, thick) {
    pen.beginPath();
    for (let k = 0; k < share.time.length; k += 1) {
      pen.lineTo(this.across(share.time[k]), this.up(share.values[k]));
    }
    pen.strokeStyle = colour;
    pen.lineWidth = thick;
    pen.setLineDash(dash);
    pen.stroke();
    pen.setLineDash([]);
  }

  /** Draws the strip with the line at an instant [s]. @param {number} now */
  draw(now) {
    if (!this.play || !this.width) return;
    const { pen } = this;
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    pen.drawImage(this.still, 0, 0);
    pen.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    const x = this.across(now);
    pen.strokeStyle = this.colours.ink;
    pen.fillStyle = this.colours.ink;
    pen.lineWidth = 1.5;
    pen.beginPath();
    pen.moveTo(x, 2);
    pen.lineTo(x, this.height - BOTTOM + 2);
    pen.stroke();
    const share = this.play.actors[this.lead].share.at(now);
    pen.beginPath();
    pen.arc(x, Math.min(Math.max(this.up(share), TOP), this.height - BOTTOM), 4.5, 0, 2 * Math.PI);
    pen.fill();
  }
}
