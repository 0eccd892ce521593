/** Tables with a caption, headings with units, and a copy button if there are numbers. */

import { html, useRef } from "/parts/preact.js";
import { copyTable } from "/app/copy.js";
import { freshId } from "/app/dom.js";
import { number, pretty } from "/app/format.js";
import { Button } from "/parts/fields.js";
import { t } from "/app/words.js";

const LONG = 20;
const SENTENCE = 40; // number of letters from which a cell has several lines

/** Table of columns (text or {label, unit, digits}) and rows of numbers, texts or templates; `copied`: rows for the
 * clipboard, if they are different.
 * @param {{ columns: (string | Column)[], rows: any[][], caption?: string, csv?: () => unknown, testid?: string, copied?: () => unknown[][], actions?: any }} props */
export const Table = ({ columns, rows, caption, csv, testid, copied = () => rows, actions }) => {
  const id = useRef(freshId("table")).current;
  const heads = columns.map((column) => (typeof column === "string" ? { label: column } : column));
  return html`
    <div class="table-block">
      <div class="table-head"><p id=${id} class="caption">${caption}</p><div class="toolbar">
        <${Button} kind="quiet" aria-label=${caption && t("Copy table: {title}", { title: caption })} onClick=${() => copyTable(heads, copied())}>Copy table<//>
        ${csv && html`<${Button} kind="quiet" aria-label=${t("Save {title} as CSV", { title: caption || "the table" })} onClick=${csv}>CSV<//>`}${actions}</div></div>
      <div class=${`table-scroll ${rows.length > LONG ? "long" : ""}`} tabindex="0" role="region" aria-labelledby=${id}>
        <table aria-labelledby=${id} data-testid=${testid}>
          <thead><tr>${heads.map(({ label, unit, numeric }, at) => html`<th key=${at} scope="col" class=${numeric === false ? "text" : ""}>
            ${label}${unit && unit !== "-" && html`<span class="unit">${` ${pretty(unit)}`}</span>`}</th>`)}</tr></thead>
          <tbody>${rows.map((row, k) => html`<tr key=${k}>${row.map((value, at) => html`
            <${Cell} key=${at} value=${value} ...${heads[at]} first=${at === 0} />`)}</tr>`)}</tbody>
        </table></div>
    </div>`;
};

/** @param {Column & { value: any, first: boolean }} props */
const Cell = ({ value, digits, numeric, nowrap, first }) => {
  const isNumber = typeof value === "number";
  const shown = isNumber ? number(value, digits) : value;
  const kind = isNumber || numeric ? "number" : nowrap ? "text nowrap" : "text";
  const title = isNumber ? String(value) : null;
  return first ? html`<th scope="row" class=${kind} title=${title}>${shown}</th>` : html`<td class=${kind} title=${title}>${shown}</td>`;
};

/** Table of text; cells are text or `[text, kind]`: a rating colour, or "own" for text of the user.
 * @param {{ caption: string, head: string[], rows: (string | [string, string | null])[][] }} props */
export const Rows = ({ caption, head, rows }) => html`
  <div class="table-scroll" tabindex="0" role="region" aria-label=${caption}>
    <table><caption class="visually-hidden">${caption}</caption>
      <thead><tr>${head.map((text) => html`<th scope="col" key=${text}>${text}</th>`)}</tr></thead>
      <tbody>${rows.map((row, k) => html`<tr key=${k}>
        ${row.map((cell, j) => {
          const [text, kind] = Array.isArray(cell) ? cell : [cell, null];
          const isOwn = kind === "own";
          const look = kind && !isOwn ? `light ${kind}` : text.length > SENTENCE ? "sentence" : null;
          return j ? html`<td class=${look} translate=${!isOwn}>${text}</td>`
            : html`<th scope="row" translate=${kind !== "own"}>${text}</th>`;
        })}</tr>`)}
      </tbody>
    </table>
  </div>`;
