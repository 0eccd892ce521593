/** Assessment: margin, overturning probability and retrofit measures; all scale factors at which the outcome changes. */

import { html, render, useSignal } from "/parts/preact.js";
import { number } from "/app/format.js";
import { modelWords } from "/app/palette.js";
import { createQuestions, motionOf } from "/questions/asking.js";
import { Choice, Field, KeyField, sentence } from "/parts/fields.js";
import { Rows } from "/parts/table.js";
import { FileOptions, optionsOf, reasonsOf } from "/views/record-options.js";
import { Drawing, FileDrop, QuestionView, filled, recordEndings, useForm } from "/questions/parts.js";
import { t, userText } from "/app/words.js";

const FAMILIES = [
  ["", "the motion of this project"], ["records", "record files"], ["firm-ground", "20 synthetic motions, firm ground"],
  ["soft-ground", "20 synthetic motions, soft ground"],
];
const FIRST = { shaken: "", files: [], units: "", margin: "1", author: "", date: "", pga: "0.3", command: "assess", by_file: {} };

/** Build the view inside its section. @param {HTMLElement} section @param {App} app */
export const mount = (section, app) => {
  const questions = createQuestions(app, "assess", "predict", "overturning-pga");
  render(html`<${Decide} app=${app} questions=${questions} />`, section);
  return { shown: () => questions.look() };
};

/** @param {{ app: App, questions: Questions }} props */
const Decide = ({ app, questions }) => {
  const form = useForm(app, "decide", FIRST);
  const [shaken, files, units, margin, author, date, pga, command] = Object.keys(FIRST).map((name) => form.at(name));
  const [range, unknown] = ["range", "unknown"].map((name) => ({ get value() { return form.at(name).value || {}; }, at: /** @param {string} key */ (key) => form.at(name, key) }));
  /** @type {Signal<Wrong>} */
  const wrong = useSignal("");
  /** @param {Event} event */
  const ask = (event) => {
    event.preventDefault();
    if (command.value === "overturning-pga") {
      wrong.value = app.faults.sentence({ inputs: true }) || crossings(app, questions, range.value);
      return;
    }
    const inputs = app.inputs.get();
    const shaking = motions(inputs, shaken.value, files.value, { units: units.value, pga: pga.value, own: optionsOf(form.value.by_file, files.value, app) });
    const factor = Number(margin.value.replace(",", "."));
    const predicts = command.value === "predict";
    const faulty = app.faults.sentence({ inputs: true }) || shaking.missing
      || (predicts || factor > 0 ? "" : { key: "margin", text: "Enter a required margin above 0." });
    wrong.value = faulty || "";
    if (faulty) return;
    const name = inputs.body.name || app.project.here.value.name;
    const common = { body: inputs.body, ...shaking.tables, ...(inputs.settings ? { settings: inputs.settings } : {}) };
    if (predicts) {
      const tables = { ...common, predict: filled(unknown.value, app.info.keys.predict) };
      questions.ask(tables, shaking.files ?? {}, t("Overturning probability of {name}", { name: userText(name) }), { command: "predict" });
      return;
    }
    const signed = { project: app.project.here.value.name, author: author.value, date: date.value };
    const header = Object.fromEntries(Object.entries(signed).filter(([, text]) => text.trim()));
    questions.ask({ ...common, assess: { ...header, margin: factor } }, shaking.files ?? {}, t("Assessment of {name}", { name: userText(name) }));
  };
  return html`
    <${QuestionView} questions=${questions} wrong=${wrong.value} onSubmit=${ask} answer=${Found}
      title="Assessment"
      lead="Margin to overturning for all restitution models and both polarities, overturning probability and retrofit measures.">
      <${Choice} label="Analysis" value=${command} options=${[["assess", "margin and retrofit measures"],
        ["predict", "overturning probability and main uncertainties"],
        ["overturning-pga", "PGA intervals with overturning"]]} />
      ${command.value === "overturning-pga" ? html`<div class="fields">${["min_pga", "max_pga", "samples", "bisections"].map((name) => html`
        <${KeyField} key=${name} name=${name} facts=${app.info.keys.minimum[name]} value=${range.at(name)} />`)}</div>
        <p class="field-help">Uses the scaled motion of this project and the first restitution model.</p>` : html`
      <${Choice} label="Ground motions" value=${shaken} options=${FAMILIES} />
      ${shaken.value === "records" && html`
        <${FileDrop} label="Drop records here, or" many accept=${recordEndings(app)} files=${files} questions=${questions} app=${app}
          help="Several records are allowed. Each record is used as recorded." />
        <${Field} label="Unit of the accelerations" value=${units} help="Only for files without a unit: g, m/s2, cm/s2." />
        ${files.value.length > 1 && html`<${FileOptions} app=${app} form=${form} names=${files.value.map((/** @type {SentFile} */ { name }) => name)}
          reasons=${reasonsOf(questions.shown.value, files.value)} />`}`}
      ${["firm-ground", "soft-ground"].includes(shaken.value)
        && html`<${Field} label="Peak acceleration" name="pga" unit="g" value=${pga} inputmode="decimal" />`}
      ${command.value === "predict" ? html`
        <p class="field-help">Uncertain inputs: one number, two numbers as a range, or empty for the default.
          Without an azimuth all directions of the body are sampled.</p>
        <div class="fields">${Object.entries(app.info.keys.predict).map(([name, facts]) => html`
          <${KeyField} key=${name} name=${name} facts=${facts} value=${unknown.at(name)} />`)}</div>` : html`
      <${Field} label="Required margin" name="margin" unit="times the motion" value=${margin} inputmode="decimal"
        help="Proposed measures reach this margin." />
      <${Field} label="Author" value=${author} help="Printed in the report." />
      <${Field} label="Date" value=${date} help="Empty: today." />`}`}
    <//>`;
};

