/** Points from a table: paste two columns, check their number, use them. */

import { html, useRef, useSignal } from "/parts/preact.js";
import { Button, Field, toWrong } from "/parts/fields.js";
import * as model from "/views/body-editor-model.js";
import { parsePoints } from "/views/body-points.js";
import { listed, t } from "/app/words.js";

/** @type {[string, string, (editor: Editor, points: Ring) => string | void][]} */
const USES = [
  ["Use as outline", "primary", (editor, points) => asOutline(editor, points)], ["Add as region", "", (editor, points) => asRegion(editor, points)],
  ["Add as hole", "", (editor, points) => asHole(editor, points)],
];

/** The part of the editor that takes pasted points. @param {{ editor: Editor }} props */
export const PastePart = ({ editor }) => {
  const box = useRef(null);
  const [text, status, fault] = ["", "", ""].map(useSignal);
  /** @param {string} typed */
  const read = (typed) => {
    const { points, fault: wrong } = parsePoints(typed);
    text.value = typed;
    fault.value = wrong;
    status.value = wrong ? "" : t("{count} points read, in {unit}.", { count: points.length, unit: editor.units() });
    return wrong ? null : points;
  };
  /** @param {(editor: Editor, points: Ring) => string | void} make */
  const use = (make) => {
    const points = read(text.value);
    if (!points) return toWrong(box.current);
    status.value = make(editor, points) ?? status.value;
    return undefined;
  };
  return html`
    <details ref=${box} class="paste"><summary>Paste points from Excel or a file</summary><div class="stack">
      <${Field} tag="textarea" label="Points: x and y per line" value=${text.value} on=${read} error=${fault.value}
        rows="5" spellcheck=${false} placeholder=${"0\t0\n0.6\t0\n0.4\t1.8"} />
      <p class="field-help" role="status">${status.value}</p>
      <div class="toolbar">${USES.map(([label, kind, make]) => html`
        <${Button} key=${label} kind=${kind} onClick=${() => use(make)}>${label}<//>`)}</div>
    </div></details>`;
};

/** Points as the whole body; returns a message. @param {Editor} editor @param {Ring} points */
export const asOutline = (editor, points) => {
  const lost = lostWords(editor.section(), editor.regions());
  editor.replace(replaced(editor.section(), editor.regions()[editor.state.selected.region], points));
  const status = t("The body now consists of these {count} points.", { count: points.length });
  return lost ? `${status} ${lost}` : status;
};

/** Points as one more region. @param {Editor} editor @param {Ring} points */
export const asRegion = (editor, points) => {
  const regions = editor.regions();
  editor.change(model.withRegion(regions, points, regions[regions.length - 1].density), { region: regions.length, ring: -1, vertex: 0 });
};

/** Points as a hole of the chosen region. @param {Editor} editor @param {Ring} points */
export const asHole = (editor, points) => {
  const [regions, { region }] = [editor.regions(), editor.state.selected];
  editor.change(
    model.withHole(regions, region, points), { region, ring: regions[region].holes?.length ?? 0, vertex: 0 },
  );
};

// The material is kept; data of the previous outline are removed.
/** @param {any} section @param {Region} region @param {Ring} outline */
const replaced = ({ depth, mass }, { density }, outline) => ({
  region: [density === undefined ? { outline } : { outline, density }],
  ...(depth === undefined ? {} : { depth }),
  ...(mass === undefined ? {} : { mass }),
});

/** Removed data of the previous body as text; empty if it had only an outline.
 * @param {any} section @param {Region[]} regions */
const lostWords = (section, regions) => {
  const holes = regions.flatMap((region) => region.holes ?? []).length;
  const others = regions.length - 1;
  const gone = [
    holes ? t(["{count} hole", "{count} holes"], { count: holes }) : "",
    others ? t(["{count} other region", "{count} other regions"], { count: others }) : "",
    section.feet ? t("the feet") : "",
    section.ground ? t("the ground height") : "",
  ].filter(Boolean);
  if (!gone.length) return "";
  return t("Removed with the previous body: {parts}. Undo restores them.", { parts: listed(gone) });
};
