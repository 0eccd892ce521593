/** Points from a table: paste two columns, see how many were read, use them. */

import { button, el, fill, freshId, toolbar } from "/views/body-parts.js";
import * as model from "/views/body-editor-model.js";
import { parsePoints } from "/views/body-points.js";

/** The part of the editor that takes pasted points. */
export const pastePart = (editor) => {
  const id = freshId("paste");
  const told = el("p", { id: `${id}-about`, class: "field-help", role: "status" });
  const box = el("textarea", {
    id, rows: 5, spellcheck: "false", placeholder: "0\t0\n0.6\t0\n0.4\t1.8",
    "aria-describedby": `${id}-about`,
    oninput: () => tell(parsePoints(box.value)),
  });
  const tell = ({ points, fault }) => {
    told.classList.toggle("field-error", Boolean(fault));
    fill(told, fault || `${points.length} points read, in ${editor.units()}.`);
  };
  const use = (make) => () => {
    const read = parsePoints(box.value);
    tell(read);
    if (read.fault) return;
    const words = make(editor, read.points);
    if (words) fill(told, words);
  };
  return el("details", { class: "paste" },
    el("summary", {}, "Paste points from Excel or a file"),
    el("div", { class: "stack" },
      el("div", { class: "field" },
        el("label", { for: id }, "Points, x and y on each line"), box, told),
      toolbar(
        button({ text: "Use as outline", kind: "primary", onClick: use(asOutline) }),
        button({ text: "Add as region", onClick: use(asRegion) }),
        button({ text: "Add as hole", onClick: use(asHole) }))));
};

/** Points as the whole body; what was done, in words. */
export const asOutline = (editor, points) => {
  const lost = lostWords(editor.section(), editor.regions());
  editor.replace(replaced(editor.section(), editor.regions()[editor.state.place.region], points));
  const words = `The ${points.length} points are the whole body now.`;
  return lost ? `${words} ${lost}` : words;
};

/** Points as one more region. */
export const asRegion = (editor, points) => {
  const regions = editor.regions();
  editor.change(model.withRegion(regions, points, regions.at(-1).density), { region: regions.length, ring: -1, vertex: 0 });
};

/** Points as a hole of the chosen region. */
export const asHole = (editor, points) => {
  const [regions, { region }] = [editor.regions(), editor.state.place];
  editor.change(
    model.withHole(regions, region, points), { region, ring: regions[region].holes?.length ?? 0, vertex: 0 },
  );
};

// What is typed of the material stays; what belonged to the former outline does not.
const replaced = ({ depth, mass }, { density }, outline) => ({
  region: [density === undefined ? { outline } : { outline, density }],
  ...(depth === undefined ? {} : { depth }),
  ...(mass === undefined ? {} : { mass }),
});

/** What of the former body is gone, in words; nothing if it had no more than its outline. */
const lostWords = (section, regions) => {
  const holes = regions.flatMap((each) => each.holes ?? []).length;
  const others = regions.length - 1;
  const gone = [
    holes ? `${holes} hole${holes > 1 ? "s" : ""}` : "",
    others ? `${others} other region${others > 1 ? "s" : ""}` : "",
    section.feet ? "the feet" : "",
    section.ground ? "the height of the ground" : "",
  ].filter(Boolean);
  if (!gone.length) return "";
  const list = gone.join(", ").replace(/, ([^,]*)$/, " and $1");
  return `Gone with the former body: ${list}. Undo brings them back.`;
};
