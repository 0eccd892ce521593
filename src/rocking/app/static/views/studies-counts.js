/** Studies without a picture of their own: how many histories ended in which way, and tables. */
import { el } from "/app/dom.js";
import { tableOf } from "/app/fields.js";
import { percent } from "/app/format.js";
import { modelWords } from "/app/palette.js";

/** Show counts of outcomes inside a place. */
export const showCounts = (place, app, study, found) => {
  (found.shares ?? []).forEach((shares, k) => {
    const rows = shares.map(({ meaning, count, share }) => [meaning, count, percent(share)]);
    const several = found.restitutions.length > 1;
    const caption = several ? `Outcomes with ${modelWords(found.restitutions[k])}` : "Outcomes";
    place.append(tableOf(["Outcome", "histories", "share"], rows, { caption, testid: "study-counts" }));
  });
  for (const [name, columns] of Object.entries(found.tables ?? {})) place.append(sheet(name, columns));
};

const MOST = 500;

const sheet = (name, columns) => {
  const count = columns[0]?.values.length ?? 0;
  const rows = Array.from({ length: Math.min(count, MOST) }, (_, k) =>
    columns.map(({ values }) => values[k] ?? "\u2013"),
  );
  const heads = columns.map((each) => ({
    label: each.name.replaceAll("_", " "),
    unit: each.unit === "1" ? "" : each.unit,
  }));
  const rest =
    count > MOST ? el("p", { class: "quiet" }, `${count - MOST} more rows are in the files.`) : null;
  return el("div", {}, tableOf(heads, rows, { caption: name, testid: `sheet-${name}` }), rest);
};