/** Ground motions of the body as job tables, their files, and missing inputs.
 * @param {Server.Inputs} inputs @param {string} shaken @param {SentFile[]} files @param {{ units: string, pga: string, own: object }} options @returns {Shaking} */
const motions = (inputs, shaken, files, { units, pga, own }) => {
  if (shaken === "records") {
    const motion = { records: files.map((file) => file.name), ...(units.trim() ? { units: units.trim() } : {}), ...own };
    const hashes = Object.fromEntries(files.map((file) => [file.name, file.sha]));
    return { tables: { motions: [motion] }, files: hashes, missing: files.length ? "" : { key: "files", text: "Add a record." } };
  }
  if (shaken) {
    const level = Number(pga.replace(",", "."));
    const missing = level > 0 ? "" : { key: "pga", text: "Enter a peak acceleration above 0." };
    const motion = { synthetic: shaken, count: 20, seed: 1, pga: level * 9.80665 };
    return { tables: { motions: [motion] }, files: {}, missing };
  }
  return motionOf(inputs) ?? { files: {}, missing: "No motion is selected. Choose a motion first." };
};

/** Request all accelerations at which the outcome changes; returns missing inputs.
 * @param {App} app @param {Questions} questions @param {any} range */
const crossings = (app, questions, range) => {
  const { body, motion, restitution, settings } = app.inputs.get();
  const shaking = motionOf({ body, motion });
  if (!shaking) return "No motion is selected. Choose a motion first.";
  const { record, pulse, scale, ...keys } = /** @type {Server.MotionInput} */ (shaking.tables.motion);
  if (!record && !pulse) return "This analysis needs one record or pulse. Choose it as the motion.";
  const named = record ? { records: [record], ...keys } : { pulse: [pulse], ...keys };
  const { models, values, ...single } = restitution ?? {};
  const first = models ? { model: models[0] } : values ? { value: values[0] } : single;
  const tables = {
    campaign: { name: "crossings", kind: "minimum-acceleration" }, body, motions: [named], restitution: first,
    minimum: filled(range, app.info.keys.minimum), ...(settings ? { settings } : {}),
  };
  questions.ask(tables, shaking.files, t("Overturning accelerations of {name}", { name: userText(body.name || app.project.here.value.name) }), { command: "overturning-pga" });
  return "";
};

