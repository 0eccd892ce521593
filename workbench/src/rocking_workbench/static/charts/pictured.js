/** Figures other than line charts, with menus that save their shown content. */

import { html, useMemo, useRef } from "/parts/preact.js";
import { fetchFile } from "/app/api.js";
import { chartFiles, menuOf, saveFile, savePngOf } from "/charts/save.js";
import { stillOf } from "/charts/still.js";
import { Made } from "/parts/made.js";

/** Figure of the page. The title of its file is `title` and `more`; `canvasOf` redraws a canvas.
 * @param {{ title: string, more?: string, about?: string, canvasOf?: (canvas: HTMLCanvasElement) => SVGElement, children?: any }} props */
export const Pictured = ({ title, more = "", about = "", canvasOf, children }) => {
  const holder = useRef(null);
  const latest = useRef(/** @type {any} */ (null));
  latest.current = { title: title + more, about, canvasOf };
  const files = useMemo(() => chartFiles(title, () => ({
    title: latest.current.title,
    about: latest.current.about,
    node: stillOf(holder.current, latest.current.canvasOf),
    alt: [...holder.current.querySelectorAll("[role=img], canvas[aria-label]")].map((image) => image.getAttribute("aria-label")).join(" "),
  }), "picture"), [title]);
  return html`<div ref=${holder} class="pictured">${children}</div><${Made} node=${files} class="chart-foot" />`;
};

/** Figure from the server; its file is the shown image. @param {{ title: string, path: string, [more: string]: any }} props */
export const Fetched = ({ title, path, ...more }) => {
  const files = useMemo(() => {
    /** @param {(file: Blob, title: string) => unknown} save */
    const saved = (save) => () => fetchFile(path).then((file) => save(file, title));
    return menuOf(title, "picture", [["PNG", saved(savePngOf)], ["SVG", saved((file) => saveFile(file, title, "svg"))]]);
  }, [title, path]);
  return html`<div><img class="drawing" src=${`/api/${path}`} ...${more} /><${Made} node=${files} class="chart-foot" /></div>`;
};
