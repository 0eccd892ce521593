/** The question of a fragility: which motions, which measure, which levels and states. */
import { el } from "/app/dom.js";
import { numberField, segmented, selectField } from "/app/fields.js";
import { rangeFields } from "/views/studies-form-parts.js";

const ANALYSES = [
    { value: "stripes", text: "Stripes" },
    { value: "incremental", text: "Incremental" },
    { value: "cloud", text: "Cloud" },
];
const SOURCES = [
    { value: "synthetic", text: "Synthetic set" },
    { value: "records", text: "All uploaded records" },
];

/** Form of a fragility; `tables` gives the tables of its job. */
export const fragilityQuestion = (app) => {
    const chosen = { kind: "stripes", source: "synthetic", count: 40, seed: 1, measure: "pga", state: 0.5 };
    const take = (key) => (value) => (chosen[key] = value);
    const families = app.info.families.map((each) => ({ value: each.name, text: each.title ?? each.name }));
    chosen.family = families[0].value;
    const levels = rangeFields({ name: "Levels of the measure", unit: "", from: 1, to: 12, count: 12 });
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
            },
        }),
        motions,
        selectField({
            label: "Intensity measure",
            options: measuresOf(app),
            value: chosen.measure,
            onChange: take("measure"),
        }),
        levels.node,
        numberField({
            label: "Rocking counts from",
            unit: "of the slenderness angle",
            value: chosen.state,
            min: 0.01,
            max: 1,
            step: 0.05,
            onChange: take("state"),
        }),
    );
    return {
        node,
        name: () => `fragility, ${chosen.kind}`,
        tables: (inputs) => tablesOf(app, inputs, chosen, levels),
    };
};

const measuresOf = (app) =>
    app.info.measures.map(({ name, words, unit }) => ({
        value: name,
        text: unit === "1" ? words : `${words} [${unit}]`,
    }));

const tablesOf = async (app, inputs, { kind, source, family, count, seed, measure, state }, levels) => {
    if (!inputs.body) throw new Error("A fragility needs a body: choose one in the step Body.");
    const set = { synthetic: family, count: Math.round(count), seed: Math.round(seed) };
    const motions = [source === "synthetic" ? set : await uploaded(app)];
    const fragility = { measure, states: [state], ...(kind === "cloud" ? {} : { levels: levels.range() }) };
    return { kind, job: { body: inputs.body, motions, fragility } };
};

const uploaded = async (app) => {
    const answer = await app.call("records");
    const records = (answer.records ?? answer).map((each) => each.record);
    if (!records.length)
        throw new Error("No record has been uploaded yet: drop some files in the step Motion.");
    return { records };
};
