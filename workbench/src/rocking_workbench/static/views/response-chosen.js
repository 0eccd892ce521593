/** Selected model, common to the cards, the scene, the charts, the impacts, and the files. */
import { signal } from "/parts/preact.js";
import { curveKey } from "/views/response-labels.js";
import { readRestitution } from "/views/response-restitution.js";
import { t } from "/app/words.js";

const chosenKey = signal(null);

/** Returns the labels of a restitution table in the order of the results.
 * @param {Server.RestitutionTable} [table] @returns {string[]} */
export const labelsOf = (table) => {
  const { models, value, feet } = readRestitution(table);
  if (feet) return [t("left {left}, right {right}", { left: feet[0], right: feet[1] })];
  return [...models, ...(table?.values ?? (value === null ? [] : [value])).map(String)];
};

/** Returns the label of the selected model; default: the first label, of the main model.
 * @param {string[]} labels */
export const chosenOf = (labels) => labels.find((label) => curveKey(label) === chosenKey.value) ?? labels[0] ?? null;

/** Selects a model; null selects the main model. @param {string | null} label */
export const look = (label) => (chosenKey.value = label === null ? null : curveKey(label));

/** Returns the address of a file about the selected model.
 * @param {string} path @param {Server.RestitutionTable} [table] */
export const pathOfChosen = (path, table) => {
  const labels = labelsOf(table);
  const index = labels.indexOf(chosenOf(labels));
  return index > 0 ? `${path}?restitution=${index}` : path;
};
