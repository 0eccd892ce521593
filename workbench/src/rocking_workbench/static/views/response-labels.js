/** Names and marks of the restitutions; all typed coefficients have one style. */
import { html } from "/parts/preact.js";
import { modelStyle, modelWords } from "/app/palette.js";

const TYPED = "fixed";

/** Returns the key under which a restitution keeps its curve: its label, or one key for typed numbers.
 * @param {string} label */
export const curveKey = (label) => (/^([0-9.]+(e-?[0-9]+)?$|left )/.test(label) ? TYPED : label);

/** Returns colour and dash of a restitution. @param {string} label @returns {{ colour: string, dash: number[] }} */
export const styleOf = (label) => {
  const { colour, dash = [] } = modelStyle(curveKey(label));
  return { colour, dash };
};

/** Returns the title of a restitution. @param {string} label */
export const wordsOf = (label) => modelWords(curveKey(label));

/** A short line in the colour and dash of a restitution. @param {{ label: string }} props */
export const Swatch = ({ label }) => {
  const { colour, dash } = styleOf(label);
  return html`<svg class="dash-key" width="34" height="10" viewBox="0 0 34 10" aria-hidden="true" focusable="false">
    <path d="M0 5H34" fill="none" stroke=${colour} stroke-width="2.5" stroke-dasharray=${dash.join(" ") || null} /></svg>`;
};
