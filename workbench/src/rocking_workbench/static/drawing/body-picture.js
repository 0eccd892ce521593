/** The body to scale: outline, centre of mass, feet, slenderness angle and semi-diagonal. */

import { svg } from "/app/dom.js";
import { highest } from "/app/extremes.js";
import { number, quantity } from "/app/format.js";
import { pointsOf, regionPaths } from "/drawing/outline.js";
import { arc, centreMark, footMark, groundLine, label } from "/drawing/symbols.js";
import { boxOf, roundStep, viewport } from "/drawing/viewport.js";
import { listed, t } from "/app/words.js";

/** Draw a body from its properties; `plain`: without text.
 * @param {Drawn} body @param {{ width?: number, height?: number, plain?: boolean }} [how] */
export const bodyPicture = (body, { width = 208, height = 360, plain = false } = {}) => {
  const view = viewport(boxOf(everything(body)), {
    width, height, margin: plain ? { bottom: 20 } : { left: 20, right: 20, top: 22, bottom: 56 },
  });
  const floor = view.y(groundOf(body));
  return svg("svg", {
    class: "picture body-picture", viewBox: `0 0 ${width} ${height}`, width, height, role: "img",
    "aria-label": inWords(body), ...(plain ? {} : { "data-testid": "body-picture" }),
  },
    groundLine(6, width - 6, floor),
    regionPaths(body.outline, view),
    massDots(body.points ?? [], body.masses ?? [], view),
    plain ? null : sidesOf(body).map(([side, foot, sign]) => sideDrawing(body, side, foot, sign, view)),
    body.foot_positions.map((foot) => footMark(view.x(foot), floor)),
    centreMark(view.x(body.centre[0]), view.y(body.centre[1])),
    plain ? null : scaleBar(view, width, height));
};

/** Height of the feet [m]. @param {Drawn} body */
export const groundOf = (body) => body.ground ?? 0;

/** @param {Drawn} body */
const everything = (body) => [
  ...pointsOf(body.outline), ...(body.points ?? []), body.centre, ...body.foot_positions.map(
    (foot) => [foot, groundOf(body)]
  ),
];

/** True if both sides of the body are equal within rounding. @param {Server.Sides} sides */
export const sameSides = ({ left, right }) =>
  /** @type {(keyof Server.SideFacts)[]} */ (Object.keys(left)).every((key) => Math.abs(left[key] - right[key]) <= 1e-9 * Math.abs(right[key]));

// Equal sides appear once, over the right foot.
/** @param {Drawn} body @returns {[Server.SideFacts, number, number][]} */
const sidesOf = ({ sides, foot_positions: feet }) => {
  /** @type {[Server.SideFacts, number, number]} */
  const right = [sides.right, feet[1], -1];
  return sameSides(sides) ? [right] : [[sides.left, feet[0], 1], right];
};

/** @param {Drawn} body @param {Server.SideFacts} side @param {number} foot @param {number} sign @param {Viewport} view */
const sideDrawing = (body, side, foot, sign, view) => {
  const [x, y] = [view.x(foot), view.y(groundOf(body))];
  const centre = [view.x(body.centre[0]), view.y(body.centre[1])];
  const rise = y - centre[1];
  const radius = Math.max(18, Math.min(0.55 * rise, 90));
  const outside = { "text-anchor": sign > 0 ? "end" : "start" };
  const beside = x - sign * 12;
  return svg("g", {},
    svg("path", { class: "thin dashed", d: `M${x} ${y}V${centre[1] - 10}` }),
    svg("path", { class: "accent-line", d: `M${x} ${y}L${centre[0]} ${centre[1]}` }),
    arc(x, y, radius, sign * side.slenderness_angle),
    label(beside, y - radius - 8, `\u03b1 = ${degrees(side.slenderness_angle)}`, outside),
    label(beside, y - radius + 12, `R = ${quantity(side.semi_diagonal, "m")}`, outside));
};

/** @param {number[][]} points @param {number[]} masses @param {Viewport} view */
const massDots = (points, masses, view) => {
  const heaviest = highest(masses);
  return points.map(([x, y], k) =>
    svg(
      "circle",
      { class: "region", cx: view.x(x), cy: view.y(y), r: Math.max(2, 9 * Math.sqrt(masses[k] / heaviest)) },
    ));
};

/** @param {number} angle */
const degrees = (angle) => quantity((angle * 180) / Math.PI, "\u00b0");

/** @param {Viewport} view @param {number} width @param {number} height */
const scaleBar = (view, width, height) => {
  const length = roundStep(width / view.scale, 5) / 2;
  const span = length * view.scale;
  const [x, y] = [width - 14 - span, height - 12];
  return svg("g", { class: "scale-bar" },
    svg("path", { class: "thin", d: `M${x} ${y - 4}v4h${span}v-4` }),
    svg("text", { class: "soft", x: x - 6, y: y + 1, "text-anchor": "end" }, quantity(length, "m", 3)));
};

/** @param {Drawn} body */
const inWords = (body) => {
  const { left, right } = body.sides;
  const [x, y] = body.centre;
  const [leftAngle, rightAngle] = [left, right].map((side) => degrees(side.slenderness_angle));
  const feet = listed(body.foot_positions.map((foot) => number(foot)));
  return t("Body to scale: centre of mass at x {x} m, y {y} m, feet at {feet} m, slenderness angle {left} to the left and {right} to the right.",
    { x: number(x), y: number(y), feet, left: leftAngle, right: rightAngle });
};
