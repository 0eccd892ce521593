/** Inputs of a link replace the inputs of the user. A button restores the inputs of the user. */

import { html, render, signal } from "/parts/preact.js";
import { Button, Note } from "/parts/fields.js";
import { t } from "/app/words.js";

/** Show the origin of the loaded inputs above the views, with a button to exchange them.
 * @param {Element} views @param {App["inputs"]} inputs */
export const mountLent = (views, inputs) => {
  const aside = signal(inputs.aside());
  inputs.subscribe(() => (aside.value = inputs.aside()));
  const holder = document.createElement("div");
  views.prepend(holder);
  render(html`<${Lent} inputs=${inputs} aside=${aside} />`, holder);
};

/** @param {{ inputs: App["inputs"], aside: Signal<Aside | null> }} props */
const Lent = ({ inputs, aside: { value: aside } }) => html`
  <div class="lent" role="status" data-testid="lent" hidden=${!aside}>${aside && html`
    <${Note} kind=${aside.mine ? "info" : "good"} text=${aside.mine
      ? t("These inputs come from {shown}. Your own inputs are kept.", { shown: aside.label })
      : t("Your own inputs are restored. The inputs from {shown} are kept.", { shown: aside.label })} />
    <div class="toolbar">
      <${Button} kind="primary" onClick=${inputs.swap}>${aside.mine ? "Restore my inputs" : "Show the other inputs"}<//>
      <${Button} kind="quiet" onClick=${inputs.forget}>${aside.mine ? "Discard my inputs" : "Discard the other inputs"}<//></div>`}</div>`;
