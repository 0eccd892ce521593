/** One instant of the scene as an SVG: the ground, the bodies of all models, and a legend. */

import { fixed } from "/app/format.js";
import { svg } from "/app/dom.js";
import { legendOf, under } from "/charts/curves.js";
import { SvgPen } from "/charts/pen.js";
import { readColours } from "/scene/theme.js";
import { t } from "/app/words.js";

/** The shown instant of a stage; `names`: titles of the models.
 * @param {import("/scene/stage.js").Stage} stage @param {number} now @param {string[]} names */
export const sceneStill = (stage, now, names) => {
  const play = /** @type {Play} */ (stage.play);
  const camera = { ...stage.camera, ratio: 1 };
  const pen = new SvgPen();
  stage.paint(/** @type {any} */ (pen), camera, readColours(stage.canvas), play, now);
  const legend = legendOf(play.actors.map(({ colour, dash }, k) => ({ label: names[k], colour, dash })), camera.width);
  const drawing = svg("svg", { width: camera.width, height: camera.height }, pen.node);
  return { node: under(legend, camera.width, camera.height, drawing), title: t("The body at {time} s", { time: fixed(now, 3) }), alt: play.description };
};
