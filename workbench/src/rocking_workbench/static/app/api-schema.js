/** An OpenAPI schema as lists that can be shown. Pure functions. */

import { DEFAULT_MODELS } from "/app/inputs.js";

/** @typedef {{ name: string, type: string, required: boolean, about: string }} Row
 * @typedef {{ [key: string]: any, anyOf?: Shape[], oneOf?: Shape[], enum?: unknown[] }} Shape
 * @typedef {{ name: string, in: string, required?: boolean, description?: string, schema?: Shape }} Parameter
 * @typedef {ReturnType<typeof operationOf>} Operation */

const METHODS = ["get", "post", "delete"];
const BLOCK = { units: "m", width: 1, height: 4 };
/** @type {{ [word: string]: any }} */
const EXAMPLES = {
  body: { body: BLOCK },
  impact: { body: BLOCK },
  motion: { motion: { pulse: "sine:amplitude=3,period=0.8" } },
  response: {
    body: BLOCK,
    motion: { pulse: "sine:amplitude=5,period=0.8" },
    restitution: { models: DEFAULT_MODELS },
  },
};

/** All operations of a schema, in their order. @param {any} schema */
export const operationsOf = (schema) =>
  Object.entries(schema.paths).flatMap(([path, item]) =>
    METHODS.filter((method) => item[method])
      .map((method) => operationOf(schema, path, method, item[method])));

/** Operations by their group: [[name, operations]].
 * @param {Operation[]} operations @returns {[string, Operation[]][]} */
export const groupsOf = (operations) => {
  const groups = new Map();
  for (const operation of operations) groups.set(operation.group, [...(groups.get(operation.group) ?? []), operation]);
  return [...groups];
};

/** The fields of an object, one row each: {name, type, required, about}.
 * @param {any} schema @param {Shape} shape @param {number} [depth] @param {string} [prefix] @param {any[]} [seen] @returns {Row[]} */
export const fieldsOf = (schema, shape, depth = 0, prefix = "", seen = []) => {
  const plain = resolved(schema, shape);
  if (!plain?.properties || depth > 4) return [];
  return Object.entries(plain.properties).flatMap(([name, property]) => {
    const row = {
      name: prefix + name,
      type: typeOf(schema, property),
      required: plain.required?.includes(name) ?? false,
      about: aboutOf(resolved(schema, property), property),
    };
    const inner = innerOf(schema, property);
    if (!inner || seen.includes(inner)) return [row];
    return [row, ...fieldsOf(schema, inner, depth + 1, `${prefix}${name}.`, [...seen, inner])];
  });
};

/** Forms of an answer: [{description, rows}], one entry per form.
 * @param {any} schema @param {Shape} shape */
export const formsOf = (schema, shape) => {
  const variants = shape?.oneOf ?? shape?.anyOf?.flatMap((/** @type {any} */ variant) => variant.oneOf ?? [variant]) ?? [];
  const forms = variants.map((/** @type {any} */ variant) => resolved(schema, variant));
  if (forms.length) {
    return forms.map((form) => ({ description: plainText(form.description), rows: fieldsOf(schema, form) }));
  }
  const list = shape?.type === "array";
  const rows = fieldsOf(schema, list ? innerOf(schema, shape) : shape);
  return [{ description: list ? "a list with the entries" : "", rows }];
};

/** Statuses of errors and their meanings: [[status, meaning]]. @param {any} schema */
export const errorsOf = (schema) =>
  Object.entries(schema.components?.responses ?? {})
    .map(([name, { description }]) => [name.replace(/\D/g, ""), description]);

/** The form of every error. @param {any} schema */
export const errorForm = (schema) => fieldsOf(schema, { $ref: "#/components/schemas/ErrorAnswer" });

