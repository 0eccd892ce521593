/** Names, colours and dashes of the restitution models from the server, and styles of other curves. */

import { svg } from "/app/dom.js";
import { t } from "/app/words.js";

/** @type {Map<string, Server.ModelFacts>} */
const models = new Map();

/** Register the models of the server, once before the first drawing. @param {Server.ModelFacts[]} facts */
export const learnModels = (facts) => {
  models.clear();
  for (const model of facts) models.set(model.name, model);
};

/** @type {Look[]} */
const SPARE = [
  { colour: "#69994D", dash: [3, 2, 8, 2] },
  { colour: "#8C6900", dash: [12, 3] },
  { colour: "#7F5CB9", dash: [5, 3, 1, 3] },
];

/** @type {Map<string, Look>} */
const spares = new Map();

/** Colour and dash of a restitution model's label, such as "ked" or "0.98*shifted-impulse:k=0.6".
 * @param {string | number} label @returns {Look} */
export const modelStyle = (label) => {
  const model = models.get(family(label));
  return model?.colour ? model : spare(String(label));
};

/** Title of the model, with its parameter if it has one. @param {string | number} label */
export const modelWords = (label) => {
  const text = String(label);
  const name = models.get(family(text))?.short_name;
  const parameters = text.includes(":") ? text.split(":")[1].replaceAll(",", ", ") : "";
  const parameter = parameters ? `, ${parameters.replaceAll("=", "\u00a0=\u00a0")}` : "";
  const factor = text.includes("*") ? `${text.split("*")[0]}\u00a0\u00d7\u00a0` : "";
  return name ? `${factor}${t(name)}${parameter}` : text;
};

/** Legend symbol: a short line with color and dash, or dots for a dotted curve.
 * @param {{ colour: string, dash?: number[], dots?: boolean }} given */
export const dashKey = ({ colour, dash = [], dots = false }) => {
  const stroke = colour.startsWith("--") ? `var(${colour})` : colour;
  const mark = dots
    ? [5, 17, 29].map((cx) => svg("circle", { cx, cy: 5, r: 2.5, fill: stroke }))
    : svg("path", {
      d: "M0 5H34", fill: "none", stroke, "stroke-width": 2.5, "stroke-dasharray": dash.join(" ") || null,
    });
  return svg("svg", {
    class: "dash-key", width: 34, height: 10, viewBox: "0 0 34 10", "aria-hidden": "true", focusable: "false",
  }, mark);
};

const ANGLES = ["#7F5CB9", "#69994D", "#8C6900", "#C6317C", "#237F8C", "#796E5B"];
const DASHES = [[], [9, 3], [3, 3], [9, 3, 3, 3], [6, 2], [2, 2, 6, 2]];

/** Style of the curve of an angle: the style of its model, or a colour that no model uses.
 * @param {string} model @param {number} index @param {{ angles: number, models: number }} given2 */
export const angleStyle = (model, index, { angles, models }) => {
  const own = modelStyle(model);
  if (angles < 2) return own;
  const at = index % ANGLES.length;
  return { colour: ANGLES[at], dash: models < 2 ? DASHES[at] : own.dash };
};

/** Colour of the n-th curve without a restitution model. @param {number} index @returns {Look} */
export const seriesStyle = (index) => {
  const looks = [...models.values()].filter(({ colour }) => colour);
  return looks[index % looks.length];
};

/** Markers and titles of the groups of published measurements. */
/** @type {{ [group: string]: { marker: string, label: string } | undefined }} */
export const GROUPS = {
  table1: { marker: "square", label: "literature (Table 1)" },
  S: { marker: "down", label: "specimens S" },
  M: { marker: "circle", label: "specimens M" },
  L: { marker: "up", label: "specimens L" },
};

/** @param {string | number} label */
const family = (label) => String(label).replace(/^.*\*/s, "").split(":")[0].trim();

/** @param {string} label */
const spare = (label) => {
  if (!spares.has(label)) spares.set(label, SPARE[spares.size % SPARE.length]);
  return /** @type {Look} */ (spares.get(label));
};
