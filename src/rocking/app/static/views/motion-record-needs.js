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

const MISSING = {
  units: "Choose the unit.",
  component: "Choose the horizontal component.",
  format: "Choose the format.",
};

/** Words by which a refusal names what was answered wrongly. */
const SIGNS = {
  time_step: /time step|time between two samples/i, units: /\bunits?\b/i,
  component: /component/i, format: /format/i,
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

/** Returns the questions to ask: [{name, field, wrong}]; `wrong()` says what an answer lacks. */
export const questionsOf = (answer, info, given) =>
  answer.needs.map((one) => {
    const name = nameOf(one);
    const label = LABELS[name] || name;
    const about = { label, value: given[name] ?? "", help: one.message || HELP[name] };
    if (name === "time_step") return stepQuestion(about);
    return choiceQuestion(name, about, choicesOf(one, answer, info));
  });

const stepQuestion = (about) => {
  const limits = { min: 1e-6, max: 10, step: 0.005 };
  const field = numberField({ ...about, value: about.value || null, unit: "s", ...limits });
  return { name: "time_step", field, wrong: () => field.fault() };
};

const choiceQuestion = (name, about, choices) => {
  const options = [{ value: "", text: "Choose" }, ...choices.map((value) => ({ value, text: value }))];
  const field = selectField({ ...about, options, onChange: () => field.setError("") });
  const open = () => choices.length > 0 && field.value === "";
  return { name, field, wrong: () => (open() ? MISSING[name] ?? "Choose one." : "") };
};

/** Whether every question has an answer; if not, says beside each field what is missing. */
export const allAnswered = (questions) => {
  for (const { field, wrong } of questions) if (wrong()) field.setError(wrong());
  const first = questions.find(({ wrong }) => wrong());
  first?.field.input.focus();
  return !first;
};

/** Says a refusal of the server beside the field it is about; false if it is about none of them. */
export const blamed = (questions, message) => {
  const found = questions.find(({ name }) => SIGNS[name]?.test(message));
  found?.field.setError(message);
  found?.field.input.focus();
  return Boolean(found);
};

/** Returns what was answered, without what was left open. */
export const answersOf = (questions) => {
  const pairs = questions.map(({ name, field }) => [name, field.value]);
  return Object.fromEntries(pairs.filter(([, value]) => value !== "" && (value ?? null) !== null));
};
