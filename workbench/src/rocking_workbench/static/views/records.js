/** Records: correction of a record by a chain of steps; measures of many records, selection and scaling to a spectrum. */

import { freshId } from "/app/dom.js";
import { html, render, useRef, useSignal } from "/parts/preact.js";
import { fetchFile } from "/app/api.js";
import { number, parseNumber } from "/app/format.js";
import { spelt, whyLeftOut } from "/app/refusal.js";
import { createQuestions } from "/questions/asking.js";
import { Button, Choice, KeyField, Note, sentence } from "/parts/fields.js";
import { Rows } from "/parts/table.js";
import { FileOptions, optionsOf, reasonsOf } from "/views/record-options.js";
import { Drawing, FileDrop, QuestionView, filled, recordEndings, useForm } from "/questions/parts.js";
import { t } from "/app/words.js";

const G = 9.80665;
const FIRST = { files: [], curve: [], steps: [], motion: {}, by_file: {}, set: {}, of: {}, code: "eurocode8", shown: "", list: "", format: "" };

/** Build the view inside its section. @param {HTMLElement} section @param {App} app */
export const mount = (section, app) => {
  const questions = createQuestions(app, "record convert", "record batch");
  const All = () => html`<${Records} key=${app.project.here.value.id} app=${app} questions=${questions} />`;
  render(html`<${All} />`, section);
  return { shown: () => questions.reopen() };
};

/** @param {{ app: App, questions: Questions }} props */
const Records = ({ app, questions }) => {
  const form = useForm(app, "records", FIRST);
  /** @type {Signal<Wrong>} */
  const wrong = useSignal("");
  /** @type {{ files: SentFile[], curve: SentFile[], steps: RecordStep[] }} */
  const { files, curve, steps } = form.value;
  const records = files.filter((file) => !isStations(file));
  const shown = shownOf(form.value, records);
  const lists = records.filter((record) => /\.csv$/i.test(record.name));
  const single = shown !== "all" && shown !== "target";
  const reasons = reasonsOf(questions.shown.value, records);
  /** @type {{ [key: string]: string[] | undefined }} */
  const choices = { units: app.info.units.acceleration, format: app.info.formats.map(({ name }) => name) };
  /** @param {string} name */
  const key = (name) => html`<${KeyField} key=${name} name=${name} value=${form.at("motion", name)}
    facts=${{ ...app.info.keys.motion[name], choices: choices[name] ?? [] }} />`;
  /** @param {Event} event */
  const ask = (event) => {
    event.preventDefault();
    wrong.value = !records.length ? { key: "files", text: "Add a record." }
      : shown === "target" && form.value.code === "file" && !curve.length
        ? { key: "curve", text: "Add a spectrum file." }
        : shown === "target" && missingOf(form.value, app) ? { key: missingOf(form.value, app), text: "Enter a number." } : "";
    if (wrong.value) return;
    form.at("sent").value = chainOf(steps).join("; ");
    const job = single ? oneOf(form.value, app, /** @type {SentFile} */ (records.find((record) => record.name === shown))) : setOf(form.value, app, shown);
    questions.ask(job.tables, job.files, job.name, { command: single ? "record convert" : "record batch", format: single ? form.value.format : "" });
  };
  return html`
    <${QuestionView} questions=${questions} wrong=${wrong.value} onSubmit=${ask} answer=${Answer}
      title="Records"
      lead="Correct one record step by step, or measure a folder of records and select records for a target spectrum.">
      <${FileDrop} label="Drop records or a folder here, or" many accept=${recordEndings(app)} files=${form.at("files")} questions=${questions}
        app=${app} help="For counts, add the StationXML file (.xml)." />
      ${records.length > 0 && html`<${Choice} label="Result" value=${form.at("shown")} chosen=${shown}
        options=${[...records.slice(0, 50).map(({ name }) => [name, t("{name}, before and after", { name })]),
          ["all", "all records, table of intensity measures"], ["target", "records selected and scaled to a spectrum"]]} />`}
      ${!single && lists.length > 0 && records.length > 1 && html`<${Choice} label="List of records" value=${form.at("list")}
        help="CSV with the column motion, or x, y and z. Optional columns: units, time_step. Add the listed files too."
        options=${[["", "none: each file is a record"], ...lists.map(({ name }) => [name, name])]} />`}
      <details open=${Object.values(form.value.motion).some(Boolean) || Object.keys({ ...form.value.by_file, ...reasons }).length > 0}>
        <summary>Missing in the file</summary>
        <div class="fields">${["units", "time_step", "format", "skip", ...(single ? ["component"] : [])].map(key)}</div>
        ${records.length > 1 && html`<${FileOptions} app=${app} form=${form} reasons=${reasons}
          names=${records.map(({ name }) => name).filter((name) => name !== form.value.list)} />`}
      </details>
      <${Chain} app=${app} form=${form} stations=${files.filter(isStations)} faulty=${faultyOf(questions, form.value)} />
      ${shown === "target" && html`<${Target} app=${app} form=${form} questions=${questions} />`}
      ${!single && html`<${KeyField} name="mirrored" facts=${app.info.keys.motions.mirrored} value=${form.at("set", "mirrored")} />`}
      ${single && html`<${Choice} label="Output format" value=${form.at("format")} help="In addition to columns of time and acceleration."
        options=${[["", "columns only (CSV)"], ...app.info.formats.filter(({ name }) => name !== "columns")
          .map(({ name, title }) => [name, `${name}: ${t(title)}`])]} />`}
    <//>`;
};

