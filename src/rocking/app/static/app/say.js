/** The status line: what happened, in words, for eyes and for screen readers. */

import { el, fill } from "/app/dom.js";

/** @type {{ [kind: string]: string | undefined }} */
const SIGNS = { info: "\u2713", warning: "!", error: "\u2715" };
let timer = 0;
let said = "";

/** Say something in the status line. @param {string} text @param {string} [kind] */
export const say = (text, kind = "info") => {
  const line = document.getElementById("status");
  said = text;
  fill(line, el("span", { class: "sign", "aria-hidden": "true" }, SIGNS[kind] ?? ""), el("span", {}, text));
  line.dataset.kind = kind;
  line.hidden = false;
  clearTimeout(timer);
  timer = setTimeout(() => hush(), kind === "error" ? 12_000 : 5_000);
};

/** Take the status line away, or some words alone if it still says them. */
export const hush = (text = said) => {
  if (text !== said) return;
  said = "";
  const line = document.getElementById("status");
  line.hidden = true;
  fill(line);
};
