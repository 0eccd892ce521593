/** Parts of the forms of studies: a range of numbers, and the motions of the inputs as tables of a job. */
import { el } from "/app/dom.js";
import { numberField } from "/app/fields.js";

/** Three fields: from, to, number; `range()` gives them as a job file writes them. */
export const rangeFields = ({ name, unit, from, to, count, log = false }) => {
  const value = { from, to, count };
  const field = (key, label, more) =>
    numberField({ label, value: value[key], onChange: (given) => (value[key] = given), ...more });
  const node = el(
    "fieldset",
    { class: "range-fields" },
    el("legend", {}, name),
    field("from", "from", { unit }),
    field("to", "to", { unit }),
    field("count", "number", { min: 1, max: 400, step: 1 }),
  );
  const range = () => {
    const ends = { from: value.from, to: value.to, count: Math.round(value.count) };
    return log ? { ...ends, spacing: "log" } : ends;
  };
  return { node, range };
};

/** Motions of a job from the motion of the inputs. */
export const motionsOf = (inputs) => {
  const motion = inputs.motion;
  if (!motion) throw new Error("A study needs a motion: choose one in the step Motion.");
  const { pulse, record, synthetic, scale, file_name: _name, member = 0, seed = 0, ...told } = motion;
  const factor = scale == null || scale === 1 ? {} : { scale };
  if (pulse) return [{ pulse: [pulse], ...factor }];
  if (record) return [{ records: [record], ...told, ...factor }];
  if (member !== 0 || factor.scale) {
    throw new Error(
      "A study takes a synthetic motion as its family makes it: set its member to 0 and its scale to 1.",
    );
  }
  return [{ synthetic, seed, count: 1, ...told }];
};