/** @param {{ name: string }} file */
const isStations = ({ name }) => /\.xml$/i.test(name);
/** @param {{ shown: string }} form @param {SentFile[]} records */
const shownOf = ({ shown }, records) => {
  if (["all", "target"].includes(shown) || records.some(({ name }) => name === shown)) return shown;
  return records.length > 1 ? "all" : records[0]?.name ?? "";
};

/** First missing key of the target spectrum.
 * @param {{ code: string, of: { [code: string]: { [key: string]: string } | undefined } }} form @param {App} app */
const missingOf = ({ code, of }, app) => Object.entries(app.info.targets[code]?.keys ?? {})
  .find(([key, { needed }]) => needed && !of[code]?.[key]?.trim())?.[0];

/** The steps as in job files and on the command line. @param {RecordStep[]} steps */
const chainOf = (steps) => steps.map(({ name, keys }) => {
  const stated = Object.entries(keys).filter(([, text]) => text.trim());
  return stated.length ? `${name}:${stated.map(([key, text]) => `${key}=${written(text)}`).join(",")}` : name;
});
/** @param {string} text */
const written = (text) => (parseNumber(text) === null ? text.replace(/[;,]/g, " ").trim() : String(parseNumber(text)));

// Step of a rejection: its index if present, else its name.
/** @param {Questions} questions @param {{ steps: RecordStep[], sent?: string }} form */
const faultyOf = (questions, { steps, sent }) => {
  const refusal = questions.shown.value?.state === "refused" ? questions.shown.value.refusal : null;
  const step = refusal?.places?.find((/** @type {any} */ { kind }) => kind === "step");
  if (!step || sent !== chainOf(steps).join("; ")) return null;
  return { index: step.number - 1, text: sentence(spelt(refusal)) };
};

/** @param {{ app: App, form: Form, stations: SentFile[], faulty: { index: number, text: string } | null }} props */
const Chain = ({ app, form, stations, faulty }) => {
  const stepFacts = app.info.steps;
  /** @type {{ steps: RecordStep[] }} */
  const { steps } = form.value;
  const heading = useRef(freshId("steps")).current;
  /** @param {RecordStep[]} next */
  const set = (next) => (form.at("steps").value = next);
  /** @param {number} index @param {string} key */
  const keyed = (index, key) => ({
    get value() { return steps[index].keys[key] ?? ""; },
    set value(text) { set(steps.map((step, k) => (k === index ? { ...step, keys: { ...step.keys, [key]: text } } : step))); },
  });
  /** @param {number} index */
  const by = (index) => ({
    get value() { return Object.keys(steps[index].keys)[0] ?? ""; },
    set value(key) { set(steps.map((step, k) => (k === index ? { ...step, keys: { [key]: "" } } : step))); },
  });
  const added = {
    get value() { return ""; },
    set value(name) { if (name) set([...steps, { name, id: freshId("step"), keys: {} }]); },
  };
  /** @param {number} index @param {number} by */
  const moved = (index, by) => {
    const next = [...steps];
    next.splice(index + by, 0, ...next.splice(index, 1));
    set(next);
  };
  return html`
    <div class="chain" role="group" aria-labelledby=${heading}>
      <h2 id=${heading}>Processing steps</h2>
      <ol>${steps.map(({ name, id }, index) => html`<li key=${id} aria-label=${t("Step {number}, {name}", { number: index + 1, name })}>
        <div class="toolbar"><strong>${name}</strong>
          <${Button} kind="quiet" aria-label=${t("Move {name} earlier", { name })} disabled=${!index} onClick=${() => moved(index, -1)}>\u2191<//>
          <${Button} kind="quiet" aria-label=${t("Move {name} later", { name })} disabled=${index === steps.length - 1} onClick=${() => moved(index, 1)}>\u2193<//>
          <${Button} kind="quiet" aria-label=${t("Remove {name}", { name })} onClick=${() => set(steps.filter((_, k) => k !== index))}>remove<//>
        </div>
        <p class="field-help">${sentence(stepFacts[name].description)}</p>
        <div class="fields">
          ${stepFacts[name].single_key && html`<${Choice} label="parameter" value=${by(index)} options=${Object.keys(stepFacts[name].keys).map((key) => [key, key])} />`}
          ${keysOf(steps[index], stepFacts[name]).map(([key, facts]) => html`<${KeyField} key=${key} name=${key}
            facts=${key === "stations" ? { ...facts, choices: stations.map((station) => station.name) } : facts} value=${keyed(index, key)} />`)}
        </div>
        ${faulty?.index === index && html`<${Note} kind="error" role="alert" text=${faulty?.text} />`}
      </li>`)}</ol>
      <${Choice} label="Add a step" value=${added}
        options=${[["", "\u2013"], ...Object.entries(stepFacts).map(([name, { description: text }]) => [name, `${name}: ${t(text)}`])]} />
    </div>`;
};

