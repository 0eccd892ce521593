/** Inventory: a list of objects of a museum, and their ratings. */

import { html, render, useEffect, useSignal } from "/parts/preact.js";
import { number } from "/app/format.js";
import { createQuestions, fileAtHand } from "/questions/asking.js";
import { Choice, Field, KeyField } from "/parts/fields.js";
import { Rows } from "/parts/table.js";
import { FileDrop, QuestionView, filled, useForm } from "/questions/parts.js";
import { t } from "/app/words.js";

const FIRST = { files: [], kind: "pga", level: "0.3", family: "firm-ground", count: "200" };
/** @type {Words} */
const LIGHTS = { red: "bad", amber: "fair", green: "good" };

/** Build the view inside its section. @param {HTMLElement} section @param {App} app */
export const mount = (section, app) => {
  const questions = createQuestions(app, "inventory");
  render(html`<${Inventory} app=${app} questions=${questions} />`, section);
  return { shown: () => questions.look() };
};

/** @param {{ app: App, questions: Questions }} props */
const Inventory = ({ app, questions }) => {
  const form = useForm(app, "inventory", FIRST);
  const [files, kind, level, family, count] = Object.keys(FIRST).map((name) => form.at(name));
  /** @type {Signal<Wrong>} */
  const wrong = useSignal("");
  const text = useSignal(null); // lines of the list, and its run
  const fixed = useSignal({}); // lines that were corrected, by their number
  /** @param {SentFile} list */
  const corrected = async (list) => {
    if (text.value?.of.sha !== list.sha || !Object.keys(fixed.value).length) return list;
    const lines = text.value.lines.map((/** @type {string} */ line, /** @type {number} */ k) => fixed.value[k + 1] ?? line);
    const sent = await questions.send(new File([lines.join("\n")], list.name));
    form.at("encoding").value = "";
    return { ...sent, name: list.name };
  };
  /** @param {Event} event */
  const ask = async (event) => {
    event.preventDefault();
    const strength = Number(level.value.replace(",", "."));
    const many = Number(count.value);
    wrong.value = !files.value.length ? { key: "files", text: "Add a list." }
      : !(strength > 0) ? { key: "level", text: "Enter an intensity level above 0." }
        : !(Number.isInteger(many) && many > 0) ? { key: "count", text: "Enter a whole number of motions above 0." } : "";
    if (wrong.value) return;
    const list = await corrected(files.value[0]).catch((error) => app.say(error.message, "error"));
    if (!list) return;
    if (list.sha !== files.value[0].sha) files.value = [list];
    fixed.value = {};
    const shaking = { [kind.value]: kind.value === "pga" ? `${strength}g` : `${strength}cm/s` };
    const tables = {
      campaign: { name: list.name, kind: "inventory" },
      inventory: { ...filled(listed(form.value), app.info.keys.inventory), objects: list.name, language: app.language, ...shaking },
      motions: [{ synthetic: family.value, count: many, seed: 1 }],
    };
    await questions.ask(tables, { [list.name]: list.sha }, t("Inventory: {name}", { name: list.name }));
    text.value = { of: list, lines: null, id: questions.shown.value?.id };
  };
  const answer = questions.shown.value?.id === text.value?.id ? questions.shown.value?.answer : null;
  useEffect(() => {
    if (answer) linesOf(text.value.of, answer.inventory).then((lines) => (text.value = { ...text.value, lines }));
  }, [text.value?.id, Boolean(answer)]);
  return html`
    <${QuestionView} questions=${questions} wrong=${wrong.value} onSubmit=${ask} answer=${Ranking}
      title="Inventory"
      lead="Rating of a list of objects with sizes. Rows without a rating are listed with the reason.">
      <${FileDrop} label="Drop a list here, or" accept=".csv,.xlsx,.ods,.txt,.tsv" files=${files} questions=${questions} app=${app}
        help="Columns such as name, width_cm, depth_cm, height_cm. Optional: count, base, weight, notes." />
      <${Choice} label="Intensity measure" value=${kind}
        options=${[["pga", "peak acceleration [g]"], ["pgv", "peak velocity [cm/s]"]]} />
      <${Field} label="Intensity level" name="level" unit=${kind.value === "pga" ? "g" : "cm/s"} value=${level} inputmode="decimal" />
      <${Choice} label="Motions" value=${family} options=${[
        ["firm-ground", "firm ground"], ["soft-ground", "soft ground"], ["point-source", "point source"],
        ["pulse-like", "near-fault, pulse-like"]]} />
      <${Field} label="Number of motions" name="count" value=${count} inputmode="numeric" help="More motions give narrower intervals: 200 motions distinguish 5 % from 10 %." />
      <details><summary>List format</summary>${READ.map((name) => html`
        <${KeyField} key=${name} name=${name} facts=${app.info.keys.inventory[name]} value=${form.at(name)} />`)}</details>
      <${Corrections} answer=${answer} text=${text.value?.of.sha === files.value[0]?.sha ? text.value : null} fixed=${fixed} />
    <//>`;
};

