/** Form for the missing data of a record file. */
import { html, useLayoutEffect, useRef, useSignal } from "/parts/preact.js";
import { keyOf } from "/app/refusal.js";
import { Button, Choice, NumberField, toWrong, wrongIn } from "/parts/fields.js";

/** @type {Words} */
const LABELS = {
  units: "Unit of the accelerations",
  time_step: "Time between two samples",
  component: "Horizontal component",
  format: "Format of the file",
};
/** @type {Words} */
const HELP = {
  units: "The file states no unit. A wrong unit scales the motion by a factor of up to 981.",
  time_step: "The file states no time step.",
};

/** @type {Words} */
const MISSING = {
  units: "Choose the unit.",
  time_step: "Enter a number.",
  component: "Choose the horizontal component.",
  format: "Choose the format.",
};

/** @param {Need} name @param {LeftOpen} answer @param {Server.Info} info */
const choicesOf = (name, { choices = {}, components = [] }, info) => {
  if (choices[name]) return choices[name];
  if (name === "units") return info.units.acceleration;
  return (name === "format" ? info.formats : components).map((option) => option.name);
};

/** Missing data named by an error of the server, with its sentence; otherwise null.
 * @param {Need[]} needs @param {any} refusal @param {string} text */
export const blamedOf = (needs, refusal, text) => {
  const name = needs.find((need) => need === (refusal.parameter && keyOf(refusal)));
  return name ? { name, text } : null;
};

/** Fields for the `needs` of `answer`; `take` receives the values once all are valid.
 * @param {{ answer: LeftOpen, info: Server.Info, initial: Told, blamed?: ReturnType<typeof blamedOf>, take: (values: Told) => unknown, button?: object, [more: string]: any }} props */
export const Needs = ({ answer, info, initial, blamed, take, button, ...more }) => {
  const form = useRef(null);
  const [answers, wrong, pressed] = [useSignal(initial), useSignal({}), useSignal(0)];
  /** @type {[Need, string[]][]} */
  const fields = answer.needs.map((name) => [name, choicesOf(name, answer, info)]);
  useLayoutEffect(() => {
    wrong.value = blamed ? { [blamed.name]: blamed.text } : {};
    if (blamed) toWrong(form.current);
  }, [blamed]);
  useLayoutEffect(() => {
    if (!pressed.value) return;
    const first = wrongIn(form.current);
    if (first) first.focus();
    else take(answers.value);
  }, [pressed.value]);
  const press = () => {
    const open = fields.filter(([name, choices]) => (name === "time_step" || choices.length) && !answers.value[name]);
    wrong.value = Object.fromEntries(open.map(([name]) => [name, MISSING[name] ?? "Choose an option."]));
    pressed.value += 1;
  };
  /** @param {any} event */
  const entered = (event) => {
    if (event.key !== "Enter" || !event.target.matches("input")) return;
    event.preventDefault();
    press();
  };
  /** @param {typeof fields[number]} need */
  const field = ([name, choices]) => {
    const about = {
      label: LABELS[name] || name, help: HELP[name], error: wrong.value[name], value: answers.value[name],
      /** @param {number} value */
      on: (value) => {
        answers.value = { ...answers.value, [name]: value || undefined };
        wrong.value = { ...wrong.value, [name]: "" };
      },
    };
    return name === "time_step" ? html`<${NumberField} key=${name} ...${about} unit="s" min=${1e-6} max=${10} step=${0.005} />`
      : html`<${Choice} key=${name} ...${about} options=${[["", "Choose"], ...choices.map((/** @type {string} */ value) => [value, value])]} />`;
  };
  return html`<div ref=${form} onKeyDown=${entered} ...${more}>${fields.map(field)}
    <${Button} onClick=${press} ...${button}>Apply<//></div>`;
};
