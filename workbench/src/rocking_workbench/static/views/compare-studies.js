/** Studies with several models: fragility, maps and spectra, and the effect of the choice. */

import { html, useSignal } from "/parts/preact.js";
import { Fetched } from "/charts/pictured.js";
import { Button, Choice, Note } from "/parts/fields.js";
import { t, userText } from "/app/words.js";

const KINDS = new Set(["overturning-map", "rocking-spectrum", "stripes", "minimum-acceleration"]);
const TABLES = [["flips", "Effect of the choice"], ["differences", "All differences"]];
const NOTHING = "Nothing to compare: the study has one model or more than six.";

/** Picture of a study with a comparison of models, as on the command line, and its files.
 * @param {{ app: App, handle: { look: () => unknown } }} props */
export const Studies = ({ app, handle }) => {
  const [all, chosen, drawn, refused] = [useSignal([]), useSignal(""), useSignal(""), useSignal("")];
  handle.look = async () => {
    const { studies } = await app.call("studies").catch(() => ({ studies: [] }));
    const here = app.project.here.value.id;
    all.value = studies.filter(({ state, kind, project }) => state === "done" && KINDS.has(kind) && (!project || project === here));
    if (!all.value.some(({ id }) => id === chosen.value)) chosen.value = all.value[0]?.id ?? "";
  };
  const study = all.value.find(({ id }) => id === chosen.value);
  /** @param {string} kind */
  const path = (kind) => `studies/${study.id}/export.${kind}`;
  return html`
    <section class="card" aria-labelledby="compare-studies-title"><h2 id="compare-studies-title">Studies of this project</h2>
      ${!study ? html`<p class="field-help">Finished maps, spectra and fragility studies with several models appear here.
          <${Button} onClick=${() => app.go("studies")}>Launch a study<//></p>` : html`
        <${Choice} label="Study" own value=${chosen} options=${all.value.map(({ id, name }) => [id, name])} />
        ${refused.value === chosen.value ? html`<${Note} data-testid="not-compared" text=${NOTHING} />` : html`
          ${drawn.value !== chosen.value && html`<p class="waiting" role="status">Drawing the comparison</p>`}
          <${Fetched} key=${chosen.value} title=${t("Models compared: {name}", { name: userText(study.name) })} path=${path("svg")} onLoad=${() => (drawn.value = chosen.value)} alt=${t("{name}: comparison of models and effect of the choice", { name: userText(study.name) })}
            onError=${() => (refused.value = chosen.value)} />
          ${study.kind !== "minimum-acceleration" && html`<div class="toolbar" role="group" aria-label="Export the comparison">
            ${TABLES.map(([table, label]) => html`<${Button} key=${table} aria-label=${t("{table} as CSV", { table: label })}
              onClick=${() => app.download(`${path("csv")}?what=${table}`, undefined, `${table}.csv`)}>${t("{table}, CSV", { table: label })}<//>`)}</div>`}`}`}
    </section>`;
};
