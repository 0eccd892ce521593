/** Canvas of the regions, with pointer, keyboard and zoom. */

import { el, fill, svg } from "/app/dom.js";
import { number, tidy } from "/app/format.js";
import * as model from "/views/body-editor-model.js";
import { groundOf } from "/drawing/body-picture.js";
import { pathOf, regionPaths } from "/drawing/outline.js";
import { centreMark, footMark, label } from "/drawing/symbols.js";
import { boxOf, multiples, roundStep, viewport, viewportAt } from "/drawing/viewport.js";
import { t } from "/app/words.js";

const HEIGHT = 460;
const NARROWEST = 80; // width in pixels below which the canvas is not visible yet
const CELL = 12; // smallest width of a grid cell in pixels
const REACH = 16; // pixels from a vertex within which it is picked
const ZOOM = 1.25;
const [NEAREST, FARTHEST] = [1e6, 0.05]; // largest and smallest scale / scale at which the body fills the drawing board

const ABOUT = "Drawing board. Tab reaches the vertices; arrow keys move one, Delete removes it, Insert adds one after it. "
  + "Page Up and Page Down zoom, Control with arrow keys pans, Home shows the whole body.";

/** The board, in an element: {follow, zoom, pan, fit, focus}. @param {Editor} editor @param {HTMLElement} element */
export const createCanvas = (editor, element) => {
  const board = svg("svg", {
    class: "picture board", role: "group", tabindex: "0", "data-testid": "board", "aria-label": ABOUT,
  });
  const wrong = el("p", { class: "board-refusal", "aria-hidden": "true", hidden: true });
  element.prepend(board, wrong);
  let view = /** @type {Viewport} */ (/** @type {unknown} */ (null)); // null as long as the canvas has no width
  let width = 0;
  /** @type {any} */
  let drag = null;
  /** @type {{ middle: number[], scale: number } | null} */
  let look = null; // {middle, scale} once zoomed or panned; until then the whole body is shown
  let units = editor.units();

  const follow = () => {
    if (!width) return;
    const regions = editor.regions();
    if (!regions.length) return fill(board);
    if (units !== editor.units()) [look, units] = [null, editor.units()];
    if (look) view = viewportAt(look.middle, look.scale, { width, height: HEIGHT });
    else if (!drag) view = fitted(regions, width, editor.state.photo);
    const focused = /** @type {HTMLElement | null} */ (document.activeElement)?.dataset?.place;
    editor.state.grid = gridStep(view, editor.state.step);
    const faultPlace = editor.refusal();
    const rings = ringsNamed(faultPlace, regions);
    putWords(wrong, editor, view, width, refusedPoint(faultPlace, rings, view));
    set(board, width);
    fill(
      board, photograph(editor.state.photo, view), gridLines(view, width, editor.step()), regionPaths(regions, view),
      statics(editor, view), edges(regions, view), picked(editor, regions, view), refused(faultPlace, rings, view, width),
      vertices(editor, regions, view), toolMarks(editor, view),
    );
    board.dataset.tool = editor.state.tool?.kind ?? "";
    board.toggleAttribute("data-photo", Boolean(editor.state.photo));
    if (
      focused && element.contains(document.activeElement) === false
    ) focusOn(focused);
  };

  /** @param {string} key */
  const focusOn = (key) => /** @type {SVGElement | null} */ (board.querySelector(`[data-place="${key}"]`))?.focus({ preventScroll: true });
  const middle = () => view.back(width / 2, HEIGHT / 2);
  /** @param {number[]} point @param {number} [scale] */
  const lookAt = (point, scale = view.scale) => {
    const fittedScale = fitted(editor.regions(), width, editor.state.photo).scale;
    look = { middle: point, scale: Math.min(NEAREST * fittedScale, Math.max(FARTHEST * fittedScale, scale)) };
    editor.tell();
  };
  /** Zoom by a factor about a fixed point. @param {number} factor @param {number[]} [point] */
  const zoom = (factor, point = chosenPoint(editor, view, width) ?? middle()) => {
    const [x, y] = [view.x(point[0]), view.y(point[1])];
    lookAt(middle(), view.scale * factor);
    pan(x - view.x(point[0]), y - view.y(point[1]));
  };
  /** @param {number} dx @param {number} dy */
  const pan = (dx, dy) => lookAt(view.back(width / 2 - dx, HEIGHT / 2 - dy));
  const fit = () => {
    look = null;
    editor.tell();
  };
  /** @param {MouseEvent} event */
  const pixelOf = (event) => {
    const box = board.getBoundingClientRect();
    return [((event.clientX - box.left) * width) / box.width, ((event.clientY - box.top) * HEIGHT) / box.height];
  };
  /** @param {MouseEvent} event */
  const pointOf = (event) => view.back(.../** @type {Point} */ (pixelOf(event)));
  /** @param {number[]} point */
  const neat = (point) => editor.snapped(point).map((coordinate) => tidy(coordinate, 9));

  const fingers = new Map();
  /** @param {any} event */
  const begin = (event) => {
    const regions = editor.regions();
    const point = pointOf(event);
    const target = model.nearest(regions, point, REACH / view.scale, editor.state.selected);
    const edge = event.target.closest("[data-edge]");
    if (editor.state.tool) {
      editor.tool.put(editor.state.tool.kind === "pen" ? neat(point) : point, REACH / view.scale);
      return board.focus({ preventScroll: true });
    }
    if (target) drag = { vertex: target, begun: false };
    else if (edge) {
      const after = placeOf(edge.dataset.edge);
      editor.change(model.inserted(regions, after, neat(point)), { ...after, vertex: after.vertex + 1 });
      drag = { vertex: editor.state.selected, begun: true };
    } else drag = { from: pixelOf(event) };
    if (!drag.vertex) return board.focus({ preventScroll: true });
    editor.select(drag.vertex);
    focusOn(keyOf(drag.vertex));
  };
  board.addEventListener("pointerdown", (event) => {
    if (event.button > 0) return;
    event.preventDefault();
    fingers.set(event.pointerId, pixelOf(event));
    try {
      board.setPointerCapture(event.pointerId);
    } catch {
      // A pointer outside the canvas is ignored.
    }
    if (fingers.size > 1) drag = { pinch: true };
    else begin(event);
  });
  board.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (!before || !drag) return;
    const now = pixelOf(event);
    fingers.set(event.pointerId, now);
    if (drag.pinch) return pinch(event.pointerId, before, now);
    if (drag.from) {
      pan(now[0] - drag.from[0], now[1] - drag.from[1]);
      drag.from = now;
      return undefined;
    }
    if (!drag.begun) editor.keep();
    drag.begun = true;
    return editor.adjust(model.moved(editor.regions(), drag.vertex, neat(pointOf(event))), drag.vertex);
  });
  /** @param {number} id @param {number[]} before @param {number[]} now */
  const pinch = (id, before, now) => {
    const other = [...fingers].find(([finger]) => finger !== id)?.[1];
    if (!other) return;
    /** @param {number[]} position */
    const spread = (position) => Math.hypot(position[0] - other[0], position[1] - other[1]);
    const held = view.back((before[0] + other[0]) / 2, (before[1] + other[1]) / 2);
    if (spread(before) > 8 && spread(now) > 8) zoom(spread(now) / spread(before), held);
    pan((now[0] - before[0]) / 2, (now[1] - before[1]) / 2);
  };
  for (const end of ["pointerup", "pointercancel"]) {
    board.addEventListener(end, (/** @type {any} */ event) => {
      fingers.delete(event.pointerId);
      if (!drag || (drag.pinch && fingers.size)) return;
      drag = null;
      follow();
    });
  }
  // Two fingers move the board; one finger scrolls the page.
  board.addEventListener("touchmove", (event) => event.touches.length > 1 && event.preventDefault(), { passive: false });
  board.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && !event.metaKey && !board.contains(document.activeElement)) return;
    event.preventDefault();
    zoom(ZOOM ** (-event.deltaY / (event.deltaMode ? 3 : 100)), pointOf(event));
  }, { passive: false });
  board.addEventListener("focusin", (event) => {
    const key = /** @type {HTMLElement} */ (event.target).dataset?.place;
    if (!key) return;
    if (key !== keyOf(editor.state.selected)) editor.select(placeOf(key));
    const point = model.ringAt(editor.regions(), editor.state.selected)[editor.state.selected.vertex];
    if (!inSight(view, width, point)) lookAt(point);
  });
  /** @type {{ [key: string]: (() => unknown) | undefined }} */
  const views = {
    PageUp: () => zoom(ZOOM), PageDown: () => zoom(1 / ZOOM), Home: fit,
    "Control+ArrowLeft": () => pan(60, 0), "Control+ArrowRight": () => pan(-60, 0),
    "Control+ArrowUp": () => pan(0, 60), "Control+ArrowDown": () => pan(0, -60),
  };
  board.addEventListener("keydown", (event) => {
    const seen = views[`${event.ctrlKey || event.metaKey ? "Control+" : ""}${event.key}`];
    if (seen) {
      event.preventDefault();
      seen();
    } else onKey(event, editor, () => chosenPoint(editor, view, width) ?? middle());
  });
  new ResizeObserver(([entry]) => {
    const next = Math.floor(entry.contentRect.width);
    if (next > NARROWEST && next !== width) {
      width = next;
      editor.tell();
    }
  }).observe(element);
  return { follow, zoom, pan, fit, focus: () => board.focus() };
};

