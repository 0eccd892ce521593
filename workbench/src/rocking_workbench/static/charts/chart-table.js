/** Chart as a table: some rows for reading, all rows for copying. */

import { html, render } from "/parts/preact.js";
import { el } from "/app/dom.js";
import { Table } from "/parts/table.js";
import { t } from "/app/words.js";

const MOST = 60;

/** Element "show as table" under a chart; refresh() after new data.
 * @param {ChartOptions} options @param {() => Columns} dataOf */
export const chartTable = ({ title, x, y, series }, dataOf) => {
  const holder = el("div", {});
  const of = el("span", { class: "visually-hidden" }, ` ${t("of {chart}", { chart: title })}`);
  const element = el("details", { class: "chart-table" }, el("summary", {}, "Show as table", of), holder);
  const columns = [x, ...series.map((curve) => ({ label: curve.label, unit: y.unit }))];
  /** @param {number} every */
  const rowsOf = (every) => {
    const data = dataOf();
    return data[0].map((_, index) => index).filter((index) => index % every === 0)
      .map((index) => data.map((column) => column[index] ?? null));
  };
  const refresh = () => {
    if (!element.open) return;
    const every = Math.max(1, Math.ceil(dataOf()[0].length / MOST));
    const caption = every > 1 ? t("{chart}: every {number}th sample; copying includes all samples", { chart: title, number: every }) : title;
    render(html`<${Table} columns=${columns} rows=${rowsOf(every)} copied=${() => rowsOf(1)} caption=${caption} />`, holder);
  };
  element.addEventListener("toggle", refresh);
  return { element, refresh };
};
