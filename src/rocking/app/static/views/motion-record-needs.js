/** What a record file does not say, asked in a small form. */
import { numberField, selectField } from "/app/fields.js";

const LABELS = {
  units: "Unit of the accelerations",
  time_step: "Time between two samples",
  component: "Horizontal component",
  format: "Format of the file",
};
const HELP = {
  units: "The file does not name it; a wrong one makes the motion up to 981 times too strong or too weak.",
  time_step: "The file does not name it.",
};

const nameOf = (one) => one.name || one;

const choicesOf = (one, answer, info) => {
  const name = nameOf(one);
  const own = one.choices || answer.choices?.[name];
  if (own) return own.map((choice) => choice.name ?? choice);
  if (name === "units") return namesOf(info.units?.acceleration ?? info.acceleration_units ?? info.units);
  if (name === "format") return namesOf(info.formats);
  return (answer.components || []).map((component) => component.name);
};

const namesOf = (given) =>
  Array.isArray(given) ? given.map((one) => one.name ?? one.label ?? one) : Object.keys(given || {});

/** Returns the questions to ask: [{name, field}]. */
export const questionsOf = (answer, info, given) =>
  answer.needs.map((one) => {
    const name = nameOf(one);
    const label = LABELS[name] || name;
    const help = one.message || HELP[name];
    if (name === "time_step") {
      const limits = { min: 1e-6, max: 10, step: 0.005 };
      return { name, field: numberField({ label, unit: "s", value: given.time_step, ...limits, help }) };
    }
    const choices = choicesOf(one, answer, info);
    const options = [{ value: "", text: "Choose" }, ...choices.map((value) => ({ value, text: value }))];
    return { name, field: selectField({ label, options, value: given[name] ?? "", help }) };
  });

/** Returns what was answered, without what was left open. */
export const answersOf = (questions) => {
  const pairs = questions.map(({ name, field }) => [name, field.value]);
  return Object.fromEntries(pairs.filter(([, value]) => value !== "" && value !== null && value !== undefined));
};