/** @param {SVGSVGElement} board @param {number} width */
const set = (board, width) => {
  board.setAttribute("viewBox", `0 0 ${width} ${HEIGHT}`);
  board.setAttribute("height", String(HEIGHT));
};

/** @param {Region[]} regions @param {number} width @param {any} photo */
const fitted = (regions, width, photo) => {
  const corners = photo ? [[photo.x, photo.y], [photo.x + photo.scale * photo.width, photo.y + photo.scale * photo.height]] : [];
  const box = boxOf([...regions.flatMap((region) => region.outline), ...corners]);
  const air = 0.08 * Math.max(box.right - box.left, box.top - box.bottom);
  const roomy = {
    left: box.left - air, right: box.right + air, top: box.top + air, bottom: Math.min(box.bottom, 0) - air,
  };
  return viewport(roomy, { width, height: HEIGHT, margin: { left: 44, right: 12, top: 10, bottom: 26 } });
};

// The visible step is also the snap step. It is the typed step, doubled until its cells are visible, or a round step
// with visible cells if no step is typed.
/** @param {Viewport} view @param {number | null | undefined} typed */
const gridStep = (view, typed) => {
  if (!typed) return tidy(roundStep(CELL / view.scale, 1));
  const times = [1, 2, 5].flatMap((mantissa) => Array.from({ length: 12 }, (_, power) => mantissa * 10 ** power));
  return tidy(typed * (times.sort((a, two) => a - two).find((factor) => typed * factor * view.scale >= CELL / 3) ?? 1));
};

