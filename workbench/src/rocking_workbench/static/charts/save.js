/** Figure as a file: shown content in light colors, with title and description. */

import { saveBlob } from "/app/api.js";
import { el, set, svg } from "/app/dom.js";
import { say } from "/app/say.js";
import { t } from "/app/words.js";
import { wrapped } from "/charts/letters.js";
import { colour, inLight } from "/charts/style.js";

const LARGER = 2; // pixels of a PNG per pixel of the page
const [MARGIN, LEAST, ROW] = [14, 360, 17];
const FONT = "system-ui, sans-serif";
/** @type {{ [subject: string]: string }} */
const SAVE = { chart: "Save the chart {title}", picture: "Save the picture {title}" };
/** @type {{ [subject: string]: string }} */
const OF = { chart: "{kind} of the chart {title}", picture: "{kind} of the picture {title}" };

/** @typedef {{ node: SVGSVGElement, title?: string, about?: string, alt?: string | null, note?: string }} Still */

/** Save a file under the title of its figure. @param {Blob} file @param {string} title @param {string} kind */
export const saveFile = (file, title, kind) => saveBlob(file, `${slug(t(title))}.${kind}`);

/** Save a picture as SVG. @param {Element} picture @param {string} title */
export const saveSvg = (picture, title) => saveFile(blobOf(picture), title, "svg");

/** Save an existing image file as PNG. @param {Blob} drawing @param {string} title */
export const savePngOf = async (drawing, title) => {
  const address = URL.createObjectURL(drawing);
  try {
    const image = new Image();
    image.src = address;
    await image.decode();
    const size = { width: LARGER * image.width, height: LARGER * image.height };
    const sheet = Object.assign(document.createElement("canvas"), size);
    sheet.getContext("2d")?.drawImage(image, 0, 0, sheet.width, sheet.height);
    /** @type {Blob | null} */
    const blob = await new Promise((resolve) => sheet.toBlob(resolve));
    if (!blob) throw new Error("This browser cannot write a PNG of this size. Save the figure as SVG.");
    saveFile(blob, title, "png");
  } finally {
    URL.revokeObjectURL(address);
  }
};

/** Menu of a figure: `draw` gives its shown content, `csv` its numbers. The elements around it contain
 * descriptions, one line per element: `data-own` with names of the user, `data-about` without names.
 * @param {string} title @param {() => Still} draw @param {string} [subject] @param {(() => string) | null} [csv] */
export const chartFiles = (title, draw, subject = "chart", csv = null) => {
  const sheet = () => inLight(() => sheetOf(title, draw(), menu));
  /** @type {[string, () => unknown][]} */
  const kinds = [["PNG", () => savePngOf(blobOf(sheet()), title)], ["SVG", () => saveSvg(sheet(), title)]];
  if (csv) kinds.push(["CSV", () => saveFile(new Blob([csv()], { type: "text/csv" }), title, "csv")]);
  const menu = menuOf(title, subject, kinds);
  return menu;
};

/** Menu of the file formats of a figure. @param {string} title @param {string} subject @param {[string, () => unknown][]} kinds */
export const menuOf = (title, subject, kinds) => {
  const items = kinds.map(([kind, save]) => el("button", {
    type: "button", class: "button quiet", "aria-label": t(OF[subject], { kind, title }),
    onclick: () => {
      leave();
      Promise.resolve().then(save).catch((error) => say(error.message, "error"));
    },
  }, kind));
  const head = el("summary", { class: "button quiet", "aria-label": t(SAVE[subject], { title }) }, "Save");
  const menu = el("details", { class: "chart-files" }, head, el("div", {}, items));
  const leave = () => { // the focus remains on the menu
    menu.open = false;
    head.focus();
  };
  /** @param {any} event */
  const close = (event) => {
    if (event.type === "focusout" && !menu.contains(event.relatedTarget)) menu.open = false;
    if (event.key === "Escape" && menu.open) leave();
  };
  for (const kind of ["focusout", "keydown"]) menu.addEventListener(kind, close);
  return menu;
};

/** Figure on its own background, with title and description. @param {string} name @param {Still} still @param {HTMLElement} menu */
const sheetOf = (name, { node, title = name, about: more = "", alt, note = "" }, menu) => {
  const [width, height] = ["width", "height"].map((side) => Number(node.getAttribute(side)));
  const wide = Math.ceil(Math.max(LEAST, width)) + 2 * MARGIN;
  /** @param {string} kind */
  const around = (kind) => menu.closest(`[data-${kind}]`)?.getAttribute(`data-${kind}`) ?? "";
  const parts = [around("own").replace(/[\p{Cc}\ufffe\uffff]/gu, " "), ...around("about").split("\n").map((line) => t(line)), t(more)];
  const about = parts.filter(Boolean).join(" \u00b7 ");
  const soft = { "font-size": 12, fill: colour("--ink-soft"), translate: "no" };
  const head = [
    ...linesOf(t(title), wide, { "font-size": 14, "font-weight": 600, fill: colour("--ink") }), ...linesOf(about, wide, soft),
  ];
  const foot = linesOf(t(note), wide, soft);
  let y = MARGIN - 2;
  for (const line of head) line.setAttribute("y", String((y += ROW)));
  set(node, { x: MARGIN, y: (y += MARGIN), overflow: "visible" });
  y += height;
  for (const line of foot) line.setAttribute("y", String((y += ROW)));
  const size = { width: wide, height: y + MARGIN };
  return svg("svg", { ...size, viewBox: `0 0 ${size.width} ${size.height}`, "font-family": FONT },
    svg("title", {}, title), svg("desc", {}, alt), svg("rect", { ...size, fill: colour("--surface") }), head, node, foot);
};

/** @param {string} text @param {number} wide @param {Attributes} look */
const linesOf = (text, wide, look) =>
  wrapped(text, wide - 2 * MARGIN, `${look["font-weight"] ?? 400} ${look["font-size"]}px ${FONT}`)
    .map((line) => svg("text", { x: MARGIN, ...look }, line));

/** @param {Element} picture */
const blobOf = (picture) => {
  const text = new XMLSerializer().serializeToString(picture);
  return new Blob(['<?xml version="1.0" encoding="utf-8"?>\n', text], { type: "image/svg+xml" });
};

/** @param {string} title */
const slug = (title) => title.toLowerCase().replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-|-$/g, "") || "chart";
