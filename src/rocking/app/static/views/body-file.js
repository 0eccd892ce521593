/** A drawing or body file, dropped or chosen: DXF, WKT, GeoJSON or TOML. */

import { contentOf } from "/app/file-content.js";
import { button, el, fill, note, selectField } from "/views/body-parts.js";
import { METRES } from "/views/body-units.js";

/** The place to drop a file, and its unit where the file does not say it. */
export const dropZone = (app) => {
  let held = null;
  let content = null;
  let placed = "";
  const said = el("div", { class: "refusal", role: "alert", "data-testid": "file-refusal" });
  const name = el("p", { class: "field-help", "data-testid": "held-file" });
  // The file is kept: another unit reads it again, unless the body was changed since by hand.
  const again = () => {
    if (held && (!placed || JSON.stringify(app.inputs.get().body) === placed)) read();
  };
  const units = selectField({
    label: "Unit of the file", value: "", onChange: again,
    options: [
      {
        value: "", text: "as the file says",
      }, ...Object.keys(METRES).map((value) => ({ value, text: value })),
    ],
    help: "WKT and GeoJSON never say it, some drawings do, a TOML file always.",
  });
  const chooser = el("input", {
    type: "file", accept: ".dxf,.wkt,.txt,.geojson,.json,.toml", class: "visually-hidden",
    "aria-label": "Body file",
    tabindex: "-1", onchange: () => {
      const [file] = chooser.files;
      chooser.value = ""; // or the same file, mended, could not be chosen again
      if (file) take(file);
    },
  });
  const take = (file) => {
    [held, content] = [file, null];
    fill(name, `File: ${file.name}. Choosing another unit reads it again.`);
    return read();
  };
  const read = async () => {
    const file = held;
    placed = "";
    fill(said);
    try {
      content ??= await contentOf(file);
      const query = { name: file.name, units: units.value || undefined };
      const answer = await app.call("body/file", { body: content, query });
      if (file !== held) return;
      app.inputs.lend({ ...app.inputs.get(), body: answer.body }, `the body of ${file.name}`);
      placed = JSON.stringify(app.inputs.get().body);
      app.say(`Read ${file.name}.`);
    } catch (error) {
      if (file !== held) return;
      fill(said, note(error.message, "error"));
      app.say(error.message, "error");
      if (/unit/.test(error.message)) units.input.focus();
    }
  };
  const zone = el("div", { class: "drop", "data-testid": "body-drop" },
    el("p", {}, "Drop a DXF, WKT, GeoJSON or TOML file here"),
    button({ text: "Choose a file", onClick: () => chooser.click() }), chooser);
  catchFiles(zone, take);
  return el("div", { class: "stack" }, zone, name, said, units);
};

/** Let an element take a dropped file. */
export const catchFiles = (zone, take) => {
  const over = (on) => (event) => {
    event.preventDefault();
    zone.classList.toggle("over", on);
  };
  zone.addEventListener("dragover", over(true));
  zone.addEventListener("dragleave", over(false));
  zone.addEventListener("drop", (event) => {
    over(false)(event);
    const file = event.dataTransfer?.files?.[0];
    if (file) take(file);
  });
};
