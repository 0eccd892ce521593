/** Files of a finished study. */
import { html, useSignal } from "/parts/preact.js";
import { Button, Note } from "/parts/fields.js";
import { t, userText } from "/app/words.js";

const FILES = [
  ["csv", "CSV"], ["xlsx", "Excel"], ["mat", "MATLAB"], ["nc", "netCDF"], ["parquet", "Parquet"], ["toml", "TOML job"],
  ["xml", "NRML"],
];
const FRAGILITIES = new Set(["stripes", "incremental", "cloud"]);

const NO_FIT = "NRML needs a fitted curve. This study has none.";

/** @param {any} found @param {number} k */
const hasFit = (found, k) => Object.keys(found.analyses?.[k]?.curves ?? {}).length > 0;

/** Buttons that save the result of a study, NRML of the restitution that is `chosen`.
 * @param {{ app: App, study: Server.StudyFacts, found: any, chosen: { restitution: number } }} props */
export const Exports = ({ app, study, found, chosen }) => {
  const said = useSignal("");
  const fragility = FRAGILITIES.has(study.kind);
  const curveless = fragility && found.analyses.every((/** @type {unknown} */ _, /** @type {number} */ k) => !hasFit(found, k));
  const offered = FILES.filter(([suffix]) => suffix !== "xml" || fragility);
  /** @param {string} suffix */
  const save = async (suffix) => {
    said.value = suffix === "xml" && !hasFit(found, chosen.restitution) ? NO_FIT : "";
    if (said.value) return;
    const place = suffix === "xml" ? `?restitution=${chosen.restitution}` : "";
    await app.download(`/api/studies/${study.id}/export.${suffix}${place}`, undefined, `study.${suffix}`);
  };
  return html`
    <div class="study-exports">
      <h3>Export</h3>
      <div class="toolbar">${offered.map(([suffix, text]) => html`
        <${Button} key=${suffix} aria-label=${t("{study} as {format}", { study: userText(study.name), format: text })} data-testid=${`export-${suffix}`}
          disabled=${suffix === "xml" && curveless} onClick=${() => save(suffix)}>${text}<//>`)}</div>
      <div aria-live="polite">
        ${said.value && html`<${Note} words=${said.value} />`}
      </div>
      ${curveless && html`<p class="quiet" data-testid="no-nrml">${NO_FIT}</p>`}
    </div>`;
};