/** @param {Viewport} view @param {number} width @param {number[]} point */
const inSight = (view, width, [x, y]) =>
  view.x(x) >= 0 && view.x(x) <= width && view.y(y) >= 0 && view.y(y) <= HEIGHT;

/** @param {Editor} editor @param {Viewport} view @param {number} width */
const chosenPoint = (editor, view, width) => {
  const { selected: vertexIndex, tool } = editor.state;
  const point = tool ? tool.cursor : model.ringAt(editor.regions(), vertexIndex)?.[vertexIndex.vertex];
  return point && inSight(view, width, point) ? point : null;
};

/** @param {Viewport} view @param {number} width @param {number} step */
const gridLines = (view, width, step) => {
  const [[left, top], [right, bottom]] = [view.back(0, 0), view.back(width, HEIGHT)];
  const many = [1, 2, 5, 10, 20, 50, 100].find((count) => count * step * view.scale >= 60) ?? 100;
  /** @param {number} value */
  const isLabelled = (value) => Math.round(value / step) % many === 0;
  const digits = Math.max(4, Math.ceil(Math.log10(Math.max(Math.abs(left), Math.abs(right), Math.abs(top)) / step)) + 1);
  /** @param {number} value @param {string} zero @param {string} d */
  const line = (value, zero, d) => svg("path", { class: Math.abs(value) < step / 2 ? zero : isLabelled(value) ? "grid-line labelled" : "grid-line", d });
  return svg("g", { "aria-hidden": "true", "data-step": step },
    multiples(left, right, step).map((value) => [
      line(value, "axis", `M${view.x(value)} 0V${HEIGHT}`),
      isLabelled(value) && svg(
        "text", { class: "soft", x: view.x(value), y: HEIGHT - 6, "text-anchor": "middle" },
        number(tidy(value), digits),
      ),
    ]),
    multiples(bottom, top, step).map((value) => [
      line(value, "ground", `M0 ${view.y(value)}H${width}`),
      isLabelled(value) && svg("text", { class: "soft", x: 6, y: view.y(value) - 4 }, number(tidy(value), digits)),
    ]));
};

/** @param {any} photo @param {Viewport} view */
const photograph = (photo, view) => photo && svg("image", {
  href: photo.url, x: view.x(photo.x), y: view.y(photo.y + photo.scale * photo.height), opacity: photo.opacity,
  width: photo.scale * photo.width * view.scale, height: photo.scale * photo.height * view.scale,
  preserveAspectRatio: "none", "aria-hidden": "true",
});

