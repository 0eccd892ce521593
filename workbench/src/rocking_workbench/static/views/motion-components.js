/** Which components of a record are horizontal and vertical. */
import { html } from "/parts/preact.js";
import { Choice } from "/parts/fields.js";

/** Fields of the components; each excludes the choice of the other.
 * @param {{ names: string[], motion: Server.MotionInput, onChange: (motion: Server.MotionInput) => unknown }} props */
export const Components = ({ names, motion, onChange }) => {
  if (names.length < 2) return null;
  const main = motion.component ?? names.find((name) => name !== motion.vertical);
  // a link may state one component twice; then both lists are complete, so that the user can change each choice
  const clash = motion.vertical === main;
  /** @param {string | null} [taken] */
  const optionsBut = (taken) => names.filter((name) => clash || name !== taken).map((name) => [name, name]);
  const { vertical = "", ...level } = motion;
  return html`
    <${Choice} label="Horizontal component" options=${optionsBut(vertical)} value=${main}
      on=${(component) => onChange({ ...motion, component })} />
    <${Choice} label="Vertical component" options=${[["", "none"], ...optionsBut(main)]} value=${vertical}
      on=${(name) => onChange(name ? { ...motion, vertical: name } : level)} />`;
};