/** @param {Given} props */
const Found = (props) => html`<${FOUND[props.question.command] ?? Verdict} ...${props} />`;

/** @type {{ [command: string]: ((props: Given) => VNode) | undefined }} */
const FOUND = { "overturning-pga": (props) => Crossings(props), predict: (props) => Forecast(props) };

const G = 9.80665;
const MOST = 20; // crossings in the table
/** @type {{ [mode: number]: string | undefined }} */
const STANDS = { "-2": "no uplift", "-1": "does not overturn" };
/** @param {number} mode */
const modeOf = (mode) => STANDS[mode] ?? (mode >= 1e6 ? "overturns" : mode === 0 ? "overturns, no impact" : t(["overturns, {count} impact", "overturns, {count} impacts"], { count: mode }));

/** @param {Given} given */
const Crossings = ({ answer, question }) => html`
  <p class=${`verdict ${answer.minimum_acceleration === null ? "good" : "bad"}`} data-testid="verdict">
    ${answer.minimum_acceleration === null ? "No overturning in this range." : t("Lowest PGA with overturning: {acceleration} g, {factor} times this motion.", {
      acceleration: number(answer.minimum_acceleration / G, 4), factor: number(answer.minimum_acceleration / answer.motion.peak_ground_acceleration, 4) })}</p>
  <p>${sentence(answer.sentence)}</p>
  <${Drawing} question=${question} alt="Overturning as a function of ground acceleration" />
  <${Rows} caption="Crossings" head=${["PGA [g]", "times this motion", "times uplift", "below", "above"]}
    rows=${answer.crossings.slice(0, MOST).map((/** @type {any} */ crossing) => [number(crossing.peak_ground_acceleration / G, 6), number(crossing.scale, 6), number(crossing.uplift_ratio, 4),
      modeOf(crossing.mode_below), modeOf(crossing.mode_above)])} />
  <p class="field-help">${t("Restitution: {model}.", { model: modelWords(answer.restitution) })}
    ${answer.crossings.length > MOST && ` ${t("First {shown} of {count} crossings. The CSV file contains all crossings.", { shown: MOST, count: answer.crossings.length })}`}</p>`;

const MARKS = { overturning: "bad", uplift: "fair" };

/** @param {Given} given */
const Verdict = ({ answer, question }) => {
  /** @param {any} model */
  const fallen = (model) => model.overturned.filter((/** @type {number} */ overturned) => overturned === 1).length;
  const rows = Object.entries(answer.models).map(([name, model]) => [
    modelWords(name), number(model.coefficient.left), number(model.coefficient.right),
    [t("{number} of {count}", { number: fallen(model), count: model.overturned.length }), fallen(model) ? "bad" : "good"],
    model.min_factor === null ? "none found" : number(model.min_factor, 3),
  ]);
  const isOverturned = Object.values(answer.models).some(fallen);
  return html`
    <p class=${`verdict ${isOverturned ? MARKS.overturning : answer.caution ? "fair" : "good"}`} data-testid="verdict">${answer.sentences[0]}</p>
    ${answer.sentences.slice(1).map((/** @type {string} */ line) => html`<p key=${line}>${line}</p>`)}
    <${Drawing} question=${question} alt="Smallest overturning scale factor of each motion, by model" />
    <h3>By restitution model</h3>
    <${Rows} caption="Models" head=${["restitution", "r left", "r right", "overturns in", "margin"]} rows=${rows} />
    <h3>Probabilities</h3>
    <${Chances} of=${answer.prediction} />
    <${Sources} of=${answer.prediction} />
    ${Object.keys(answer.refused).length > 0 && html`<p class="field-help">${t("Models not applicable to this body: {reasons}", {
      reasons: Object.entries(answer.refused).map(([name, reason]) => `${modelWords(name)}: ${t(reason)}`).join("; ") })}</p>`}`;
};

