/** Synthetic motion: family, seed and index, optionally scaled to a level. */
import { html } from "/parts/preact.js";
import { Button, Choice, NumberField, Segmented } from "/parts/fields.js";
import { t } from "/app/words.js";

const LEVELS = [["", "As generated"], ["pga", "Scaled to PGA"], ["pgv", "Scaled to PGV"]];
/** @type {{ [key in "pga" | "pgv"]: { label: string, unit: string, usual: number } }} */
const LEVEL = {
  pga: { label: "Peak ground acceleration", unit: "m/s2", usual: 3 },
  pgv: { label: "Peak ground velocity", unit: "m/s", usual: 0.5 },
};
const KINDS = /** @type {const} */ (["pga", "pgv"]);

/** The initial motion. */
export const usualSynthetic = () => ({ synthetic: "pulse-like", seed: 0, member: 0 });

/** The editor of a synthetic motion.
 * @param {{ app: App, motion: Server.MotionInput | null, onChange: (motion: Server.MotionInput) => unknown }} props */
export const Synthetic = ({ app, motion, onChange }) => {
  if (!motion) return null;
  const { families } = app.info;
  const family = families.find(({ name }) => name === motion.synthetic);
  const { pga, pgv, ...drawn } = motion;
  const kind = KINDS.find((key) => motion[key] !== undefined) ?? "";
  /** @param {Partial<Server.MotionInput>} changes */
  const change = (changes) => onChange({ ...motion, ...changes });
  /** @param {string} label @param {"seed" | "member"} key @param {string} help */
  const wholeField = (label, key, help) => html`<${NumberField} label=${label} help=${help} min=${0} step=${1} integer
    value=${motion[key] ?? 0} on=${(value) => change({ [key]: value })} />`;
  return html`
    <div class="synthetic-editor">
      <${Choice} label="Family" options=${families.map(({ name }) => [name, name.replaceAll("-", " ")])} value=${motion.synthetic}
        on=${(synthetic) => change({ synthetic })} />
      <p class="field-help">${family && t("{sentence}; {more}", { sentence: family.title, more: family.origin })}</p>
      <div class="fields">${wholeField("Seed", "seed", "The same seed gives the same motions on every computer.")}
        ${wholeField("Realization", "member", "Index of the motion: 0, 1, 2, ...")}</div>
      <${Button} onClick=${() => change({ member: (motion.member ?? 0) + 1 })}>Next realization<//>
      <${Segmented} label="Level" options=${LEVELS} value=${kind}
        on=${(/** @type {"" | "pga" | "pgv"} */ next) => onChange(next ? { ...drawn, [next]: LEVEL[next].usual } : drawn)} />
      ${kind && html`<${NumberField} key=${kind} label=${LEVEL[kind].label} unit=${LEVEL[kind].unit} min=${1e-6} step=${0.1}
        value=${motion[kind]} on=${(level) => change({ [kind]: level })} />`}
    </div>`;
};
