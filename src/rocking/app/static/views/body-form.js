/** The form of a body: unit, shape, sizes, depth, density and feet. */

import { el, fill, note, numberField, segmented, selectField, textField } from "/views/body-parts.js";
import { asShape, pathOfShape, SHAPES, shapeOf, tableOfShape } from "/views/body-shapes.js";
import { fromMetres, inUnits, METRES } from "/views/body-units.js";

/** The form; follow() brings it up to date with the inputs. */
export const createForm = (app) => {
  const body = () => app.inputs.get().body;
  const sizes = el("div", { class: "fields", "data-testid": "sizes" });
  const kept = new Map();
  const shape = selectField({
    label: "Shape", options: choices(shapeOf(body())), value: shapeOf(body()),
    onChange: (next) => {
      const now = body();
      kept.set(shapeOf(now), now);
      const before = kept.get(next);
      app.inputs.set("body", before
        ? renamed(inUnits(before, now.units), now.name) : asShape(now, next, app.body.get()));
      app.faults.refresh();
    },
  });
  const units = segmented({
    label: "Lengths in", value: body().units,
    options: Object.keys(METRES).map((each) => ({ value: each, text: each })),
    onChange: (next) => app.inputs.set("body", inUnits(body(), next)),
  });
  const name = textField({
    label: "Name", value: body().name, placeholder: "optional", maxLength: 80,
    onChange: (text) => app.inputs.set("body.name", text.trim() || undefined),
  });
  const feet = el("div", { class: "fields", "data-testid": "feet" });
  let built = "";
  let fields = [];
  const follow = () => {
    const now = body();
    const key = `${shapeOf(now)} ${now.units}`;
    shape.setOptions(choices(shapeOf(now)));
    shape.value = shapeOf(now);
    units.value = now.units;
    name.value = now.name ?? "";
    if (key !== built) {
      fields = fieldsOf(app);
      fill(sizes, shapeOf(now) === "mass_points" ? note("This body is a set of masses from a file.") : null,
        fields.filter(([, , isFoot]) => !isFoot).map(([, field]) => field));
      fill(feet, fields.filter(([, , isFoot]) => isFoot).map(([, field]) => field));
      feet.hidden = !feet.childElementCount;
      built = key;
    }
    const table = tableOfShape(now);
    for (const [read, field] of fields) field.value = read(table) ?? null;
    for (const { after } of fields) after?.();
    app.faults.refresh();
  };
  // The field that the server refused is marked too, until the body changes.
  let refused = null;
  const refuse = (error) => {
    const key = error?.field;
    const found = fields.find(([, , , name]) => key && name === key)?.[1];
    if (refused && refused !== found) refused.setError("");
    if (found && !found.input.hasAttribute("aria-invalid")) found.setError(error.message);
    refused = found ?? null;
  };
  follow();
  return { element: el("div", { class: "stack" }, shape, units, sizes, feet, name), follow, refuse };
};

const renamed = ({ name: _, ...body }, name) => (name ? { ...body, name } : body);

const choices = (current) => {
  const listed = Object.entries(SHAPES).map(([value, { words }]) => ({ value, text: words }));
  return current === "mass_points" ? [
    ...listed, { value: "mass_points", text: "Mass points (from a file)" }
  ] : listed;
};

