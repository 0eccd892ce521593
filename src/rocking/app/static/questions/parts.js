/** What every view of a question is made of: fields, its progress, its files, and earlier ones. */

import { html, signal, useEffect, useRef } from "/parts/preact.js";
import { freshId } from "/app/dom.js";
import { parseNumber, pretty } from "/app/format.js";
import { changedAt, keep, stored } from "/app/inputs.js";

/** A signal that lives as long as its component. */
export const useSignal = (first) => useRef(signal(first)).current;

/** The fields of a form that outlasts a reload; `form.at(...path)` is a signal of one of them. */
export const useForm = (key, first) => {
  const form = useRef(null);
  if (!form.current) {
    const all = signal({ ...first, ...stored(key) });
    all.at = (...path) => ({
      get value() { return path.reduce((tree, name) => tree?.[name], all.value) ?? ""; },
      set value(next) {
        all.value = changedAt(all.value, path, next);
        keep(key, all.value);
      },
    });
    form.current = all;
  }
  return form.current;
};

/** A labelled field; `kind` is the type of the input. */
export const Field = ({ label, unit, help, value, kind = "text", error, ...more }) => {
  const id = useRef(freshId("field")).current;
  const words = error || help;
  return html`
    <div class="field">
      <div class="field-head"><label for=${id}>${label}${unit && html` <span class="unit">${unit}</span>`}</label></div>
      <input id=${id} type=${kind} autocomplete="off" aria-describedby=${`${id}-about`} aria-invalid=${error ? "true" : null}
        value=${value?.value} onInput=${(event) => value && (value.value = event.target.value)} ...${more} />
      <p id=${`${id}-about`} class=${`field-help ${error ? "field-error" : ""}`}>${words}</p>
    </div>`;
};

/** A choice of one; chosen: what it is while nothing was chosen. */
export const Choice = ({ label, help, value, chosen, options }) => {
  const id = useRef(freshId("choice")).current;
  return html`
    <div class="field">
      <div class="field-head"><label for=${id}>${label}</label></div>
      <select id=${id} aria-describedby=${`${id}-about`} value=${chosen ?? value.value}
        onChange=${({ target }) => { value.value = target.value; target.value = value.value; }}>
        ${options.map(([key, text]) => html`<option key=${key} value=${key}>${text}</option>`)}
      </select>
      <p id=${`${id}-about`} class="field-help">${help}</p>
    </div>`;
};

const YES = { true: "yes", false: "no" };

/** A field of a key, with the unit, the words and the choices of its description. */
export const KeyField = ({ name, facts, ...more }) => {
  const label = name.replaceAll("_", " ");
  if (!facts.choices.length) {
    return html`<${Field} label=${label} unit=${pretty(facts.unit.replace(/^-$/, ""))} help=${sentence(facts.words)}
      placeholder=${facts.usual} ...${more} />`;
  }
  const others = facts.choices.filter((word) => word !== facts.usual).map((word) => [word, YES[word] ?? word]);
  return html`<${Choice} label=${label} help=${sentence(facts.words)} ...${more}
    options=${[["", YES[facts.usual] ?? (facts.usual || "\u2013")], ...others]} />`;
};

/** The keys that were filled in, as a table has them; what is no number is left for the server to refuse. */
export const filled = (texts, known) => Object.fromEntries(Object.entries(texts).filter(([, text]) => text.trim()).map(
  ([key, text]) => [key, valueOf(text.trim(), known[key].kind)],
));
const valueOf = (text, kind) => {
  if (kind === "true or false") return text === "true";
  if (kind === "any") return numbersOf(text.replace(/^\[(.*)\]$/, "$1")) ?? text;
  if (!kind.includes("number")) return text;
  if (!kind.startsWith("list")) return parseNumber(text) ?? text;
  return partsOf(text).map((part) => parseNumber(part) ?? part);
};
const partsOf = (text) => {
  const parts = text.trim().split(/\s*;\s*|,\s+|\s+/);
  return parts.length > 1 ? parts : text.split(",");
};
// One number, or several; null where something is none.
const numbersOf = (text) => {
  const found = parseNumber(text) ?? partsOf(text).map(parseNumber);
  return Array.isArray(found) && found.includes(null) ? null : found;
};

/** The endings of record files of every format, and of what they come in. */
export const recordEndings = ({ info }) => [
  ...new Set([...info.formats.flatMap(({ suffixes }) => suffixes), ".txt", ".csv", ".dat", ".zip", ".bbp", ".xml"]),
].join(",");

