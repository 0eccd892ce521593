/** Descriptions of figures, below the title in their files. */

import { quantity } from "/app/format.js";
import { plainWords } from "/views/studies-words.js";

/** Name of the body, otherwise its size, and the motion, for elements around figures.
 * @param {{ name?: string | null, sides?: Server.Sides }} body @param {any} [motion] @param {string[]} [more] */
export const aboutOf = ({ name, sides }, motion = null, more = []) => {
  const size = name || !sides ? [] : [`h/b = ${quantity(sides.right.slenderness_ratio, "")}, R = ${quantity(sides.right.semi_diagonal, "m")}`];
  const factor = motion && motion.scale !== undefined && motion.scale !== 1 ? `${quantity(motion.scale, "")} \u00d7 ` : "";
  const moved = motion ? [factor + plainWords(motion.name)] : [];
  return { "data-own": name ?? "", "data-about": [...size, ...moved, ...more].join("\n") };
};
