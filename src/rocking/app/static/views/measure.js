/** Measure: the coefficient of restitution from a sound, a table, or the microphone; and what was published of it. */

import { html, render, useSignal } from "/parts/preact.js";
import { number } from "/app/format.js";
import { spelt } from "/app/refusal.js";
import { createQuestions } from "/questions/asking.js";
import { Button, Choice, Field, Note } from "/parts/fields.js";
import { Rows } from "/parts/table.js";
import { Drawing, FileDrop, QuestionView, useForm } from "/questions/parts.js";
import { record } from "/questions/microphone.js";
import { t } from "/app/words.js";

const KINDS = [
  ["", "what the file says"], ["times", "times of the impacts"], ["rotation", "rotation"], ["displacement", "displacement"],
  ["angular velocity", "angular velocity"], ["acceleration", "acceleration"],
];

const FIRST = { files: [], kind: "", column: "", unit: "", known: "yes", what: "identify", trend: "" };

/** Build the view inside its section. @param {HTMLElement} section @param {App} app */
export const mount = (section, app) => {
  const questions = createQuestions(app, "identify", "paper");
  render(html`<${Measure} app=${app} questions=${questions} />`, section);
  return { shown: () => questions.look() };
};

/** @param {{ app: App, questions: Questions }} props */
const Measure = ({ app, questions }) => {
  const form = useForm(app, "measure", FIRST);
  const [files, kind, column, unit, known, what, trend] = Object.keys(FIRST).map((name) => form.at(name));
  /** @type {Signal<Wrong>} */
  const wrong = useSignal("");
  const recording = useSignal(null);
  const listen = async () => {
    if (recording.value) {
      const file = await recording.value.end();
      recording.value = null;
      await questions.send(file).then((sent) => (files.value = [sent]), (error) => app.say(error.message, "error"));
      return;
    }
    try {
      recording.value = await record();
    } catch {
      app.say("The browser does not let this page listen: allow the microphone, or drop a file.", "error");
    }
  };
  /** @param {Event} event */
  const ask = (event) => {
    event.preventDefault();
    if (what.value === "paper") {
      wrong.value = "";
      questions.ask({}, {}, "What the published measurements say", { command: "paper" });
      return;
    }
    const inputs = app.inputs.get();
    wrong.value = (known.value === "yes" && app.faults.sentence({ inputs: true })) || (files.value.length ? "" : { key: "files", words: "Nothing was sent yet." });
    if (wrong.value) return;
    const [file] = files.value;
    const table = { file: file.name, kind: kind.value, column: column.value.trim(), unit: unit.value.trim() };
    const measurement = Object.fromEntries(Object.entries(table).filter(([, words]) => words));
    const tables = { measurement, ...(trend.value ? { identify: { trend: true } } : {}), ...(known.value === "yes" ? { body: inputs.body } : {}) };
    questions.ask(tables, { [file.name]: file.sha }, t("What {name} says", { name: file.name }));
  };
  return html`
    <${QuestionView} questions=${questions} wrong=${wrong.value} onSubmit=${ask} answer=${Found}
      title="What does an impact cost?"
      lead="Let the body go from a tilt and record it: each knock tells how much of the speed was left.">
      <${Choice} label="Question" value=${what} options=${[["identify", "what my recording says"],
        ["paper", "what the published measurements say"]]} />
      ${what.value === "paper" ? html`<p class="field-help">Every table, figure and claim of Mao et al. (2024), recomputed, and all
        models against its 39 measurements; as a report. It takes about half a minute.</p>` : html`
      <${FileDrop} label="Drop a recording here, or" accept=".wav,.flac,.csv,.txt,.xlsx,.mp4,.mov,.avi,.webm" files=${files} questions=${questions}
        app=${app} help="Sound (WAV, FLAC), a video, or a table of times, rotations, a gyroscope or an accelerometer." />
      <${Button} aria-pressed=${String(Boolean(recording.value))} onClick=${listen}>
        ${recording.value ? "End the recording" : "Record with the microphone"}<//>
      <${Choice} label="It holds" value=${kind} options=${KINDS} help="Of a table only." />
      <${Field} label="Column" value=${column} help="Of a table with several." />
      <${Field} label="Unit" value=${unit} help="Where the table states none." />
      <${Choice} label="The body" value=${known} options=${[["yes", "is that of this project"], ["no", "is not known"]]} />
      <${Choice} label="What an impact takes" value=${trend} options=${[["", "is the same share each time"], ["yes", "changes steadily"]]} />`}
    <//>`;
};

/** @param {Given} given */
const Found = (given) => (given.question.command === "paper" ? html`<${Published} ...${given} />` : html`<${Recording} ...${given} />`);

/** @type {Words} */
const MARK = { holds: "good", "holds in part": "fair", "does not hold": "bad" };

/** @param {Given} given */
const Published = ({ answer }) => html`
  <p class="verdict" data-testid="verdict">
    ${t("{number} of {count} claims hold", { number: answer.claims.filter((/** @type {any} */ one) => one.verdict === "holds").length, count: answer.claims.length })}</p>
  ${answer.verdict.map((/** @type {string} */ words) => html`<p key=${words}>${words}</p>`)}
  <h3>All models against all measurements</h3>
  <${Rows} caption="Models" head=${["model", "RMSE of r", "95 % interval", "bias"]}
    rows=${answer.league.map((/** @type {any} */ one) => [one.name, number(one.rmse, 3), t("{low} to {high}", { low: number(one.rmse_low, 3), high: number(one.rmse_high, 3) }),
      number(one.bias, 2)])} />
  <h3>Claims</h3>
  <${Rows} caption="Claims" head=${["claim", "verdict"]}
    rows=${answer.claims.map((/** @type {any} */ one) => [`${t(one.section)}: ${t(one.claim)}`, [one.verdict, MARK[one.verdict]]])} />`;

/** @type {Words} */
const HEADS = { within: "within the interval", bias: "above what was measured" };
/** @param {unknown} value */
const shown = (value) => (typeof value === "number" ? number(value) : value === true ? "yes" : value === false ? "no" : String(value ?? ""));

/** @param {Given} given */
const Recording = ({ answer, question }) => {
  const models = answer.models ?? [];
  return html`
    <p class="verdict" data-testid="verdict">${answer.verdict}</p>
    ${answer.doubts.map((/** @type {string} */ doubt) => spelt(answer.messages?.[doubt] ?? { text: doubt, facts: {} })).map((/** @type {string} */ words) => html`<${Note} kind="warning" key=${words} words=${words} />`)}
    <${Drawing} question=${question} alt="What was measured, what fits it, and what is left over" />
    ${models.length > 0 && html`<h3>Beside the models</h3><${Rows} caption="Models" head=${Object.keys(models[0]).map((key) => HEADS[key] ?? key)}
      rows=${models.map((/** @type {object} */ each) => Object.values(each).map(shown))} />`}`;
};
