/** Buttons that save a picture as the command line would draw it. */

import { html } from "/parts/preact.js";
import { Button } from "/parts/fields.js";

/** PNG and SVG of one of the pictures of the API; `query` says more, such as the foot.
 * @param {{ app: App, what: string, query?: string }} props */
export const PictureTools = ({ app, what, query = "" }) => {
  /** @param {string} kind */
  const save = (kind) => app.download(`picture/${what}.${kind}${query}`, app.inputs.get(), `${what}.${kind}`);
  return html`<div class="toolbar picture-tools">${["png", "svg"].map((kind) => html`
    <${Button} key=${kind} kind="quiet" aria-label=${`Save the ${what} picture as ${kind.toUpperCase()}`}
      onClick=${() => save(kind)}>${kind.toUpperCase()}<//>`)}</div>`;
};
