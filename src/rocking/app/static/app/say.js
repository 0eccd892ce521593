/** The status line: what happened, in words, for eyes and for screen readers. */

import { el, fill } from "/app/dom.js";

/** @type {{ [kind: string]: string | undefined }} */
const SIGNS = { info: "\u2713", warning: "!", error: "\u2715" };
let timer = 0;
let shownText = "";
/** @type {HTMLElement | null} */
let kept = null; // it may have gone with the dialog that it was in
const statusLine = () => (kept ??= document.getElementById("status"));

/** Say something in the status line. @param {string} text @param {string} [kind] */
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

// A dialog is over all else, and what is outside of it is not read out: while one is open the line is in it.
/** @param {HTMLElement} line */
const inSight = (line) => {
  const dialog = [...document.querySelectorAll("dialog[open]")].at(-1);
  if ((dialog ?? document.body) === line.parentElement) return;
  (dialog ?? document.body).append(line);
  dialog?.addEventListener("close", () => dialog.contains(line) && inSight(line), { once: true });
};

/** Take the status line away, or some words alone if it still says them. */
export const hush = (text = shownText) => {
  if (text !== shownText) return;
  shownText = "";
  const line = statusLine();
  line.hidden = true;
  fill(line);
};
