/** The table of the models, and their warnings in plain words. */

import { html } from "/parts/preact.js";
import { fixed, percent } from "/app/format.js";
import { Note, sentence } from "/parts/fields.js";
import { Table } from "/parts/table.js";
import { Swatch, wordsOf } from "/views/response-labels.js";
import { t } from "/app/words.js";

const COLUMNS = [
  { label: "Model" }, { label: "Coefficient r", digits: 5 }, { label: "95 % interval", numeric: true },
  { label: "Impulse position k", digits: 4 }, { label: "Energy lost", numeric: true }, { label: "Friction demand", digits: 4 },
  { label: "Admissible", numeric: false },
];

/** One row per model; copies contain all digits.
 * @param {{ app: App, answer: Server.ImpactAnswered, foot: Foot }} props */
export const Coefficients = ({ app, answer, foot }) => {
  const rows = answer.coefficients[foot];
  const shown = rows.map((row) => [
    html`<span class="model-name" title=${answer.titles?.[row.model]}><${Swatch} label=${row.model} />${wordsOf(row.model)}</span>`,
    row.coefficient, `${fixed(row.coefficient_low, 4)} \u2026 ${fixed(row.coefficient_high, 4)}`, row.impulse_ratio,
    percent(row.energy_loss), row.friction_demand, row.admissible ? "yes" : html`<strong class="bad">no</strong>`,
  ]);
  const copied = () => rows.map((row) => [
    row.model, row.coefficient, t("{low} to {high}", { low: row.coefficient_low, high: row.coefficient_high }), row.impulse_ratio, row.energy_loss,
    row.friction_demand, row.admissible ? "yes" : "no",
  ]);
  return html`<${Table} columns=${COLUMNS} rows=${shown} copied=${copied} testid="coefficients"
    caption=${t("Velocity after / velocity before, impact on the {foot} foot", { foot })}
    csv=${() => app.download(`table/coefficients.csv?foot=${foot}`, app.inputs.get(), "coefficients.csv")} />`;
};

/** Warnings of a foot, each with its models.
 * @param {{ answer: Server.ImpactAnswered, foot: Foot }} props */
export const Warnings = ({ answer, foot }) => {
  const models = answer.coefficients[foot];
  const modelsByWarning = new Map();
  for (const { model, warnings } of models) {
    for (const warning of warnings) modelsByWarning.set(warning, [...(modelsByWarning.get(warning) ?? []), model]);
  }
  return html`<div class="stack" data-testid="impact-warnings">${[...modelsByWarning].map(([warning, whose]) => html`
    <${Note} key=${warning} kind="warning"
      text=${sentence(whose.length === models.length ? warning : `${whose.map((/** @type {string} */ model) => t(wordsOf(model))).join(", ")}: ${t(warning)}`)} />`)}</div>`;
};