const READ = ["map_columns", "encoding"];
/** @param {{ [name: string]: string }} typed */
const listed = (typed) => Object.fromEntries(READ.map((name) => [name, typed[name] ?? ""]));

const MOST = 20; // number of rows for correction

// Lines of a text list, in the encoding of the answer; null for a workbook, which is corrected in its application.
/** @param {SentFile} list @param {string} source */
const linesOf = async ({ name, sha }, source) => {
  if (/\.(xlsx|ods)$/i.test(name)) return null;
  const encoding = / \(([\w-]+)\)$/.exec(source)?.[1] ?? "utf-8";
  try {
    const reader = new TextDecoder(NAMES[encoding] ?? encoding, { fatal: true });
    return reader.decode(await fileAtHand(sha).arrayBuffer()).split(/\r\n|\r|\n/);
  } catch {
    return null;
  }
};
/** @type {Words} */
const NAMES = { mac_roman: "macintosh", "utf-8-sig": "utf-8", "utf-16-be": "utf-16be", "utf-16-le": "utf-16le" };

// Rows of the list that were not assessed, unchanged.
/** @param {{ answer: any, text: any, fixed: Signal<any> }} props */
const Corrections = ({ answer, text, fixed }) => {
  const rows = (text?.lines && answer?.not_assessed) || [];
  /** @param {{ row: number }} fault */
  const at = ({ row }) => ({
    get value() { return fixed.value[row] ?? text.lines[row - 1]; },
    set value(line) { fixed.value = { ...fixed.value, [row]: line }; },
  });
  return rows.length > 0 && html`
    <fieldset><legend>Correct rows, then compute again</legend>
      <pre tabindex="0" aria-label=${t("Header of the list")}>${answer.header_lines.map((/** @type {number} */ row) => text.lines[row - 1]).join("\n")}</pre>
      ${rows.slice(0, MOST).map((/** @type {any} */ row) => html`<${Field} key=${`${text.id} ${row.row}`} label=${t("Line {number}", { number: row.row })} help=${row.reason}
        value=${at(row)} />`)}</fieldset>`;
};

/** Inventory number and name of a row. @param {{ number: string, name: string }} row */
const label = ({ number, name }) => [...new Set([number, name])].filter(Boolean).join(" ");

/** @param {string[]} ends */
const between = ([low, high]) => t("{low} to {high}", { low, high });

/** Ratings with the other restitution models. @param {{ rating_by_comparison: Record<string, string> }} object */
const byModel = (object) => Object.entries(object.rating_by_comparison)
  .map(([model, rating]) => `${model} ${t(rating.toUpperCase())}`).join(", ");

/** @param {Given} given */
const Ranking = ({ answer }) => {
  const missing = answer.not_assessed.length;
  const noted = answer.objects.some((/** @type {any} */ object) => object.note || object.noted);
  const rows = answer.objects.map((/** @type {any} */ object) => [
    [`${label(object)}${object.count > 1 ? ` (${object.count})` : ""}`, "own"], [object.rating.toUpperCase(), LIGHTS[object.rating]], byModel(object),
    between(object.overturned_interval.map((/** @type {number} */ end) => number(100 * end, 2))), object.text, object.measures,
    ...(noted ? [[[object.note, object.noted].filter(Boolean).join(". "), "own"]] : []),
  ]);
  return html`
    <p class="verdict" data-testid="verdict">${missing
      ? t("{red} red, {amber} amber, {green} green, {missing} not assessed, at {level}.", { ...answer.counts, missing, level: answer.hazard.level })
      : t("{red} red, {amber} amber, {green} green, at {level}.", { ...answer.counts, level: answer.hazard.level })}</p>
    ${rows.length > 0 && html`<${Rows} caption="Objects, highest risk first"
      head=${["object", "rating", "rating with other models", "overturns [%]", "result", "recommendation", ...(noted ? ["note"] : [])]} rows=${rows} />`}
    ${missing > 0 && html`<h3>Not assessed</h3><${Rows} caption="Rows without a rating" head=${["object", "line", "reason"]}
      rows=${answer.not_assessed.map((/** @type {any} */ row) => [label(row) ? [label(row), "own"] : "no name", String(row.row), row.reason])} />`}
    ${answer.not_objects.length > 0 && html`<details><summary>Lines that are not objects</summary>
      <${Rows} caption="Lines of the list that are not objects" head=${["text", "line", "reason"]}
        rows=${answer.not_objects.map((/** @type {any} */ row) => [[row.text, "own"], String(row.row), row.reason])} /></details>`}
    ${answer.stated.map((/** @type {string} */ note) => html`<p key=${note} class="field-help">${note}</p>`)}
    ${answer.columns_not_read.length > 0 && html`<p class="field-help">${t("Ignored columns: {names}", { names: answer.columns_not_read.join(", ") })}</p>
      <p class="field-help">Assign columns under \u201cList format\u201d.</p>`}`;
};
