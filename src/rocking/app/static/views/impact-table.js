/** The table of the models, and their warnings in plain words. */

import { tableOf, note } from "/app/fields.js";
import { el } from "/app/dom.js";
import { percent } from "/app/format.js";
import { dashKey, modelStyle, modelWords } from "/app/palette.js";

/** One row for each model; copying takes every digit. */
export const coefficientTable = (answer, foot, app) => {
  const rows = answer.coefficients[foot];
  const columns = [
    { label: "Model" }, { label: "Coefficient r", digits: 5 }, {
      label: "95 % interval", numeric: true,
    }, { label: "Impulse at k", digits: 4 },
    {
      label: "Energy lost", numeric: true,
    }, { label: "Friction needed", digits: 4 }, { label: "Admissible", numeric: false },
  ];
  const shown = rows.map((row) => [
    modelName(row.model, answer.titles?.[row.model]),
    row.coefficient_of_restitution,
    range(row),
    row.impulse_ratio_k,
    percent(row.energy_loss),
    row.friction_demand,
    row.admissible ? "yes" : el("strong", { class: "bad" }, "no"),
  ]);
  return tableOf(columns, shown, {
    caption: `Velocity after over velocity before, landing on the ${foot} foot`,
    testid: "coefficients",
    csv: () => app.download(`table/coefficients.csv?onto=${foot}`, app.inputs.get(), "coefficients.csv"),
    copyRows: () => rows.map((row) => [
      row.model, row.coefficient_of_restitution, `${row.low_95} to ${row.high_95}`, row.impulse_ratio_k,
      row.energy_loss,
      row.friction_demand, row.admissible ? "yes" : "no",
    ]),
  });
};

/** The warnings of one foot, each with the models it concerns. */
export const warningNotes = (answer, foot) => {
  const here = new Map();
  for (const { model, warnings } of answer.coefficients[foot]) {
    for (const words of warnings) here.set(words, [...(here.get(words) ?? []), model]);
  }
  const every = answer.coefficients[foot].length;
  return [...here].map(([words, models]) =>
    note(
      sentence(models.length === every ? words : `${models.map(modelWords).join(", ")}: ${words}`), "warning",
    ));
};

const sentence = (words) => words[0].toUpperCase() + words.slice(1);

/** A model's key and words. */
export const modelName = (label, title) =>
  el("span", { class: "model-name", title }, dashKey(modelStyle(label)), modelWords(label));

const range = ({ low_95: low, high_95: high }) => `${low.toFixed(4)} \u2026 ${high.toFixed(4)}`;