/** @type {Words} */
const WHAT = { uplift: "rocks", sliding: "slides", overturning: "overturns" };
/** @param {number | null} low @param {number | null} high */
const between = (low, high) => (low === null ? "\u2013" : t("{low} to {high}", { low: percent(low), high: percent(high) }));

/** Probabilities, under these motions and under further motions of the same kind, compared with those of another restitution.
 * @param {{ of: any }} props */
const Chances = ({ of: { probability, beside } }) => html`
  <${Rows} caption="Probabilities" head=${["outcome", "probability", "95 % interval", "with similar motions"]}
    rows=${[...Object.entries(probability).map(([outcome, chance]) => [WHAT[outcome], chance]),
      ...Object.entries(beside).map(([model, chance]) => [t("overturns, with {model} and a quarter of the samples", { model: modelWords(model) }), chance])].map(([label, chance]) => [
      label, percent(chance.value), between(chance.low, chance.high), between(chance.wide_low, chance.wide_high)])} />`;

/** Source and processing of the motions, and the scale of the words for probabilities.
 * @param {{ of: any }} props */
const Sources = ({ of: { motions, likelihood_scale, not_sampled, repairs } }) => html`
  <details><summary>Source and processing of the ground motions</summary>
    <ul translate="no">${motions.map((/** @type {any} */ motion) => html`<li key=${motion.name} translate="no">${motion.name}: ${motion.provenance.join("; ")}</li>`)}</ul></details>
  <details><summary>Likelihood terms</summary><p>${likelihood_scale}</p></details>
  <details><summary>Not sampled</summary>
    <ul>${not_sampled.map((/** @type {string} */ input) => html`<li key=${input}>${input}</li>`)}</ul></details>
  ${repairs.length > 0 && html`<details><summary>Mesh repairs</summary>
    <ul>${repairs.map((/** @type {string} */ repair) => html`<li key=${repair}>${repair}</li>`)}</ul></details>`}`;

/** @param {Given} given */
const Forecast = ({ answer, question }) => {
  const { high } = answer.probability.overturning;
  const shares = Object.entries(answer.contributions).sort(([, first], [, other]) => other.total - first.total);
  /** @param {number} low @param {number} at @param {number} high */
  const share = (low, at, high) => t("{value} ({low} to {high})", { value: number(at, 2), low: number(low, 2), high: number(high, 2) });
  return html`
    <p class=${`verdict ${high <= 0.05 ? "good" : high <= 0.5 ? "fair" : "bad"}`} data-testid="verdict">${answer.verdict}</p>
    <ul>${answer.sentences.slice(1).map((/** @type {string} */ text) => html`<li key=${text}>${text}</li>`)}</ul>
    <${Drawing} question=${question} alt="Probabilities of rocking, sliding and overturning, and main uncertainties" />
    <h3>Probabilities</h3>
    <${Chances} of=${answer} />
    ${answer.decides && html`<p>${answer.decides}</p>`}
    ${shares.some(([, indices]) => indices.total) && html`<h3>Main uncertainties</h3>
      <${Rows} caption="Contributions to variance" head=${["uncertain input", "alone", "with interactions"]}
        rows=${shares.map(([name, s]) => [name, share(s.first_low, s.first, s.first_high), share(s.total_low, s.total, s.total_high)])} />
      <p class="field-help">Contributions to the variance of overturning (Sobol indices), with 95 % intervals.</p>
      <${Rows} caption="Range limits" head=${["input", "overturns at the lower limit", "overturns at the upper limit"]}
        rows=${Object.entries(answer.ends).map(([name, e]) => [name, `${percent(e.probability_low)} (${number(e.input_low, 3)})`,
          `${percent(e.probability_high)} (${number(e.input_high, 3)})`])} />`}
    <details><summary>Assumptions</summary>
      <ul>${answer.assumed.map((/** @type {string} */ assumption) => html`<li key=${assumption}>${assumption}</li>`)}</ul></details>
    <${Sources} of=${answer} />`;
};

/** @param {any} value */
const percent = (value) => `${number(100 * value, 3)}\u00a0%`;
