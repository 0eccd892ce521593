/** Conversion between the table `restitution` of the inputs and the form. */

import { DEFAULT_MODELS } from "/app/inputs.js";

/** Returns {models, value, feet} of a table; feet is [left, right] or null.
 * @param {Server.RestitutionTable} [table] @returns {Chosen} */
export const readRestitution = (table) => {
  if (!table) return { models: DEFAULT_MODELS, value: null, feet: null };
  const feet = table.left === undefined ? null : /** @type {number[]} */ ([table.left, table.right]);
  const models = /** @type {string[]} */ (table.models ?? (table.model === undefined ? [] : [table.model]));
  const value = table.values?.[0] ?? table.value ?? null;
  return { models: [...models], value, feet };
};

/** Returns the table; null if nothing is chosen. @param {Chosen} chosen @returns {Server.RestitutionTable | null} */
export const writeRestitution = ({ models, value, feet }) => {
  if (feet) return { left: feet[0], right: feet[1] };
  if (!models.length && value === null) return null;
  if (!models.length) return { values: [/** @type {number} */ (value)] };
  return value === null ? { models } : { models, values: [value] };
};
