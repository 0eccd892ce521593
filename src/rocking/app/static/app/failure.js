/** What could not be shown: why in words, and the way to try again. */

import { html, render } from "/parts/preact.js";
import { Button, Note, sentence } from "/parts/fields.js";

/** Put components in a place of their own instead of all that stands in a node.
 * @param {Element} node @param {VNode} content */
export const inPlaceOf = (node, content) => {
  const holder = document.createElement("div");
  node.replaceChildren(holder);
  render(content, holder);
};

/** Say why the page could not start; what the address holds is kept for the next try. @param {string} message */
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
