/** The page of the API: reads the server's own schema and shows it, with calls to copy. */

import { call } from "/app/api.js";
import { errorForm, errorsOf, fieldsOf, formsOf, groupsOf, operationsOf } from "/app/api-schema.js";
import { snippetsOf } from "/app/api-snippets.js";
import { button, note, segmented } from "/app/controls.js";
import { el, fill } from "/app/dom.js";
import { say } from "/app/say.js";

const HEADS = ["Name", "Type", "Needed", "Meaning"];
const TOLD = ["Name", "Type", "Always", "Meaning"];

const start = async () => {
  const schema = await call("openapi.json");
  const operations = operationsOf(schema);
  const groups = groupsOf(operations);
  fill(document.getElementById("contents"), groups.map(([name, list]) => [
    el("h2", {}, name),
    el("ul", {}, list.map((each) => el("li", {}, el("a", { href: `#${each.id}` }, sign(each), each.path)))),
  ]));
  fill(document.getElementById("main"), introduction(schema, operations.length), errors(schema),
    groups.map(([name, list]) => [el("h2", {}, name), list.map((each) => cardOf(schema, each))]));
  if (location.hash) document.getElementById(location.hash.slice(1))?.scrollIntoView();
};

const introduction = (schema, count) =>
  el("section", { class: "card", "aria-label": "About" },
    el("h1", {}, `${schema.info.title} ${schema.info.version}: ${count} endpoints`),
    paragraphs(schema.info.description, "lead"),
    el("p", { class: "lead" }, "The schema itself: ",
      el("a", { href: "/api/openapi.json" }, "/api/openapi.json")));

const comesBack = (words) =>
  words ? `What comes back: ${words[0].toLowerCase()}${words.slice(1)}` : "What comes back";

const errors = (schema) =>
  el("section", { class: "card", id: "errors", "data-testid": "api-errors", "aria-label": "Errors" },
    el("h2", {}, "Errors, the same everywhere"),
    el("dl", { class: "api-errors" }, errorsOf(schema).map(([status, words]) => [
      el("dt", {}, status), el("dd", {}, words)])),
    tableOf("What comes back", errorForm(schema), TOLD));

const paragraphs = (text, kind) =>
  text.split(/\n\s*\n/).map((part) => el("p", { class: kind }, coded(part.replace(/\s*\n\s*/g, " "))));

const coded = (text) => text.split("`").map((part, index) => (index % 2 ? el("code", {}, part) : part));

const cardOf = (schema, operation) =>
  el("section", {
    class: "card api-card", id: operation.id, "data-testid": "endpoint",
    "aria-label": `${operation.method} ${operation.path}`,
  },
    el("div", { class: "api-head" }, sign(operation), el("span", { class: "api-path" }, operation.path)),
    operation.summary ? el("p", {}, el("strong", {}, operation.summary)) : null,
    operation.about ? paragraphs(operation.about, "api-about") : null,
    parametersOf(operation),
    tableOf("What is sent", fieldsOf(schema, operation.body)),
    operation.kind === "file" ? el("p", {}, "A file is sent as application/octet-stream.") : null,
    formsOf(schema, operation.answer).map(({ words, rows }) => tableOf(comesBack(words), rows, TOLD)),
    operation.files.length ? el("p", {}, `What comes back: a file, ${operation.files.join(" or ")}.`) : null,
    callsOf(operation));

const sign = ({ method }) => el("span", { class: "api-method", dataset: { method } }, method.toUpperCase());

const parametersOf = ({ parameters }) =>
  tableOf("In the address", parameters.map((each) => ({
    name: each.name,
    type: each.schema?.enum?.join(", ") ?? each.schema?.type ?? each.schema?.anyOf?.[0]?.type ?? "text",
    required: each.required ?? false,
    about: each.description ?? each.schema?.description ?? "",
  })));

const tableOf = (title, rows, heads = HEADS) => {
  if (!rows.length) return null;
  const table = el("table", { class: "api-fields" },
    el("thead", {}, el("tr", {}, heads.map((word) => el("th", { scope: "col" }, word)))),
    el("tbody", {}, rows.map((row) => el("tr", {},
      el("th", { scope: "row" }, el("code", {}, row.name)),
      el("td", {}, row.type), el("td", {}, row.required ? "yes" : ""), el("td", {}, row.about)))));
  const attributes = { class: "api-scroll", tabindex: "0", role: "region", "aria-label": title };
  const scroll = el("div", attributes, table);
  if (rows.length <= 12) return el("div", {}, el("h3", {}, title), scroll);
  return el("details", {}, el("summary", {}, `${title}: ${rows.length} fields`), scroll);
};

const callsOf = (operation) => {
  const snippets = snippetsOf(operation, location.origin);
  const text = el("code", {}, snippets[0].code);
  const choice = segmented({
    label: "Call it from", options: snippets, value: "curl",
    onChange: (value) => fill(text, snippets.find((each) => each.value === value).code),
  });
  const copy = button({
    text: "Copy", kind: "quiet", label: `Copy the call of ${operation.path}`,
    onClick: () => copied(text.textContent),
  });
  return el("details", { "data-testid": "calls" }, el("summary", {}, "Call it"), choice,
    el("div", { class: "api-code" }, el("pre", { tabindex: "0" }, text), copy));
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

start().catch((error) => fill(document.getElementById("main"), note(error.message, "error")));
