/** Error message with its cause and a button to retry. */

import { html, render } from "/parts/preact.js";
import { Button, Note, sentence } from "/parts/fields.js";

/** Mount components in a new element in place of the content of a node.
 * @param {Element} node @param {VNode} content */
export const inPlaceOf = (node, content) => {
  const holder = document.createElement("div");
  node.replaceChildren(holder);
  render(content, holder);
};

/** Show the reason of a failed start; the fragment of the address is kept for the retry. @param {string} message */
export const showFailure = (message) => {
  inPlaceOf(document.getElementById("main"), html`
    <div class="card door" data-testid="failure">
      <h1>rocking could not start</h1>
      <div class="refusal" role="alert"><${Note} kind="error" text=${sentence(message)} /></div>
      <p>You are still signed in. This browser keeps your inputs.</p>
      <${Button} kind="primary" onClick=${() => location.reload()}>Try again<//>
    </div>`);
  document.body.classList.add("at-the-door");
  /** @type {HTMLElement | null} */ (document.querySelector(".door button"))?.focus();
};
