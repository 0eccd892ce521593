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

const NO_FIT = "There is no fitted curve, so there is nothing to write as NRML.";

const hasFit = (found) =>
    (found.analyses ?? []).some(({ curves }) => Object.keys(curves).length > 0);

/** Buttons that save the result of a study. */
export const exportsOf = (app, study, found) => {
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
                button({
                    text,
                    label: `${study.name} as ${text}`,
                    onClick: save(suffix),
                    testid: `export-${suffix}`,
                    disabled: suffix === "xml" && !hasFit(found),
                }),
            ),
        ),
        ONLY.xml.has(study.kind) && !hasFit(found) ? el("p", { class: "quiet" }, NO_FIT) : null,
    );
};
