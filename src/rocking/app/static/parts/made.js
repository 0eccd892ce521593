/** What is made by the page's own functions, as a component. */

import { html, useLayoutEffect, useRef } from "/parts/preact.js";
import { fill } from "/app/dom.js";

/** A node that was made elsewhere. */
export const Made = ({ node, ...more }) => {
  const place = useRef(null);
  useLayoutEffect(() => void fill(place.current, node), [node]);
  return html`<div ref=${place} ...${more}></div>`;
};
