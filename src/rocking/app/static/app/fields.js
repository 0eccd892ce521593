/** The fields of a form, each with a visible label, a unit and a place for its error. */

import { el, fill, freshId } from "/app/dom.js";
import { editable, number, parseNumber, pretty, tidy } from "/app/format.js";

export {
  button, card, iconButton, note, segmented, selectField, switchField, toolbar,
} from "/app/controls.js";
export { tableOf } from "/app/table.js";

/** A number with its unit; decimal commas and arrow keys work. An element with `value` and `setError`. */
export const numberField = ({
  label, unit, value, min, max, step, onChange, help, optional = false, name,
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
  const { field, setError } = frame(id, label, unit, input, help);
  const take = () => {
    const { fault, given } = checked(input.value, { min, max, optional, unit });
    setError(fault);
    if (!fault) onChange?.(given);
  };
  input.addEventListener("input", take);
  input.addEventListener("keydown", (event) => {
    const turn = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (!turn) return;
    event.preventDefault();
    input.value = editable(stepped(input.value, turn * (event.shiftKey ? 10 : 1), { min, max, step }));
    take();
  });
  const setValue = (next) => {
    if (parseNumber(input.value) !== (next ?? null)) input.value = editable(next);
    setError("");
  };
  return withValue(
    field, input, () => checked(input.value, { min, max, optional }).given, setValue, setError,
  );
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
  const setError = (text) => {
    if (text) input.setAttribute("aria-invalid", "true");
    else input.removeAttribute("aria-invalid");
    about.classList.toggle("field-error", Boolean(text));
    fill(about, text || help || "");
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

const checked = (text, { min, max, optional, unit = "" }) => {
  if (!text.trim()) return optional ? { given: null } : { fault: "A number is needed here.", given: null };
  const given = parseNumber(text);
  if (given === null) return { fault: "This is not a number.", given: null };
  if (min !== undefined && min !== null && given < min) return {
    fault: `At least ${number(min)} ${unit}.`, given,
  };
  if (max !== undefined && max !== null && given > max) return {
    fault: `At most ${number(max)} ${unit}.`, given,
  };
  return { given };
};

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
