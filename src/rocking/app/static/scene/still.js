/** One instant of the scene as an SVG: the ground, the bodies of all models, and which is which. */

import { svg } from "/app/dom.js";
import { colour } from "/charts/style.js";
import { legendOf } from "/charts/vector.js";
import { pixelOf } from "/scene/camera.js";
import { turned } from "/scene/geometry.js";
import { tickStep, tickText } from "/scene/pictures.js";

/** @typedef {Camera & { moved: number, ridden: number, colours: Colours }} Frame */

const [HEAD, ROW, HATCH] = [30, 18, 14];

/** The instant that a stage shows, under a title; `names` are the models in words.
 * @param {import("/scene/stage.js").Stage} stage @param {number} now @param {string} title @param {string[]} names */
export const sceneStill = (stage, now, title, names) => {
  const { camera, colours } = stage;
  const play = /** @type {Play} */ (stage.play);
  const moved = stage.factor * play.ground.at(now);
  const frame = { ...camera, moved, ridden: stage.rides ? moved : 0, colours };
  const lines = play.actors.map(({ colour: paint, dash }, k) => ({ label: names[k], colour: paint, dash }));
  const legend = legendOf(lines, camera.width);
  const top = HEAD + legend.rows * ROW;
  const [width, height] = [camera.width, camera.height + top];
  const ghosts = play.actors.filter((_, k) => k !== stage.lead);
  const lead = play.actors[stage.lead];
  return svg("svg", {
    width, height, viewBox: `0 0 ${width} ${height}`, "font-family": "system-ui, sans-serif", "font-size": 12,
  },
    svg("title", {}, title),
    svg("desc", {}, play.words),
    svg("rect", { width, height, fill: colour("--surface") }),
    svg("text", { x: 12, y: 18, "font-size": 13, "font-weight": 600, fill: colour("--ink") }, title),
    legend.node,
    svg("g", { transform: `translate(0 ${top})` },
      groundOf(frame),
      ghosts.map((actor) => bodyOf(frame, play.shape, actor, actor.rotation.at(now), false)),
      bodyOf(frame, play.shape, lead, lead.rotation.at(now), true)));
};

/** @param {number} value */
const round = (value) => Math.round(value * 100) / 100;

/** @param {Frame} frame @param {number} x @param {number} y */
const placed = (frame, x, y) =>
  `${round(pixelOf(frame, x + frame.moved, frame.ridden))} ${round(frame.floor - y * frame.scale)}`;

/** @param {Frame} frame */
const groundOf = (frame) => {
  const { width, height, floor, colours, moved, ridden } = frame;
  const hatches = [];
  const start = pixelOf(frame, moved, ridden) % HATCH;
  for (let x = start - HATCH; x < width + 2 * HATCH; x += HATCH) {
    hatches.push(`M${round(x)} ${floor + 1}l-8 8`);
  }
  return [
    svg("rect", { x: 0, y: floor, width, height: height - floor, fill: colours.ground }),
    svg("path", { d: hatches.join(""), stroke: colours.hatch, "stroke-width": 1.2 }),
    svg("path", { d: `M0 ${floor}H${width}`, stroke: colours.ink, "stroke-width": 1.8 }),
    rulerOf(frame),
  ];
};

/** @param {Frame} frame */
const rulerOf = (frame) => {
  const { width, height, scale, middle, ridden, colours } = frame;
  const step = tickStep(scale);
  const half = (0.5 * width) / scale;
  const ticks = [];
  const first = Math.ceil((middle + ridden - half) / step);
  for (let k = first; k * step < middle + ridden + half; k += 1) ticks.push(k);
  return ticks.map((k) => {
    const x = round(pixelOf(frame, k * step, ridden));
    const words = x > 26 && x < width - 26 ? tickText(k * step, step) : "";
    return [
      svg("path", { d: `M${x} ${height - 26}v5`, stroke: colours.soft }),
      svg("text", { x, y: height - 8, "text-anchor": "middle", fill: colours.soft }, words),
    ];
  });
};

/** The one that is followed is filled and has its centre; the others are outlines in their dash.
 * @param {Frame} frame @param {Shape} shape @param {Actor} actor @param {number} rotation @param {boolean} filled */
const bodyOf = (frame, shape, actor, rotation, filled) => {
  /** @param {number[]} point */
  const at = ([x, y]) => placed(frame, .../** @type {Point} */ (turned(x, y, rotation, shape.feet)));
  /** @param {number[][]} points */
  const ring = (points) => `M${points.map(at).join("L")}Z`;
  const look = filled
    ? { fill: frame.colours.body, "stroke-width": 1.8 }
    : { fill: "none", "stroke-width": 1.6, "stroke-dasharray": actor.dash.join(" ") || null };
  const regions = shape.regions.map(({ outline, holes, shade }) => svg("path", {
    d: [outline, ...holes].map(ring).join(""), "fill-rule": "evenodd", stroke: actor.colour,
    "fill-opacity": filled ? round(0.4 + 0.6 * shade) : null, ...look,
  }));
  const [left, right] = shape.feet;
  const stick = ring([[left, 0], shape.centre, [right, 0]]);
  return svg("g", {}, regions,
    shape.regions.length ? null : svg("path", { d: stick, stroke: actor.colour, ...look, fill: "none" }),
    filled ? [dotsOf(frame, shape, at), crossOf(frame, at(shape.centre))] : null);
};

/** @param {Frame} frame @param {Shape} shape @param {(point: number[]) => string} at */
const dotsOf = ({ colours }, { points }, at) => points.map(([x, y, share]) => {
  const [cx, cy] = at([x, y]).split(" ");
  return svg("circle", { cx, cy, r: round(3 + 6 * Math.sqrt(share)), fill: colours.ink });
});

/** @param {Frame} frame @param {string} place */
const crossOf = ({ colours }, place) =>
  svg("path", { d: `M${place}m-7 0h14m-7 -7v14`, stroke: colours.ink, "stroke-width": 1.5, fill: "none" });
