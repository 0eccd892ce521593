/** Scale factor of the motion, by slider and by number. */
import { html } from "/parts/preact.js";
import { NumberField, Slider } from "/parts/fields.js";

const LEAST = 0.1;
const MOST = 10;

/** Slider and number of the same factor. @param {{ value: number, on: (value: number) => unknown }} props */
export const Scale = ({ value, on }) => html`
  <div class="motion-scale">
    <${Slider} label="Scale of the motion" min=${LEAST} max=${MOST} log
      value=${Math.min(Math.max(Math.abs(value), LEAST), MOST)} on=${on} />
    <${NumberField} label="Factor" value=${value} min=${-1000} max=${1000} step=${0.05} moves on=${on}
      help="A negative factor reverses the polarity." />
  </div>`;
