/** An overturning map: point at a cell to see what is there, click it or walk to it to keep its history. */
import { el, fill } from "/app/dom.js";
import { segmented, selectField } from "/app/fields.js";
import { modelWords } from "/app/palette.js";
import { onTheme } from "/charts/style.js";
import { cellHistory } from "/views/studies-cell.js";
import { createGrid } from "/views/studies-grid.js";
import { cellWords, layersOf } from "/views/studies-layers.js";
import { greek } from "/views/studies-words.js";

const STEPS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

const START = "Click a cell, or walk with the arrow keys.";

const same = (one, other) => Boolean(other) && one.ix === other.ix && one.iy === other.iy;

/** Show a map inside a place; returns how to clear up. */
export const showMap = (place, app, study, found, chosen) => {
  const canvas = el("canvas", {
    class: "map-canvas",
    tabindex: "0",
    role: "application",
    "data-testid": "map-canvas",
    "aria-label": `Map of ${greek(found.x.words)} and ${greek(found.y.words)}; `
      + "arrow keys move from cell to cell, Enter opens the history in Response",
  });
  const stage = el("div", { class: "map-stage" }, canvas);
  const legend = el("ul", { class: "map-legend" });
  const told = el(
    "p",
    { class: "map-told", "aria-live": "polite", "data-testid": "map-told" },
    START,
  );
  const choices = el("div", { class: "map-choices" });
  const history = cellHistory(app, study);
  const state = { k: 0, layer: "verdict", aim: null, kept: null };
  const grid = createGrid(canvas, found.x, found.y);
  let layers = [];

  const draw = () => {
    const layer = layers.find((each) => each.value === state.layer) ?? layers[0];
    const lines = layer.value === "difference" ? [] : linesOf(found, state.k);
    grid.draw(layer.paint, [state.kept, state.aim], lines);
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
    const aim = grid.cellAt(event);
    if (aim && !same(aim, state.aim)) preview(aim);
  };
  const click = (event) => {
    const aim = grid.cellAt(event);
    if (aim) keep(aim);
  };
  const leave = () => {
    state.aim = state.kept ?? state.aim;
    draw();
    tell();
  };
  canvas.addEventListener("pointermove", hover);
  canvas.addEventListener("pointerleave", leave);
  canvas.addEventListener("click", click);
  canvas.addEventListener("keydown", walk);
  place.append(el("div", { class: "map" }, choices, stage, legend, told), history.node);
  grid.fit();
  choose();
  const observer = new ResizeObserver(() => (grid.fit(), draw()));
  observer.observe(stage);
  const forget = onTheme(draw);
  return () => {
    observer.disconnect();
    forget();
    history.destroy();
  };
};

const linesOf = (found, k) => (found.contours?.[k] ?? []).map((line) => line.points ?? line);
