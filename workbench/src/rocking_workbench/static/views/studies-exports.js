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

/** @param {any} result @param {number} k */
const hasFit = (result, k) => Object.keys(result.analyses?.[k]?.curves ?? {}).length > 0;

/** Buttons that save the result of a study, NRML for the `chosen` restitution.
 * @param {{ app: App, study: Server.StudyFacts, result: any, chosen: { restitution: number } }} props */
export const Exports = ({ app, study, result, chosen }) => {
  const notice = useSignal("");
  const fragility = FRAGILITIES.has(study.kind);
  const curveless = fragility && result.analyses.every((/** @type {unknown} */ _, /** @type {number} */ k) => !hasFit(result, k));
  const offered = FILES.filter(([suffix]) => suffix !== "xml" || fragility);
  /** @param {string} suffix */
  const save = async (suffix) => {
    notice.value = suffix === "xml" && !hasFit(result, chosen.restitution) ? NO_FIT : "";
    if (notice.value) return;
    const query = suffix === "xml" ? `?restitution=${chosen.restitution}` : "";
    await app.download(`/api/studies/${study.id}/export.${suffix}${query}`, undefined, `study.${suffix}`);
  };
  return html`
    <div class="study-exports">
      <h3>Export</h3>
      <div class="toolbar">${offered.map(([suffix, text]) => html`
        <${Button} key=${suffix} aria-label=${t("{study} as {format}", { study: userText(study.name), format: text })} data-testid=${`export-${suffix}`}
          disabled=${suffix === "xml" && curveless} onClick=${() => save(suffix)}>${text}<//>`)}</div>
      <div aria-live="polite">
        ${notice.value && html`<${Note} text=${notice.value} />`}
      </div>
      ${curveless && html`<p class="quiet" data-testid="no-nrml">${NO_FIT}</p>`}
    </div>`;
};
