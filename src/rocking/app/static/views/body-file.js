/** A drawing or body file, dropped or chosen: DXF, WKT, GeoJSON or TOML. */

import { button, el, selectField } from "/views/body-parts.js";
import { METRES } from "/views/body-units.js";

/** The place to drop a file, and its unit where the file does not say it. */
export const dropZone = (app) => {
  let refused = null;
  const units = selectField({
    label: "Unit of the file", value: "", onChange: () => refused && take(refused),
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
    tabindex: "-1", onchange: () => chooser.files[0] && take(chooser.files[0]),
  });
  const take = async (file) => {
    chooser.value = "";
    refused = null;
    units.setError("");
    try {
      const query = { name: file.name, units: units.value || undefined };
      const answer = await app.call("body/file", { body: file, query });
      app.inputs.set("body", answer.body);
      app.say(`Read ${file.name}.`);
    } catch (error) {
      // The file is kept: choosing another unit tries it again.
      refused = file;
      units.setError(error.message);
      app.say(error.message, "error");
    }
  };
  const zone = el("div", { class: "drop", "data-testid": "body-drop" },
    el("p", {}, "Drop a DXF, WKT, GeoJSON or TOML file here"),
    button({ text: "Choose a file", onClick: () => chooser.click() }), chooser);
  catchFiles(zone, take);
  return el("div", { class: "stack" }, units, zone);
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
