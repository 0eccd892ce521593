/** A pulse: its type and its parameters. */
import { html, useMemo } from "/parts/preact.js";
import { NumberField, Slider } from "/parts/fields.js";
import { readPulse, writePulse } from "/views/motion-pulse-words.js";
import { pulsesOf } from "/views/motion-pulses.js";
import { Sketch } from "/views/motion-sketch.js";
import { plainWords } from "/views/studies-words.js";
import { t } from "/app/words.js";

const USUAL = "sine";
const kept = new Map(); // edited parameters of each pulse

/** Discard the edited values. */
export const forgetPulses = () => kept.clear();

/** Editor of a pulse; `blamed`: the refused parameter, with the reason.
 * @param {{ app: App, motion: Server.MotionInput | null, blamed?: any, onChange: (motion: Server.MotionInput) => unknown }} props */
export const Pulse = ({ app, motion, blamed, onChange }) => {
  const pulses = useMemo(() => pulsesOf(app.info), []);
  const [name, parameters] = readPulse(motion?.pulse ?? "");
  const shown = pulses.get(name);
  /** @param {string} next */
  const choose = (next) => onChange({ pulse: writePulse(next, kept.get(next) ?? borrowed(pulses.get(next), parameters)) });
  /** @param {string} key @param {number} value */
  const turn = (key, value) => {
    kept.set(name, { ...parameters, [key]: value });
    onChange({ pulse: writePulse(name, kept.get(name)) });
  };
  return html`
    <div class="pulse-editor">
      <fieldset class="pulse-cards"><legend>Pulse</legend>${[...pulses].map(([key, { title }]) => html`
        <label key=${key} class="pulse-card">
          <input type="radio" name="pulse" value=${key} checked=${key === name} onChange=${() => choose(key)} />
          <${Sketch} name=${key} /><span class="pulse-name">${title}</span></label>`)}
      </fieldset>
      <div class="pulse-fields" data-testid="pulse-parameters">
        ${shown && html`<p class="field-help">${aboutOf(shown)}</p>
          ${shown.parameters.map((parameter) => html`<${Parameter} key=${`${name} ${parameter.name}`} ...${parameter}
            value=${parameters[parameter.name] ?? parameter.usual} error=${blamed?.key === parameter.name && blamed.text} on=${(value) => turn(parameter.name, value)} />`)}`}
      </div>
    </div>`;
};

/** The initial pulse. @param {App} app */
export const usualPulse = ({ info }) => ({ pulse: writePulse(USUAL, kept.get(USUAL) ?? borrowed(pulsesOf(info).get(USUAL), {})) });

/** @param {{ summary: string }} pulse */
const aboutOf = ({ summary }) => {
  const text = summary.replace(/^Return /, "").replaceAll("`", "");
  return plainWords(text.charAt(0).toUpperCase() + text.slice(1));
};

// amplitude and period remain after a change of the pulse
/** @param {ReturnType<ReturnType<typeof pulsesOf>["get"]>} pulse @param {{ [key: string]: number }} before */
const borrowed = (pulse, before) => Object.fromEntries((pulse?.parameters ?? [])
  .filter(({ needed, name }) => needed || name in before).map(({ name, usual }) => [name, before[name] ?? usual]));

/** @param {any} props */
const Parameter = ({ label, unit, low, high, integer, log, limits, value, error, on }) => html`
  <div class="parameter">
    <${Slider} label=${label} unit=${unit} min=${low} max=${high} step=${integer ? 1 : (high - low) / 200} log=${log}
      value=${Math.min(Math.max(Math.abs(value), low), high)} on=${on} />
    <${NumberField} kind="exact" label=${t("{name}, exactly", { name: label })} unit=${unit} step=${integer ? 1 : undefined} ...${limits} value=${value}
      error=${error} on=${on} />
  </div>`;
