/** Form of an overturning map: two axes. */
import { html, useMemo, useSignal } from "/parts/preact.js";
import { Choice } from "/parts/fields.js";
import { greek } from "/views/studies-words.js";
import { Range, motionsOf, rangeOf, unitOf, usualRange } from "/views/studies-form-parts.js";
import { t } from "/app/words.js";

/** Axes that only a pulse has. */
const OF_PULSES = new Set(["frequency_ratio", "amplitude_ratio", "period"]);

const SIDES = { x: "Horizontal axis", y: "Vertical axis" };

/** Form of a map. The motion of the inputs sets the default axes, and the choice of axes.
 * @param {{ app: App, question: StudyQuestion }} props */
export const MapQuestion = ({ app, question }) => {
  const own = useSignal({});
  const pulse = Boolean(app.inputs.get().motion?.pulse);
  const offered = app.info.axes.filter(({ name }) => pulse || !OF_PULSES.has(name));
  const first = pulse ? { x: "frequency_ratio", y: "amplitude_ratio" } : { x: "scale", y: "semi_diagonal" };
  const preferred = { ...first, ...own.value };
  const chosen = Object.values(preferred).every((axis) => offered.some(({ name }) => name === axis)) ? preferred : first;
  const [x, y] = [chosen.x, chosen.y].map((axis) => useMemo(() => usualRange(app, axis, 50), [axis]));
  question.current = {
    name: "overturning map",
    tables: (inputs) => {
      if (!inputs.body) throw new Error("A map needs a body. Choose a body in the step Body.");
      const map = { x: { axis: chosen.x, ...rangeOf(x) }, y: { axis: chosen.y, ...rangeOf(y) } };
      return { kind: "overturning-map", job: { body: inputs.body, motions: motionsOf(inputs), map } };
    },
  };
  /** @param {"x" | "y"} which @param {any} range */
  const side = (which, range) => html`
    <${Choice} label=${SIDES[which]} options=${offered.map(({ name, description: text }) => [name, greek(text)])}
      value=${chosen[which]} on=${(name) => (own.value = { ...own.value, [which]: name })} />
    <${Range} key=${which + chosen[which]} name=${t("{quantity}, values", { quantity: SIDES[which] })} range=${range}
      unit=${unitOf(offered.find(({ name }) => name === chosen[which]))} />`;
  return html`<div class="map-question">${side("x", x)}${side("y", y)}</div>`;
};
