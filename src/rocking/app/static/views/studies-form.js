/** What a new study computes: chosen here, about the body and the motion of the other steps. */
import { html, useRef, useSignal } from "/parts/preact.js";
import { Button, Field, Segmented, wrongIn } from "/parts/fields.js";
import { MapQuestion } from "/views/studies-form-map.js";
import { FragilityQuestion } from "/views/studies-form-fragility.js";
import { SpectrumQuestion } from "/views/studies-form-spectrum.js";

/** @type {{ [kind: string]: (given: any) => VNode }} */
const QUESTIONS = { "overturning-map": MapQuestion, fragility: FragilityQuestion, "rocking-spectrum": SpectrumQuestion };
const KINDS = [
  ["overturning-map", "Overturning map"], ["fragility", "Fragility"], ["rocking-spectrum", "Rocking spectra"],
];

/** A name that no study has yet. @param {string} name @param {Set<string>} taken */
const fresh = (name, taken) => {
  let found = name;
  for (let k = 2; taken.has(found); k += 1) found = `${name} ${k}`;
  return found;
};

/** Form with one question at a time; calls onLaunched(id); `taken` says which names there are.
 * @param {{ app: App, visits: number, onLaunched: (id: string) => unknown, taken: () => Set<string> }} props */
export const StudyForm = ({ app, visits, onLaunched, taken }) => {
  const [kind, name, problem, busy] = [useSignal("overturning-map"), useSignal(""), useSignal(""), useSignal(false)];
  const [form, question] = [useRef(null), useRef(null)];
  const Question = QUESTIONS[kind.value];

  /** A field in error holds its last good number, which is not the one on the screen. */
  const faultOf = () => {
    const wrong = wrongIn(form.current);
    wrong?.focus();
    return wrong ? "A number of this form is marked as wrong: correct it first." : app.faults.sentence({ inputs: true });
  };
  /** @param {Event} event */
  const launch = async (event) => {
    event.preventDefault();
    problem.value = faultOf();
    if (problem.value || busy.value) return;
    const inputs = app.inputs.get();
    busy.value = true;
    try {
      const { kind: asked, job } = question.current.tables(inputs);
      const called = fresh(name.value.trim() || question.current.name, taken());
      const tables = { campaign: { name: called, kind: asked }, restitution: inputs.restitution || { model: "ked" }, ...job };
      if (inputs.settings && Object.keys(inputs.settings).length) tables.settings = inputs.settings;
      const { id } = await app.call("studies", { json: { name: called, job: tables, project: app.project.here.value.id } });
      name.value = "";
      onLaunched(id);
    } catch (error) {
      problem.value = error.message;
    }
    busy.value = false;
  };
  /** @param {any} chosen */
  const choose = (chosen) => {
    kind.value = chosen;
    problem.value = "";
  };
  return html`
    <form ref=${form} class="study-form" onSubmit=${launch}>
      <${Segmented} label="Kind" options=${KINDS} value=${kind.value} on=${choose} />
      <div class="study-question"><${Question} app=${app} question=${question} visits=${visits} /></div>
      <${Field} label="Name" id="study-name" value=${name} maxlength="100" />
      <p class="error-text" role="alert" id="study-problem">${problem.value}</p>
      <div class="toolbar"><${Button} type="submit" kind="primary" data-testid="study-launch" disabled=${busy.value}>Launch<//></div>
    </form>`;
};
