/** Options of single record files of a set: unit, time step, format, lines to skip, in place of those for all files. */

import { html } from "/parts/preact.js";
import { spelt } from "/app/refusal.js";
import { Button, Choice, KeyField, Note, sentence } from "/parts/fields.js";
import { filled } from "/questions/parts.js";
import { t } from "/app/words.js";

const KEYS = ["units", "time_step", "format", "skip"];
const MOST_REASONS = 12; // largest number of unread files that are listed with their fields

/** Options of the uploaded files as a table of a job; empty if no file has options.
 * @param {FileTexts} byFile @param {SentFile[]} records @param {App} app */
export const optionsOf = (byFile, records, app) => {
  const files = Object.fromEntries(records.map(({ name }) => [name, filled(byFile[name] ?? {}, app.info.keys.motion)])
    .filter(([, options]) => Object.keys(options).length));
  return Object.keys(files).length ? { files } : {};
};

/** Reasons of unread files by name: files that the result excludes, or that the error names.
 * @param {Server.WholeQuestion | null} question @param {SentFile[]} records @returns {{ [name: string]: string }} */
export const reasonsOf = (question, records) => {
  /** @type {{ file: string, reason: string }[]} */
  const leftOut = question?.answer?.left_out ?? [];
  const refusal = question?.state === "refused" ? question.refusal : null;
  /** @param {string} path */
  const last = (path) => path.split("/").at(-1);
  /** @param {string} name */
  const reasonOf = (name) => leftOut.find(({ file }) => last(file) === name)?.reason
    ?? (last(String(refusal?.facts?.file ?? "")) === name ? refusal?.facts?.cause : undefined)
    ?? ((refusal?.places ?? []).some((/** @type {any} */ location) => location.kind === "file" && last(location.name) === name) ? spelt(refusal) : "");
  return Object.fromEntries(records.map(({ name }) => [name, reasonOf(name)]).filter(([, reason]) => reason).slice(0, MOST_REASONS));
};

/** Fields of the files with separate options and of unread files; `reasons`: reasons of unread files.
 * @param {{ app: App, form: Form, names: string[], reasons: { [name: string]: string } }} props */
export const FileOptions = ({ app, form, names, reasons }) => {
  /** @type {FileTexts} */
  const byFile = form.value.by_file;
  const [shown, others] = [true, false].map((are) => names.filter((name) => (name in byFile || name in reasons) === are));
  const added = {
    get value() { return ""; },
    set value(name) { if (name) form.at("by_file").value = { ...byFile, [name]: {} }; },
  };
  /** @type {{ [key: string]: string[] | undefined }} */
  const choices = { units: app.info.units.acceleration, format: app.info.formats.map(({ name }) => name) };
  /** @param {string} file @param {string} key */
  const field = (file, key) => html`<${KeyField} key=${key} name=${`${file}.${key}`.toLowerCase()} label=${key.replace("_", " ")} help=""
    value=${form.at("by_file", file, key)} facts=${{ ...app.info.keys.motion[key], choices: choices[key] ?? [] }} />`;
  /** @param {string} file */
  const without = (file) => Object.fromEntries(Object.entries(byFile).filter(([name]) => name !== file));
  return html`
    <div class="chain" role="group" aria-label="Options per file">
      ${shown.length > 0 && html`<ul>${shown.map((name) => html`<li key=${name} aria-label=${name}>
        <div class="toolbar"><strong translate=${false}>${name}</strong>
          ${name in byFile && html`<${Button} kind="quiet" aria-label=${t("Remove the options of {name}", { name })}
            onClick=${() => (form.at("by_file").value = without(name))}>remove<//>`}</div>
        ${reasons[name] && html`<${Note} kind="error" text=${sentence(reasons[name])} />`}
        <div class="fields">${KEYS.map((key) => field(name, key))}</div></li>`)}</ul>`}
      ${others.length > 0 && html`<${Choice} label="Add a file with other options" value=${added}
        help="The unit, time step, format and skipped lines of a file replace the common options."
        options=${[["", "\u2013"], ...others.map((name) => [name, name])]} />`}
    </div>`;
};
