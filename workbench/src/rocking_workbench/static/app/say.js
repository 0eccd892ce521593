/** Status line with the last event, also for screen readers. */

import { el, fill } from "/app/dom.js";

/** @type {{ [kind: string]: string | undefined }} */
const SIGNS = { info: "\u2713", warning: "!", error: "\u2715" };
let timer = 0;
let shownText = "";
/** @type {HTMLElement | null} */
let kept = null; // a closed dialog may have removed the line
const statusLine = () => (kept ??= document.getElementById("status"));

/** Show a text in the status line. @param {string} text @param {string} [kind] */
export const say = (text, kind = "info") => {
  const line = statusLine();
  inSight(line);
  shownText = text;
  fill(line, el("span", { class: "sign", "aria-hidden": "true" }, SIGNS[kind] ?? ""), el("span", {}, text));
  line.dataset.kind = kind;
  line.hidden = false;
  clearTimeout(timer);
  timer = setTimeout(() => hush(), kind === "error" ? 12_000 : 5_000);
};

// Content outside an open dialog is not read by screen readers: the line is moved into the dialog.
/** @param {HTMLElement} line */
const inSight = (line) => {
  const dialog = [...document.querySelectorAll("dialog[open]")].at(-1);
  if ((dialog ?? document.body) === line.parentElement) return;
  (dialog ?? document.body).append(line);
  dialog?.addEventListener("close", () => dialog.contains(line) && inSight(line), { once: true });
};

/** Clear the status line. With a text: only if the line shows this text. */
export const hush = (text = shownText) => {
  if (text !== shownText) return;
  shownText = "";
  const line = statusLine();
  line.hidden = true;
  fill(line);
};
