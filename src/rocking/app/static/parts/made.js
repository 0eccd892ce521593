/** What is made by the page's own functions, as components: a node, a field that keeps what is typed. */

import { html, useLayoutEffect, useRef } from "/parts/preact.js";
import { fill } from "/app/dom.js";

/** A node that was made elsewhere. */
export const Made = ({ node, ...more }) => {
  const place = useRef(null);
  useLayoutEffect(() => void fill(place.current, node), [node]);
  return html`<div ref=${place} ...${more}></div>`;
};

/** A field, as a slider or `numberField`: made once, it follows `value`; `on` hears of each change. */
export const Kept = ({ make, value, on, hidden = false, ...options }) => {
  const place = useRef(null);
  const field = useRef(null);
  const heard = useRef(on);
  heard.current = on;
  useLayoutEffect(() => {
    const tell = (given) => heard.current(given);
    field.current = make({ ...options, value, onInput: tell, onChange: tell });
    fill(place.current, field.current);
  }, []);
  useLayoutEffect(() => {
    if (!(Math.abs(field.current.value - value) < 1e-9)) field.current.value = value;
  }, [value]);
  return html`<div ref=${place} hidden=${hidden}></div>`;
};

/** Yes or no. */
export const Switch = ({ label, help, value, on, hidden = false }) => html`
  <div class="field field-switch" hidden=${hidden}>
    <label><input type="checkbox" checked=${value} onChange=${(event) => on(event.target.checked)} /><span>${label}</span></label>
    ${help && html`<p class="field-help">${help}</p>`}
  </div>`;

/** A value that is told by `set`, where a signal is wanted. */
export const told = (value, set) => ({
  get value() {
    return value;
  },
  set value(next) {
    set(next);
  },
});
