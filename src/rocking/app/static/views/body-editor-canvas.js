/** The board on which regions are drawn: drag a vertex, click an edge, or use the keys. */

import { el, fill, number, svg, tidy } from "/views/body-parts.js";
import * as model from "/views/body-editor-model.js";
import { regionPaths } from "/drawing/outline.js";
import { centreMark, footMark } from "/drawing/symbols.js";
import { boxOf, multiples, roundStep, viewport } from "/drawing/viewport.js";

const HEIGHT = 460;

/** The board: {element, follow}. */
export const createCanvas = (editor) => {
  const board = svg("svg", {
    class: "picture board", role: "group", "data-testid": "board",
    "aria-label": "Drawing board. Tab reaches the vertices; arrow keys move one, "
      + "Delete removes it, Insert adds one after it.",
  });
  const element = el("div", { class: "board-box" }, board);
  let view = null;
  let drag = null;
  let width = 0;

  const follow = () => {
    if (!width) return;
    const regions = editor.regions();
    if (!regions.length) return fill(board);
    if (!drag) view = fitted(regions, width);
    const focused = document.activeElement?.dataset?.place;
    set(board, width);
    fill(
      board, gridLines(view, width), regionPaths(regions, view), statics(editor, view), edges(regions, view),
      vertices(editor, regions, view),
    );
    if (
      focused && element.contains(document.activeElement) === false
    ) board.querySelector(`[data-place="${focused}"]`)?.focus();
  };

  const pointOf = (event) => {
    const box = board.getBoundingClientRect();
    return view.back(
      ((event.clientX - box.left) * width) / box.width, ((event.clientY - box.top) * HEIGHT) / box.height,
    );
  };
  board.addEventListener("pointerdown", (event) => {
    const handle = event.target.closest("[data-place]");
    const edge = event.target.closest("[data-edge]");
    if (handle) drag = { place: placeOf(handle.dataset.place), begun: false };
    else if (edge) addOn(editor, placeOf(edge.dataset.edge), pointOf(event));
    else return;
    event.preventDefault();
    if (drag) {
      board.setPointerCapture(event.pointerId);
      editor.select(drag.place);
      board.querySelector(`[data-place="${keyOf(drag.place)}"]`)?.focus();
    }
  });
  board.addEventListener("pointermove", (event) => {
    if (!drag) return;
    if (!drag.begun) editor.keep();
    drag.begun = true;
    editor.adjust(
      model.moved(editor.regions(), drag.place, editor.snapped(pointOf(event)).map((each) => tidy(each, 6))),
      drag.place,
    );
  });
  for (const end of ["pointerup", "pointercancel"]) {
    board.addEventListener(end, () => {
      if (!drag) return;
      drag = null;
      follow();
    });
  }
  board.addEventListener("focusin", (event) => {
    const key = event.target.dataset?.place;
    if (key && key !== keyOf(editor.state.place)) editor.select(placeOf(key));
  });
  board.addEventListener("keydown", (event) => onKey(event, editor));
  new ResizeObserver(([entry]) => {
    const next = Math.floor(entry.contentRect.width);
    if (next && next !== width) {
      width = next;
      follow();
    }
  }).observe(element);
  return { element, follow };
};

const set = (board, width) => {
  board.setAttribute("viewBox", `0 0 ${width} ${HEIGHT}`);
  board.setAttribute("height", HEIGHT);
};

const fitted = (regions, width) => {
  const box = boxOf(regions.flatMap((each) => each.outline));
  const air = 0.08 * Math.max(box.right - box.left, box.top - box.bottom);
  const roomy = {
    left: box.left - air, right: box.right + air, top: box.top + air, bottom: Math.min(box.bottom, 0) - air,
  };
  return viewport(roomy, { width, height: HEIGHT, margin: { left: 44, right: 12, top: 10, bottom: 26 } });
};

const gridLines = (view, width) => {
  const [[left, top], [right, bottom]] = [view.back(0, 0), view.back(width, HEIGHT)];
  const step = roundStep(right - left, Math.max(4, width / 70));
  const lines = (values, draw) => values.map(draw);
  return svg("g", { "aria-hidden": "true" },
    lines(multiples(left, right, step), (value) => [
      svg("path", { class: value === 0 ? "axis" : "grid-line", d: `M${view.x(value)} 0V${HEIGHT}` }),
      svg(
        "text", { class: "soft", x: view.x(value), y: HEIGHT - 6, "text-anchor": "middle" },
        number(tidy(value), 4),
      ),
    ]),
    lines(multiples(bottom, top, step), (value) => [
      svg("path", { class: value === 0 ? "ground" : "grid-line", d: `M0 ${view.y(value)}H${width}` }),
      svg("text", { class: "soft", x: 6, y: view.y(value) - 4 }, number(tidy(value), 4)),
    ]));
};