/** @param {Editor} editor @param {Viewport} view */
const statics = (editor, view) => {
  const facts = editor.facts();
  if (!facts || editor.refusalWords()) return null; // a refused body has no properties
  const metres = editor.metres();
  return svg("g", { class: "board-facts", "aria-hidden": "true" },
    facts.foot_positions.map((foot) => footMark(view.x(foot / metres), view.y(groundOf(facts) / metres))),
    centreMark(view.x(facts.centre[0] / metres), view.y(facts.centre[1] / metres)));
};

/** @param {Region[]} regions @param {Viewport} view */
const edges = (regions, view) =>
  model.ringsOf(regions).flatMap(({ region, ring, points }) =>
    points.map(([x, y], vertex) => {
      const [nextX, nextY] = points[(vertex + 1) % points.length];
      return svg("path", {
        class: "edge", "data-edge": keyOf({ region, ring, vertex }),
        d: `M${view.x(x)} ${view.y(y)}L${view.x(nextX)} ${view.y(nextY)}`,
      });
    }));

// Edge after the selected vertex, with its dimensions.
/** @param {Editor} editor @param {Region[]} regions @param {Viewport} view */
const picked = (editor, regions, view) => {
  const { from, to, length, angle } = model.edgeAt(regions, editor.state.selected);
  const [[x1, y1], [x2, y2]] = [from, to].map(([x, y]) => [view.x(x), view.y(y)]);
  const flat = Math.abs(x2 - x1) > Math.abs(y2 - y1);
  return svg("g", { class: "edge-picked", "aria-hidden": "true" },
    svg("path", { class: "accent-line", d: `M${x1} ${y1}L${x2} ${y2}` }),
    !editor.refusal() && label((x1 + x2) / 2 + (flat ? 0 : 9), (y1 + y2) / 2 - (flat ? 9 : 0), `${number(length)}\u00a0${editor.units()}, ${number(tidy(angle, 9))}°`, {
      "text-anchor": flat ? "middle" : "start",
    }));
};

// Location of an error: a ring around the point, a line at its height, or the named outlines.
/** @param {any} fault @param {Ring[]} rings @param {Viewport} view @param {number} width */
const refused = (fault, rings, view, width) => {
  if (!fault) return null;
  const marks = fault.y === undefined ? rings.map((ring) => svg("path", { class: "refused", d: pathOf([ring], view) }))
    : fault.x === undefined ? svg("path", { class: "refused", d: `M0 ${view.y(fault.y)}H${width}` })
      : svg("g", { class: "refused", transform: `translate(${view.x(fault.x)} ${view.y(fault.y)})` },
        svg("circle", { r: 13 }), svg("path", { d: "M-5 -5L5 5M-5 5L5 -5" }));
  return svg("g", { "data-testid": "board-refusal", "aria-hidden": "true" }, marks);
};

/** @param {any} fault @param {Ring[]} rings @param {Viewport} view */
const refusedPoint = (fault, rings, view) => {
  if (!fault) return null;
  if (fault.y !== undefined) return [fault.x ?? view.back(0, 0)[0], fault.y];
  const box = rings.length && boxOf(rings[rings.length - 1]);
  return box ? [(box.left + box.right) / 2, (box.bottom + box.top) / 2] : null;
};

/** @param {any} fault @param {Region[]} regions */
const ringsNamed = (fault, regions) => (fault?.regions ?? []).map((/** @type {number} */ index) => regions[index]).filter(Boolean)
  .map((/** @type {Region} */ region) => region.holes?.[fault.hole] ?? region.outline);

// Message of the error next to its mark; the alert below contains it for screen readers.
/** @param {HTMLElement} note @param {Editor} editor @param {Viewport} view @param {number} width @param {number[] | null} point */
const putWords = (note, editor, view, width, point) => {
  note.hidden = !point;
  if (!point) return;
  // next to the body if possible, so that no vertex is hidden
  const box = boxOf(editor.regions().flatMap((region) => region.outline));
  const [left, right] = [view.x(box.left), width - view.x(box.right)].map((room) => Math.min(room, width - 20) - 20);
  const [side, other] = left >= right ? ["right", "left"] : ["left", "right"];
  const room = Math.max(left, right);
  const y = Math.min(Math.max(view.y(point[1]), 0), HEIGHT - 20);
  const [low, off] = [y > HEIGHT / 2, room > 110 ? 0 : 18];
  Object.assign(note.style, {
    [side]: `${room > 110 ? width - room : 8}px`, [other]: "auto", maxWidth: `${room > 110 ? Math.min(240, room) : 160}px`,
    top: low ? "auto" : `${y + off}px`, bottom: low ? `${(note.parentElement?.clientHeight ?? 0) - y + off}px` : "auto",
  });
  if (note.textContent !== editor.refusalWords()) fill(note, editor.refusalWords());
};

