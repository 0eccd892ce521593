/** Cards of the outcomes, table of impacts, and files for export. */
import { html, useMemo } from "/parts/preact.js";
import { number, quantity } from "/app/format.js";
import { Button, Card, Choice } from "/parts/fields.js";
import { Table } from "/parts/table.js";
import { chosenOf, labelsOf, look, pathOfChosen } from "/views/response-chosen.js";
import { curveKey, Swatch, wordsOf } from "/views/response-labels.js";
import { outcomeOf } from "/views/response-words.js";
import { Film } from "/views/takeaway-film.js";
import { t } from "/app/words.js";

/** One card per model; the chosen card selects the model of the details.
 * @param {{ answers: any[], lead: string | null }} props */
export const Cards = ({ answers, lead }) => html`
  <fieldset class="outcomes" data-testid="outcomes">
    <legend class="visually-hidden">Model with solid lines in the animation</legend>
    ${answers.map((answer) => (answer.error ? html`
      <div key=${answer.label} class="outcome outcome-unknown outcome-refused"><${Head} label=${answer.label} />
        <span class="outcome-facts">${answer.error}</span></div>`
    : html`<${Verdict} key=${curveKey(answer.label)} answer=${answer} checked=${answer.label === lead} />`))}
  </fieldset>`;

/** @param {{ label: string }} props */
const Head = ({ label }) => html`<span class="outcome-model"><${Swatch} label=${label} />${wordsOf(label)}</span>`;

/** @param {{ answer: Server.ResponseFacts, checked: boolean }} props */
const Verdict = ({ answer, checked }) => {
  const { kind, sign, word } = outcomeOf(answer);
  return html`
    <label class=${`outcome outcome-${kind}`} data-testid=${`outcome-${answer.label}`} data-outcome=${answer.outcome}>
      <input type="radio" name="followed" value=${answer.label} checked=${checked} onChange=${() => look(answer.label)} />
      <${Head} label=${answer.label} />
      <span class="outcome-word"><span class="outcome-sign" aria-hidden="true">${sign}</span>${word}</span>
      <span class="outcome-facts">${factsOf(answer)}</span>
      ${answer.warnings.map((warning) => html`<span class="outcome-warning" key=${warning}>${warning}</span>`)}
    </label>`;
};

/** @param {Server.ResponseFacts} answer */
const factsOf = (answer) => {
  const { right, left } = answer.coefficient;
  const same = Math.abs(right - left) < 1e-12;
  const [onto, other] = [number(right, 4), number(left, 4)];
  const r = same ? onto : t("{first} left, {second} right", { first: other, second: onto });
  const peak = answer.outcome === "overturned"
    ? t("overturns at {time}", { time: quantity(answer.overturning_time, "s", 4) })
    : t("peak {rotation}", { rotation: quantity(answer.peak_ratio, "\u03b1", 3) });
  const count = answer.impacts.length;
  return `r = ${r} \u00b7 ${peak} \u00b7 ${t(["{count} impact", "{count} impacts"], { count })}`;
};

const COLUMNS = [
  { label: "No.", digits: 6 }, { label: "Time", unit: "s", digits: 6 }, { label: "Before", unit: "rad/s", digits: 5 },
  { label: "After", unit: "rad/s", digits: 5 }, { label: "r", digits: 5 }, { label: "Onto", numeric: false },
];
const MOST = 200;

/** @param {Server.Impact[]} impacts */
const rowsOf = (impacts) =>
  impacts.map((impact, k) => [
    k + 1, impact.time, impact.velocity_before, impact.velocity_after, impact.coefficient, impact.foot,
  ]);

/** Impacts of the selected model.
 * @param {{ app: App, answers: Server.ResponseFacts[], answer: Server.ResponseFacts }} props */
export const Impacts = ({ app, answers, answer }) => {
  const rows = useMemo(() => rowsOf(answer.impacts), [answer]);
  const counted = { count: rows.length, model: wordsOf(answer.label), shown: MOST };
  return html`<${Card} title="Impacts"><div class="impacts">
    <${Choice} label="Model" value=${answer.label} on=${look} options=${answers.map(({ label }) => [label, wordsOf(label)])} />
    <div data-testid="impacts"><${Table} columns=${COLUMNS} rows=${rows.slice(0, MOST)} copied=${() => rows} testid="impacts-table"
      caption=${rows.length > MOST ? t("{count} impacts ({model}); first {shown} shown, copying includes all", counted)
        : t(["{count} impact ({model})", "{count} impacts ({model})"], counted)}
      csv=${() => app.download("table/impacts.csv", app.inputs.get(), "impacts.csv")} /></div></div><//>`;
};

const FILES = [["Curves, CSV", "table/response.csv"], ["Animation, page", "animation.html"]];

/** Files of the response of the selected model.
 * @param {{ app: App, restitution?: Server.RestitutionTable }} props */
export const TakeAway = ({ app, restitution }) => {
  /** @param {string} path */
  const save = (path) => app.download(pathOfChosen(path, restitution), app.inputs.get(), path.replaceAll("/", "-"));
  const labels = labelsOf(restitution);
  return html`<${Card} title="Export">
    <div class="toolbar">${FILES.map(([label, path]) => html`<${Button} key=${path} onClick=${() => save(path)}>${label}<//>`)}
      <${Film} app=${app}>Animation, GIF<//></div>
    <p class="field-help" data-testid="files-model">${labels.length > 1
      && t("Curves and animation: {model}.", { model: wordsOf(chosenOf(labels)) })}</p><//>`;
};
