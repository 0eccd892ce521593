/** The question of an overturning map: two axes. */
import { el } from "/app/dom.js";
import { selectField } from "/app/fields.js";
import { greek } from "/views/studies-words.js";
import { motionsOf, rangeFields } from "/views/studies-form-parts.js";

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
};
/** Axes that only a pulse has. */
const OF_PULSES = new Set(["frequency_ratio", "amplitude_ratio", "period"]);

const isPulse = (app) => Boolean(app.inputs.get().motion?.pulse);
const firstAxes = (pulse) =>
  pulse ? { x: "frequency_ratio", y: "amplitude_ratio" } : { x: "scale", y: "semi_diagonal" };

/** Form of a map; `tables` gives the tables of its job, `refresh` follows the motion of the inputs. */
export function mapQuestion(app) {
  let pulse = isPulse(app);
  let touched = false;
  let chosen = firstAxes(pulse);
  const ranges = {};
  const node = el("div", { class: "map-question" });
  const offered = () => app.info.axes.filter(({ name }) => pulse || !OF_PULSES.has(name));

  const side = (which, words) => {
    const place = el("div", {});
    const change = (name) => {
      chosen[which] = name;
      const axis = app.info.axes.find((each) => each.name === name);
      const [from, to] = USUAL[name] || [1, 2];
      ranges[which] = rangeFields({
        name: `${words}, values`,
        unit: axis.unit === "1" ? "" : axis.unit,
        from,
        to,
        count: 50,
      });
      place.replaceChildren(ranges[which].node);
    };
    const select = selectField({
      label: words,
      options: offered().map((axis) => ({ value: axis.name, text: greek(axis.words) })),
      value: chosen[which],
      onChange: (name) => {
        touched = true;
        change(name);
      },
    });
    change(chosen[which]);
    return [select, place];
  };
  const build = () => node.replaceChildren(...side("x", "Across"), ...side("y", "Up"));
  const refresh = () => {
    if (isPulse(app) === pulse) return;
    pulse = isPulse(app);
    const there = new Set(offered().map(({ name }) => name));
    if (!touched || !there.has(chosen.x) || !there.has(chosen.y)) {
      touched = false;
      chosen = firstAxes(pulse);
    }
    build();
  };
  build();

  return {
    node,
    refresh,
    name: () => "overturning map",
    tables: (inputs) => {
      if (!inputs.body) throw new Error("A map needs a body: choose one in the step Body.");
      const map = {
        x: { axis: chosen.x, ...ranges.x.range() },
        y: { axis: chosen.y, ...ranges.y.range() },
      };
      return { kind: "overturning-map", job: { body: inputs.body, motions: motionsOf(inputs), map } };
    },
  };
}
