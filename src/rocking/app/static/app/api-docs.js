/** The page of the API: reads the server's own schema and shows it, with calls to copy. */

import { html, render, useSignal } from "/parts/preact.js";
import { call } from "/app/api.js";
import { errorForm, errorsOf, fieldsOf, formsOf, groupsOf, operationsOf } from "/app/api-schema.js";
import { snippetsOf } from "/app/api-snippets.js";
import { inPlaceOf } from "/app/failure.js";
import { say } from "/app/say.js";
import { Button, Card, Note, Segmented } from "/parts/fields.js";

const HEADS = ["Name", "Type", "Needed", "Meaning"];
const TOLD = ["Name", "Type", "Always", "Meaning"];

const start = async () => {
  const schema = await call("openapi.json");
  const operations = operationsOf(schema);
  const groups = groupsOf(operations);
  render(groups.map(([name, list]) => html`<h2>${name}</h2>
    <ul>${list.map((each) => html`<li><a href=${`#${each.id}`}><${Sign} ...${each} />${each.path}</a></li>`)}</ul>`), document.getElementById("contents"));
  const main = document.getElementById("main");
  main.replaceChildren();
  render(html`
    <section class="card" aria-label="About">
      <h1>${`${schema.info.title} ${schema.info.version}: ${operations.length} endpoints`}</h1>
      <${Paragraphs} text=${schema.info.description} kind="lead" />
      <p class="lead">The schema itself: <a href="/api/openapi.json">/api/openapi.json</a></p></section>
    <${Card} title="Errors, the same everywhere" id="errors" data-testid="api-errors">
      <dl class="api-errors">${errorsOf(schema).map(([status, words]) => html`<dt>${status}</dt><dd>${words}</dd>`)}</dl>
      <${Fields} title="What comes back" rows=${errorForm(schema)} heads=${TOLD} /><//>
    ${groups.map(([name, list]) => html`<h2>${name}</h2>${list.map((each) => html`<${Endpoint} schema=${schema} operation=${each} />`)}`)}`, main);
  if (location.hash) document.getElementById(location.hash.slice(1))?.scrollIntoView();
};

const comesBack = (words) =>
  words ? `What comes back: ${words[0].toLowerCase()}${words.slice(1)}` : "What comes back";

const Paragraphs = ({ text, kind }) => text.split(/\n\s*\n/).map((part) => html`
  <p class=${kind}>${part.replace(/\s*\n\s*/g, " ").split("`").map((words, k) => (k % 2 ? html`<code>${words}</code>` : words))}</p>`);

const Sign = ({ method }) => html`<span class="api-method" data-method=${method}>${method.toUpperCase()}</span>`;

const Endpoint = ({ schema, operation }) => html`
  <section class="card api-card" id=${operation.id} data-testid="endpoint" aria-label=${`${operation.method} ${operation.path}`}>
    <div class="api-head"><${Sign} ...${operation} /><span class="api-path">${operation.path}</span></div>
    ${operation.summary && html`<p><strong>${operation.summary}</strong></p>`}
    ${operation.about && html`<${Paragraphs} text=${operation.about} kind="api-about" />`}
    <${Fields} title="In the address" rows=${operation.parameters.map(parameterOf)} />
    <${Fields} title="What is sent" rows=${fieldsOf(schema, operation.body)} />
    ${operation.kind === "file" && html`<p>A file is sent as application/octet-stream.</p>`}
    ${formsOf(schema, operation.answer).map(({ words, rows }) => html`<${Fields} title=${comesBack(words)} rows=${rows} heads=${TOLD} />`)}
    ${operation.files.length > 0 && html`<p>${`What comes back: a file, ${operation.files.join(" or ")}.`}</p>`}
    <${Calls} operation=${operation} />
  </section>`;

const parameterOf = (each) => ({
  name: each.name,
  type: each.schema?.enum?.join(", ") ?? each.schema?.type ?? each.schema?.anyOf?.[0]?.type ?? "text",
  required: each.required ?? false,
  about: each.description ?? each.schema?.description ?? "",
});

const Fields = ({ title, rows, heads = HEADS }) => {
  const table = html`<div class="api-scroll" tabindex="0" role="region" aria-label=${title}><table class="api-fields">
    <thead><tr>${heads.map((word) => html`<th scope="col">${word}</th>`)}</tr></thead>
    <tbody>${rows.map((row) => html`<tr><th scope="row"><code>${row.name}</code></th><td>${row.type}</td>
      <td>${row.required ? "yes" : ""}</td><td>${row.about}</td></tr>`)}</tbody></table></div>`;
  if (!rows.length) return null;
  if (rows.length <= 12) return html`<div><h3>${title}</h3>${table}</div>`;
  return html`<details><summary>${`${title}: ${rows.length} fields`}</summary>${table}</details>`;
};

const Calls = ({ operation }) => {
  const snippets = snippetsOf(operation, location.origin);
  const chosen = useSignal("curl");
  const { code } = snippets.find(({ value }) => value === chosen.value);
  return html`<details data-testid="calls"><summary>Call it</summary>
    <${Segmented} label="Call it from" value=${chosen} options=${snippets.map(({ value, text }) => [value, text])} />
    <div class="api-code"><pre tabindex="0"><code>${code}</code></pre>
      <${Button} kind="quiet" aria-label=${`Copy the call of ${operation.path}`} onClick=${() => copied(code)}>Copy<//></div></details>`;
};

const copied = async (text) => {
  try {
    await navigator.clipboard.writeText(text);
    say("Copied.");
  } catch {
    say("This browser does not let the page copy; mark the text and copy it.", "warning");
  }
};

document.getElementById("theme").addEventListener("click", () => {
  document.dispatchEvent(new CustomEvent("rocking:toggle-theme"));
});

start().catch((error) => inPlaceOf(document.getElementById("main"), html`<${Note} kind="error" words=${error.message} />`));
