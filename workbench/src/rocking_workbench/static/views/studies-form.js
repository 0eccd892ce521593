/** Form of a new study of the body and the motion of the other steps. */
import { html, useRef, useSignal } from "/parts/preact.js";
import { Button, Field, Segmented, wrongIn } from "/parts/fields.js";
import { MapQuestion } from "/views/studies-form-map.js";
import { FragilityQuestion } from "/views/studies-form-fragility.js";
import { SpectrumQuestion } from "/views/studies-form-spectrum.js";
import { KeysQuestion } from "/views/studies-form-keys.js";

/** Forms of studies by the table of their jobs. @type {{ [table: string]: ((props: any) => VNode) | undefined }} */
const QUESTIONS = { map: MapQuestion, fragility: FragilityQuestion, spectrum: SpectrumQuestion };
/** @type {{ [table: string]: string | undefined }} */
const LABELS = {
  map: "Overturning map", fragility: "Fragility", spectrum: "Rocking spectra", histories: "Histories", minimum: "Minimum accelerations",
  bifurcation: "Bifurcation diagram", orbits: "Periodic orbits", lyapunov: "Lyapunov exponents", basins: "Basins",
};

/** One kind of study for each table, in the order of the labels. @param {Server.Info} info @returns {Map<string, Server.KindOfStudy>} */
const kindsOf = ({ study_kinds: kinds }) => {
  const tables = [...new Set([...Object.keys(LABELS), ...kinds.map(({ table }) => table)])];
  return new Map(tables.flatMap((table) => kinds.filter((kind) => kind.table === table).map((kind) => [table, kind])));
};

/** A name that is not used by another study. @param {string} name @param {Set<string>} taken */
const fresh = (name, taken) => {
  let candidate = name;
  for (let k = 2; taken.has(candidate); k += 1) candidate = `${name} ${k}`;
  return candidate;
};

/** Form with one step at a time; calls onLaunched(id); `taken`: existing names.
 * @param {{ app: App, visits: number, onLaunched: (id: string) => unknown, taken: () => Set<string> }} props */
export const StudyForm = ({ app, visits, onLaunched, taken }) => {
  const [kind, name, problem, busy] = [useSignal("map"), useSignal(""), useSignal(""), useSignal(false)];
  const [form, question] = [useRef(null), useRef(null)];
  const kinds = kindsOf(app.info);
  /** @param {string} table */
  const labelOf = (table) => LABELS[table] ?? table.replaceAll("_", " ");
  const Question = QUESTIONS[kind.value] ?? KeysQuestion;

  /** A field with an error keeps its last valid number, which differs from the number on the screen. */
  const faultOf = () => {
    const wrong = wrongIn(form.current);
    wrong?.focus();
    return wrong ? "An input of this form is invalid. Correct it first." : app.faults.sentence({ inputs: true });
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
      const stated = inputs.restitution && { restitution: inputs.restitution };
      const tables = { campaign: { name: called, kind: asked }, ...stated, ...job };
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
      <${Segmented} label="Kind" options=${[...kinds.keys()].map((table) => [table, labelOf(table)])} value=${kind.value} on=${choose} />
      <div class="study-question"><${Question} key=${kind.value} app=${app} question=${question} visits=${visits}
        kind=${kinds.get(kind.value)} label=${labelOf(kind.value)} /></div>
      <${Field} label="Name" id="study-name" value=${name} maxlength="100" />
      <p class="error-text" role="alert" id="study-problem">${problem.value}</p>
      <div class="toolbar"><${Button} type="submit" kind="primary" data-testid="study-launch" disabled=${busy.value}>Launch<//></div>
    </form>`;
};
