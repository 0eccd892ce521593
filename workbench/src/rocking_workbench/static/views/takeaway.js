/** Export: all data of the inputs as files, tables, and a link. */
import { html, render, signal, useRef, useSignal } from "/parts/preact.js";
import { Button, Card, Choice, Field } from "/parts/fields.js";
import { chosenOf, labelsOf, look, pathOfChosen } from "/views/response-chosen.js";
import { wordsOf } from "/views/response-labels.js";
import { Film } from "/views/takeaway-film.js";
import { t, userText } from "/app/words.js";

/** @type {[string, string, string[], string?][]} */
const TABLES = [
  ["body", "Body", ["csv", "xlsx"]],
  ["coefficients", "Coefficients of every model", ["csv", "xlsx"]],
  ["measures", "Intensity measures", ["csv", "xlsx"], "motion"],
  ["motion", "Motion: a, v, d", ["csv", "mat", "xlsx"], "motion"],
  ["spectrum", "Response spectrum", ["csv", "xlsx"], "motion"],
  ["response", "Response, every sample", ["csv", "mat", "nc"], "response"],
  ["impacts", "Impacts", ["csv", "xlsx"], "response"],
];
/** @type {Words} */
const NAMES = {
  csv: "CSV", xlsx: "Excel", mat: "MATLAB", nc: "netCDF", html: "Web page", toml: "TOML",
  zip: "ZIP with the record", pdf: "PDF",
};

/** Files with one of several models. */
const OF_ONE = /^\/api\/(table\/response\.|animation\.)/;

/** Build the view inside its section. @param {HTMLElement} section @param {App} app */
export const mount = (section, app) => {
  const now = signal(null);
  const refresh = () => (now.value = { inputs: app.inputs.get(), link: app.link() });
  app.inputs.subscribe(refresh);
  refresh();
  render(html`<${TakeAway} app=${app} now=${now} />`, section);
  return { shown: refresh };
};

/** @param {{ app: App, now: Signal<{ inputs: Server.Inputs, link: string }> }} props */
const TakeAway = ({ app, now: { value: { inputs, link } } }) => {
  const chooser = useRef(null);
  const moves = Boolean(inputs.motion) || inputs.response?.initial_rotation != null;
  /** @type {{ [needs: string]: boolean }} */
  const there = { motion: Boolean(inputs.motion), response: moves };
  /** @param {string} path @param {string} name @param {any} [needs] @param {string} [testid] */
  const file = (path, name, needs, testid) => html`<${File} key=${path} app=${app} path=${`/api/${path}`} name=${name}
    testid=${testid ?? path.replace(/\W/g, "-")} disabled=${needs && !there[needs]} />`;
  /** @param {string} name @param {...any} files */
  const row = (name, ...files) => html`<li key=${name} class="take-row"><span>${name}</span><div class="toolbar">${files}</div></li>`;
  const labels = labelsOf(inputs.restitution);
  return html`
    <header class="view-head"><h1>Export</h1>
      <p class="lead">Inputs and results as files, as tables and as a link.</p></header>
    <div class="takeaway">
      <div class="takeaway-part">
        <${Link} app=${app} link=${link} />
        <${Card} title="Input file">
          <p class="quiet">Same numbers on the command line: rocking simulate response.toml</p>
          <div class="toolbar">${file("inputs.toml", "Inputs", null, "take-toml")}${file("inputs.zip", "Inputs", null, "take-zip")}
            <${Button} onClick=${() => chooser.current.click()}>${"Read a TOML or ZIP file \u2026"}<//></div><//>
        <${Card} title="Report">
          <p class="quiet">Body, coefficients compared with measurements, motion, response and impacts, with the source of each number.</p>
          <div class="toolbar">${file("report.pdf", "Report", "response", "take-report")}</div><//>
        <${Card} title="Pictures">
          <p class="quiet">To save a figure, open \u201cSave\u201d below the figure.</p>
          <ul>${row("Animation", file("animation.html", "Animation", "response"), html`<${Film} app=${app} aria-label="Animation as GIF"
            data-testid="animation-gif" disabled=${!moves}>GIF<//>`)}</ul><//>
      </div>
      <div class="takeaway-part"><${Card} title="Tables">
        <${Choice} label="Model in files with one model" hidden=${labels.length < 2} value=${chosenOf(labels)} on=${look}
          options=${labels.map((label) => [label, wordsOf(label)])}
          help="For the animation, and the response as CSV, MATLAB and netCDF. The file name contains the model." />
        <ul>${TABLES.map(([table, name, kinds, needs]) => row(name, kinds.map((kind) => file(`table/${table}.${kind}`, name, needs))))}</ul><//></div>
    </div>
    <input ref=${chooser} type="file" accept=".toml,.zip" hidden aria-label="File of inputs, TOML or ZIP" data-testid="read-toml"
      onChange=${({ target }) => read(app, target)} />`;
};

/** @param {{ app: App, path: string, name: string, testid: string, disabled: boolean }} props */
const File = ({ app, path, name, testid, disabled }) => {
  const busy = useSignal(false);
  const kind = path.replace(/^.*\./s, "");
  const save = async () => {
    if (busy.value) return;
    busy.value = true;
    const inputs = app.inputs.get();
    await app.download(OF_ONE.test(path) ? pathOfChosen(path, inputs.restitution) : path, inputs, `rocking.${kind}`);
    busy.value = false;
  };
  return html`<${Button} aria-label=${t("{study} as {format}", { study: userText(name), format: NAMES[kind] })} aria-busy=${busy.value ? "true" : null} disabled=${disabled}
    data-testid=${testid} onClick=${save}>${NAMES[kind]}<//>`;
};

/** @param {{ app: App, link: string }} props */
const Link = ({ app, link }) => {
  const copy = async () => {
    try {
      await navigator.clipboard.writeText(link);
      app.say("Link copied.");
    } catch {
      document.getElementById("permanent-link").focus();
      app.say("Press Ctrl+C to copy the link.");
    }
  };
  return html`<${Card} title="Link">
    <p class="quiet">The link contains all inputs and opens on any computer with rocking. It does not contain record files: send them too, or export the ZIP.</p>
    <${Field} id="permanent-link" label="Permanent link of the inputs" value=${link} readonly data-testid="permanent-link"
      onFocus=${({ target }) => target.select()} />
    <div class="toolbar"><${Button} kind="primary" onClick=${copy} data-testid="copy-link">Copy link<//></div><//>`;
};

/** @param {App} app @param {any} box */
const read = async (app, box) => {
  const [file] = box.files;
  box.value = "";
  if (!file) return;
  try {
    const inputs = await app.call("/api/inputs/read", { body: file, query: { name: file.name } });
    app.inputs.lend(inputs, t("the file {name}", { name: file.name }));
    app.say(t("The inputs of {name} are loaded.", { name: file.name }));
  } catch (error) {
    app.say(error.message, "error");
  }
};
