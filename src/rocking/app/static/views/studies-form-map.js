/** The question of an overturning map: two axes. */
import { html, useMemo, useSignal } from "/parts/preact.js";
import { Choice } from "/parts/fields.js";
import { greek } from "/views/studies-words.js";
import { Range, motionsOf, rangeOf, unitOf } from "/views/studies-form-parts.js";
import { t } from "/app/words.js";

/** @type {{ [measure: string]: number[] | undefined }} */
const USUAL = {
  frequency_ratio: [0.5, 8],
  amplitude_ratio: [1, 10],
  scale: [0.25, 4],
  pga: [1, 12],
  pgv: [0.1, 2],
  period: [0.2, 3],
  duration: [0.5, 5],
  semi_diagonal: [0.25, 4],
  slenderness_ratio: [2, 8],
  slenderness_angle: [0.1, 0.4],
  width: [0.2, 2],
  height: [0.5, 6],
  restitution: [0.7, 1],
  initial_rotation: [-0.2, 0.2],
  initial_angular_velocity: [-1, 1],
};
/** Axes that only a pulse has. */
const OF_PULSES = new Set(["frequency_ratio", "amplitude_ratio", "period"]);

const SIDES = { x: "Across", y: "Up" };

/** Form of a map: its axes are those of the motion of the inputs until others are chosen that this motion has.
 * @param {{ app: App, question: StudyQuestion }} props */
export const MapQuestion = ({ app, question }) => {
  const own = useSignal({});
  const pulse = Boolean(app.inputs.get().motion?.pulse);
  const offered = app.info.axes.filter(({ name }) => pulse || !OF_PULSES.has(name));
  const first = pulse ? { x: "frequency_ratio", y: "amplitude_ratio" } : { x: "scale", y: "semi_diagonal" };
  const wanted = { ...first, ...own.value };
  const chosen = Object.values(wanted).every((axis) => offered.some(({ name }) => name === axis)) ? wanted : first;
  const [x, y] = [useAxis(chosen.x), useAxis(chosen.y)];
  question.current = {
    name: "overturning map",
    tables: (inputs) => {
      if (!inputs.body) throw new Error("A map needs a body: choose one in the step Body.");
      const map = { x: { axis: chosen.x, ...rangeOf(x) }, y: { axis: chosen.y, ...rangeOf(y) } };
      return { kind: "overturning-map", job: { body: inputs.body, motions: motionsOf(inputs), map } };
    },
  };
  /** @param {"x" | "y"} which @param {any} range */
  const side = (which, range) => html`
    <${Choice} label=${SIDES[which]} options=${offered.map(({ name, words }) => [name, greek(words)])}
      value=${chosen[which]} on=${(name) => (own.value = { ...own.value, [which]: name })} />
    <${Range} key=${which + chosen[which]} name=${t("{quantity}, values", { quantity: SIDES[which] })} range=${range}
      unit=${unitOf(offered.find(({ name }) => name === chosen[which]))} />`;
  return html`<div class="map-question">${side("x", x)}${side("y", y)}</div>`;
};

/** The usual range of an axis, to be changed by its fields. @param {string} axis */
const useAxis = (axis) => useMemo(() => {
  const [from, to] = USUAL[axis] ?? [1, 2];
  return { from, to, count: 50 };
}, [axis]);
