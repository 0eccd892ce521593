/** Polygon editor: vertices by pointer and keyboard, holes, densities, undo. */

import { html, signal, useLayoutEffect, useRef } from "/parts/preact.js";
import { tidy } from "/app/format.js";
import { Button, Card } from "/parts/fields.js";
import { createCanvas } from "/views/body-editor-canvas.js";
import * as model from "/views/body-editor-model.js";
import { Details, Tools } from "/views/body-editor-panel.js";
import { EdgePart, Pen, PenEnds, PhotoPart, createTool } from "/views/body-editor-tools.js";
import { PastePart } from "/views/body-paste.js";
import { regionsOf, shapeOf, weighed } from "/views/body-shapes.js";
import { METRES, inUnits } from "/views/body-units.js";

/** Editor of a polygon; not visible for other shapes. @param {{ editor: Editor }} props */
export const Editor = ({ editor }) => {
  const drawn = editor.drawn.value; // redraws all parts
  const [shown, there] = [editor.shown(), editor.regions().length > 0];
  return html`
    <div class="editor-place" hidden=${!shown}>
      <${Card} title="Draw" data-testid="editor">
        ${there && html`<${Tools} editor=${editor} drawn=${drawn}><${Pen} editor=${editor} drawn=${drawn} /><//>`}
        <div class="board-row">
          <div class="stack"><${Board} editor=${editor} />
            <p class="field-help board-told" role="status" data-testid="board-told">${editor.status.value}</p>
            ${there && html`<${PenEnds} editor=${editor} drawn=${drawn} />`}</div>
          ${there && html`<${Details} editor=${editor} drawn=${drawn} />`}</div>
        ${there && html`<${EdgePart} editor=${editor} drawn=${drawn} /><${PhotoPart} editor=${editor} drawn=${drawn} />`}
        <${PastePart} editor=${editor} /><//>
    </div>`;
};

/** @type {[string, string, (board: any) => unknown][]} */
const VIEWS = [
  ["+", "Zoom in", (board) => board.zoom(1.5)], ["\u2212", "Zoom out", (board) => board.zoom(1 / 1.5)],
  ["\u2922", "Show the whole body", (board) => board.fit()],
  ["\u2190", "Pan left", (board) => board.pan(80, 0)], ["\u2192", "Pan right", (board) => board.pan(-80, 0)],
  ["\u2191", "Pan up", (board) => board.pan(0, 80)], ["\u2193", "Pan down", (board) => board.pan(0, -80)],
];

/** @param {{ editor: Editor }} given */
const Board = ({ editor }) => {
  const box = useRef(null);
  useLayoutEffect(() => {
    editor.board = createCanvas(editor, box.current);
  }, []);
  return html`<div ref=${box} class="board-box"><div class="board-view">${VIEWS.map(([sign, label, look]) => html`
    <${Button} key=${label} kind="icon" aria-label=${label} title=${label} onClick=${() => look(editor.board)}>
      <span aria-hidden="true">${sign}</span><//>`)}</div></div>`;
};

// The view remains at the same position of the body; points in the former unit are removed.
/** @param {any} state @param {number} factor */
const changeUnits = (state, factor) => {
  state.tool = null;
  if (state.photo) for (const key of ["x", "y", "scale"]) state.photo[key] *= factor;
};

/** Drawing and its changes: `tell()` redraws the drawing. The tools and the canvas use this object.
 * @param {App} app */
export const createEditor = (app) => {
  const history = model.createHistory();
  const [drawn, boardText] = [signal(0), signal("")];
  // Photograph and tool remain in this browser and are not part of the body.
  /** @type {any} */
  const state = { selected: { region: 0, ring: -1, vertex: 0 }, snap: true, step: null, grid: null, tool: null, photo: null };
  const body = () => app.inputs.get().body;
  const regions = () => editable(body().section, app.body.get(), body().units);
  let { units } = body();
  // Feet and depth have their own fields: an undo step contains them only if the edit replaced the complete section.
  const now = ({ withSection = false } = {}) => {
    const { section, units: of } = body();
    return { section, regions: regions(), units: of, withSection };
  };
  const step = () => state.grid ?? state.step ?? 0.05;
  /** @type {Editor} */
  const editor = {
    state, history, regions, step, drawn, status: boardText, board: /** @type {any} */ (null), // before the first drawing
    tool: /** @type {any} */ (null), // at the end
    shown: () => shapeOf(body()) === "section",
    section: () => body().section,
    units: () => body().units,
    facts: () => app.body.get(),
    metres: () => METRES[body().units],
    refusal: () => inUnitsOf(app.body.error()?.place, METRES[body().units]),
    refusalWords: () => app.body.error()?.message ?? "",
    /** @param {Region[]} next @param {Place} [position] */
    change: (next, position = state.selected) => {
      history.keep(now());
      editor.adjust(next, position);
    },
    /** @param {Region[]} next @param {Place} [position] */
    adjust: (next, position = state.selected) => {
      state.selected = position;
      app.inputs.set("body.section.region", weighed(next, /** @type {any} */ (body().section ?? {})));
      editor.tell();
    },
    /** Regions with another density, which replaces a mass. @param {Region[]} next @param {number | null} density */
    weigh: (next, density) => {
      if (density !== null) app.inputs.set("body.section.mass", undefined);
      editor.change(next);
    },
    /** @param {object} section */
    replace: (section) => {
      history.keep(now({ withSection: true }));
      editor.show(section, { region: 0, ring: -1, vertex: 0 });
    },
    /** @param {object} section @param {Place} position */
    show: (section, position) => {
      state.selected = position;
      app.inputs.set("body.section", section);
      editor.tell();
    },
    keep: () => history.keep(now()),
    /** @param {Place} position */
    select: (position) => {
      state.selected = position;
      editor.tell();
    },
    /** @param {number[]} point */
    snapped: (point) => model.snapped(point, state.snap ? step() : 0, tidy),
    /** @param {"undo" | "redo"} direction */
    travel: (direction) => {
      const entry = history[direction](now);
      if (!entry) return;
      const table = entry.withSection ? entry.section : { region: entry.regions };
      const { section } = /** @type {any} */ (inUnits)({ units: entry.units, section: table }, body().units);
      const position = withinReach(entry.regions, state.selected);
      if (entry.withSection) editor.show(section, position);
      else editor.adjust(section.region, position);
    },
    say: app.say,
    tell: () => {
      if (editor.shown()) {
        if (units !== body().units) changeUnits(state, METRES[units] / editor.metres());
        ({ units } = body());
        const current = regions();
        if (current.length) state.selected = withinReach(current, state.selected);
        editor.board?.follow(); // first: the canvas has the grid step
      }
      drawn.value += 1;
    },
  };
  editor.tool = createTool(editor);
  return editor;
};

/** @param {Refusal["place"]} fault @param {number} metres */
const inUnitsOf = (fault, metres) => fault && {
  ...fault, x: fault.x === undefined ? undefined : fault.x / metres, y: fault.y === undefined ? undefined : fault.y / metres,
};

// Regions as text (WKT) become points at the first edit.
/** @param {any} section @param {Server.DescribedBody | null} facts @param {Unit} units @returns {Region[]} */
const editable = (section, facts, units) => {
  const stated = section?.region ?? [];
  return stated.every((/** @type {Region} */ region) => region.outline) ? stated : regionsOf(facts, units);
};

/** Nearest existing index after a change. @param {Region[]} regions @param {Place} place */
export const withinReach = (regions, { region, ring, vertex }) => {
  const atRegion = Math.min(region, regions.length - 1);
  const atRing = Math.min(ring, (regions[atRegion].holes?.length ?? 0) - 1);
  const points = model.ringAt(regions, { region: atRegion, ring: atRing });
  return { region: atRegion, ring: atRing, vertex: Math.min(vertex, points.length - 1) };
};
