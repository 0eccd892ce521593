/** Parts of the views of runs: form, progress, files, previous runs. */

import { html, useEffect, useMemo, useRef, useSignal } from "/parts/preact.js";
import { parseNumber } from "/app/format.js";
import { keyOf, refusalWords } from "/app/refusal.js";
import { Fetched } from "/charts/pictured.js";
import { Drop } from "/parts/drop.js";
import { Button, Note, Refused, sentence, toWrong, useRefused } from "/parts/fields.js";
import { dateTime, t, userText } from "/app/words.js";

/** Fields of the form of a view, stored in the project; `form.at(...path)` is the signal of a field.
 * @param {App} app @param {string} view @param {{ [name: string]: any }} first @returns {Form} */
export const useForm = (app, view, first) => useRef(app.forms.of(view, first)).current;

/** Filled keys as a table; invalid numbers are left for the server to reject.
 * @param {{ [key: string]: string }} texts @param {{ [key: string]: Server.KeyFacts }} facts */
export const filled = (texts, facts) => Object.fromEntries(
  Object.entries(texts).filter(([key, text]) => facts[key] && typeof text === "string" && text.trim())
    .map(([key, text]) => [key, valueOf(text.trim(), facts[key].kind)]),
);
/** @param {string} text @param {string} kind */
const valueOf = (text, kind) => {
  if (kind === "true or false") return text === "true";
  if (kind === "any") return numbersOf(text.replace(/^\[(.*)\]$/, "$1")) ?? text;
  if (kind === "numbers") return numbersOf(text) ?? text;
  if (!kind.includes("number")) return text;
  if (!kind.startsWith("list")) return parseNumber(text) ?? text;
  return partsOf(text).map((item) => parseNumber(item) ?? item);
};
/** @param {string} text */
const apart = (text) => text.trim().split(/\s*;\s*|,\s+|\s+/);
/** @param {string} text */
const partsOf = (text) => (apart(text).length > 1 ? apart(text) : text.split(","));
// One number or several, separated by commas or blanks; null if one is not valid.
/** @param {string} text */
const numbersOf = (text) => {
  const numbers = (apart(text).length > 1 ? null : parseNumber(text)) ?? partsOf(text).map(parseNumber);
  return Array.isArray(numbers) && numbers.includes(null) ? null : numbers;
};

/** Suffixes of record files of all formats and of archives. @param {App} app */
export const recordEndings = ({ info }) => [
  ...new Set([...info.formats.flatMap(({ suffixes }) => suffixes), ".txt", ".csv", ".dat", ".zip", ".bbp", ".xml"]),
].join(",");

/** Drop area and file dialog. `files`: signal with the last uploaded file, or with all files if `adds`; `name`: key in
 * rejections.
 * @param {{ label: string, name?: string, help?: string, accept?: string, files: Signal<SentFile[]>, many?: boolean, adds?: boolean, questions: Questions, app: App }} props */
export const FileDrop = ({ files, name = "files", many = false, adds = many, questions, app, help, ...more }) => {
  const [error, changed] = useRefused(name);
  const sending = useSignal("");
  /** @param {File[]} chosen */
  const take = async (chosen) => {
    /** @type {SentFile[]} */
    let sent = [];
    changed();
    try {
      for (let k = 0; k < chosen.length; k += AT_ONCE) {
        if (chosen.length > AT_ONCE) sending.value = t("Sending {number} of {count}", { number: k + 1, count: chosen.length });
        sent = [...sent, ...await Promise.all(chosen.slice(k, k + AT_ONCE).map((file) => questions.send(file)))];
      }
      const all = adds ? [...(files.value || []), ...sent] : sent;
      // two files with one name are different files
      const named = all.map((file, k) => (all.slice(0, k).some((other) => other.name === file.name && other.sha !== file.sha)
        ? { ...file, name: `${file.sha.slice(0, 8)}-${file.name}` } : file));
      files.value = named.filter((file, k) => named.findIndex((other) => other.sha === file.sha) === k);
    } catch (error) {
      app.say(error.message, "error");
    }
    sending.value = "";
  };
  return html`
    <${Drop} many=${many} error=${error} on=${take} ...${more}>
      <p class="field-help">${help}</p>
      <p class="field-help" role="status">${sending.value}</p>
      ${files.value.length > 0 && html`<ul class="sent" aria-label="Files">
        ${files.value.map((file) => html`<li key=${file.sha}><span translate=${false}>${file.name}</span>
          <${Button} kind="quiet" aria-label=${t("Remove {name}", { name: file.name })}
            onClick=${() => (files.value = files.value.filter((other) => other !== file))}>remove<//></li>`)}
      </ul>`}<//>`;
};

const AT_ONCE = 6; // parallel uploads

/** Error of a run, as text of the page. @param {{ message: string, refusal?: any }} question */
export const reasonOf = ({ message, refusal }) => sentence(refusal ? refusalWords(refusal) : message);

// State of a run: computing, rejected, or its answer.
/** @param {{ questions: Questions, answer: any }} props */
const Outcome = ({ questions, answer: Answer }) => {
  const question = questions.shown.value;
  const [heading, refusal] = [useRef(null), useRef(null)];
  const done = question?.state === "done";
  useEffect(() => {
    if (!isTyping()) (done ? heading : refusal).current?.focus();
  }, [question?.state, question?.id]);
  if (!question) return null;
  return html`
    <section class="card question" aria-labelledby="outcome-title" data-testid="outcome" data-state=${question.state}>
      <h2 id="outcome-title" ref=${heading} tabindex="-1">${question.name}</h2>
      ${questions.busy.value && html`<${Waiting} questions=${questions} question=${question} />`}
      ${question.state === "refused" && html`
        <div ref=${refusal} tabindex="-1" role="alert"><${Note} kind="error" text=${reasonOf(question)} /></div>
        <${Drawing} question=${question} alt="Partial result" />`}
      ${question.state === "stopped" && html`<${Note} text="The run was stopped." />`}
      ${done && question.answer && html`<${Answer} answer=${question.answer} question=${question}
        questions=${questions} />`}
      ${done && html`<${Files} questions=${questions} question=${question} />`}
    </section>`;
};