// All keys of a step; of a step with a single key, the selected key.
/** @param {{ keys: object }} step @param {Server.StepFacts} facts */
const keysOf = ({ keys }, { single_key: single, keys: facts }) => {
  const all = Object.entries(facts);
  return single ? [all.find(([key]) => key in keys) ?? all[0]] : all;
};

/** @param {{ app: App, form: Form, questions: Questions }} props */
const Target = ({ app, form, questions }) => {
  const { code } = form.value;
  const codes = Object.entries(app.info.targets).map(([name, { description: text }]) => [name, `${name}: ${t(text)}`]);
  return html`
    <${Choice} label="Target spectrum" value=${form.at("code")} options=${[...codes, ["file", "a file (CSV) of periods and accelerations"]]} />
    ${code === "file" ? html`<${FileDrop} label="Drop the spectrum here, or" name="curve" accept=".csv" files=${form.at("curve")} questions=${questions} app=${app}
      help="First line: column names with units, T [s], Sa [g]." />`
      : html`<div class="fields">${Object.entries(app.info.targets[code].keys).map(([key, facts]) => html`<${KeyField} key=${`${code}.${key}`} name=${key}
        facts=${facts} value=${form.at("of", code, key)} />`)}</div>`}
    <div class="fields">${["count", "periods"].map((name) => html`<${KeyField} key=${name} name=${name}
      facts=${app.info.keys.motions[name]} value=${form.at("set", name)} />`)}</div>`;
};

/** @param {SentFile[]} files @param {string} [folder] */
const shas = (files, folder = "") => Object.fromEntries(files.map((file) => [`${folder}${file.name}`, file.sha]));

/** @param {any} form @param {App} app @param {SentFile} record */
const oneOf = ({ files, steps, motion, by_file: byFile }, app, record) => ({
  tables: { motion: { record: record.name, ...filled({ ...motion, ...byFile[record.name] }, app.info.keys.motion), ...processOf(steps) } },
  files: shas([record, ...files.filter(isStations)]),
  name: t("{name}, before and after", { name: record.name }),
});

/** @param {any} form @param {App} app @param {string} shown */
const setOf = ({ files, curve, steps, motion, by_file: byFile, set, of, code, list }, app, shown) => {
  const records = files.filter((/** @type {SentFile} */ file) => !isStations(file));
  const { component, ...keys } = motion;
  const { mirrored, ...chosen } = filled(set, app.info.keys.motions);
  const spectrum = `${code}:${Object.entries(of[code] ?? {}).filter(([, text]) => text.trim()).map(([key, text]) => `${key}=${written(text)}`).join(",")}`;
  /** @type {{ target?: string }} */
  const selection = shown === "target" ? { target: code === "file" ? curve[0].name : spectrum, ...chosen } : {};
  const named = records.some((/** @type {SentFile} */ { name }) => name === list) ? `records/${list}` : "records";
  return {
    tables: { motions: [{ records: [named], ...filled(keys, app.info.keys.motions), ...optionsOf(byFile, records, app),
      ...processOf(steps), ...selection, ...(mirrored ? { mirrored } : {}) }] },
    files: { ...shas(records, "records/"), ...shas(files.filter(isStations)), ...shas(shown === "target" && code === "file" ? curve : []) },
    name: selection.target ? t(["{count} record for {target}", "{count} records for {target}"], { count: records.length, target: selection.target })
      : t(["{count} record", "{count} records"], { count: records.length }),
  };
};

/** @param {RecordStep[]} steps */
const processOf = (steps) => (steps.length ? { process: chainOf(steps) } : {});

/** @param {Given} props */
const Answer = (props) => (props.question.command === "record convert" ? html`<${Corrected} ...${props} />` : html`<${Chosen} ...${props} />`);

const HEAD = [["samples", "samples"], ["time_step", "step [s]"], ["peak_ground_acceleration", "PGA [m/s\u00b2]"], ["peak_ground_velocity", "PGV [m/s]"],
  ["peak_ground_displacement", "PGD [m]"], ["end_velocity", "final velocity [m/s]"]];

