/** The polygon editor: vertices that pointer and keyboard move alike, holes, densities, undo. */

import { createCanvas } from "/views/body-editor-canvas.js";
import * as model from "/views/body-editor-model.js";
import { createPanel } from "/views/body-editor-panel.js";
import { createTools } from "/views/body-editor-tools.js";
import { pastePart } from "/views/body-paste.js";
import { card, el, fill, tidy } from "/views/body-parts.js";
import { regionsOf, shapeOf } from "/views/body-shapes.js";
import { inUnits, METRES } from "/views/body-units.js";

/** Put the editor in its place; follow() shows it for a polygon and takes it away for any other shape. */
export const mountEditor = (place, app) => {
  const editor = createEditor(app);
  const canvas = createCanvas(editor);
  const [panel, tools] = [createPanel(editor), createTools(editor, canvas)];
  panel.tools.append(...tools.pen);
  const parts = [canvas, panel, tools]; // the board first: it knows the step of its grid
  const board = card("Draw", panel.tools,
    el("div", { class: "board-row" }, el("div", { class: "stack" }, canvas.element, tools.told, tools.ends), panel.details),
    tools.edge, tools.photo, pastePart(editor));
  board.dataset.testid = "editor";
  fill(place, board);
  let units = editor.units();
  const follow = () => {
    place.hidden = shapeOf(app.inputs.get().body) !== "section";
    if (place.hidden) return;
    if (units !== editor.units()) changeUnits(editor.state, METRES[units] / editor.metres());
    units = editor.units();
    const regions = editor.regions();
    if (regions.length) editor.state.place = withinReach(regions, editor.state.place);
    for (const part of parts) part.follow();
  };
  editor.watch(follow);
  app.inputs.subscribe((_, changed) => changed.has("body") && follow());
  follow();
  return { follow };
};

// The picture stays where it was on the body; points that were set in the former unit are gone.
const changeUnits = (state, factor) => {
  state.tool = null;
  if (state.photo) for (const key of ["x", "y", "scale"]) state.photo[key] *= factor;
};

const createEditor = (app) => {
  const history = model.createHistory();
  const watchers = new Set();
  // Photograph and tool are this browser's alone: they are no part of the body.
  const state = { place: { region: 0, ring: -1, vertex: 0 }, snap: true, step: null, grid: null, tool: null, photo: null };
  const body = () => app.inputs.get().body;
  const regions = () => editable(body().section, app.body.get(), body().units);
  const tell = () => watchers.forEach((each) => each());
  // Feet and depth are typed beside the board: a step takes them along only if it changed them itself.
  const now = ({ whole = false } = {}) => {
    const { section, units } = body();
    return { section, regions: regions(), units, whole };
  };
  const put = (next) => app.inputs.set("body.section.region", next);
  const step = () => state.grid ?? state.step ?? 0.05;
  const editor = {
    state, history, regions, step,
    section: () => body().section,
    units: () => body().units,
    facts: () => app.body.get(),
    metres: () => METRES[body().units],
    refusal: () => inUnitsOf(app.body.error()?.place, METRES[body().units]),
    refusalWords: () => app.body.error()?.message ?? "",
    watch: (watcher) => watchers.add(watcher),
    change: (next, place = state.place) => {
      history.keep(now());
      editor.adjust(next, place);
    },
    adjust: (next, place = state.place) => {
      state.place = place;
      put(next);
      tell();
    },
    replace: (section) => {
      history.keep(now({ whole: true }));
      editor.show(section, { region: 0, ring: -1, vertex: 0 });
    },
    show: (section, place) => {
      state.place = place;
      app.inputs.set("body.section", section);
      tell();
    },
    keep: () => history.keep(now()),
    select: (place) => {
      state.place = place;
      tell();
    },
    snapped: (point) => model.snapped(point, state.snap ? step() : 0, tidy),
    travel: (direction) => {
      const found = history[direction](now);
      if (!found) return;
      const table = found.whole ? found.section : { region: found.regions };
      const { section } = inUnits({ units: found.units, section: table }, body().units);
      const place = withinReach(found.regions, state.place);
      if (found.whole) editor.show(section, place);
      else editor.adjust(section.region, place);
    },
    say: app.say,
    tell,
  };
  return editor;
};

const inUnitsOf = (place, metres) => place && {
  ...place, x: place.x === undefined ? undefined : place.x / metres, y: place.y === undefined ? undefined : place.y / metres,
};

// Regions written as text (WKT) become points as soon as someone draws on them.
const editable = (section, facts, units) => {
  const given = section?.region ?? [];
  return given.every((each) => each.outline) ? given : regionsOf(facts, units);
};

/** The nearest place that exists after a change. */
export const withinReach = (regions, { region, ring, vertex }) => {
  const atRegion = Math.min(region, regions.length - 1);
  const atRing = Math.min(ring, (regions[atRegion].holes?.length ?? 0) - 1);
  const points = model.ringAt(regions, { region: atRegion, ring: atRing });
  return { region: atRegion, ring: atRing, vertex: Math.min(vertex, points.length - 1) };
};
