/** The question of a fragility: which motions, which measure, which levels and states. */
import { el } from "/app/dom.js";
import { numberField, segmented, selectField } from "/app/fields.js";
import { pretty } from "/app/format.js";
import { rangeFields } from "/views/studies-form-parts.js";
import { recordChoice } from "/views/studies-form-records.js";

const ANALYSES = [
  { value: "stripes", text: "Stripes" },
  { value: "incremental", text: "Incremental" },
  { value: "cloud", text: "Cloud" },
];
const SOURCES = [
  { value: "synthetic", text: "Synthetic set" },
  { value: "records", text: "Uploaded records" },
];

/** Form of a fragility; `tables` gives the tables of its job. */
export const fragilityQuestion = (app) => {
  const chosen = { kind: "stripes", source: "synthetic", count: 40, seed: 1, measure: "pga", state: 0.5 };
  const take = (key) => (value) => (chosen[key] = value);
  const families = app.info.families.map((each) => ({ value: each.name, text: each.title ?? each.name }));
  chosen.family = families[0].value;
  const records = recordChoice(app);
  records.node.hidden = true;
  const levels = levelFields(app, () => chosen.measure);
  const motions = el(
    "div",
    { class: "fields" },
    selectField({ label: "Family", options: families, value: chosen.family, onChange: take("family") }),
    numberField({
      label: "Motions",
      value: chosen.count,
      min: 2,
      max: 2000,
      step: 1,
      onChange: take("count"),
    }),
    numberField({ label: "Seed", value: chosen.seed, min: 0, step: 1, onChange: take("seed") }),
  );
  const node = el(
    "div",
    { class: "question" },
    segmented({
      label: "Analysis",
      options: ANALYSES,
      value: chosen.kind,
      onChange: (value) => {
        chosen.kind = value;
        levels.node.hidden = value === "cloud";
      },
    }),
    segmented({
      label: "Motions",
      options: SOURCES,
      value: chosen.source,
      onChange: (value) => {
        chosen.source = value;
        motions.hidden = value !== "synthetic";
        records.node.hidden = value !== "records";
        if (value === "records") records.refresh();
      },
    }),
    motions,
    records.node,
    selectField({
      label: "Intensity measure",
      options: measuresOf(app),
      value: chosen.measure,
      onChange: (value) => {
        chosen.measure = value;
        levels.build();
      },
    }),
    levels.node,
    numberField({
      label: "Rocking counts from",
      unit: "\u03b1",
      help: "As a share of the slenderness angle \u03b1: 0.5 is half way to the point of no return.",
      value: chosen.state,
      min: 0.01,
      max: 1,
      step: 0.05,
      onChange: take("state"),
    }),
  );
  return {
    node,
    refresh: () => chosen.source === "records" && records.refresh(),
    name: () => `fragility, ${chosen.kind}`,
    tables: (inputs) => tablesOf(inputs, chosen, levels, records),
  };
};

const measuresOf = (app) =>
  app.info.measures.map(({ name, words, unit }) => ({
    value: name,
    text: unit === "1" ? words : `${words} [${pretty(unit)}]`,
  }));

/** Where the levels of a measure usually lie. */
const USUAL = { pga: [1, 12], pgv: [0.1, 2] };

const levelFields = (app, measure) => {
  const node = el("div", {});
  let fields = null;
  const build = () => {
    const { unit, name } = app.info.measures.find((each) => each.name === measure());
    const [from, to] = USUAL[name] ?? [1, 12];
    const shown = unit === "1" ? "" : unit;
    fields = rangeFields({ name: "Levels of the measure", unit: shown, from, to, count: 12 });
    node.replaceChildren(fields.node);
  };
  build();
  return { node, build, range: () => fields.range() };
};

const tablesOf = (inputs, { kind, source, family, count, seed, measure, state }, levels, records) => {
  if (!inputs.body) throw new Error("A fragility needs a body: choose one in the step Body.");
  const set = { synthetic: family, count: Math.round(count), seed: Math.round(seed) };
  const motions = source === "synthetic" ? [set] : records.tables();
  const fragility = { measure, states: [state], ...(kind === "cloud" ? {} : { levels: levels.range() }) };
  return { kind, job: { body: inputs.body, motions, fragility } };
};
