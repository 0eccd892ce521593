/** What stands around the board: undo, regions and holes, densities, the grid, the chosen vertex. */

import { highest, lowest } from "/app/extremes.js";
import { editable } from "/app/format.js";
import { button, el, fill, numberField, switchField, tidy, toolbar } from "/views/body-parts.js";
import * as model from "/views/body-editor-model.js";

/** The panel: {tools, details, follow}. */
export const createPanel = (editor) => {
  const undo = button({ text: "Undo", onClick: () => editor.travel("undo") });
  const redo = button({ text: "Redo", onClick: () => editor.travel("redo") });
  const addRegion = button({ text: "Add region", onClick: () => newRegion(editor) });
  const addHole = button({ text: "Add hole", onClick: () => newHole(editor) });
  const dropRing = button({ text: "Remove part", kind: "danger", onClick: () => removePart(editor) });
  const stand = button({
    text: "Stand on the ground", onClick: () => editor.change(model.onTheGround(editor.regions(), tidy)),
  });
  const snap = switchField({
    label: "Snap to grid", value: editor.state.snap, onChange: (on) => {
      editor.state.snap = on;
    },
  });
  const grid = numberField({
    label: "Grid step", above: 0, optional: true, value: null,
    onChange: (value) => {
      editor.state.step = value;
      editor.tell();
    },
    help: "Of the grid and of the arrow keys; with Shift ten times. Empty: as the zoom asks.",
  });
  const vertex = vertexFields(editor);
  const densities = el("div", { class: "fields", "data-testid": "densities" });
  let shown = -1;
  let boxes = [];
  const follow = () => {
    const regions = editor.regions();
    if (!regions.length) return;
    able(undo, editor.history.canUndo());
    able(redo, editor.history.canRedo());
    dropRing.disabled = editor.state.place.ring < 0 && regions.length < 2;
    grid.input.placeholder = editable(editor.step());
    vertex.follow();
    if (shown !== regions.length) {
      boxes = regions.map((_, index) => densityField(editor, index));
      fill(densities, boxes);
      shown = regions.length;
    }
    boxes.forEach((field, index) => (field.value = regions[index].density ?? null));
  };
  return {
    tools: toolbar(undo, redo, addRegion, addHole, dropRing, stand),
    details: el(
      "div", { class: "stack" }, el("div", { class: "fields" }, vertex.fields, grid, snap), densities,
    ),
    follow,
  };
};

// A button that becomes disabled would drop the focus; one that says that it is keeps it.
const able = (node, can) => {
  if (can) node.removeAttribute("aria-disabled");
  else node.setAttribute("aria-disabled", "true");
};

const vertexFields = (editor) => {
  const fields = ["x", "y"].map((axis, index) => numberField({
    label: `Vertex ${axis}`,
    onChange: (value) => {
      const { place } = editor.state;
      const point = [...model.ringAt(editor.regions(), place)[place.vertex]];
      point[index] = value;
      editor.change(model.moved(editor.regions(), place, point));
    },
  }));
  const follow = () => {
    const point = model.ringAt(editor.regions(), editor.state.place)?.[editor.state.place.vertex];
    fields.forEach((field, index) => point && (field.value = point[index]));
  };
  return { fields, follow };
};

const densityField = (editor, index) => numberField({
  label: `Density of region ${index + 1}`, unit: "kg/m3", above: 0, optional: true,
  help: "Empty: 2400 kg/m\u00b3.",
  onChange: (value) => editor.change(model.withDensity(editor.regions(), index, value)),
});

// A new region stands on top of the others, as wide as they are and a quarter as high.
const newRegion = (editor) => {
  const regions = editor.regions();
  const points = regions.flatMap((each) => each.outline);
  const [xs, ys] = [0, 1].map((axis) => points.map((each) => each[axis]));
  const top = highest(ys);
  const ridge = points.filter((each) => each[1] === top).map((each) => each[0]);
  const whole = [lowest(xs), highest(xs)];
  const [left, right] = ridge.length > 1 ? [lowest(ridge), highest(ridge)] : whole;
  const high = tidy(top + (top - lowest(ys)) / 4, 6);
  const outline = [[left, top], [right, top], [right, high], [left, high]];
  editor.change(
    model.withRegion(regions, outline, regions.at(-1).density),
    { region: regions.length, ring: -1, vertex: 0 },
  );
};

const newHole = (editor) => {
  const { region } = editor.state.place;
  const regions = editor.regions();
  const hole = model.middleHole(regions[region].outline, (value) => tidy(value, 6));
  editor.change(
    model.withHole(regions, region, hole), { region, ring: regions[region].holes?.length ?? 0, vertex: 0 },
  );
};

const removePart = (editor) => {
  const { region } = editor.state.place;
  const next = model.withoutRing(editor.regions(), editor.state.place);
  editor.change(next, { region: Math.min(region, next.length - 1), ring: -1, vertex: 0 });
};
