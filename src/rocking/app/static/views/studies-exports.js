/** Files of a finished study. */
import { el } from "/app/dom.js";
import { button } from "/app/fields.js";

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

/** Buttons that save the result of a study. */
export const exportsOf = (app, study) => {
    const offered = FILES.filter(([suffix]) => !ONLY[suffix] || ONLY[suffix].has(study.kind)).filter(
        ([suffix]) => !(["png", "svg"].includes(suffix) && NO_PICTURE.has(study.kind)),
    );
    const save = (suffix) => () =>
        app.download(`/api/studies/${study.id}/export.${suffix}`, undefined, `study.${suffix}`);
    return el(
        "div",
        { class: "study-exports" },
        el("h3", {}, "Take away"),
        el(
            "div",
            { class: "toolbar" },
            offered.map(([suffix, text]) =>
                button({ text, onClick: save(suffix), testid: `export-${suffix}` }),
            ),
        ),
    );
};
