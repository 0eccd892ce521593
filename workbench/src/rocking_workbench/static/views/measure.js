/** Identification: coefficient of restitution from a sound, a table or the microphone; published measurements. */

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
  ["", "as in the file"], ["times", "times of the impacts"], ["rotation", "rotation"], ["displacement", "displacement"],
  ["angular velocity", "angular velocity"], ["acceleration", "acceleration"],
];

const FIRST = { files: [], kind: "", column: "", unit: "", body: "yes", command: "identify", trend: "" };

/** Build the view inside its section. @param {HTMLElement} section @param {App} app */
export const mount = (section, app) => {
  const questions = createQuestions(app, "identify", "reproduce");
  render(html`<${Measure} app=${app} questions=${questions} />`, section);
  return { shown: () => questions.look() };
};

/** @param {{ app: App, questions: Questions }} props */
const Measure = ({ app, questions }) => {
  const form = useForm(app, "measure", FIRST);
  const [files, kind, column, unit, knownBody, command, trend] = Object.keys(FIRST).map((name) => form.at(name));
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
      app.say("The browser blocks the microphone. Allow the microphone, or drop a file.", "error");
    }
  };
  /** @param {Event} event */
  const ask = (event) => {
    event.preventDefault();
    if (command.value === "reproduce") {
      wrong.value = "";
      questions.ask({}, {}, "Published measurements", { command: "reproduce" });
      return;
    }
    const inputs = app.inputs.get();
    wrong.value = (knownBody.value === "yes" && app.faults.sentence({ inputs: true })) || (files.value.length ? "" : { key: "files", text: "Add a recording." });
    if (wrong.value) return;
    const [file] = files.value;
    const table = { file: file.name, kind: kind.value, column: column.value.trim(), unit: unit.value.trim() };
    const measurement = Object.fromEntries(Object.entries(table).filter(([, text]) => text));
    const tables = { measurement, ...(trend.value ? { identify: { trend: true } } : {}), ...(knownBody.value === "yes" ? { body: inputs.body } : {}) };
    questions.ask(tables, { [file.name]: file.sha }, t("Identification from {name}", { name: file.name }));
  };
  return html`
    <${QuestionView} questions=${questions} wrong=${wrong.value} onSubmit=${ask} answer=${Found}
      title="Identification"
      lead="Release the tilted body and record its impacts. The impacts give the coefficient of restitution.">
      <${Choice} label="Analysis" value=${command} options=${[["identify", "my recording"],
        ["reproduce", "published measurements"]]} />
      ${command.value === "reproduce" ? html`<p class="field-help">Recomputed tables, figures and claims of Mao et al. (2024), and a comparison of all models with its 39 measurements. Time: about 30 s.</p>` : html`
      <${FileDrop} label="Drop a recording here, or" accept=".wav,.flac,.csv,.txt,.xlsx,.mp4,.mov,.avi,.webm" files=${files} questions=${questions}
        app=${app} help="Sound (WAV, FLAC), a video, or a table of times, rotations, a gyroscope or an accelerometer." />
      <${Button} aria-pressed=${String(Boolean(recording.value))} onClick=${listen}>
        ${recording.value ? "Stop recording" : "Record with the microphone"}<//>
      <${Choice} label="Recorded quantity" value=${kind} options=${KINDS} help="For tables only." />
      <${Field} label="Column" value=${column} help="For tables with several columns." />
      <${Field} label="Unit" value=${unit} help="For tables without a unit." />
      <${Choice} label="The body" value=${knownBody} options=${[["yes", "body of this project"], ["no", "unknown"]]} />
      <${Choice} label="Coefficient of restitution" value=${trend} options=${[["", "constant"], ["yes", "with a trend"]]} />`}
    <//>`;
};

/** @param {Given} props */
const Found = (props) => (props.question.command === "reproduce" ? html`<${Published} ...${props} />` : html`<${Recording} ...${props} />`);

/** @type {Words} */
const MARK = { holds: "good", "holds in part": "fair", "does not hold": "bad" };

/** @param {Given} given */
const Published = ({ answer }) => html`
  <p class="verdict" data-testid="verdict">
    ${t("{number} of {count} claims confirmed", { number: answer.claims.filter((/** @type {any} */ claim) => claim.verdict === "holds").length, count: answer.claims.length })}</p>
  ${answer.verdict.map((/** @type {string} */ line) => html`<p key=${line}>${line}</p>`)}
  <h3>Models compared with measurements</h3>
  <${Rows} caption="Models" head=${["model", "RMSE of r", "95 % interval", "bias"]}
    rows=${answer.league.map((/** @type {any} */ model) => [model.name, number(model.rmse, 3), t("{low} to {high}", { low: number(model.rmse_low, 3), high: number(model.rmse_high, 3) }),
      number(model.bias, 2)])} />
  <h3>Claims</h3>
  <${Rows} caption="Claims" head=${["claim", "verdict"]}
    rows=${answer.claims.map((/** @type {any} */ claim) => [`${t(claim.section)}: ${t(claim.claim)}`, [claim.verdict, MARK[claim.verdict]]])} />`;

/** @type {Words} */
const HEADS = { within: "within the interval", bias: "model minus measured" };
/** @param {unknown} value */
const shown = (value) => (typeof value === "number" ? number(value) : value === true ? "yes" : value === false ? "no" : String(value ?? ""));

/** @param {Given} given */
const Recording = ({ answer, question }) => {
  const models = answer.models ?? [];
  return html`
    <p class="verdict" data-testid="verdict">${answer.verdict}</p>
    ${answer.doubts.map((/** @type {string} */ doubt) => spelt(answer.messages?.[doubt] ?? { text: doubt, facts: {} })).map((/** @type {string} */ text) => html`<${Note} kind="warning" key=${text} text=${text} />`)}
    <${Drawing} question=${question} alt="Measurements, fit and residuals" />
    ${models.length > 0 && html`<h3>Comparison with models</h3><${Rows} caption="Models" head=${Object.keys(models[0]).map((key) => HEADS[key] ?? key)}
      rows=${models.map((/** @type {object} */ model) => Object.values(model).map(shown))} />`}`;
};
