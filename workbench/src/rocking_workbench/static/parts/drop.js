/** Files by dropping or choosing. */

import { html, useRef } from "/parts/preact.js";
import { freshId } from "/app/dom.js";
import { Button } from "/parts/fields.js";

/** Drop area for files; `error`: its error; `on` receives a list of files, of length 1 without `many`; `testid`: of the box.
 * @param {{ label: string, name?: string, accept?: string, many?: boolean, folders?: boolean, error?: string, on: (files: File[]) => unknown, testid?: string, children?: any, [more: string]: any }} props */
export const Drop = ({ label, name = label, accept, many = false, folders = many, error = "", on, testid, children, ...more }) => {
  const [fileInput, folder] = [useRef(null), useRef(null)];
  const about = useRef(freshId("drop")).current;
  /** @param {boolean} over */
  const mark = (over) => (/** @type {DragEvent & { currentTarget: HTMLElement }} */ event) => {
    event.preventDefault();
    event.currentTarget.classList.toggle("over", over);
  };
  /** @param {ArrayLike<File> & Iterable<File>} files */
  const take = (files) => files.length && on(many ? [...files] : [files[0]]);
  /** @param {any} event */
  const drop = (event) => {
    mark(false)(event);
    const entries = [...event.dataTransfer.items].map((item) => item.webkitGetAsEntry?.()).filter(Boolean);
    if (folders && entries.some((entry) => entry.isDirectory)) return inFolders(entries).then(take);
    return take(event.dataTransfer.files);
  };
  /** @param {any} event */
  const chosen = ({ target }) => {
    const files = [...target.files];
    target.value = ""; // otherwise the browser ignores a second choice of the same file
    take(files);
  };
  return html`
    <div class=${`drop ${error ? "wrong" : ""}`} onDragOver=${mark(true)} onDragLeave=${mark(false)} onDrop=${drop} ...${more}>
      <p>${label}</p>
      <div class="toolbar">
        <${Button} aria-describedby=${about} onClick=${() => fileInput.current.click()}>${many ? "Choose files" : "Choose a file"}<//>
        ${folders && html`<${Button} onClick=${() => folder.current.click()}>Choose a folder<//>
          <input ref=${folder} class="visually-hidden" type="file" tabindex="-1" aria-label="A folder" webkitdirectory onChange=${chosen} />`}
      </div>
      <input ref=${fileInput} class="visually-hidden" type="file" tabindex="-1" aria-label=${name} accept=${accept} multiple=${many} data-testid=${testid}
        onChange=${chosen} />
      <p id=${about} class="field-help field-error">${error}</p>
      ${children}
    </div>`;
};

// All dropped files, including those in folders, which browsers return in parts.
/** @param {any[]} entries @returns {Promise<File[]>} */
const inFolders = async (entries) => (await Promise.all(entries.map(async (entry) => {
  if (entry.isFile) return new Promise((resolve, reject) => entry.file(resolve, reject));
  const reader = entry.createReader();
  /** @returns {Promise<File[]>} */
  const inside = async () => {
    const batch = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
    return batch.length ? [...await inFolders(batch), ...await inside()] : [];
  };
  return inside();
}))).flat();
