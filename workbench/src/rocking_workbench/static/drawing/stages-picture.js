/** The three stages of KED: the same body with the velocities that each stage leaves. */

import { el, svg } from "/app/dom.js";
import { percent } from "/app/format.js";
import { groundOf } from "/drawing/body-picture.js";
import { pointsOf, regionPaths } from "/drawing/outline.js";
import { arrow, footMark, groundLine } from "/drawing/symbols.js";
import { boxOf, viewport } from "/drawing/viewport.js";
import { t } from "/app/words.js";

/** @typedef {{ name: string, fraction: number, velocities: Point[] }} StageField */

/** @type {{ [stage: string]: [string, string] | undefined }} */
export const STAGE_WORDS = {
  before: ["Before", "rotation about the old foot"],
  "stage 1": ["Stage 1", "vertical velocity lost"],
  "stage 2": ["Stage 2", "velocity towards the new foot lost"],
  after: ["After", "rotation about the new foot"],
};

/** Draw panels for {points, stages: [{name, fraction, velocities}]}, all with one scale of arrows.
 * @param {Drawn} body @param {{ points: Point[], stages: StageField[] }} field @param {string} foot @param {{ width: number }} size */
export const stagesPicture = (body, field, foot, { width }) => {
  const columns = width < 520 ? 2 : 4;
  const panel = Math.floor((width - (columns - 1) * 12) / columns) - 18;
  const fastest = Math.max(
    ...field.stages.flatMap((stage) => stage.velocities.map(([vx, vy]) => Math.hypot(vx, vy)))
  );
  const reach = 0.16 * Math.min(panel, 300);
  return el("div", { class: `stages columns-${columns}`, "data-testid": "stages-picture" },
    field.stages.map(
      (stage) => onePanel(body, field.points, stage, foot, { width: panel, pixels: reach / (fastest || 1) })
    ));
};

/** @param {Drawn} body @param {Point[]} points @param {StageField} stage @param {string} foot @param {{ width: number, pixels: number }} size */
const onePanel = (body, points, { name, fraction, velocities }, foot, { width, pixels }) => {
  const height = Math.min(320, Math.max(220, width * 1.3));
  const view = viewport(boxOf(
    [...pointsOf(body.outline), ...(body.points ?? []), ...body.foot_positions.map((foot) => [foot, groundOf(body)])]
  ), {
    width, height, margin: { left: 26, right: 26, top: 26, bottom: 26 },
  });
  const floor = view.y(groundOf(body));
  const [title, description] = STAGE_WORDS[name] ?? [name, ""];
  const lands = foot === "right" ? 1 : 0;
  const foothold = body.foot_positions[name === "before" ? 1 - lands : lands];
  return el("figure", { class: "stage" },
    svg("svg", {
      class: "picture", viewBox: `0 0 ${width} ${height}`, width, height, role: "img",
      "aria-label": t("{stage}: {description}. {share} of the kinetic energy remains.", { stage: title, description, share: percent(fraction) }),
    },
      groundLine(4, width - 4, floor),
      regionPaths(body.outline, view, { class: "region faint" }),
      footMark(view.x(foothold), floor),
      svg("g", { class: `stage-arrows ${name.replace(" ", "-")}` }, points.map(([x, y], index) =>
        arrow(view.x(x), view.y(y), velocities[index][0] * pixels, -velocities[index][1] * pixels)))),
    el(
      "figcaption", {}, el("strong", {}, title), el("span", {}, description),
      el("span", { class: "share" }, percent(fraction)),
    ));
};
