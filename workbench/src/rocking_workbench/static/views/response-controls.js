/** Parameters with immediate results: scale factor, size, initial rotation, friction, models. */
import { html, useRef, useSignal } from "/parts/preact.js";
import { Card, Choice, NumberField, Slider, Switch } from "/parts/fields.js";
import { motionBefore, rememberMotion } from "/views/motion-before.js";
import { look } from "/views/response-chosen.js";
import { Swatch, wordsOf } from "/views/response-labels.js";
import { readRestitution, writeRestitution } from "/views/response-restitution.js";
import { canBeScaled, scaledBody } from "/views/response-size.js";

const [LEAN, USUAL] = [0.5, 0.9];
const CALIBRATED = "The calibrated model is fitted to published measurements. The page Impact shows its interval.";

/** Start from an initial rotation, without ground motion. @param {App} app */
export const lean = (app) => {
  rememberMotion(app, app.inputs.get().motion);
  app.inputs.set("response.initial_rotation", LEAN);
  app.inputs.set("motion", undefined);
};

/** @param {App} app */
const shake = (app) => {
  app.inputs.set("response.initial_rotation", undefined);
  app.inputs.set("motion", motionBefore(app));
};

/** @param {number} value */
const clipped = (value) => Math.min(Math.max(Math.abs(value), 0.1), 10);

/** The controls of the response. @param {{ app: App, inputs: Server.Inputs }} props */
export const Controls = ({ app, inputs }) => {
  const { body, motion, restitution, response } = inputs;
  const free = response?.initial_rotation ?? null;
  return html`
    <div class="response-controls">
      <${Card} title="Parameters">
        <${Slider} label="Scale of the motion" min=${0.1} max=${10} log hidden=${free !== null || !motion}
          value=${clipped(motion?.scale ?? 1)} on=${(scale) => app.inputs.set("motion.scale", scale)} />
        <${Size} app=${app} body=${body} />
        <${Switch} label="Start from an initial rotation" help="Free rocking without ground motion."
          value=${free !== null} on=${(yes) => (yes ? lean(app) : shake(app))} />
        <${Slider} label="Initial rotation / slenderness angle" min=${-0.99} max=${0.99} step=${0.01}
          hidden=${free === null} value=${free ?? LEAN} on=${(value) => app.inputs.set("response.initial_rotation", value || 0.01)} />
        <${NumberField} label="Friction between body and ground" min=${0.01} max=${10} step=${0.05}
          help="A body with a larger friction demand would slide." value=${response?.assumed_friction ?? 0.5}
          on=${(value) => app.inputs.set("response.assumed_friction", value)} />
      <//>
      <${Card} title="Restitution models">
        <${Models} app=${app} table=${restitution} /><//>
    </div>`;
};

/** All lengths of the body, relative to the body at the slider value 1.
 * @param {{ app: App, body: Server.BodyInput }} props */
const Size = ({ app, body }) => {
  const drawn = useRef(body);
  const factor = useRef(1);
  if (JSON.stringify(body) !== JSON.stringify(scaledBody(drawn.current, factor.current))) [drawn.current, factor.current] = [body, 1];
  /** @param {number} next */
  const resize = (next) => {
    factor.current = next;
    app.inputs.set("body", scaledBody(drawn.current, next));
  };
  return html`<${Slider} label="Size of the body, all lengths" min=${0.2} max=${5} log hidden=${!canBeScaled(body)}
    help="Relative to the body in the drawing. Larger bodies are more stable." value=${factor.current} on=${resize} />`;
};

/** True if a model needs no coefficient from the user. @param {Pick<Server.ModelFacts, "parameters">} model */
export const complete = ({ parameters }) => Object.values(parameters).every((parameter) => parameter.default !== null);

/** Restitution models to compare, and a coefficient of the user.
 * @param {{ app: App, table?: Server.RestitutionTable }} props */
const Models = ({ app, table }) => {
  const state = readRestitution(table);
  const { models, value, feet } = state;
  const refused = useSignal(0);
  /** @param {Partial<Chosen>} changes */
  const change = (changes) => {
    const next = writeRestitution({ ...state, ...changes });
    if (next) return app.inputs.set("restitution", next);
    refused.value += 1;
    return app.say("Select at least one model or coefficient.", "warning");
  };
  /** @param {string} label */
  const others = (label) => models.filter((model) => model !== label);
  /** @param {string} label */
  const lead = (label) => {
    change({ models: [label, ...others(label)] });
    look(label);
  };
  /** @param {string} label @param {number} index */
  const foot = (label, index) => html`<${NumberField} label=${label} min=${0} max=${10} step=${0.01} value=${feet?.[index]}
    on=${(coefficient) => change({ feet: feet?.map((old, k) => (k === index ? coefficient : old)) })} />`;
  const completeLabels = app.info.models.filter(complete).map(({ label }) => label);
  return html`
    <div class="models" data-refused=${refused.value}>
      <fieldset class="model-list"><legend class="visually-hidden">Models</legend>
        ${[...new Set([...completeLabels, ...models])].map((label) => html`
          <label class="model-row" key=${label} title=${app.info.models.find((model) => model.label === label)?.title}>
            <input type="checkbox" value=${label} checked=${models.includes(label)} disabled=${feet !== null}
              onChange=${(event) => change({ models: event.target.checked ? [...others(label), label] : others(label) })} />
            <${Swatch} label=${label} /><span>${wordsOf(label)}</span></label>`)}
      </fieldset>
      ${models.length > 1 && !feet && html`<${Choice} label="Main model" value=${models[0]} on=${lead}
        options=${models.map((label) => [label, wordsOf(label)])}
        help="The first result in files, report and command line." />`}
      <${Switch} label="Own coefficient" hidden=${feet !== null} value=${value !== null}
        on=${(yes) => change({ value: yes ? USUAL : null })} />
      ${value !== null && !feet && html`<${Slider} label="Coefficient of restitution r" min=${0} max=${1} step=${0.005}
        value=${Math.min(value, 1)} on=${(coefficient) => change({ value: coefficient })} />`}
      <p class="field-help">${CALIBRATED}</p>
      <${Switch} label="One coefficient for each foot" help="Replaces all models." value=${feet !== null}
        on=${(yes) => change({ feet: yes ? [USUAL, USUAL] : null })} />
      ${feet && html`<div class="fields">${foot("Impact onto the left foot", 0)}${foot("Impact onto the right foot", 1)}</div>`}
    </div>`;
};
