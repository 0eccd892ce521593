/** Colours of the scene, from the custom properties of the page. */

const NAMES = ["ink", "soft", "line", "body", "ground", "hatch", "impact", "fall"];

/** Reads the colours into an object of the drawing.
 * @param {Element} element @param {any} [into] */
export const readColours = (element, into = {}) => {
  const style = getComputedStyle(element);
  for (const name of NAMES) into[name] = style.getPropertyValue(`--scene-${name}`).trim() || "#808080";
  return into;
};

const reduced = window.matchMedia("(prefers-reduced-motion: reduce)");

/** True if the user prefers reduced motion. */
export const calm = () => reduced.matches;