/** Files by dropping or choosing; `files` is a signal of what was sent. */
export const FileDrop = ({ label, help, accept, files, many = false, questions, app }) => {
  const input = useRef(null);
  const over = useSignal(false);
  const folder = useRef(null);
  const sending = useSignal("");
  const take = async (list) => {
    const chosen = many ? [...list] : [...list].slice(0, 1);
    let sent = [];
    try {
      for (let k = 0; k < chosen.length; k += AT_ONCE) {
        if (chosen.length > AT_ONCE) sending.value = `Sending ${k + 1} of ${chosen.length}`;
        sent = [...sent, ...await Promise.all(chosen.slice(k, k + AT_ONCE).map((file) => questions.send(file)))];
      }
      const all = many ? [...(files.value || []), ...sent] : sent;
      // two files of one name are two files
      const named = all.map((one, k) => (all.slice(0, k).some((each) => each.name === one.name && each.sha !== one.sha)
        ? { ...one, name: `${one.sha.slice(0, 8)}-${one.name}` } : one));
      files.value = named.filter((one, k) => named.findIndex((each) => each.sha === one.sha) === k);
    } catch (error) {
      app.say(error.message, "error");
    }
    sending.value = "";
  };
  const drop = (event) => {
    event.preventDefault();
    over.value = false;
    const entries = [...event.dataTransfer.items].map((item) => item.webkitGetAsEntry?.()).filter(Boolean);
    if (many && entries.some((entry) => entry.isDirectory)) return inFolders(entries).then(take);
    return take([...event.dataTransfer.files]);
  };
  const mark = (on) => (event) => {
    event.preventDefault();
    over.value = on;
  };
  return html`
    <div class=${`drop ${over.value ? "over" : ""}`} onDragOver=${mark(true)} onDragLeave=${mark(false)} onDrop=${drop}>
      <p>${label}</p>
      <div class="toolbar">
        <button type="button" class="button" onClick=${() => input.current.click()}>Choose ${many ? "files" : "a file"}</button>
        ${many && html`<button type="button" class="button" onClick=${() => folder.current.click()}>Choose a folder</button>
          <input ref=${folder} class="visually-hidden" type="file" tabindex="-1" aria-label="A folder" webkitdirectory
            onChange=${(event) => { take([...event.target.files]); event.target.value = ""; }} />`}
      </div>
      <input ref=${input} class="visually-hidden" type="file" tabindex="-1" aria-label=${label} accept=${accept}
        multiple=${many} onChange=${(event) => { take([...event.target.files]); event.target.value = ""; }} />
      <p class="field-help">${help}</p>
      <p class="field-help" role="status">${sending.value}</p>
      ${files.value.length > 0 && html`<ul class="sent" aria-label="Files">
        ${files.value.map((one) => html`<li key=${one.sha}>${one.name}
          <button type="button" class="button quiet" aria-label=${`Leave out ${one.name}`}
            onClick=${() => (files.value = files.value.filter((each) => each !== one))}>leave out</button></li>`)}
      </ul>`}
    </div>`;
};

const AT_ONCE = 6; // files that are sent beside one another

// All files of what was dropped, of folders those in them, which browsers give in pieces.
const inFolders = async (entries) => (await Promise.all(entries.map(async (entry) => {
  if (entry.isFile) return new Promise((resolve, reject) => entry.file(resolve, reject));
  const reader = entry.createReader();
  const inside = async () => {
    const some = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
    return some.length ? [...await inFolders(some), ...await inside()] : [];
  };
  return inside();
}))).flat();

// What stands of a question: being answered, refused, or its answer.
const Outcome = ({ questions, answer: Answer }) => {
  const question = questions.shown.value;
  const heading = useRef(null);
  const done = question?.state === "done";
  useEffect(() => {
    const typing = document.activeElement?.matches("input, textarea, select");
    if (done && !typing) heading.current?.focus();
  }, [done, question?.id]);
  if (!question) return null;
  return html`
    <section class="card question" aria-labelledby="outcome-title" data-testid="outcome" data-state=${question.state}>
      <h2 id="outcome-title" ref=${heading} tabindex="-1">${question.name}</h2>
      ${questions.busy.value && html`<${Waiting} questions=${questions} question=${question} />`}
      ${question.state === "refused" && html`<${Wrong} words=${sentence(question.message)} />
        <${Drawing} question=${question} alt="What was found all the same" />`}
      ${question.state === "stopped" && html`<p class="note info"><span class="sign" aria-hidden="true">i</span>
        <span>It was stopped.</span></p>`}
      ${done && question.answer && html`<${Answer} answer=${question.answer} question=${question}
        questions=${questions} />`}
      ${done && html`<${Files} questions=${questions} question=${question} />`}
    </section>`;
};

