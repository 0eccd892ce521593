/** The fields of a form, each with a visible label, a unit and a place for its error. */

import { el, fill, freshId } from "/app/dom.js";
import { faults } from "/app/faults.js";
import { editable, number, parseNumber, pretty, quantity, tidy } from "/app/format.js";

export {
  button, card, iconButton, note, segmented, selectField, switchField, toolbar,
} from "/app/controls.js";

/** A number with its unit; decimal commas and arrow keys work. Has `value`, `fault` and `setError`. */
export const numberField = ({
  label, unit, value, min, above, max, step, onChange, help, optional = false, name,
}) => {
  const id = freshId("number");
  const input = el("input", {
    id,
    type: "text",
    inputmode: "decimal",
    autocomplete: "off",
    spellcheck: "false",
    name,
    value: editable(value),
    "aria-describedby": `${id}-about`,
  });
  const limits = { min, above, max, optional, unit };
  const { field, setError } = frame(id, label, unit, input, help);
  const take = () => {
    const { fault, given } = checked(input.value, limits);
    setError(fault, fault ? "" : decimalWords(input.value, given));
    if (!fault) onChange?.(given);
  };
  input.addEventListener("input", take);
  input.addEventListener("keydown", (event) => {
    const turn = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (!turn) return;
    event.preventDefault();
    const turns = turn * (event.shiftKey ? 10 : 1);
    input.value = editable(stepped(input.value, turns, { min: min ?? above, max, step }));
    take();
  });
  const setValue = (next) => {
    const [typed, given] = [input.value.trim(), next ?? null];
    const same = typed ? parseNumber(typed) === given && given !== null : given === null;
    if (!same) input.value = editable(next);
    setError("", decimalWords(input.value, next));
  };
  withValue(field, input, () => checked(input.value, limits).given, setValue, setError);
  return Object.assign(field, { fault: () => checked(input.value, limits).fault ?? "" });
};

/** A line of text. An element with `value` and `setError`. */
export const textField = ({ label, value, onChange, help, placeholder, maxLength = 200 }) => {
  const id = freshId("text");
  const input = el("input", {
    id, type: "text", autocomplete: "off", placeholder, maxlength: maxLength, value: value ?? "",
    "aria-describedby": `${id}-about`, oninput: () => onChange?.(input.value),
  });
  const { field, setError } = frame(id, label, "", input, help);
  const setValue = (next) => {
    if (input.value !== (next ?? "")) input.value = next ?? "";
  };
  return withValue(field, input, () => input.value, setValue, setError);
};

/** A slider that says its value beside its label; logarithmic on request. An element with `value`. */
export const slider = ({ label, unit, min, max, step, value, log = false, onInput, help }) => {
  const id = freshId("slider");
  const scale = log ? logarithmic(min, max) : linear(min, max, step);
  const shown = el("output", { for: id, class: "slider-value" });
  const input = el("input", {
    id, type: "range", min: scale.low, max: scale.high, step: scale.step, "aria-describedby": `${id}-about`,
  });
  const tell = (given) => {
    const text = unit ? `${number(given)}\u00a0${pretty(unit)}` : number(given);
    fill(shown, text);
    input.setAttribute("aria-valuetext", text);
  };
  const setValue = (given) => {
    input.value = String(scale.from(given));
    tell(given);
  };
  input.addEventListener("input", () => {
    const given = scale.to(Number(input.value));
    tell(given);
    onInput?.(given);
  });
  setValue(value);
  const { field, setError } = frame(id, label, "", input, help, shown);
  field.classList.add("field-slider");
  return withValue(field, input, () => scale.to(Number(input.value)), setValue, setError);
};

const frame = (id, label, unit, input, help, beside) => {
  const about = el("p", { id: `${id}-about`, class: "field-help" }, help);
  const caption = el(
    "label", { for: id }, label, unit ? el("span", { class: "unit" }, ` ${pretty(unit)}`) : null,
  );
  const setError = (text, hint = "") => {
    faults.mark(input, label, text);
    if (text) input.setAttribute("aria-invalid", "true");
    else input.removeAttribute("aria-invalid");
    about.classList.toggle("field-error", Boolean(text));
    fill(about, text || hint || help || "");
  };
  const field = el(
    "div", { class: "field" }, el("div", { class: "field-head" }, caption, beside), input, about,
  );
  return { field, setError };
};

const withValue = (field, input, get, set, setError) => {
  Object.defineProperty(field, "value", { get, set, configurable: true });
  return Object.assign(field, { input, setValue: set, setError });
};

const checked = (text, { min, above, max, optional, unit = "" }) => {
  if (!text.trim()) return optional ? { given: null } : { fault: "A number is needed here.", given: null };
  const given = parseNumber(text);
  if (given === null) return { fault: "This is not a number.", given: null };
  const wrong = [
    [above !== undefined && given <= above, "More than", above],
    [min !== undefined && min !== null && given < min, "At least", min],
    [max !== undefined && max !== null && given > max, "At most", max],
  ].find(([fails]) => fails);
  return wrong ? { fault: `${wrong[1]} ${quantity(wrong[2], unit)}.`, given } : { given };
};

// "1,000" is one to us and a thousand to others: say how it was read.
const decimalWords = (text, given) =>
  /^\s*[+-]?\d{1,3},\d{3}\s*$/.test(text)
    ? `Read as ${number(given)}: the comma is the decimal sign. For thousands leave it out.` : "";

const stepped = (text, turns, { min, max, step }) => {
  const value = parseNumber(text) ?? min ?? 0;
  const by = step ?? 10 ** Math.floor(Math.log10(Math.abs(value) || 1) - 1);
  return tidy(Math.min(max ?? Infinity, Math.max(min ?? -Infinity, value + turns * by)));
};

const linear = (low, high, step = "any") => ({ low, high, step, from: (value) => value, to: tidy });

const logarithmic = (min, max) => ({
  low: 0,
  high: 1000,
  step: 1,
  from: (value) => (1000 * Math.log(value / min)) / Math.log(max / min),
  to: (place) => tidy(min * (max / min) ** (place / 1000), 4),
});