/** @param {Editor} editor @param {Region[]} regions @param {Viewport} view */
const vertices = (editor, regions, view) => {
  const chosen = keyOf(editor.state.selected);
  return model.ringsOf(regions).flatMap(({ region, ring, points }) =>
    points.map(([x, y], vertex) => {
      const key = keyOf({ region, ring, vertex });
      const where = `${ring < 0 ? t("region {region}", { region: region + 1 }) : t("hole {hole} of region {region}", { hole: ring + 1, region: region + 1 })}`;
      return svg("g", {
        class: `vertex${key === chosen ? " chosen" : ""}`, tabindex: "0", role: "button", "data-place": key,
        transform: `translate(${view.x(x)} ${view.y(y)})`,
        "aria-label": t("Vertex {number} of {ring}: x {x}, y {y} {unit}", { number: vertex + 1, ring: where, x: number(x, 7), y: number(y, 7), unit: editor.units() }),
      }, svg("circle", { class: "reach", r: 16 }), svg("circle", { class: "dot", r: 5.5 }));
    }));
};

// Present points, and the position of the next point.
/** @param {Editor} editor @param {Viewport} view */
const toolMarks = (editor, view) => {
  const { tool } = editor.state;
  if (!tool) return null;
  /** @param {number[]} point */
  const at = ([x, y]) => `${view.x(x)} ${view.y(y)}`;
  return svg("g", { class: "tool-marks", "data-testid": "tool-marks", "aria-hidden": "true" },
    tool.points.length > 1 && svg("path", { class: "accent-line", d: `M${tool.points.map(at).join("L")}` }),
    tool.points.map((point) => svg("circle", { r: 5.5, cx: view.x(point[0]), cy: view.y(point[1]) })),
    tool.cursor && svg("path", { class: "cursor", d: "M-12 0H12M0 -12V12", transform: `translate(${at(tool.cursor)})` }));
};

/** @param {any} event @param {Editor} editor @param {() => number[]} start */
const onKey = (event, editor, start) => {
  const key = event.target.dataset?.place;
  if (event.key.toLowerCase() === "z" && (event.ctrlKey || event.metaKey)) {
    event.preventDefault();
    return editor.travel(event.shiftKey ? "redo" : "undo");
  }
  if (editor.state.tool) {
    if (editor.tool.key(event.key, event.shiftKey ? 10 : 1, start)) event.preventDefault();
    return undefined;
  }
  const action = key && actions[event.key];
  if (!action) return undefined;
  event.preventDefault();
  return action(editor, placeOf(key), event.shiftKey ? 10 : 1);
};

/** @param {number} dx @param {number} dy @returns {(editor: Editor, vertex: Place, times: number) => void} */
const shifted = (dx, dy) => (editor, vertexIndex, times) => {
  const [x, y] = model.ringAt(editor.regions(), vertexIndex)[vertexIndex.vertex];
  const by = editor.step() * times;
  editor.change(model.moved(editor.regions(), vertexIndex, [tidy(x + dx * by), tidy(y + dy * by)]), vertexIndex);
};

/** @param {Editor} editor @param {Place} vertexIndex */
const drop = (editor, vertexIndex) => {
  const next = model.removed(editor.regions(), vertexIndex);
  if (next === editor.regions()) return editor.say("A polygon needs at least three vertices.", "warning");
  return editor.change(next, { ...vertexIndex, vertex: Math.max(0, vertexIndex.vertex - 1) });
};

/** @param {Editor} editor @param {Place} vertexIndex */
const add = (editor, vertexIndex) => {
  const { from, to } = model.edgeAt(editor.regions(), vertexIndex);
  editor.change(
    model.inserted(editor.regions(), vertexIndex, [0, 1].map((axis) => tidy((from[axis] + to[axis]) / 2))),
    { ...vertexIndex, vertex: vertexIndex.vertex + 1 },
  );
};

/** @type {{ [key: string]: ((editor: Editor, vertex: Place, times: number) => unknown) | undefined }} */
const actions = {
  ArrowLeft: shifted(-1, 0), ArrowRight: shifted(1, 0), ArrowUp: shifted(0, 1), ArrowDown: shifted(0, -1),
  Delete: drop, Backspace: drop, Insert: add, "+": add,
};

/** @param {Place} place */
const keyOf = ({ region, ring, vertex }) => `${region}:${ring}:${vertex}`;

/** @param {string} key @returns {Place} */
const placeOf = (key) => {
  const [region, ring, vertex] = key.split(":").map(Number);
  return { region, ring, vertex };
};