/** Words as a sentence. */
export const sentence = (words) => `${words.slice(0, 1).toUpperCase()}${words.slice(1)}${/[.!?]$/.test(words) ? "" : "."}`;

const Waiting = ({ questions, question }) => html`
  <div class="waiting-line" role="status">
    <progress aria-label="Being answered"></progress>
    <span>${question.state === "waiting" ? "in line" : "being computed"}</span>
    <button type="button" class="button" onClick=${questions.stop}>Stop</button>
  </div>`;

const WORDS = {
  pdf: "Report (PDF)", html: "Report (web page)", svg: "Picture (SVG)", xlsx: "Excel", csv: "CSV", json: "What was done (JSON)", glb: "3D (glTF)",
  "results.json": "All numbers (JSON)",
};
const wordsOf = (name) => {
  const ending = name.split(".").at(-1);
  return name.startsWith("record.") ? `Record (${ending.toUpperCase()})` : WORDS[name] ?? WORDS[ending];
};

const Files = ({ questions, question }) => html`
  <div class="toolbar" role="group" aria-label="Take away">
    ${question.files.map((name) => html`<button type="button" class="button" key=${name} onClick=${() => questions.take(name)}>
      ${wordsOf(name)}</button>`)}
  </div>
  <details><summary>The same on the command line</summary>
    ${!question.toml.trim() ? html`<pre tabindex="0">rocking ${question.command} --out ${question.command}</pre>` : html`
    <p class="field-help">Save it as question.toml, its files beside it${question.command === "motions" && " and the records in a folder records"}:</p>
    <pre tabindex="0">rocking ${question.command} question.toml${question.format && ` --out ${question.format}=${question.files.at(-1)}`}</pre><pre tabindex="0">${question.toml}</pre>`}
  </details>`;

/** The picture of an answer, if it has one. */
export const Drawing = ({ question, alt }) => question.files.includes("picture.svg")
  && html`<img class="drawing" src=${`/api/questions/${question.id}/picture.svg`} alt=${alt} />`;

/** A table; cells are text, or `[text, kind]`: the colour of a light, or "own" of a first cell in the user's words. */
export const Rows = ({ caption, head, rows }) => html`
  <div class="table-scroll" tabindex="0" role="region" aria-label=${caption}>
    <table><caption class="visually-hidden">${caption}</caption>
      <thead><tr>${head.map((words) => html`<th scope="col" key=${words}>${words}</th>`)}</tr></thead>
      <tbody>${rows.map((row, k) => html`<tr key=${k}>
        ${row.map((cell, j) => {
          const [text, kind] = Array.isArray(cell) ? cell : [cell, null];
          return j ? html`<td class=${kind ? `light ${kind}` : null}>${text}</td>`
            : html`<th scope="row" translate=${kind !== "own"}>${text}</th>`;
        })}</tr>`)}
      </tbody>
    </table>
  </div>`;

// Earlier questions of the project.
const Earlier = ({ questions }) => questions.all.value.length > 0 && html`
  <section class="card" aria-labelledby="earlier-title">
    <h2 id="earlier-title">Asked before</h2>
    <ul class="project-list" aria-label="Asked before">
      ${questions.all.value.map((one) => html`<li key=${one.id}>
        <p><strong>${one.name}</strong><span class="quiet">${new Date(one.asked).toLocaleString()}, ${one.state}</span></p>
        <div class="toolbar">
          <button type="button" class="button" aria-label=${`Show ${one.name}`} onClick=${() => questions.open(one.id)}>Show</button>
          <button type="button" class="button" aria-label=${`Delete ${one.name}`} onClick=${() => questions.remove(one.id)}>Delete</button>
        </div></li>`)}
    </ul>
  </section>`;

/** A view of a question: what is asked, what was asked before, and what was found, which `answer` shows. */
export const QuestionView = ({ title, lead, questions, wrong, onSubmit, answer, children }) => html`
  <header class="view-head"><h1>${title}</h1><p class="lead">${lead}</p></header>
  <div class="columns narrow-wide">
    <div class="asked">
      <form class="card" onSubmit=${onSubmit} aria-label="What is asked">
        ${children}
        ${wrong && html`<${Wrong} words=${wrong} />`}
        <button type="submit" class="button primary" disabled=${questions.busy.value}>Ask</button>
      </form>
      <${Earlier} questions=${questions} />
    </div>
    <${Outcome} questions=${questions} answer=${answer} />
  </div>`;

/** What is wrong. */
export const Wrong = ({ words }) => html`
  <p class="note error" role="alert"><span class="sign" aria-hidden="true">\u2715</span><span>${words}</span></p>`;
