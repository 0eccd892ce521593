/** Tables that anyone can read: a caption, headings with units, and a copy button. */

import { copyTable } from "/app/copy.js";
import { button, toolbar } from "/app/controls.js";
import { el, freshId } from "/app/dom.js";
import { number, pretty } from "/app/format.js";

/** A table of columns (text or {label, unit, digits}) and rows of numbers, texts or nodes. */
export const tableOf = (columns, rows, { caption, csv, testid, copyRows, actions = [] } = {}) => {
  const id = freshId("table");
  const heads = columns.map((each) => (typeof each === "string" ? { label: each } : each));
  const tools = [
    button({
      text: "Copy table", kind: "quiet", label: caption ? `Copy table: ${caption}` : undefined,
      onClick: () => copyTable(heads, copyRows?.() ?? rows),
    }),
    csv ? button(
      { text: "CSV", kind: "quiet", label: `Save ${caption ?? "the table"} as CSV`, onClick: csv }
    ) : null,
    ...actions,
  ];
  const table = el("table", { "aria-labelledby": id, ...(testid ? { "data-testid": testid } : {}) },
    el("thead", {}, el("tr", {}, heads.map(heading))),
    el(
      "tbody", {},
      rows.map((row) => el("tr", {}, row.map((value, index) => cell(value, heads[index], index)))),
    ));
  const scroll = `table-scroll${rows.length > LONG ? " long" : ""}`;
  return el("div", { class: "table-block" },
    el("div", { class: "table-head" }, el("p", { id, class: "caption" }, caption), toolbar(tools)),
    el("div", { class: scroll, tabindex: "0", role: "region", "aria-labelledby": id }, table));
};

const LONG = 20;

const heading = ({ label, unit, numeric }) =>
  el("th", { scope: "col", class: numeric === false ? "text" : "" }, label,
    unit && unit !== "-" ? el("span", { class: "unit" }, ` ${pretty(unit)}`) : null);

const cell = (value, { digits, numeric, nowrap }, index) => {
  const isNumber = typeof value === "number";
  const shown = isNumber ? number(value, digits) : value;
  const attributes = {
    class: isNumber || numeric ? "number" : nowrap ? "text nowrap" : "text",
    title: isNumber ? String(value) : undefined,
  };
  return index === 0 ? el("th", { scope: "row", ...attributes }, shown) : el("td", attributes, shown);
};