/** @param {Given} given */
const Corrected = ({ answer, question, questions }) => {
  const doubts = ["before", "after"].flatMap((when) => answer[when].warnings.map((/** @type {string} */ warning) => `${t(when)}: ${t(warning)}`));
  const header = Object.entries(answer.metadata).filter(([key]) => key !== "header");
  return html`
    <p class="verdict" data-testid="verdict">${t("{name}: PGA {before} g before, {after} g after.", {
      name: answer.name, before: number(answer.before.peak_ground_acceleration / G, 4), after: number(answer.after.peak_ground_acceleration / G, 4) })}</p>
    ${doubts.map((doubt) => html`<${Note} kind="warning" key=${doubt} text=${sentence(doubt)} />`)}
    <${Drawing} question=${question} alt="Acceleration, velocity, displacement, Fourier amplitudes and response spectrum, before and after" />
    <div class="toolbar"><${Button} kind="primary" onClick=${() => use(questions, question)}>Use as motion<//></div>
    <${Rows} caption="Before and after" head=${["record", ...HEAD.map(([, label]) => label)]} rows=${["before", "after"].map((when) =>
      [when, ...HEAD.map(([key]) => (key === "samples" ? String(answer[when][key]) : number(answer[when][key])))])} />
    <h3>Processing</h3>
    <ul aria-label="Processing">${answer.provenance.map((/** @type {string} */ step) => html`<li key=${step} class="provenance">${step}</li>`)}</ul>
    <details><summary>File header</summary>
      <dl class="facts">${header.map(([key, text]) => html`<dt key=${key}>${key}</dt><dd>${text}</dd>`)}</dl>
      ${answer.metadata.header && html`<pre tabindex="0">${answer.metadata.header}</pre>`}
    </details>`;
};

/** Store the corrected record as a new record, and use it as the motion.
 * @param {Questions} questions @param {Server.WholeQuestion} question */
const use = async ({ app }, question) => {
  try {
    const name = `${question.name.split(",")[0].replace(/\.\w+$/, "")}-corrected.csv`;
    const sent = async () => app.call("records", { method: "POST", body: await fetchFile(`questions/${question.id}/record.csv`), query: { name } });
    const kept = await app.project.within(sent());
    app.inputs.set("response.initial_rotation", undefined);
    app.inputs.set("motion", { record: kept.record, file_name: kept.file_name });
    app.say(t("{name} is the motion of this project.", { name: kept.file_name }));
  } catch (error) {
    app.say(error.message, "error");
  }
};

/** @type {[string, string, number][]} */
const SHOWN = [["pga", "PGA [g]", 1 / G], ["pgv", "PGV [m/s]", 1], ["arias", "Arias [m/s]", 1], ["d5_95", "D5-95 [s]", 1]];

/** @param {Given} given */
const Chosen = ({ answer, question }) => {
  const { records, selection, left_out: left } = answer;
  const scaled = selection && selection.scale.length === records.length;
  const rows = records.map((/** @type {any} */ row, /** @type {number} */ k) => {
    const seen = ["x", "y", "z"].filter((axis) => row[`pga_${axis}`] !== null);
    const lead = [...seen].sort((a, b) => Number(a === "z") - Number(b === "z") || row[`pga_${b}`] - row[`pga_${a}`])[0];
    return [row.record, ...(scaled ? [number(selection.scale[k], 3), number(selection.misfit[k], 2)] : []),
      ...SHOWN.map(([key, , size]) => number(row[`${key}_${lead}`] * size, 4)), seen.join(" ")];
  });
  return html`
    <p class="verdict" data-testid="verdict">${selection ? sentence(selection.sentence) : left.length
      ? t("{count} records, {left} files ignored.", { count: records.length, left: left.length }) : t(["{count} record.", "{count} records."], { count: records.length })}</p>
    <${Drawing} question=${question} alt=${selection ? "Spectra of the scaled records, their mean and the target" : "Spectra of the records"} />
    <${Rows} caption="Records" rows=${rows}
      head=${["record", ...(scaled ? ["factor", "misfit"] : []), ...SHOWN.map(([, text]) => text), "components"]} />
    <p class="field-help">The table shows the component with the largest peak. The files contain all components and their spectra.</p>
    ${records.some((/** @type {any} */ row) => row.doubts) && html`<h3>Warnings</h3><${Rows} caption="Warnings" head=${["record", "warning"]}
      rows=${records.filter((/** @type {any} */ row) => row.doubts).map((/** @type {any} */ row) => [row.record, row.doubts])} />`}
    ${left.length > 0 && html`<h3>Ignored files</h3><${Rows} caption="Ignored files" head=${["file", "reason"]}
      rows=${left.map((/** @type {any} */ file) => [file.file, whyLeftOut(file)])} />`}`;
};
