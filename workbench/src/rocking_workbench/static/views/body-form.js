/** Form of a body: unit, shape, sizes, mass or density, and feet. */

import { html, useRef, useState } from "/parts/preact.js";
import { Choice, Field, Note, NumberField, Segmented } from "/parts/fields.js";
import { asShape, shapeOf, tableOfShape, withKey } from "/views/body-shapes.js";
import { METRES, fromMetres, inUnits } from "/views/body-units.js";
import { SHAPES } from "/app/shapes.js";
import { t } from "/app/words.js";

const UNITS = Object.keys(METRES).map((unit) => [unit, unit]);
const FROM_FILE = [["mass_points", "Mass points (from a file)"]];

/** Fields of a body; a field with an error of the server is marked until the body changes.
 * @param {{ app: App, body: Server.BodyInput, refusal: Refusal | null }} props */
export const Form = ({ app, body, refusal }) => {
  const [kept, replaced] = [useRef(new Map()).current, useRef({}).current];
  const shape = shapeOf(body);
  const { units } = body;
  /** @param {string} next */
  const become = (next) => {
    const now = app.inputs.get().body; // the properties do not contain the last edit yet
    kept.set(shapeOf(now), now);
    const before = kept.get(next);
    const again = before ? renamed(inUnits(before, units), now.name) : asShape(now, next, app.body.get());
    const { mass } = tableOfShape(now);
    app.inputs.set("body", mass === tableOfShape(again).mass ? again : withKey(again, "mass", mass, replaced));
  };
  /** @param {string} key */
  const put = (key) => (/** @type {any} */ value) => app.inputs.set("body", withKey(app.inputs.get().body, key, value, replaced));
  /** @param {string} key */
  const error = (key) => (refusal?.field === key ? refusal.message : "");
  const own = `${shape} ${units}`; // the fields of the new shape, also with equal values
  return html`<div class="stack">
    <${Choice} label="Shape" value=${shape} on=${become}
      options=${[...Object.entries(SHAPES).map(([key, { label: text }]) => [key, text]), ...(shape === "mass_points" ? FROM_FILE : [])]} />
    <${Segmented} label="Lengths in" options=${UNITS} value=${units} on=${(next) => app.inputs.set("body", inUnits(app.inputs.get().body, next))} />
    ${shape === "mass_points" ? html`<${Note} text="This body consists of mass points from a file." />`
      : html`<${Sizes} key=${own} shape=${shape} units=${units} table=${tableOfShape(body)} put=${put} error=${error} />`}
    <${Field} label="Name" value=${body.name} placeholder=${t("optional")} maxlength="80" translate=${false}
      on=${(text) => app.inputs.set("body.name", text.trim() || undefined)} />
  </div>`;
};

/** @param {Server.BodyInput} body @param {string | null} [name] */
const renamed = ({ name: _, ...body }, name) => (name ? { ...body, name } : body);

// Range of the solver in metres; other sizes are typing or unit errors.
const [LEAST, MOST] = [1e-9, 1e9];

/** @param {Unit} unit */
const sizeLimits = (unit) => {
  const [min, max] = [LEAST, MOST].map((length) => fromMetres(length, unit));
  return METRES[unit] ? { above: 0, min, max } : { above: 0 };
};

/** @param {{ shape: string, units: Unit, table: any, put: (key: string) => (value: any) => void, error: (key: string) => string }} props */
const Sizes = ({ shape, units, table, put, error }) => {
  const limits = sizeLimits(units);
  /** @param {string} key @param {string} label @param {object} [more] */
  const field = (key, label, more) => html`<${NumberField} key=${key} label=${label} value=${table[key]} on=${put(key)}
    error=${error(key)} ...${more} />`;
  /** @param {string} key @param {string} label @param {string} unit @param {string} help */
  const positive = (key, label, unit, help) => field(key, label, { unit, help, above: 0, optional: true });
  /** @param {string} key @param {string[]} labels @param {string} help @param {string} alone */
  const pair = (key, labels, help, alone) => html`<${Pair} key=${key} labels=${labels} unit=${units} help=${help} alone=${alone}
    value=${table[key]} on=${put(key)} error=${error(key)} />`;
  return html`
    <div class="fields" data-testid="sizes">
      ${SHAPES[shape].fields.map(([key, label, more]) => field(key, label, { unit: units, ...(more?.min === undefined && limits), ...more }))}
      ${field("depth", "Depth", { unit: units, optional: true, ...limits, help: "Depth, across the motion. Empty: 1\u00a0m. The assessment warns if the depth is the weaker side." })}
      ${shape !== "section" && positive("density", "Density", "kg/m3", "Empty: 2400\u00a0kg/m\u00b3.")}
      ${positive("mass", "Mass", "kg", "Replaces the density.")}
      ${pair("centre", ["Centre of mass x", "Centre of mass y"], "Both empty: homogeneous body.", "Enter both x and y.")}
      ${positive("moment_of_inertia", "Moment of inertia", "kg m2", "About the centre of mass. Empty: assumed.")}
    </div>
    <div class="fields" data-testid="feet">
      ${pair("feet", ["Left foot", "Right foot"], "Both empty: the edges of the base.", "Enter both feet or neither.")}
    </div>`;
};

// Two numbers, both or none: typed values are kept until both are present or both are empty.
/** @param {{ labels: string[], value?: number[] | null, on: (pair: any) => void, help: string, alone: string, error: string, unit: string }} props */
const Pair = ({ labels, value, on, help, alone, error, ...more }) => {
  /** @type {{ current: (number | null)[] }} */
  const typed = useRef([null, null]);
  const seen = useRef("");
  if (seen.current !== String(value)) {
    seen.current = String(value);
    if (value) typed.current = [...value];
    else if (!typed.current.includes(null)) typed.current = [null, null];
  }
  const [, draw] = useState();
  /** @param {number} index */
  const take = (index) => (/** @type {number | null} */ number) => {
    const pair = typed.current.with(index, number);
    typed.current = pair;
    draw({});
    if (pair[0] === null && pair[1] === null) on(null);
    else if (!pair.includes(null)) on(pair);
  };
  /** @param {number} index */
  const lonely = (index) => typed.current[index] === null && typed.current[1 - index] !== null;
  return labels.map((label, index) => html`<${NumberField} key=${label} label=${label} value=${typed.current[index]} on=${take(index)}
    optional help=${index ? help : ""} error=${lonely(index) ? alone : index ? "" : error} ...${more} />`);
};
