/** What the parts of the Body view take from the shell, in one place. */

export { el, fill, freshId, svg } from "/app/dom.js";
export {
  button, card, iconButton, note, numberField, segmented, selectField, switchField, tableOf,
  textField, toolbar,
} from "/app/fields.js";
export { number, quantity, tidy } from "/app/format.js";
