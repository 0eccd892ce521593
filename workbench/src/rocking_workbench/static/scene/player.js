/** The player: stage, strip and controls, driven by one clock. */
import { el } from "/app/dom.js";
import { onTheme } from "/charts/style.js";
import { Clock } from "/scene/clock.js";
import { controlsOf } from "/scene/controls.js";
import { noteFrame, resetFrames } from "/scene/frames.js";
import { Stage } from "/scene/stage.js";
import { sceneStill } from "/scene/still.js";
import { Strip } from "/scene/strip.js";

const READOUT_MS = 66;

/** Animation of a rocking body, with speed and position. */
export class Player {
  constructor(onInstant = (/** @type {number} */ _) => {}) {
    this.onInstant = onInstant;
    this.clock = new Clock();
    this.touched = false;
    this.play = /** @type {Play | null} */ (null);
    this.lead = 0;
    this.groundMode = "true";
    this.updated = 0;
    const seen = { role: "img", tabindex: "0", "data-testid": "scene-stage" };
    const stage = el("canvas", { class: "scene-stage", ...seen });
    const strip = el("canvas", { class: "scene-strip", "aria-hidden": "true" });
    this.controls = controlsOf({
      onToggle: () => this.toggle(),
      onSeek: (share) => this.seek(share * this.clock.end),
      onSpeed: (speed) => this.setSpeed(speed),
      onGround: (mode) => {
        this.setGround(mode);
        this.draw();
      },
    });
    this.stageCanvas = stage;
    this.element = el("div", { class: "scene", "data-testid": "scene" }, stage, strip, this.controls.element);
    this.stage = new Stage(stage);
    this.strip = new Strip(strip, (instant) => this.seek(instant));
    this.frame = this.frame.bind(this);
    stage.addEventListener("keydown", (event) => this.onKey(event));
    new ResizeObserver(() => this.resize()).observe(this.element);
    onTheme(() => this.repaint());
  }

  /** Set a new answer; a running animation continues at the same instant. @param {Play} play @param {number} lead */
  show(play, lead) {
    this.play = play;
    this.lead = lead;
    this.clock.end = play.end;
    if (!this.touched) this.clock.now = Math.min(play.restTime, play.end);
    this.clock.now = Math.min(this.clock.now, play.end);
    this.setGround(this.groundMode);
    this.strip.show(play, lead);
    this.stageCanvas.setAttribute("aria-label", play.description);
    this.draw();
  }

  /** Shows the ground motion, magnifies it, or moves the picture with the ground. @param {string} mode */
  setGround(mode) {
    this.groundMode = mode;
    if (!this.play) return;
    this.stage.show(this.play, this.lead, mode);
    this.controls.tellGround(mode, this.stage.factor, this.stage.rides);
  }

  /** Sets the speed: seconds of the history per second of the screen. @param {number} speed */
  setSpeed(speed) {
    this.clock.speed = speed;
    if (!this.clock.running) this.draw();
  }

  /** Starts or stops. */
  toggle() {
    if (this.clock.running) this.pause();
    else this.start();
  }

  /** Starts; the first time from the beginning. */
  start() {
    if (!this.play) return;
    if (!this.touched) this.clock.now = 0;
    this.touched = true;
    this.clock.start();
    resetFrames();
    this.controls.tellRunning(this.clock.running);
    requestAnimationFrame(this.frame);
  }

  /** Stops. */
  pause() {
    this.clock.stop();
    this.controls.tellRunning(false);
    this.tell();
  }

  /** Goes to an instant [s] and stops there. @param {number} instant */
  seek(instant) {
    this.touched = true;
    this.clock.seek(instant);
    this.pause();
    this.draw();
  }

  /** Shows the instant of the pointer in another chart, unless the animation runs. @param {number} instant */
  glance(instant) {
    if (this.clock.running || !this.play) return;
    this.clock.seek(instant);
    this.touched = true;
    this.draw();
  }

  /** Draw one frame and request the next. @param {number} stamp */
  frame(stamp) {
    if (!this.clock.running) return;
    const started = performance.now();
    this.clock.tick(stamp);
    this.stage.draw(this.clock.now, this.clock.speed);
    this.strip.draw(this.clock.now);
    this.onInstant(this.clock.now);
    if (stamp - this.updated > READOUT_MS || !this.clock.running) {
      this.updated = stamp;
      this.tell();
    }
    noteFrame(performance.now() - started);
    if (this.clock.running) requestAnimationFrame(this.frame);
    else this.controls.tellRunning(false);
  }

  /** The shown instant as a separate picture; `names`: titles of the models. @param {string[]} names */
  still(names) {
    return sceneStill(this.stage, this.clock.now, names);
  }

  /** Writes the time and the rotation as numbers. */
  tell() {
    if (!this.play) return;
    const { now, end } = this.clock;
    const actor = this.play.actors[this.lead];
    this.controls.tell(now, end, actor.rotation.at(now), actor.share.at(now));
  }

  draw() {
    if (!this.play) return;
    this.stage.draw(this.clock.now, this.clock.speed);
    this.strip.draw(this.clock.now);
    this.onInstant(this.clock.now);
    this.tell();
  }

  resize() {
    this.stage.resize();
    this.strip.resize();
    this.draw();
  }

  repaint() {
    this.stage.repaint();
    this.strip.repaint();
    this.draw();
  }

  /** Moves in time by keys while the stage has the focus. @param {KeyboardEvent} event */
  onKey(event) {
    const { now, end, speed } = this.clock;
    const stride = event.shiftKey ? 0.5 : Math.max(speed, 0.1) / 30;
    const does = {
      ArrowRight: () => this.seek(now + stride),
      ArrowLeft: () => this.seek(now - stride),
      Home: () => this.seek(0),
      End: () => this.seek(end),
    }[event.key];
    if (!this.play || !does || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    does();
  }
}
