/** Input form of a fragility analysis: motions, intensity measure, levels and limit state. */
import { html, useMemo, useRef, useSignal } from "/parts/preact.js";
import { pretty } from "/app/format.js";
import { Choice, NumberField, Segmented } from "/parts/fields.js";
import { Range, limitsOf, rangeOf, unitOf, usualRange } from "/views/studies-form-parts.js";
import { RecordChoice } from "/views/studies-form-records.js";
import { t } from "/app/words.js";

const ANALYSES = [["stripes", "Stripes"], ["incremental", "Incremental"], ["cloud", "Cloud"]];
const SOURCES = [["synthetic", "Synthetic set"], ["records", "Uploaded records"]];

/** Form of a fragility. @param {{ app: App, question: StudyQuestion, visits: number }} props */
export const FragilityQuestion = ({ app, question, visits }) => {
  const { families, measures, keys: { fragility: keys, motions } } = app.info;
  /** @type {Signal<any>} */
  const chosen = useSignal({
    kind: "stripes", source: "synthetic", family: families[0].name, count: 40, seed: 1, measure: keys.im.usual,
    state: JSON.parse(keys.limit_states.usual)[0],
  });
  const { kind, source, measure } = chosen.value;
  const records = useRef(null);
  const measured = measures.find(({ name }) => name === measure);
  const levels = useMemo(() => usualRange(app, measure, 12), [measure]);
  /** @param {string} key */
  const take = (key) => (/** @type {any} */ value) => (chosen.value = { ...chosen.value, [key]: value });
  /** @param {any} Kind @param {string} key @param {string} label @param {object} more */
  const field = (Kind, key, label, more) => html`<${Kind} label=${label} value=${chosen.value[key]} on=${take(key)} ...${more} />`;
  /** @param {string} key @param {string} label @param {[string, string][]} options */
  const choice = (key, label, options) => field(Choice, key, label, { options });
  question.current = { name: t("fragility, {kind}", { kind }), tables: (inputs) => tablesOf(inputs, chosen.value, levels, records.current) };
  return html`<div class="question">
    ${field(Segmented, "kind", "Analysis", { options: ANALYSES })}
    ${field(Segmented, "source", "Motions", { options: SOURCES })}
    <div class="fields" hidden=${source !== "synthetic"}>
      ${choice("family", "Family", families.map(({ name, title }) => [name, title ?? name]))}
      ${field(NumberField, "count", "Motions", { ...limitsOf(motions.count), max: app.info.limits.study_motions, step: 1 })}
      ${field(NumberField, "seed", "Seed", { ...limitsOf(motions.seed), step: 1, integer: true })}
    </div>
    <${RecordChoice} app=${app} taken=${records} visits=${visits} hidden=${source !== "records"} />
    ${choice("measure", "Intensity measure", measures.map(({ name, description: text, unit }) =>
      [name, unit === "1" ? text : `${text} [${pretty(unit)}]`]))}
    <div hidden=${kind === "cloud"}><${Range} key=${measure} name="Levels of the measure" unit=${unitOf(measured)} range=${levels} /></div>
    ${field(NumberField, "state", "Rocking limit state", {
      unit: "\u03b1", above: 0, step: 0.05,
      help: "Fraction of the slenderness angle \u03b1.",
    })}
  </div>`;
};

/** @param {Server.Inputs} inputs @param {any} chosen @param {any} levels @param {() => any} records */
const tablesOf = (inputs, { kind, source, family, count, seed, measure, state }, levels, records) => {
  if (!inputs.body) throw new Error("A fragility needs a body. Choose a body in the step Body.");
  const set = { synthetic: family, count: Math.round(count), seed: Math.round(seed) };
  const motions = source === "synthetic" ? [set] : records();
  const fragility = { im: measure, limit_states: [state], ...(kind === "cloud" ? {} : { levels: rangeOf(levels) }) };
  return { kind, job: { body: inputs.body, motions, fragility } };
};
