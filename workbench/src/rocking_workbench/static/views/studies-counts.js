/** Studies without a figure: number of histories per outcome, and tables. */
import { html } from "/parts/preact.js";
import { Fetched } from "/charts/pictured.js";
import { Table } from "/parts/table.js";
import { percent } from "/app/format.js";
import { modelWords } from "/app/palette.js";
import { t } from "/app/words.js";

const MOST = 500;

/** Counts of outcomes, the tables of a study, and its picture if it has findings. @param {{ study: Server.StudyFacts, result: any }} props */
export const Counts = ({ study, result }) => {
  const several = result.restitutions?.length > 1;
  return html`
    ${result.tables?.findings && html`<${Fetched} title=${study.kind} path=${`studies/${study.id}/export.svg`} alt=${study.kind} />`}
    ${(result.shares ?? []).map((/** @type {Server.Share[]} */ shares, /** @type {number} */ k) => html`<${Table} key=${k} columns=${["Outcome", "simulations", "fraction"]} testid="study-counts"
      rows=${shares.map(({ meaning, count, share }) => [meaning, count, percent(share)])}
      caption=${several ? t("Outcomes with {model}", { model: modelWords(result.restitutions[k]) }) : "Outcomes"} />`)}
    ${Object.entries(result.tables ?? {}).map(([name, columns]) => html`<${Columns} key=${name} name=${name} columns=${columns} />`)}`;
};

/** @param {{ name: string, columns: any[] }} props */
const Columns = ({ name, columns }) => {
  const count = columns[0]?.values.length ?? 0;
  const rows = Array.from({ length: Math.min(count, MOST) }, (_, k) => columns.map(({ values }) => values[k] ?? "\u2013"));
  const heads = columns.map((column) => ({ label: column.name.replaceAll("_", " "), unit: column.unit === "1" ? "" : column.unit }));
  return html`<div><${Table} columns=${heads} rows=${rows} caption=${name} testid=${`sheet-${name}`} />
    ${count > MOST && html`<p class="quiet">${t("The files contain {count} more rows.", { count: count - MOST })}</p>`}</div>`;
};
