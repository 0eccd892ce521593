/** The status line: what happened, in words, for eyes and for screen readers. */

import { el, fill } from "/app/dom.js";

/** @type {{ [kind: string]: string | undefined }} */
const SIGNS = { info: "\u2713", warning: "!", error: "\u2715" };
let timer = 0;

/** Say something in the status line; returns how to take it back, as long as nothing else is said. @param {string} text @param {string} [kind] */
export const say = (text, kind = "info") => {
  const line = document.getElementById("status");
  const words = el("span", {}, text);
  fill(line, el("span", { class: "sign", "aria-hidden": "true" }, SIGNS[kind] ?? ""), words);
  line.dataset.kind = kind;
  line.hidden = false;
  clearTimeout(timer);
  timer = setTimeout(hush, kind === "error" ? 12_000 : 5_000);
  return () => line.contains(words) && hush();
};

/** Take the status line away. */
export const hush = () => {
  const line = document.getElementById("status");
  line.hidden = true;
  fill(line);
};