const statics = (editor, view) => {
  const facts = editor.facts();
  if (!facts) return null;
  const metres = editor.metres();
  return svg("g", { class: "board-facts", "aria-hidden": "true" },
    facts.feet_m.map((foot) => footMark(view.x(foot / metres), view.y(0))),
    centreMark(view.x(facts.centre_m[0] / metres), view.y(facts.centre_m[1] / metres)));
};

const edges = (regions, view) =>
  model.ringsOf(regions).flatMap(({ region, ring, points }) =>
    points.map(([x, y], vertex) => {
      const [nextX, nextY] = points[(vertex + 1) % points.length];
      return svg("path", {
        class: "edge", "data-edge": keyOf({ region, ring, vertex }),
        d: `M${view.x(x)} ${view.y(y)}L${view.x(nextX)} ${view.y(nextY)}`,
      });
    }));

const vertices = (editor, regions, view) => {
  const chosen = keyOf(editor.state.place);
  return model.ringsOf(regions).flatMap(({ region, ring, points }) =>
    points.map(([x, y], vertex) => {
      const key = keyOf({ region, ring, vertex });
      const where = `${ring < 0 ? `region ${region + 1}` : `hole ${ring + 1} of region ${region + 1}`}`;
      return svg("g", {
        class: `vertex${key === chosen ? " chosen" : ""}`, tabindex: "0", role: "button", "data-place": key,
        transform: `translate(${view.x(x)} ${view.y(y)})`,
        "aria-label": `Vertex ${vertex + 1} of ${where}: x ${number(x)}, y ${number(y)} ${editor.units()}`,
      }, svg("circle", { class: "reach", r: 16 }), svg("circle", { class: "dot", r: 5.5 }));
    }));
};

const addOn = (editor, place, point) => {
  const regions = editor.regions();
  editor.change(
    model.inserted(regions, place, editor.snapped(point).map((each) => tidy(each, 6))),
    { ...place, vertex: place.vertex + 1 },
  );
};

const onKey = (event, editor) => {
  const key = event.target.dataset?.place;
  if (event.key.toLowerCase() === "z" && (event.ctrlKey || event.metaKey)) {
    event.preventDefault();
    return editor.travel(event.shiftKey ? "redo" : "undo");
  }
  const action = key && actions[event.key];
  if (!action) return;
  event.preventDefault();
  action(editor, placeOf(key), event.shiftKey ? 10 : 1);
};

const shifted = (dx, dy) => (editor, place, times) => {
  const [x, y] = model.ringAt(editor.regions(), place)[place.vertex];
  const by = editor.step() * times;
  editor.change(model.moved(editor.regions(), place, [tidy(x + dx * by), tidy(y + dy * by)]), place);
};

const drop = (editor, place) => {
  const next = model.removed(editor.regions(), place);
  if (next === editor.regions()) return editor.say("A polygon keeps at least three vertices.", "warning");
  editor.change(next, { ...place, vertex: Math.max(0, place.vertex - 1) });
};

const add = (editor, place) => {
  const ring = model.ringAt(editor.regions(), place);
  const [[x, y], [nextX, nextY]] = [ring[place.vertex], ring[(place.vertex + 1) % ring.length]];
  editor.change(
    model.inserted(editor.regions(), place, [tidy((x + nextX) / 2), tidy((y + nextY) / 2)]),
    { ...place, vertex: place.vertex + 1 },
  );
};

const actions = {
  ArrowLeft: shifted(-1, 0), ArrowRight: shifted(1, 0), ArrowUp: shifted(0, 1), ArrowDown: shifted(0, -1),
  Delete: drop, Backspace: drop, Insert: add, "+": add,
};

const keyOf = ({ region, ring, vertex }) => `${region}:${ring}:${vertex}`;

const placeOf = (key) => {
  const [region, ring, vertex] = key.split(":").map(Number);
  return { region, ring, vertex };
};
