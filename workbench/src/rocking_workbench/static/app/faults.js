/** Fields with invalid values; the inputs do not contain these values. */

import { t } from "/app/words.js";

/** @typedef {{ inputs?: boolean, view?: string }} Which @typedef {{ label: string, text: string, view: string, input: Element }} Fault */

/** @type {Map<Element, { label: string, text: string }>} */
const faultsByInput = new Map();
/** @type {Set<(faults: Fault[]) => unknown>} */
const watchers = new Set();

/** Add the error of a field; an empty text removes it.
 * @param {Element} input @param {string} label @param {string} text */
const mark = (input, label, text) => {
  if (text ? faultsByInput.get(input)?.text === text : !faultsByInput.has(input)) return;
  if (text) faultsByInput.set(input, { label, text });
  else faultsByInput.delete(input);
  tell();
};

// Only visible fields count; the fields of a former shape or choice do not exist any more.
/** @param {Element} input */
const counts = (input) => input.isConnected && !input.closest("[hidden]:not([role=tabpanel])");

/** @param {Element} input */
const viewOf = (input) => input.closest("[role=tabpanel]")?.id.replace("view-", "") ?? "";

/** All fields with errors: {label, text, view, input}; of one view, or with `inputs` of all views except the studies.
 * @param {Which} [which] */
const list = ({ inputs = false, view } = {}) =>
  [...faultsByInput].filter(([input]) => counts(input))
    .map(([input, fault]) => ({ ...fault, view: viewOf(input), input }))
    .filter((fault) => (view ? fault.view === view : !inputs || fault.view !== "studies"));

/** @param {Which} [which] */
const any = (which) => list(which).length > 0;

/** Errors of all fields as one text; empty if there are none. `but` excludes some.
 * @param {Which & { but?: string }} [which] */
const sentence = ({ but, ...which } = {}) =>
  list(which).filter(({ text }) => text !== but).map(({ label, text }) => `${t(label)}: ${t(text)}`).join(" ");

const tell = () => {
  for (const watcher of [...watchers]) watcher(list());
};

/** Call `watcher` at each change of an error; returns a function to end it. @param {(faults: Fault[]) => unknown} watcher */
const subscribe = (watcher) => {
  watchers.add(watcher);
  return () => watchers.delete(watcher);
};

/** Register of the errors of all fields. */
export const faults = { mark, list, any, sentence, subscribe, refresh: tell };
