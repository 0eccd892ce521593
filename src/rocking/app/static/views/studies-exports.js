/** Files of a finished study. */
import { el, fill } from "/app/dom.js";
import { button, note } from "/app/fields.js";

const FILES = [
  ["png", "PNG"],
  ["svg", "SVG"],
  ["csv", "CSV"],
  ["xlsx", "Excel"],
  ["mat", "MATLAB"],
  ["nc", "netCDF"],
  ["parquet", "Parquet"],
  ["toml", "TOML job"],
  ["xml", "NRML"],
];
const ONLY = { xml: new Set(["stripes", "incremental", "cloud"]) };
const NO_PICTURE = new Set(["histories"]);

const NO_FIT = "There is no fitted curve, so there is nothing to write as NRML.";

/** What is drawn or written of one restitution alone. */
const OF_ONE = new Set(["png", "svg", "xml"]);

const CROSS =
  "These curves cross, which the file cannot hold. With one dispersion for all states they do not.";

const hasFit = (found, k) => Object.keys(found.analyses?.[k]?.curves ?? {}).length > 0;

/** Buttons that save the result of a study, pictures and curves of the restitution that is shown. */
export const exportsOf = (app, study, found, chosen) => {
  const offered = FILES.filter(([suffix]) => !ONLY[suffix] || ONLY[suffix].has(study.kind)).filter(
    ([suffix]) => !(["png", "svg"].includes(suffix) && NO_PICTURE.has(study.kind)),
  );
  const said = el("div", { "aria-live": "polite" });
  const fetched = (suffix, more = "") => {
    const place = OF_ONE.has(suffix) ? `?restitution=${chosen.restitution}` : "";
    const path = `/api/studies/${study.id}/export.${suffix}${place}${more}`;
    return app.download(path, undefined, `study.${suffix}`);
  };
  const nest = () => fetched("xml", "&crossing=common-dispersion").then(() => fill(said));
  const save = (suffix) => async () => {
    fill(said);
    if (suffix === "xml" && !hasFit(found, chosen.restitution)) return fill(said, note(NO_FIT, "info"));
    const refused = await fetched(suffix);
    if (!/must not cross/.test(refused?.message)) return undefined;
    const text = "Save with one dispersion";
    return fill(said, note(CROSS, "info"), button({ text, onClick: nest, testid: "export-nested" }));
  };
  const none = (suffix) => suffix === "xml" && found.analyses.every((_, k) => !hasFit(found, k));
  return el(
    "div",
    { class: "study-exports" },
    el("h3", {}, "Take away"),
    el(
      "div",
      { class: "toolbar" },
      offered.map(([suffix, text]) =>
        button({
          text,
          label: `${study.name} as ${text}`,
          onClick: save(suffix),
          testid: `export-${suffix}`,
          disabled: none(suffix),
        }),
      ),
    ),
    said,
    ONLY.xml.has(study.kind) && none("xml")
      ? el("p", { class: "quiet", "data-testid": "no-nrml" }, NO_FIT)
      : null,
  );
};
