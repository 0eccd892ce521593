/** How strong: a factor on the motion, by slider and by number. */
import { el } from "/app/dom.js";
import { numberField, slider } from "/app/fields.js";

const LEAST = 0.1;
const MOST = 10;

/** Returns a slider and a number that say the same factor. */
export const scaleEditor = (onChange) => {
  const bar = slider({
    label: "Scale of the motion",
    unit: "",
    min: LEAST,
    max: MOST,
    value: 1,
    log: true,
    onInput: (value) => {
      exact.value = value;
      onChange(value);
    },
  });
  const exact = numberField({
    label: "Factor",
    value: 1,
    min: -1000,
    max: 1000,
    step: 0.05,
    help: "A negative factor turns the motion round.",
    onChange: (value) => {
      if (value === 0) return exact.setError("Not 0: nothing would move.");
      bar.value = within(Math.abs(value));
      return onChange(value);
    },
  });
  const element = el("div", { class: "motion-scale" }, bar, exact);
  const show = (value) => {
    exact.value = value;
    if (bar.value !== value) bar.value = within(Math.abs(value));
  };
  return { element, show };
};

const within = (value) => Math.min(Math.max(value, LEAST), MOST);
