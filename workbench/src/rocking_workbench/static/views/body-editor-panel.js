/** Controls around the canvas: undo, regions and holes, densities, grid, selected vertex. */

import { highest, lowest } from "/app/extremes.js";
import { editable, tidy } from "/app/format.js";
import { Button, NumberField, Switch } from "/parts/fields.js";
import { html } from "/parts/preact.js";
import * as model from "/views/body-editor-model.js";
import { t } from "/app/words.js";

/** Actions on the whole drawing; `children` are the tools. @param {{ editor: Editor, children?: any }} props */
export const Tools = ({ editor, children }) => {
  const { history, state } = editor;
  // a disabled button would lose the focus; aria-disabled keeps it
  /** @param {"undo" | "redo"} direction @param {string} text @param {boolean} can */
  const travel = (direction, text, can) => html`
    <${Button} aria-disabled=${can ? null : "true"} onClick=${() => editor.travel(direction)}>${text}<//>`;
  return html`<div class="toolbar">
    ${travel("undo", "Undo", history.canUndo())}${travel("redo", "Redo", history.canRedo())}
    <${Button} onClick=${() => newRegion(editor)}>Add region<//>
    <${Button} onClick=${() => newHole(editor)}>Add hole<//>
    <${Button} kind="danger" disabled=${state.selected.ring < 0 && editor.regions().length < 2} onClick=${() => removePart(editor)}>Remove region or hole<//>
    <${Button} onClick=${() => editor.change(model.onTheGround(editor.regions(), tidy))}>Move to the ground<//>
    ${children}
  </div>`;
};

/** The chosen vertex, the grid and the densities, in numbers. @param {{ editor: Editor }} props */
export const Details = ({ editor }) => {
  const { selected: position, snap, step } = editor.state;
  /** @type {Region[]} */
  const regions = editor.regions();
  const point = model.ringAt(regions, position)[position.vertex];
  /** @param {number} index */
  const put = (index) => (/** @type {number} */ value) => editor.change(model.moved(editor.regions(), position, point.with(index, value)));
  /** @param {number} index */
  const weigh = (index) => (/** @type {number | null} */ value) => editor.weigh(model.withDensity(editor.regions(), index, value), value);
  /** @param {"snap" | "step"} key */
  const set = (key) => (/** @type {any} */ value) => {
    Object.assign(editor.state, { [key]: value });
    editor.tell();
  };
  return html`
    <div class="stack">
      <div class="fields">
        ${["x", "y"].map((axis, index) => html`<${NumberField} key=${`${axis} ${Object.values(position)}`} label=${t("Vertex {axis}", { axis })}
          value=${point[index]} on=${put(index)} />`)}
        <${NumberField} label="Grid step" value=${step} on=${set("step")} above=${0} optional aside placeholder=${editable(editor.step())}
          help="Step of the grid and of the arrow keys (with Shift: ten steps). Empty: depends on the zoom." />
        <${Switch} label="Snap to grid" value=${snap} on=${set("snap")} />
      </div>
      <div class="fields" data-testid="densities">${regions.map(({ density }, index) => html`
        <${NumberField} key=${index} label=${t("Density of region {number}", { number: index + 1 })} unit="kg/m3" above=${0} optional
          help="Empty: 2400 kg/m\u00b3." value=${density} on=${weigh(index)} />`)}</div>
    </div>`;
};

// A new region is placed above the others, with their width and a quarter of their height.
/** @param {Editor} editor */
const newRegion = (editor) => {
  /** @type {Region[]} */
  const regions = editor.regions();
  const points = regions.flatMap((region) => region.outline);
  const [xs, ys] = [0, 1].map((axis) => points.map((point) => point[axis]));
  const top = highest(ys);
  const ridge = points.filter((point) => point[1] === top).map((point) => point[0]);
  const extent = [lowest(xs), highest(xs)];
  const [left, right] = ridge.length > 1 ? [lowest(ridge), highest(ridge)] : extent;
  const high = tidy(top + (top - lowest(ys)) / 4, 6);
  /** @type {Ring} */
  const outline = [[left, top], [right, top], [right, high], [left, high]];
  editor.change(
    model.withRegion(regions, outline, regions[regions.length - 1].density),
    { region: regions.length, ring: -1, vertex: 0 },
  );
};

/** @param {Editor} editor */
const newHole = (editor) => {
  const { region } = editor.state.selected;
  const regions = editor.regions();
  const hole = model.middleHole(regions[region].outline, (value) => tidy(value, 6));
  editor.change(
    model.withHole(regions, region, hole), { region, ring: regions[region].holes?.length ?? 0, vertex: 0 },
  );
};

/** @param {Editor} editor */
const removePart = (editor) => {
  const { region } = editor.state.selected;
  const next = model.withoutRing(editor.regions(), editor.state.selected);
  editor.change(next, { region: Math.min(region, next.length - 1), ring: -1, vertex: 0 });
};
