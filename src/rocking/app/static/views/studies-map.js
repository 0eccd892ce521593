/** An overturning map: point at a cell to see what is there, click it or walk to it to keep its history. */
import { el, fill } from "/app/dom.js";
import { button, segmented, selectField } from "/app/fields.js";
import { modelWords } from "/app/palette.js";
import { onTheme } from "/charts/style.js";
import { cellHistory } from "/views/studies-cell.js";
import { createGrid } from "/views/studies-grid.js";
import { cellWords, layersOf } from "/views/studies-layers.js";
import { greek } from "/views/studies-words.js";

const STEPS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

const CLOSER = { "+": 2, "=": 2, "-": 0.5 };
const START = "Click a cell, or walk with the arrow keys. Draw a frame with the pointer, or press +, to look closer.";
const SHORTEST = 6; // a pointer that moves less has clicked [CSS pixel]

const same = (one, other) => Boolean(other) && one.ix === other.ix && one.iy === other.iy;

/** Show a map inside a place; returns how to clear up. */
export const showMap = (place, app, study, found, chosen) => {
  const canvas = el("canvas", {
    class: "map-canvas",
    tabindex: "0",
    role: "application",
    "data-testid": "map-canvas",
    "aria-label": `Map of ${greek(found.x.words)} and ${greek(found.y.words)}; `
      + "arrow keys move from cell to cell, Enter opens the history in Response, "
      + "plus and minus look closer and from further away, 0 shows all",
  });
  const look = (how) => {
    how();
    draw();
  };
  const all = button({ text: "Show the whole map", onClick: () => (canvas.focus(), look(grid.whole)) });
  const stage = el("div", { class: "map-stage" }, canvas);
  const legend = el("ul", { class: "map-legend" });
  const told = el(
    "p",
    { class: "map-told", "aria-live": "polite", "data-testid": "map-told" },
    START,
  );
  const choices = el("div", { class: "map-choices" });
  const history = cellHistory(app, study);
  const state = { k: 0, layer: "verdict", aim: null, kept: null, drag: null };
  const grid = createGrid(canvas, found.x, found.y);
  let layers = [];
  let lines = NONE;
  let drawn = null;

  const draw = () => {
    const layer = layers.find((each) => each.value === state.layer) ?? layers[0];
    grid.draw(layer.paint, [state.kept, state.aim], layer.value === "difference" ? NONE : lines, state.drag?.frame);
    all.hidden = grid.isWhole();
    if (layer === drawn) return;
    drawn = layer;
    fill(
      legend,
      layer.legend.map(({ paint, words }) => {
        const key = el("span", { class: "map-key", "aria-hidden": "true" });
        key.style.backgroundColor = paint;
        return el("li", {}, key, words);
      }),
    );
  };
  const choose = () => {
    const several = found.restitutions.length > 1;
    lines = linesOf(found, state.k);
    layers = layersOf(found, state.k, several ? (state.k === 0 ? 1 : 0) : null);
    fill(
      choices,
      several
        ? selectField({
            label: "Restitution",
            value: state.k,
            options: found.restitutions.map((label, value) => ({ value, text: modelWords(label) })),
            onChange: (value) => {
              state.k = chosen.restitution = value;
              choose();
              if (state.kept) keep(state.kept);
            },
          })
        : null,
      segmented({
        label: "Show",
        options: layers.map(({ value, text }) => ({ value, text })),
        value: state.layer,
        onChange: (value) => ((state.layer = value), draw()),
      }),
    );
    draw();
  };
  const tell = () => fill(told, state.aim ? cellWords(found, state.k, state.aim) : START);
  const keep = (aim) => {
    state.kept = aim;
    state.aim = aim;
    grid.reveal(aim);
    draw();
    tell();
    history.show(aim, state.k, true);
  };
  const preview = (aim) => {
    state.aim = aim;
    draw();
    tell();
    if (!state.kept) history.show(aim, state.k, false);
  };
  const walk = (event) => {
    if (event.key === "Enter" && state.aim) {
      return same(state.aim, state.kept) ? history.open() : keep(state.aim);
    }
    const factor = CLOSER[event.key];
    if (factor && !event.ctrlKey && !event.metaKey) return look(() => grid.closer(state.aim, factor));
    if (event.key === "0") return look(grid.whole);
    const step = STEPS[event.key];
    if (!step) return undefined;
    event.preventDefault();
    const from = state.aim ?? { ix: -step[0], iy: -step[1] };
    const within = (value, count) => Math.min(count - 1, Math.max(0, value));
    return keep({
      ix: within(from.ix + step[0], found.x.values.length),
      iy: within(from.iy + step[1], found.y.values.length),
    });
  };
  const hover = (event) => {
    if (state.drag) return dragged(event);
    const aim = grid.cellAt(event);
    if (aim && !same(aim, state.aim)) preview(aim);
  };
  const press = (event) => {
    state.framed = false;
    if (event.button !== 0 || event.pointerType === "touch" || !grid.cellAt(event)) return;
    state.drag = { x: event.clientX, y: event.clientY, from: grid.sharesAt(event), frame: null };
    canvas.setPointerCapture(event.pointerId);
  };
  const dragged = (event) => {
    const { x, y, from, frame } = state.drag;
    const moved = Math.min(Math.abs(event.clientX - x), Math.abs(event.clientY - y)) >= SHORTEST;
    if (!moved && !frame) return;
    state.drag.frame = [from, grid.sharesAt(event)];
    draw();
  };
  const release = () => {
    const frame = state.drag?.frame;
    state.drag = null;
    if (!frame) return;
    state.framed = true; // the click that follows keeps no cell
    const between = (k) => frame.map((shares) => Math.min(1, Math.max(0, shares[k]))).sort((a, b) => a - b);
    look(() => grid.look(between(0), between(1)));
  };
  const click = (event) => {
    const aim = grid.cellAt(event);
    if (aim && !state.framed) keep(aim);
    state.framed = false;
  };
  const leave = () => {
    state.aim = state.kept ?? state.aim;
    draw();
    tell();
  };
  canvas.addEventListener("pointerdown", press);
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", () => ((state.drag = null), draw()));
  canvas.addEventListener("pointermove", hover);
  canvas.addEventListener("pointerleave", leave);
  canvas.addEventListener("click", click);
  canvas.addEventListener("keydown", walk);
  place.append(el("div", { class: "map" }, choices, stage, el("div", { class: "toolbar" }, all), legend, told), history.node);
  grid.fit();
  choose();
  const observer = new ResizeObserver(() => (grid.fit(), draw()));
  observer.observe(stage);
  const forget = onTheme(() => (grid.fit(), draw()));
  return () => {
    observer.disconnect();
    forget();
    history.destroy();
  };
};

const NONE = [];

const linesOf = (found, k) => (found.contours?.[k] ?? []).map((line) => line.points ?? line);
