/** Calls of an endpoint as text to copy: curl, Python, MATLAB. Pure functions. */

/** @typedef {import("/app/api-schema.js").Operation} Operation */

const KEY_HELP = "The file api-key in the data folder contains the key. Each start writes a new key.";

/** A call in each language: [{value, text, code}]. @param {Operation} operation @param {string} origin */
export const snippetsOf = (operation, origin) => [
  { value: "curl", text: "curl", code: curl(operation, origin) },
  { value: "python", text: "Python", code: python(operation, origin) },
  { value: "matlab", text: "MATLAB", code: matlab(operation, origin) },
];

/** @param {{ path: string, query: string[] }} given @param {string} origin */
const address = ({ path, query }, origin) =>
  origin + path + (query.length ? `?${query.map((name) => `${name}=VALUE`).join("&")}` : "");

/** @param {{ kind: string | null }} given */
const type = ({ kind }) => (kind === "file" ? "application/octet-stream" : "application/json");

/** @param {Operation} operation @param {string} origin */
const curl = (operation, origin) => {
  const unsafe = operation.method !== "get";
  const lines = [
    `curl -X ${operation.method.toUpperCase()} '${address(operation, origin)}'`,
    "-H \"Authorization: Bearer $KEY\"",
    unsafe ? `-H 'Origin: ${origin}'` : null,
    operation.kind ? `-H 'Content-Type: ${type(operation)}'` : null,
    operation.kind === "json" ? `-d '${JSON.stringify(operation.example)}'` : null,
    operation.kind === "file" ? "--data-binary @FILE" : null,
    operation.download ? `-o ${operation.download}` : null,
  ].filter(Boolean);
  return `# ${KEY_HELP}\n${lines.join(" \\\n  ")}`;
};

/** @param {Operation} operation @param {string} origin */
const python = (operation, origin) => {
  const unsafe = operation.method !== "get";
  const content = operation.kind === "json" ? "json.dumps(question).encode()" : "Path(\"FILE\").read_bytes()";
  const head = [
    "\"Authorization\": f\"Bearer {key}\"",
    unsafe ? `"Origin": "${origin}"` : null,
    operation.kind ? `"Content-Type": "${type(operation)}"` : null,
  ].filter(Boolean);
  return [
    "import json",
    "from pathlib import Path",
    "from urllib.request import Request, urlopen",
    "",
    `# ${KEY_HELP}`,
    "key = Path(\"api-key\").read_text()",
    operation.kind === "json" ? `question = ${pythonOf(operation.example)}` : null,
    "request = Request(",
    `    "${address(operation, origin)}",`,
    operation.kind ? `    data=${content},` : null,
    `    headers={${head.join(", ")}},`,
    `    method="${operation.method.toUpperCase()}",`,
    ")",
    "with urlopen(request) as answer:",
    operation.download
      ? `    Path("${operation.download}").write_bytes(answer.read())`
      : "    print(json.load(answer))",
  ].filter((line) => line !== null).join("\n");
};

/** @type {{ [word: string]: string | undefined }} */
const WORDS = { true: "True", false: "False", null: "None" };

/** @param {unknown} value */
const pythonOf = (value) =>
  JSON.stringify(value, null, 4).replace(/"(?:[^"\\]|\\.)*"|\b(true|false|null)\b/g,
    (literal, word) => WORDS[word] ?? literal);

/** @param {Operation} operation @param {string} origin */
const matlab = (operation, origin) => {
  const unsafe = operation.method !== "get";
  const head = [
    "'Authorization', ['Bearer ' key]",
    unsafe ? `'Origin', '${origin}'` : null,
    operation.kind ? `'Content-Type', '${type(operation)}'` : null,
  ].filter(Boolean);
  return [
    `% ${KEY_HELP}`,
    "key = fileread('api-key');",
    operation.kind === "json" ? `question = jsondecode('${quoted(operation.example)}');` : null,
    operation.kind === "file"
      ? "file = fopen('FILE'); content = fread(file, Inf, '*uint8'); fclose(file);"
      : null,
    "import matlab.net.http.*",
    `header = matlab.net.http.HeaderField(${head.join(", ")});`,
    `request = RequestMessage('${operation.method.toUpperCase()}', header${bodyOf(operation)});`,
    `answer = request.send('${address(operation, origin)}');`,
    operation.download ? saved(operation.download) : "disp(answer.Body.Data)",
  ].filter((line) => line !== null).join("\n");
};

/** @param {unknown} value */
const quoted = (value) => JSON.stringify(value).replaceAll("'", "''");

/** @param {string} name */
const saved = (name) => `file = fopen('${name}', 'w'); fwrite(file, answer.Body.Data); fclose(file);`;

/** @param {{ kind: string | null }} given */
const bodyOf = ({ kind }) =>
  ({ json: ", MessageBody(question)", file: ", MessageBody(content)" })[kind ?? ""] ?? "";
