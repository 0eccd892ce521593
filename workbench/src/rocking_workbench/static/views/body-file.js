/** A drawing or body file, dropped or chosen: DXF, WKT, GeoJSON or TOML. */

import { html, useRef, useSignal } from "/parts/preact.js";
import { contentOf } from "/app/file-content.js";
import { Drop } from "/parts/drop.js";
import { Choice, Note, toWrong } from "/parts/fields.js";
import { METRES } from "/views/body-units.js";
import { t } from "/app/words.js";

const UNITS = [["", "as in the file"], ...Object.keys(METRES).map((unit) => [unit, unit])];

/** Drop area for a body file, with its unit if the file does not contain it. @param {{ app: App }} props */
export const BodyFile = ({ app }) => {
  const box = useRef(null);
  const held = useRef({}); // the file, its content, and its body
  const [units, name, wrong] = ["", "", ""].map(useSignal);
  const read = async () => {
    const mine = held.current;
    mine.placed = "";
    wrong.value = "";
    try {
      mine.content ??= await app.project.within(contentOf(mine.file));
      const query = { name: mine.file.name, units: units.value || undefined };
      const answer = await app.project.within(app.call("body/file", { body: mine.content, query }));
      if (mine !== held.current) return;
      app.inputs.lend({ ...app.inputs.get(), body: answer.body }, t("the file {name}", { name: mine.file.name }));
      mine.placed = JSON.stringify(app.inputs.get().body);
      app.say(t("{name} is read.", { name: mine.file.name }));
    } catch (error) {
      if (mine !== held.current) return;
      wrong.value = error.message;
      app.say(error.message, "error");
      toWrong(box.current);
    }
  };
  /** @param {File[]} files */
  const take = ([file]) => {
    held.current = { file };
    name.value = file.name;
    return read();
  };
  // The file is stored. A change of the unit imports it again, unless the body has been edited since the import.
  /** @param {string} unit */
  const inUnit = (unit) => {
    units.value = unit;
    const { file, placed } = held.current;
    if (file && (!placed || JSON.stringify(app.inputs.get().body) === placed)) read();
  };
  const ofUnit = /unit/.test(wrong.value.replace(name.value, ""));
  return html`
    <div ref=${box} class="stack">
      <${Drop} label="Drop a DXF, WKT, GeoJSON or TOML file here" name="Body file" accept=".dxf,.wkt,.txt,.geojson,.json,.toml"
        on=${take} data-testid="body-drop" />
      <p class="field-help" data-testid="held-file">${name.value && t("File: {name}. After a change of the unit the file is read again.", { name: name.value })}</p>
      <div class="refusal" role="alert" data-testid="file-refusal">${wrong.value && !ofUnit && html`<${Note} kind="error" text=${wrong.value} />`}</div>
      <${Choice} label="Unit of the file" value=${units.value} on=${inUnit} options=${UNITS} error=${ofUnit && wrong.value}
        help="TOML files contain a unit, DXF files sometimes. WKT and GeoJSON files contain no unit." />
    </div>`;
};
