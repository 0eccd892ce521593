/** Contact bed: coefficient of springs and dashpots as a function of one parameter. */

import { html, useMemo, useRef, useSignal } from "/parts/preact.js";
import { number } from "/app/format.js";
import { modelStyle, modelWords } from "/app/palette.js";
import { createTime, Figure } from "/charts/figure.js";
import { Button, Choice, KeyField, Note, Refused, sentence, toWrong } from "/parts/fields.js";
import { filled, refusedOf, useForm } from "/questions/parts.js";
import { t } from "/app/words.js";

const VARIED = {
  slenderness: "slenderness", damping: "damping", modulus_over_thickness: "stiffness of a layer", friction: "friction",
  release: "initial rotation", density: "density, one layer", width: "width, one layer",
  points: "number of contact points", amplitude: "unevenness of the base", seed: "random seed of the unevenness",
};
const RANGE = ["from", "to", "count", "spacing"];
const NOTHING = {};
const BED = { label: "contact bed", colour: "--accent", points: true };

/** Inputs and results of the contact bed; `body` has the slenderness and the width.
 * @param {{ app: App, body: { slenderness: number, width: number } }} props */
export const Laboratory = ({ app, body }) => {
  const keys = app.info.keys.contact_bed;
  const form = useForm(app, "bed", {});
  const varied = useSignal("slenderness");
  const [result, refused, busy] = [null, {}, false].map(useSignal);
  /** @param {any} event */
  const compute = async (event) => {
    event.preventDefault();
    busy.value = true;
    try {
      const json = { ...body, ...filled(form.value, keys), varied: varied.value };
      result.value = await app.call("contact-bed", { json });
      refused.value = {};
    } catch (error) {
      refused.value = refusedOf({ message: error.message, refusal: error.text ? error : undefined });
      toWrong(event.target);
    }
    busy.value = false;
  };
  /** @param {string} name */
  const field = (name) => html`<${KeyField} key=${name} name=${name} facts=${keys[name]} value=${form.at(name)}
    ...${name in body ? { placeholder: number(/** @type {any} */ (body)[name], 4) } : {}} />`;
  const others = Object.keys(keys).filter((name) => name !== "varied" && !RANGE.includes(name));
  return html`<div class="question" data-testid="bed">
    <form class="stack" onSubmit=${compute} aria-label="Contact bed">
      <${Choice} label="Varied parameter" value=${varied} options=${Object.entries(VARIED)} />
      <details><summary>Range and bed parameters</summary>
        <div class="fields"><${Refused.Provider} value=${refused.value}>${[...RANGE, ...others].map(field)}<//></div></details>
      ${refused.value.text && html`<${Note} kind="error" role="alert" text=${refused.value.text} />`}
      <div class="toolbar"><${Button} type="submit" disabled=${busy.value}>Compute<//></div>
    </form>
    ${result.value && html`<${Emerged} result=${result.value} />`}</div>`;
};

/** @param {{ result: Server.ContactBedAnswered }} props */
const Emerged = ({ result: { varied, unit, values, results, rigid } }) => {
  const shown = useSignal("coefficient");
  const time = useRef(createTime()).current;
  const { unit: of, values: curve } = results[shown.value];
  const beside = shown.value === "coefficient" ? Object.entries(rigid) : [];
  const log = values[0] > 0 && values[values.length - 1] / values[0] > 8;
  const quantity = shown.value.replaceAll("_", " ");
  const shape = {
    title: t("Contact bed: {quantity}", { quantity }), x: { label: VARIED[varied], unit, log }, y: { label: quantity, unit: of },
    series: [BED, ...beside.map(([name]) => ({ ...modelStyle(name), label: modelWords(name) }))], height: 300,
  };
  const data = useMemo(() => [values, curve, ...beside.map(([, coefficients]) => coefficients)], [values, shown.value]);
  return html`
    <div class="stack" data-testid="bed-results">
      <${Choice} label="Show" value=${shown} help=${results[shown.value].description && sentence(results[shown.value].description)}
        options=${Object.keys(results).map((name) => [name, name.replaceAll("_", " ")])} />
      <${Figure} shape=${shape} data=${data} interval=${null} marks=${NOTHING} time=${time} testid="bed-chart" />
    </div>`;
};
