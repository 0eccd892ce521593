/** A pulse: which one, and its parameters. */
import { el, fill } from "/app/dom.js";
import { numberField, slider } from "/app/fields.js";
import { readPulse, writePulse } from "/views/motion-pulse-words.js";
import { pulsesOf } from "/views/motion-pulses.js";
import { sketch } from "/views/motion-sketch.js";
import { plainWords } from "/views/studies-words.js";

const USUAL = "sine";

/** Returns the editor of a pulse. */
export const pulseEditor = (app, onChange) => {
  const pulses = pulsesOf(app.info);
  const kept = new Map();
  const fields = el("div", { class: "pulse-fields", "data-testid": "pulse-parameters" });
  const cards = pulseCards(pulses, (name) => choose(name));
  const element = el("div", { class: "pulse-editor" }, cards.element, fields);
  let shown = { name: "", parameters: {}, controls: {} };

  const parametersOf = (name) => kept.get(name) || borrowed(pulses.get(name), shown.parameters);
  const wordsOf = () => writePulse(shown.name, shown.parameters);
  const choose = (name) => {
    build(name, parametersOf(name));
    onChange({ pulse: wordsOf() });
  };
  const build = (name, parameters) => {
    shown = { name, parameters: { ...parameters }, controls: {} };
    const pulse = pulses.get(name);
    const parts = pulse.parameters.map((one) => {
      const control = parameterControl(one, parameters[one.name] ?? one.usual, (value) => {
        shown.parameters[one.name] = value;
        kept.set(name, { ...shown.parameters });
        onChange({ pulse: wordsOf() });
      });
      shown.controls[one.name] = control;
      return control.element;
    });
    fill(fields, el("p", { class: "field-help" }, aboutOf(pulse)), parts);
    cards.choose(name);
  };
  const show = (motion) => {
    const [name, parameters] = readPulse(motion.pulse);
    if (!pulses.has(name) || motion.pulse === wordsOf()) return;
    if (name !== shown.name) build(name, parameters);
    shown.parameters = { ...parameters };
    for (const [key, control] of Object.entries(shown.controls)) {
      if (parameters[key] !== undefined) control.show(parameters[key]);
    }
  };
  const usual = () => ({ pulse: writePulse(USUAL, parametersOf(USUAL)) });
  return { element, show, usual };
};

const aboutOf = ({ summary }) => {
  const text = summary.replace(/^Return /, "").replaceAll("`", "");
  return plainWords(text.charAt(0).toUpperCase() + text.slice(1));
};

// amplitude and period stay when one goes from pulse to pulse
const borrowed = (pulse, before) =>
  Object.fromEntries(pulse.parameters.filter((one) => one.needed || one.name in before)
    .map((one) => [one.name, before[one.name] ?? one.usual]));

const parameterControl = ({ label, unit, usual, low, high, whole, log }, value, onChange) => {
  const bar = slider({
    label,
    unit,
    min: low,
    max: high,
    step: whole ? 1 : log ? undefined : (high - low) / 200,
    value: Math.min(Math.max(Math.abs(value), low), high),
    log,
    onInput: (given) => {
      exact.value = given;
      onChange(given);
    },
  });
  const exact = numberField({
    label: `${label}, exactly`,
    unit,
    value,
    step: whole ? 1 : undefined,
    onChange: (given) => {
      bar.value = Math.min(Math.max(Math.abs(given ?? usual), low), high);
      onChange(given);
    },
  });
  exact.classList.add("exact");
  const show = (given) => {
    exact.value = given;
    bar.value = Math.min(Math.max(Math.abs(given), low), high);
  };
  return { element: el("div", { class: "parameter" }, bar, exact), show };
};

const pulseCards = (pulses, onChoose) => {
  const items = new Map();
  for (const [name, { title }] of pulses) {
    const input = el("input", { type: "radio", name: "pulse", value: name, onchange: () => onChoose(name) });
    const words = el("span", { class: "pulse-name" }, title);
    items.set(name, [input, el("label", { class: "pulse-card" }, input, sketch(name), words)]);
  }
  const labels = [...items.values()].map(([, label]) => label);
  const element = el("fieldset", { class: "pulse-cards" }, el("legend", {}, "Pulse"), ...labels);
  const choose = (name) => {
    for (const [key, [input]] of items) input.checked = key === name;
  };
  return { element, choose };
};
