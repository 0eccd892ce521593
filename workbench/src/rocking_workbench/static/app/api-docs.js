/** Page of the API: shows the schema of the server, with calls to copy. */

import { html, render, useSignal } from "/parts/preact.js";
import { call } from "/app/api.js";
import { errorForm, errorsOf, fieldsOf, formsOf, groupsOf, operationsOf } from "/app/api-schema.js";
import { snippetsOf } from "/app/api-snippets.js";
import { fill } from "/app/dom.js";
import { say } from "/app/say.js";
import { Button, Note, Segmented } from "/parts/fields.js";

/** @typedef {import("/app/api-schema.js").Operation} Operation @typedef {import("/app/api-schema.js").Row} Row */

const HEADS = ["Name", "Type", "Required", "Meaning"];
const TOLD = ["Name", "Type", "Always", "Meaning"];
const LONG = 12;

/** @param {any} page @param {Element} element */
const show = (page, element) => {
  fill(element);
  render(page, element);
};

const start = async () => {
  const schema = /** @type {any} */ (await call("openapi.json"));
  const operations = operationsOf(schema);
  const groups = groupsOf(operations);
  show(groups.map(([name, list]) => html`
    <h2>${name}</h2><ul>${list.map((operation) => html`<li><a href=${`#${operation.id}`}><${Sign} ...${operation} />${operation.path}</a></li>`)}</ul>`),
  document.getElementById("contents"));
  show(html`<${Introduction} schema=${schema} count=${operations.length} /><${Errors} schema=${schema} />
    ${groups.map(([name, list]) => html`<h2>${name}</h2>${list.map((operation) => html`<${Endpoint} schema=${schema} operation=${operation} />`)}`)}`,
  document.getElementById("main"));
  if (location.hash) document.getElementById(location.hash.slice(1))?.scrollIntoView();
};

/** @param {{ schema: any, count: number }} props */
const Introduction = ({ schema, count }) => html`
  <section class="card" aria-label="About">
    <h1>${`${schema.info.title} ${schema.info.version}: ${count} endpoints`}</h1>
    <${Paragraphs} text=${schema.info.description} kind="lead" />
    <p class="lead">The schema itself: <a href="/api/openapi.json">/api/openapi.json</a></p></section>`;

/** @param {{ schema: any }} props */
const Errors = ({ schema }) => html`
  <section class="card" id="errors" data-testid="api-errors" aria-label="Errors"><h2>Errors</h2>
    <dl class="api-errors">${errorsOf(schema).map(([status, meaning]) => html`<dt>${status}</dt><dd>${meaning}</dd>`)}</dl>
    <${Fields} title="Response" rows=${errorForm(schema)} heads=${TOLD} /></section>`;

/** @param {{ text: string, kind: string }} props */
const Paragraphs = ({ text, kind }) => text.split(/\n\s*\n/).map((paragraph) => html`
  <p class=${kind}>${paragraph.replace(/\s*\n\s*/g, " ").split("`").map((segment, k) => (k % 2 ? html`<code>${segment}</code>` : segment))}</p>`);

/** @param {{ schema: any, operation: Operation }} props */
const Endpoint = ({ schema, operation }) => {
  const { id, method, path, summary, about, kind, files } = operation;
  return html`
    <section class="card api-card" id=${id} data-testid="endpoint" aria-label=${`${method} ${path}`}>
      <div class="api-head"><${Sign} method=${method} /><span class="api-path">${path}</span></div>
      ${summary && html`<p><strong>${summary}</strong></p>`}
      ${about && html`<${Paragraphs} text=${about} kind="api-about" />`}
      <${Fields} title="Path and query" rows=${operation.parameters.map(parameterOf)} />
      <${Fields} title="Request body" rows=${fieldsOf(schema, operation.body)} />
      ${kind === "file" && html`<p>A file is sent as application/octet-stream.</p>`}
      ${formsOf(schema, operation.answer).map(({ description: text, rows }) => html`<${Fields} title=${comesBack(text)} rows=${rows} heads=${TOLD} />`)}
      ${files.length > 0 && html`<p>${`Response: a file, ${files.join(" or ")}.`}</p>`}
      <${Calls} operation=${operation} /></section>`;
};

/** @param {{ method: string }} props */
const Sign = ({ method }) => html`<span class="api-method" data-method=${method}>${method.toUpperCase()}</span>`;

/** @param {string} text */
const comesBack = (text) => (text ? `Response: ${text[0].toLowerCase()}${text.slice(1)}` : "Response");

/** @param {Operation["parameters"][number]} parameter */
const parameterOf = ({ name, schema, required = false, description }) => ({
  name, required, about: description ?? schema?.description ?? "",
  type: schema?.enum?.join(", ") ?? schema?.type ?? schema?.anyOf?.[0]?.type ?? "text",
});

/** @param {{ title: string, rows: Row[], heads?: string[] }} props */
const Fields = ({ title, rows, heads = HEADS }) => {
  if (!rows.length) return null;
  const table = html`
    <div class="api-scroll" tabindex="0" role="region" aria-label=${title}><table class="api-fields">
      <thead><tr>${heads.map((word) => html`<th scope="col">${word}</th>`)}</tr></thead>
      <tbody>${rows.map(({ name, type, required, about }) => html`
        <tr><th scope="row"><code>${name}</code></th><td>${type}</td><td>${required && "yes"}</td><td>${about}</td></tr>`)}</tbody>
    </table></div>`;
  return rows.length <= LONG ? html`<div><h3>${title}</h3>${table}</div>`
    : html`<details><summary>${`${title}: ${rows.length} fields`}</summary>${table}</details>`;
};

/** @param {{ operation: Operation }} props */
const Calls = ({ operation }) => {
  const snippets = snippetsOf(operation, location.origin);
  const chosen = useSignal("curl");
  const { code } = snippets.find(({ value }) => value === chosen.value) ?? snippets[0];
  return html`
    <details data-testid="calls"><summary>Example call</summary>
      <${Segmented} label="Language of the example" options=${snippets.map(({ value, text }) => [value, text])} value=${chosen} />
      <div class="api-code"><pre tabindex="0"><code>${code}</code></pre>
        <${Button} kind="quiet" aria-label=${`Copy the call of ${operation.path}`} onClick=${() => copied(code)}>Copy<//></div></details>`;
};

/** @param {string} text */
const copied = async (text) => {
  try {
    await navigator.clipboard.writeText(text);
    say("Copied.");
  } catch {
    say("This browser blocks copying. Select the text and copy it.", "warning");
  }
};

document.getElementById("theme").addEventListener("click", () => {
  document.dispatchEvent(new CustomEvent("rocking:toggle-theme"));
});

start().catch((error) => show(html`<${Note} kind="error" text=${error.message} />`, document.getElementById("main")));
