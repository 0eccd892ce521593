/** Restitution model: source, assumptions, known defects and measurements. */

import { html, useEffect, useRef, useSignal } from "/parts/preact.js";
import { Button, Note } from "/parts/fields.js";
import { number } from "/app/format.js";
import { wordsOf } from "/views/response-labels.js";
import { t } from "/app/words.js";

/** @param {string} label */
const familyOf = (label) => label.replace(/^.*\*/s, "").split(":")[0];

/** Entry of one model in the catalogue of models and the published measurements.
 * @param {{ app: App, label: string, onClose: () => unknown }} props */
export const About = ({ app, label, onClose }) => {
  const model = app.info.models.find(({ name }) => name === familyOf(label));
  const impact = useSignal(null);
  const heading = useRef(null);
  const { body, settings } = app.inputs.get();
  useEffect(() => void app.call("impact", { json: { body, ...(settings && { settings }) } })
    .then((answer) => (impact.value = answer)).catch(() => (impact.value = null)), [body, settings]);
  useEffect(() => heading.current?.focus(), [label]);
  const close = html`<${Button} onClick=${onClose}>Close<//>`;
  if (!model) return html`<section class="card"><h2 ref=${heading} tabindex="-1">${wordsOf(label)}</h2>
    <p>An entered coefficient has no source.</p><div class="toolbar">${close}</div></section>`;
  return html`
    <section class="card about-model" aria-labelledby="about-model-title" data-testid="about-model">
      <h2 id="about-model-title" ref=${heading} tabindex="-1">${model.title}</h2>
      <h3>Source</h3><p>${model.citation}</p>
      <h3>Assumptions</h3><${List} of=${model.assumptions} />
      ${model.domain && html`<h3>Range of validity</h3><p>${model.domain}</p>`}
      <h3>Known defects</h3><${List} of=${model.known_defects} />
      <h3>Evidence</h3><${Evidence} impact=${impact.value} name=${model.name} />
      <div class="toolbar"><${Button} onClick=${() => app.go("impact")}>Compare with measurements<//>${close}</div>
    </section>`;
};

/** @param {{ of: string[] }} props */
const List = ({ of }) => (of.length ? html`<ul class="bullets">${of.map((text) => html`<li key=${text}>${text}</li>`)}</ul>`
  : html`<p>None known.</p>`);

/** @type {{ [foot: string]: string }} */
const LANDS = {
  left: "This body, impact on the left foot: r = {coefficient}. 95 % interval for a measured body: {low} to {high}.",
  right: "This body, impact on the right foot: r = {coefficient}. 95 % interval for a measured body: {low} to {high}.",
};

/** @param {{ impact: Server.ImpactAnswered | null, name: string }} props */
const Evidence = ({ impact, name }) => {
  if (!impact) return html`<p class="waiting">Computing</p>`;
  const rows = Object.entries(impact.coefficients)
    .flatMap(([foot, all]) => all.filter(({ model }) => familyOf(model) === name).slice(0, 1).map((row) => ({ foot, row })));
  if (!rows.length) return html`<p>No published measurement applies to this model.</p>`;
  return html`${rows.map(({ foot, row }) => html`<p key=${foot}>${t(LANDS[foot], {
        coefficient: number(row.coefficient, 4), low: number(row.coefficient_low, 4), high: number(row.coefficient_high, 4) })}${" "}
      ${row.admissible ? "" : "No single impulse on the base gives this coefficient without creating energy."}</p>
      <${Warnings} of=${row.warnings} />`)}
    <p class="field-help">${t("{count} published measurements.", { count: impact.measured.measurements.length })} ${impact.measured.source}</p>`;
};

/** @param {{ of: string[] }} props */
const Warnings = ({ of }) => of.map((text) => html`<${Note} key=${text} kind="warning" text=${text} />`);
