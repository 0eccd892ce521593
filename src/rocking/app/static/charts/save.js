/** A chart or a picture as a file: SVG, and PNG drawn from it at twice the size. */

import { saveBlob } from "/app/api.js";
import { el } from "/app/dom.js";
import { sayAll } from "/app/words.js";

const LARGER = 2;

/** Save a picture as SVG. @param {Element} picture @param {string} title */
export const saveSvg = (picture, title) => saveBlob(blobOf(picture), `${slug(title)}.svg`);

/** Save a picture as PNG. @param {Element} picture @param {string} title */
export const savePng = async (picture, title) => {
  const address = URL.createObjectURL(blobOf(picture));
  try {
    const image = new Image();
    image.src = address;
    await image.decode();
    const size = { width: LARGER * image.width, height: LARGER * image.height };
    const sheet = Object.assign(document.createElement("canvas"), size);
    sheet.getContext("2d")?.drawImage(image, 0, 0, sheet.width, sheet.height);
    /** @type {Blob | null} */
    const blob = await new Promise((resolve) => sheet.toBlob(resolve));
    if (blob) saveBlob(blob, `${slug(title)}.png`);
  } finally {
    URL.revokeObjectURL(address);
  }
};

/** The menu that saves a chart, or what else `what` says: `vector` draws it, `csv` has its numbers.
 * @param {string} title @param {() => Element} vector @param {string} [what] @param {(() => string) | null} [csv] */
export const chartFiles = (title, vector, what = "chart", csv = null) => {
  /** @type {[string, () => unknown][]} */
  const kinds = [["PNG", () => savePng(vector(), title)], ["SVG", () => saveSvg(vector(), title)]];
  if (csv) kinds.push(["CSV", () => saveBlob(new Blob([csv()], { type: "text/csv" }), `${slug(title)}.csv`)]);
  const items = kinds.map(([kind, save]) => el("button", {
    type: "button", class: "button quiet", "aria-label": `${kind} of the ${what} ${title}`,
    onclick: () => {
      save();
      menu.open = false;
    },
  }, kind));
  const menu = el("details", { class: "chart-files" },
    el("summary", { class: "button quiet", "aria-label": `Save the ${what} ${title}` }, "Save"),
    el("div", {}, items));
  /** @param {any} event */
  const close = (event) => {
    if (event.type === "keydown" ? event.key === "Escape" : !menu.contains(event.relatedTarget)) menu.open = false;
  };
  for (const kind of ["focusout", "keydown"]) menu.addEventListener(kind, close);
  return menu;
};

/** @param {Element} picture */
const blobOf = (picture) => {
  sayAll(picture);
  const text = new XMLSerializer().serializeToString(picture);
  return new Blob(['<?xml version="1.0" encoding="utf-8"?>\n', text], { type: "image/svg+xml" });
};

/** @param {string} title */
const slug = (title) => title.toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-|-$/g, "") || "chart";
