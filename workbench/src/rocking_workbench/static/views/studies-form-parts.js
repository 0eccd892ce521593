/** Parts of the forms of studies: a range of numbers, and the motions of the inputs as tables of a job. */
import { html } from "/parts/preact.js";
import { NumberField } from "/parts/fields.js";

/** Three fields: from, to, number, which write into `range`; another range needs another key.
 * @param {{ name: string, unit?: string, range: any }} props */
export const Range = ({ name, unit = "", range }) => {
  /** @param {string} key @param {string} label @param {object} more */
  const field = (key, label, more) => html`<${NumberField} label=${label} value=${range[key]}
    on=${(number) => (range[key] = number)} ...${more} />`;
  return html`<fieldset class="range-fields"><legend>${name}</legend>
    ${field("from", "from", { unit })}${field("to", "to", { unit })}${field("count", "number", { min: 1, step: 1 })}
  </fieldset>`;
};

/** A range in the notation of a job file. @param {{ from: number, to: number, count: number, [more: string]: unknown }} range */
export const rangeOf = ({ from, to, count, ...more }) => ({ from, to, count: Math.round(count), ...more });

/** Default range of an axis or of a measure; the fields of the range change it. @param {App} app @param {string} name @param {number} count */
export const usualRange = ({ info }, name, count) => {
  const [from, to] = info.axes.find((axis) => axis.name === name)?.usual ?? [1, 12];
  return { from, to, count };
};

/** Limits of a numeric field from the description of its key. @param {Server.KeyFacts} facts */
export const limitsOf = ({ ge, gt, le }) => ({ min: ge ?? undefined, above: gt ?? undefined, max: le ?? undefined });

/** Unit of a label; empty if there is no unit. @param {{ unit: string }} [axis] */
export const unitOf = ({ unit } = { unit: "" }) => (unit === "1" ? "" : unit);

/** Motions of a job from the motion of the inputs. @param {Server.Inputs} inputs */
export const motionsOf = (inputs) => {
  const motion = inputs.motion;
  if (!motion) throw new Error("A study needs a motion. Choose a motion in the step Motion.");
  const { pulse, record, synthetic, scale, file_name: _name, member = 0, seed = 0, ...options } = motion;
  const factor = scale == null || scale === 1 ? {} : { scale };
  if (pulse) return [{ pulse: [pulse], ...factor }];
  if (record) return [{ records: [record], ...options, ...factor }];
  if (member !== 0 || factor.scale) {
    throw new Error(
      "A study needs an unscaled synthetic motion. Set its realization to 0 and its scale to 1.",
    );
  }
  return [{ synthetic, seed, count: 1, ...options }];
};
