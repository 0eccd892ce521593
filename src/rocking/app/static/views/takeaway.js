/** Take away: everything that belongs to the inputs, as files, as tables, and as a link. */
import { el } from "/app/dom.js";
import { button, card, selectField } from "/app/fields.js";
import { chosenOf, labelsOf, look, onLook, pathOfChosen } from "/views/response-chosen.js";
import { wordsOf } from "/views/response-labels.js";
import { filmButton } from "/views/takeaway-film.js";

const PICTURES = [
  ["body", "Body"],
  ["coefficients", "Coefficients against the measurements"],
  ["stages", "KED's three stages"],
  ["motion", "Motion and spectrum", "motion"],
  ["response", "Response", "response"],
];
const TABLES = [
  ["body", "Body", ["csv", "xlsx"]],
  ["coefficients", "Coefficients of every model", ["csv", "xlsx"]],
  ["measures", "Intensity measures", ["csv", "xlsx"], "motion"],
  ["motion", "Motion: a, v, d", ["csv", "mat", "xlsx"], "motion"],
  ["spectrum", "Response spectrum", ["csv", "xlsx"], "motion"],
  ["response", "Response, every sample", ["csv", "mat", "nc"], "response"],
  ["impacts", "Impacts", ["csv", "xlsx"], "response"],
];
const NAMES = {
  csv: "CSV",
  xlsx: "Excel",
  mat: "MATLAB",
  nc: "netCDF",
  png: "PNG",
  svg: "SVG",
  html: "Web page",
  gif: "GIF",
  toml: "TOML",
  zip: "ZIP with the record",
  pdf: "PDF",
};

/** Files that hold one model of several. */
const OF_ONE = /^\/api\/(table\/response\.|animation\.)/;

/** Build the view inside its section. */
export const mount = (section, app) => {
  const needing = [];
  const fileButton = (path, suffix, name, needs, testid) => {
    const node = button({
      text: NAMES[suffix] ?? suffix,
      label: `${name} as ${NAMES[suffix] ?? suffix}`,
      testid,
      onClick: async () => {
        if (node.getAttribute("aria-busy")) return;
        node.setAttribute("aria-busy", "true");
        const inputs = app.inputs.get();
        const address = OF_ONE.test(path) ? pathOfChosen(path, inputs.restitution) : path;
        await app.download(address, inputs, `rocking.${suffix}`);
        node.removeAttribute("aria-busy");
      },
    });
    if (needs) needing.push({ node, needs });
    return node;
  };
  const film = filmButton(app, { text: "GIF", label: "Animation as GIF", testid: "animation-gif" });
  needing.push({ node: film.button, needs: "response" });
  const which = selectField({
    label: "Model in files that hold one",
    options: [],
    help: "Animation, and response as CSV, MATLAB and netCDF; the name of the file says it.",
    onChange: look,
  });
  const row = (name, ...buttons) =>
    el("li", { class: "take-row" }, el("span", {}, name), el("div", { class: "toolbar" }, buttons));

  const link = el("input", {
    type: "text",
    id: "permanent-link",
    readonly: true,
    "data-testid": "permanent-link",
    onfocus: () => link.select(),
  });
  const copied = async () => {
    try {
      await navigator.clipboard.writeText(link.value);
      app.say("The link is on the clipboard.");
    } catch {
      link.select();
      app.say("Press Ctrl+C to copy the link.");
    }
  };
  const refresh = () => {
    const inputs = app.inputs.get();
    link.value = app.inputs.link();
    const labels = labelsOf(inputs.restitution);
    which.hidden = labels.length < 2;
    which.setOptions(labels.map((label) => ({ value: label, text: wordsOf(label) })));
    which.value = chosenOf(labels);
    const there = {
      motion: Boolean(inputs.motion),
      response: Boolean(inputs.motion) || inputs.response?.free != null,
    };
    for (const { node, needs } of needing) node.disabled = !there[needs];
  };

  const words = el(
    "div",
    { class: "takeaway-part" },
    card(
      "Link",
      el(
        "p",
        { class: "quiet" },
        "It holds all inputs. Whoever runs rocking on a computer of their own sees the same with it; ",
        "records travel by their hash, so send the file along, or take the ZIP.",
      ),
      el(
        "div",
        { class: "field" },
        el("label", { for: "permanent-link" }, "Permanent link of the inputs"),
        link,
      ),
      el(
        "div",
        { class: "toolbar" },
        button({ text: "Copy link", kind: "primary", onClick: copied, testid: "copy-link" }),
      ),
    ),
    card(
      "For the command line, and for colleagues",
      el(
        "p",
        { class: "quiet" },
        "The same numbers, to the last digit, with: rocking simulate response.toml",
      ),
      el(
        "div",
        { class: "toolbar" },
        fileButton("/api/inputs.toml", "toml", "Inputs", null, "take-toml"),
        fileButton("/api/inputs.zip", "zip", "Inputs", null, "take-zip"),
        button({ text: "Read a TOML or its ZIP \u2026", onClick: () => chooser.click() }),
      ),
    ),
    card(
      "Report",
      el(
        "p",
        { class: "quiet" },
        "Body, coefficients against the measurements, motion, response and impacts, ",
        "with where every number comes from.",
      ),
      el(
        "div",
        { class: "toolbar" },
        fileButton("/api/report.pdf", "pdf", "Report", "response", "take-report"),
      ),
    ),
    card(
      "Pictures",
      el(
        "ul",
        {},
        PICTURES.map(([what, name, needs]) =>
          row(
            name,
            ["png", "svg"].map((suffix) =>
              fileButton(
                `/api/picture/${what}.${suffix}`,
                suffix,
                name,
                needs,
                `picture-${what}-${suffix}`,
              ),
            ),
          ),
        ),
        row(
          "Animation",
          fileButton("/api/animation.html", "html", "Animation", "response", "animation-html"),
          film.button,
        ),
      ),
      film.progress,
    ),
  );
  const tables = el(
    "div",
    { class: "takeaway-part" },
    card(
      "Tables",
      which,
      el(
        "ul",
        {},
        TABLES.map(([what, name, suffixes, needs]) =>
          row(
            name,
            suffixes.map((suffix) =>
              fileButton(
                `/api/table/${what}.${suffix}`,
                suffix,
                name,
                needs,
                `table-${what}-${suffix}`,
              ),
            ),
          ),
        ),
      ),
    ),
  );
  const lead = "All of it as files, as tables and as a link: what was put in, and what came out.";
  section.append(
    el("header", { class: "view-head" }, el("h1", {}, "Take away"), el("p", { class: "lead" }, lead)),
    el("div", { class: "takeaway" }, words, tables),
  );

  const chooser = el("input", {
    type: "file",
    accept: ".toml,.zip",
    hidden: true,
    "aria-label": "File of inputs, TOML or ZIP",
    "data-testid": "read-toml",
  });
  chooser.addEventListener("change", async () => {
    const [file] = chooser.files;
    chooser.value = "";
    if (!file) return;
    try {
      const found = await app.call("/api/inputs/read", { body: file, query: { name: file.name } });
      app.inputs.lend(found.inputs ?? found, `what ${file.name} holds`);
      app.say(`The inputs of ${file.name} are loaded.`);
    } catch (error) {
      app.say(error.message, "error");
    }
  });
  section.append(chooser);
  app.inputs.subscribe(refresh);
  onLook(refresh);
  refresh();
  return { shown: refresh };
};