const fieldsOf = (app) => {
  const body = app.inputs.get().body;
  const { units } = body;
  const put = (key, value) => {
    const now = app.inputs.get().body;
    if (key === "feet" && value && tableOfShape(now) === now) app.inputs.set("body", withFeet(now, value));
    else app.inputs.set(`${pathOfShape(now)}.${key}`, value ?? undefined);
    // mass and density say the same: the one that was typed last is meant
    const other = { mass: "density", density: "mass" }[key];
    if (other && value) app.inputs.set(`${pathOfShape(app.inputs.get().body)}.${other}`, undefined);
    const { region } = app.inputs.get().body.section ?? {};
    if (key === "mass" && value && region) {
      app.inputs.set("body.section.region", region.map(({ density: _, ...each }) => each));
    }
  };
  const shape = SHAPES[shapeOf(body)] ?? { fields: [] };
  const own = shape.fields.map(
    ([key, label, more = {}]) => sizeField(key, label, { unit: units, ...more }, put)
  );
  const isMassPoints = shapeOf(body) === "mass_points";
  const common = isMassPoints ? [] : [
    [(table) => table.depth, numberField({
      label: "Depth", unit: units, optional: true, ...sizeLimits(units),
      onChange: (value) => put("depth", value),
      help: "Out of the picture; only the mass needs it. Empty: 1\u00a0m.",
    }), false, "depth"],
  ];
  const density = [(table) => table.density, numberField({
    label: "Density", unit: "kg/m3", optional: true, above: 0, onChange: (value) => put("density", value),
    help: "Empty: 2400\u00a0kg/m\u00b3.",
  }), false, "density"];
  const mass = [(table) => table.mass, numberField({
    label: "Mass", unit: "kg", optional: true, above: 0, onChange: (value) => put("mass", value),
    help: "In place of the density.",
  }), false, "mass"];
  const hasDensity = !isMassPoints && shapeOf(body) !== "section";
  return [
    ...own, ...common, ...(hasDensity ? [density] : []), ...(isMassPoints ? [] : [mass]),
    ...(isMassPoints ? [] : [...knownFields(units, put), ...feetFields(units, put)])
  ];
};

// What the solver takes, in metres; other sizes are slips of the keyboard or of the unit.
const [LEAST, MOST] = [1e-9, 1e9];

const sizeLimits = (unit) => {
  const [min, max] = [LEAST, MOST].map((length) => fromMetres(length, unit));
  return METRES[unit] ? { above: 0, min, max } : { above: 0 };
};

const sizeField = (key, label, { whole, ...more }, put) => {
  const field = numberField({
    label, ...(more.min === undefined ? sizeLimits(more.unit) : {}), ...more,
    onChange: (value) => (
      whole && !Number.isInteger(value) ? field.setError("A whole number is needed.") : put(key, value)
    ),
  });
  return [(table) => table[key], field, false, key];
};

// Feet narrower than the outline, or two typed places; empty means: as wide as the base.
const feetFields = (units, put) => pairFields(
  "feet", ["Left foot", "Right foot"], { unit: units, help: "Both empty: the edges of the base." }, ALONE, put, true
);

// What is known of the mass: each is optional, and what is left empty is assumed.
const knownFields = (units, put) => [
  ...pairFields("centre", ["Centre of mass x", "Centre of mass y"], {
    unit: units, help: "Both empty: as if homogeneous.",
  }, "Give both x and y: one alone is not used.", put),
  [(table) => table.moment_of_inertia, numberField({
    label: "Moment of inertia", unit: "kg m2", optional: true, above: 0,
    onChange: (value) => put("moment_of_inertia", value), help: "About the centre of mass. Empty: assumed.",
  }), false, "moment_of_inertia"],
];

// Two numbers that stand together or not at all.
const pairFields = (key, labels, { help, ...more }, alone, put, isFoot = false) => {
  const pair = [null, null];
  const settled = (table) => {
    if (table[key]) pair.splice(0, 2, ...table[key]);
    else if (pair.every((each) => each !== null)) pair.fill(null);
    return pair;
  };
  const take = (index) => (value) => {
    pair[index] = value;
    lone();
    if (pair.every((each) => each === null)) put(key, undefined);
    else if (pair.every((each) => each !== null)) put(key, [...pair]);
  };
  const both = labels.map((label, index) => numberField({
    label, ...more, optional: true, onChange: take(index), help: index ? help : undefined,
  }));
  const lone = () => both.forEach((field, at) => {
    if (pair[at] === null && pair[1 - at] !== null) field.setError(alone);
    else if (!field.input.value.trim()) field.setError("");
  });
  return both.map(
    (field, index) => Object.assign([(table) => settled(table)[index], field, isFoot], { after: lone })
  );
};

const ALONE = "Give both feet, or neither: one alone is not used.";

// Feet of its own stand in a block's table; the short form has none.
const withFeet = ({ units, name, ...block }, feet) => (
  { units, ...(name ? { name } : {}), block: { ...block, feet } }
);
