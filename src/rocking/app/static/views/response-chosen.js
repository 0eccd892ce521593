/** The model that is looked at: one for the cards, the scene, the charts, the impacts, and the files. */
import { curveKey } from "/views/response-labels.js";
import { readRestitution } from "/views/response-restitution.js";

let wanted = null;
const watchers = new Set();

/** Returns the labels of a restitution table in the order of its answers. */
export const labelsOf = (table) => {
  const { models, value, feet } = readRestitution(table);
  if (feet) return [`left ${feet[0]}, right ${feet[1]}`];
  return [...models, ...(table?.values ?? (value === null ? [] : [value])).map(String)];
};

/** Returns which of some labels is looked at; the first, which is the main model, unless another was chosen. */
export const chosenOf = (labels) => labels.find((label) => curveKey(label) === wanted) ?? labels[0] ?? null;

/** Looks at a model; null goes back to the main one. */
export const look = (label) => {
  wanted = label === null ? null : curveKey(label);
  for (const watcher of [...watchers]) watcher();
};

/** Calls back when another model is looked at. */
export const onLook = (watcher) => watchers.add(watcher);

/** Returns the address of a file about the model that is looked at. */
export const pathOfChosen = (path, table) => {
  const labels = labelsOf(table);
  const place = labels.indexOf(chosenOf(labels));
  return place > 0 ? `${path}?restitution=${place}` : path;
};