/** @param {{ questions: Questions, question: Server.WholeQuestion }} props */
const Waiting = ({ questions, question }) => html`
  <div class="waiting-line" role="status">
    <progress aria-label="Computing"></progress>
    <span>${question.state === "waiting" ? "Queued" : "Computing"}</span>
    <${Button} onClick=${questions.stop}>Stop<//>
  </div>`;

/** @type {{ [name: string]: string | undefined }} */
const WORDS = {
  pdf: "Report (PDF)", html: "Report (web page)", xlsx: "Excel", csv: "CSV", json: "Provenance (JSON)", glb: "3D (glTF)",
  "results.json": "All numbers (JSON)",
};
/** @param {string} name */
const wordsOf = (name) => {
  const ending = name.replace(/^.*\./s, "");
  return name.startsWith("record.") ? t("Record ({format})", { format: ending.toUpperCase() }) : WORDS[name] ?? WORDS[ending];
};

/** @param {{ questions: Questions, question: Server.WholeQuestion }} props */
const Files = ({ questions, question }) => html`
  <div class="toolbar" role="group" aria-label="Export">
    ${question.files.filter((name) => name !== DRAWING).map((name) => html`<${Button} key=${name} onClick=${() => questions.take(name)}>
      ${wordsOf(name)}<//>`)}
  </div>
  <details><summary>Command line</summary>
    ${!question.toml.trim() ? html`<pre tabindex="0">rocking ${question.command} -o ${question.command}</pre>` : html`
    <p class="field-help">${question.command === "record batch"
      ? "Save this text as question.toml. Put its files in the same folder and the records in a folder named records:" : "Save this text as question.toml. Put its files in the same folder:"}</p>
    <pre tabindex="0">rocking ${question.command} question.toml${question.format && ` -o ${question.format}=${question.files.at(-1)}`}</pre><pre tabindex="0">${question.toml}</pre>`}
  </details>`;

/** Picture of a result, if it has one. @param {{ question: Server.WholeQuestion, alt: string }} props */
export const Drawing = ({ question, alt }) => question.files.includes(DRAWING)
  && html`<${Fetched} title=${question.name} path=${`questions/${question.id}/${DRAWING}`} alt=${alt} />`;

const DRAWING = "picture.svg";

// Previous runs of the project.
/** @param {{ questions: Questions }} props */
const Earlier = ({ questions }) => questions.all.value.length > 0 && html`
  <section class="card" aria-labelledby="earlier-title">
    <h2 id="earlier-title">Previous runs</h2>
    <ul class="project-list" aria-label="Previous runs">
      ${questions.all.value.map((question) => html`<li key=${question.id}>
        <p><strong>${question.name}</strong><span class="quiet">${dateTime(question.asked)}, ${t(question.state)}</span></p>
        <div class="toolbar">
          <${Button} aria-label=${t("Show {name}", { name: userText(question.name) })} onClick=${() => questions.open(question.id)}>Show<//>
          <${Button} aria-label=${t("Delete {name}", { name: userText(question.name) })} onClick=${() => questions.remove(question.id)}>Delete<//>
        </div></li>`)}
    </ul>
  </section>`;

/** An error of the server, for display at a field: key of the field and text of the error.
 * @param {{ message: string, refusal?: any }} refused */
export const refusedOf = (refused) => ({ key: refused.refusal ? keyOf(refused.refusal) : undefined, text: reasonOf(refused) });

/** View of a run: form, previous runs, and results shown by `answer`; wrong: error that prevents
 * the run, as a text or as {key, text} of a field.
 * @param {{ title: string, lead: string, questions: Questions, wrong: Wrong, onSubmit: (event: any) => unknown, answer: any, children: any }} props */
export const QuestionView = ({ title, lead, questions, wrong, onSubmit, answer, children }) => {
  const form = useRef(null);
  const submissions = useSignal(0);
  const { value: question } = questions.shown;
  const refused = useMemo(/** @returns {{ key?: string, text?: string }} */ () => {
    if (wrong) return typeof wrong === "string" ? { text: wrong } : wrong;
    return question?.state === "refused" && questions.isOfForm(question.id) ? refusedOf(question) : {};
  }, [submissions.value, wrong, question?.id, question?.state]);
  useEffect(() => {
    if (refused.key && submissions.value && (wrong || !isTyping())) toWrong(form.current);
  }, [refused]);
  /** @param {any} event */
  const submit = (event) => {
    submissions.value += 1;
    onSubmit(event);
  };
  return html`
    <header class="view-head"><h1>${title}</h1><p class="lead">${lead}</p></header>
    <div class="columns narrow-wide">
      <div class="asked">
        <form ref=${form} class="card" onSubmit=${submit} aria-label="Inputs">
          <${Refused.Provider} value=${refused}>${children}<//>
          ${wrong && html`<${Note} kind="error" role="alert" text=${refused.text} />`}
          <${Button} type="submit" kind="primary" disabled=${questions.busy.value}>Compute<//>
        </form>
        <${Earlier} questions=${questions} />
      </div>
      <${Outcome} questions=${questions} answer=${answer} />
    </div>`;
};

const isTyping = () => document.activeElement?.matches("input, textarea, select");