/** @param {any} schema @param {string} path @param {string} method @param {any} operation */
const operationOf = (schema, path, method, operation) => {
  const contents = operation.requestBody?.content ?? {};
  const json = contents["application/json"];
  const kind = json ? "json" : Object.keys(contents).length ? "file" : null;
  return {
    id: `${method}${path.replace(/[^A-Za-z0-9]+/g, "-")}`,
    path, method, kind,
    group: operation.tags?.[0] ?? "general",
    summary: operation.summary ?? "",
    about: plainText(operation.description),
    parameters: /** @type {Parameter[]} */ (operation.parameters ?? []),
    query: /** @type {Parameter[]} */ (operation.parameters ?? [])
      .filter((parameter) => parameter.in === "query" && parameter.required).map((parameter) => parameter.name),
    body: json?.schema ?? null,
    answer: answerOf(operation)["application/json"]?.schema ?? null,
    files: Object.keys(answerOf(operation)).filter((type) => type !== "application/json"),
    download: downloadOf(path),
    example: json ? exampleOf(schema, path, json) : null,
  };
};

/** @param {any} operation */
const answerOf = (operation) => {
  const good = Object.entries(operation.responses ?? {}).find(([status]) => status.startsWith("2"));
  return good?.[1].content ?? {};
};

/** @param {any} schema @param {string} path @param {any} json */
const exampleOf = (schema, path, json) => {
  const examples = Object.values(json.examples ?? {}).map((example) => example.value);
  const example = json.example ?? examples[0] ?? resolved(schema, json.schema)?.examples?.[0];
  if (example) return example;
  const word = path.split("/")[2];
  if (EXAMPLES[word]) return EXAMPLES[word];
  const names = Object.keys(resolved(schema, json.schema)?.properties ?? {});
  if (names.includes("body")) return EXAMPLES.response;
  return Object.fromEntries(names.map((name) => [name, "VALUE"]));
};

/** @param {string} path */
const downloadOf = (path) => {
  const last = path.split("/").at(-1) ?? "";
  return last.includes(".") ? last.replace(/[{}]/g, "") : null;
};

// Description without its table of parameters, since the page shows this table separately.
/** @param {string} text */
const plainText = (text) => (text ?? "").split(/\n\s*(?:Parameters|Returns|Raises)\n\s*-+/)[0].trim();

/** @param {any} schema @param {Shape} shape */
const resolved = (schema, shape) => {
  if (!shape?.$ref) return shape;
  return /** @type {string} */ (shape.$ref).split("/").slice(1).reduce((node, key) => node?.[key], schema);
};

/** @param {any} schema @param {Shape} shape @returns {string} */
const typeOf = (schema, shape) => {
  if (shape.$ref) return typeOf(schema, resolved(schema, shape) ?? {});
  const choices = shape.anyOf ?? shape.oneOf;
  if (choices) return [...new Set(choices.map((choice) => typeOf(schema, choice)))].join(" or ");
  if (shape.enum) return shape.enum.map((value) => JSON.stringify(value)).join(", ");
  if (shape.const !== undefined) return JSON.stringify(shape.const);
  if (shape.type === "array") return `list of ${typeOf(schema, shape.items ?? shape.prefixItems?.[0] ?? {})}`;
  return KINDS[shape.type] ?? shape.type ?? "anything";
};

/** @param {any} schema @param {Shape} shape @returns {any} */
const innerOf = (schema, shape) => {
  const choices = [shape, ...(shape.anyOf ?? [])].map((variant) => resolved(schema, variant));
  const direct = choices.find((variant) => variant?.properties);
  if (direct) return direct;
  const held = choices.flatMap((variant) => [variant?.items, variant?.additionalProperties]);
  return held.filter((inner) => typeof inner === "object").map((inner) => innerOf(schema, inner))
    .find(Boolean) ?? null;
};

/** @type {{ [type: string]: string | undefined }} */
const KINDS = { string: "text", object: "table", integer: "whole number" };

const LIMITS = {
  minimum: "≥", exclusiveMinimum: ">", maximum: "≤", exclusiveMaximum: "<",
  maxLength: "length ≤", minLength: "length ≥",
};

/** @param {Shape} plain @param {Shape} shape */
const aboutOf = (plain, shape) => {
  const numbers = [shape, ...(shape.anyOf ?? [])];
  const limits = Object.entries(LIMITS).flatMap(([key, sign]) =>
    numbers.filter((variant) => variant[key] !== undefined).map((variant) => `${sign} ${variant[key]}`));
  const usual = shape.default ?? null;
  const text = plainText(shape.description ?? plain?.description).replace(/\.$/, "");
  const usualText = usual === null ? "" : `default ${JSON.stringify(usual)}`;
  return [text, ...limits, usualText].filter(Boolean).join("; ");
};
