/** What a record file does not say, asked in a small form. */
import { html, useLayoutEffect, useRef, useSignal } from "/parts/preact.js";
import { Button, Choice, NumberField, toWrong, wrongIn } from "/parts/fields.js";

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
  time_step: "A number is needed here.",
  component: "Choose the horizontal component.",
  format: "Choose the format.",
};

/** Words by which a refusal names what was answered wrongly. */
const SIGNS = {
  time_step: /time step|time between two samples/i, units: /\bunits?\b/i,
  component: /component/i, format: /format/i,
};

/** The name of a need. */
export const nameOf = (one) => one.name || one;

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

/** What of some needs a refusal of the server is about: {name, words}; null if about none of them. */
export const blamedOf = (needs, words) => {
  const name = needs.map(nameOf).find((one) => SIGNS[one]?.test(words));
  return name ? { name, words } : null;
};

/** Fields for what `answer` needs; `take` gets what was answered once nothing is missing or wrong. */
export const Needs = ({ answer, info, given, blamed, take, button, ...more }) => {
  const place = useRef(null);
  const [answers, wrong, pressed] = [useSignal(given), useSignal({}), useSignal(0)];
  const fields = answer.needs.map((one) => [one, nameOf(one), choicesOf(one, answer, info)]);
  useLayoutEffect(() => {
    wrong.value = blamed ? { [blamed.name]: blamed.words } : {};
    if (blamed) toWrong(place.current);
  }, [blamed]);
  useLayoutEffect(() => {
    if (!pressed.value) return;
    const first = wrongIn(place.current);
    if (first) first.focus();
    else take(answers.value);
  }, [pressed.value]);
  const press = () => {
    const open = fields.filter(([, name, choices]) => (name === "time_step" || choices.length) && !answers.value[name]);
    wrong.value = Object.fromEntries(open.map(([, name]) => [name, MISSING[name] ?? "Choose one."]));
    pressed.value += 1;
  };
  const entered = (event) => {
    if (event.key !== "Enter" || !event.target.matches("input")) return;
    event.preventDefault();
    press();
  };
  const field = ([one, name, choices]) => {
    const about = {
      label: LABELS[name] || name, help: one.message || HELP[name], error: wrong.value[name], value: answers.value[name],
      on: (value) => {
        answers.value = { ...answers.value, [name]: value || undefined };
        wrong.value = { ...wrong.value, [name]: "" };
      },
    };
    return name === "time_step" ? html`<${NumberField} key=${name} ...${about} unit="s" min=${1e-6} max=${10} step=${0.005} />`
      : html`<${Choice} key=${name} ...${about} options=${[["", "Choose"], ...choices.map((value) => [value, value])]} />`;
  };
  return html`<div ref=${place} onKeyDown=${entered} ...${more}>${fields.map(field)}
    <${Button} onClick=${press} ...${button}>Read it so<//></div>`;
};
