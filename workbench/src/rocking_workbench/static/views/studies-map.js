/** Overturning map: the pointer shows a cell; a click or a key keeps its history. */
import { batch, html, useLayoutEffect, useMemo, useRef, useSignal } from "/parts/preact.js";
import { modelWords } from "/app/palette.js";
import { Pictured } from "/charts/pictured.js";
import { onTheme } from "/charts/style.js";
import { Button, Choice, Segmented } from "/parts/fields.js";
import { Cell, createCell } from "/views/studies-cell.js";
import { createGrid } from "/views/studies-grid.js";
import { cellWords, layersOf } from "/views/studies-layers.js";
import { greek } from "/views/studies-words.js";
import { t } from "/app/words.js";

/** @typedef {{ x: number, y: number, from: number[], frame: number[][] | null }} Drag */

/** @type {{ [key: string]: number[] | undefined }} */
const STEPS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

/** @type {{ [key: string]: number | undefined }} */
const CLOSER = { "+": 2, "=": 2, "-": 0.5 };
const MAP = "Map of {x} and {y}. Arrow keys move between cells, Enter opens the time history in Response, plus and minus zoom, 0 shows the whole map.";
const START = "Click a cell or use the arrow keys. Drag a frame or press + to zoom in.";
const SHORTEST = 6; // a shorter movement of the pointer is a click [CSS pixel]
/** @type {Lines} */
const NONE = [];

/** @param {Cell} first @param {Cell | null} other */
const same = (first, other) => other !== null && first.ix === other.ix && first.iy === other.iy;

/** A map, of one restitution and one layer at a time.
 * @param {{ app: App, study: Server.StudyFacts, result: MapFound, chosen: { restitution: number } }} props */
export const OverturningMap = ({ app, study, result, chosen }) => {
  const [canvas, painter] = [useRef(null), useRef(null)];
  const [k, layerName, aim, kept, frame, looks] = [0, "verdict", null, null, null, 0].map(useSignal);
  const cell = useMemo(() => createCell(app, study), []);
  const several = result.restitutions.length > 1;
  const [layers, lines] = useMemo(() => [
    layersOf(result, k.value, several ? (k.value === 0 ? 1 : 0) : null),
    result.contours?.[k.value] ?? NONE,
  ], [k.value]);
  const layer = layers.find(({ value }) => value === layerName.value) ?? layers[0];
  /** @param {Layer} of */
  const linesOf = (of) => (of.value === "difference" ? NONE : lines);
  /** @param {() => unknown} how */
  const look = (how) => {
    how();
    looks.value += 1;
  };
  useLayoutEffect(() => {
    const grid = createGrid(canvas.current, /** @type {MapAxis} */ (result.x), /** @type {MapAxis} */ (result.y));
    painter.current = grid;
    const fit = () => look(grid.fit);
    fit();
    const observer = new ResizeObserver(fit);
    observer.observe(canvas.current.parentElement);
    const forget = onTheme(fit);
    return () => {
      observer.disconnect();
      forget();
    };
  }, []);
  useLayoutEffect(() => painter.current.draw(layer.paint, [kept.value, aim.value], linesOf(layer), frame.value));

  /** @param {Cell} at */
  const keep = (at) => batch(() => {
    kept.value = at;
    aim.value = at;
    look(() => painter.current.reveal(at));
    cell.show(at, k.value, true);
  });
  /** @param {Cell} at */
  const preview = (at) => {
    aim.value = at;
    if (!kept.value) cell.show(at, k.value, false);
  };
  /** @param {number} value */
  const choose = (value) => batch(() => {
    k.value = chosen.restitution = value;
    if (kept.value) keep(kept.value);
  });
  /** @param {KeyboardEvent} event */
  const walk = (event) => {
    if (event.key === "Enter" && aim.value) return same(aim.value, kept.value) ? cell.open() : keep(aim.value);
    const factor = CLOSER[event.key];
    if (factor && !event.ctrlKey && !event.metaKey) return look(() => painter.current.closer(aim.value, factor));
    if (event.key === "0") return look(painter.current.showAll);
    const step = STEPS[event.key];
    if (!step) return undefined;
    event.preventDefault();
    const from = aim.value ?? { ix: -step[0], iy: -step[1] };
    /** @param {number} value @param {number} count */
    const within = (value, count) => Math.min(count - 1, Math.max(0, value));
    return keep({ ix: within(from.ix + step[0], result.x.values.length), iy: within(from.iy + step[1], result.y.values.length) });
  };
  const pointer = usePointer({ canvas, painter, frame, keep, preview, aim, look });
  const showAll = () => {
    canvas.current.focus();
    look(painter.current.showAll);
  };
  const looked = kept.value ?? aim.value;
  const leave = () => (aim.value = kept.value ?? aim.value);
  return html`<div class="study-result">
    <div class="map" data-about=${modelWords(result.restitutions[k.value])}>
      <div class="map-choices">
        ${several && html`<${Choice} label="Restitution" value=${k.value} on=${choose} options=${result.restitutions.map((label, value) => [value, modelWords(label)])} />`}
        <${Segmented} label="Show" value=${layer.value} on=${(value) => (layerName.value = value)} options=${layers.map(({ value, text }) => [value, text])} />
      </div>
      <${Pictured} title="Overturning map" more=${`: ${t(layer.text)}`} canvasOf=${() => painter.current.asSvg(layer.paint, linesOf(layer))}>
        <div class="map-stage"><canvas ref=${canvas} class="map-canvas" tabindex="0" role="application" data-testid="map-canvas"
          aria-label=${t(MAP, { x: greek(result.x.description), y: greek(result.y.description) })}
          onKeyDown=${walk} onPointerLeave=${leave} ...${pointer}></canvas></div>
        <ul class="map-legend">${layer.legend.map(({ paint, label: text }) => html`
          <li key=${text}><span class="map-key" aria-hidden="true" style=${{ backgroundColor: paint }}></span>${text}</li>`)}</ul><//>
      <div class="toolbar"><${Button} hidden=${looks.value === 0 || painter.current.isWhole()} onClick=${showAll}>Show the whole map<//></div>
      ${(result.islands?.[k.value] ?? []).map((/** @type {string} */ island) => html`<p key=${island} class="quiet" data-testid="map-islands">${island}</p>`)}
      <p class="map-told" aria-live="polite" data-testid="map-told">${aim.value ? cellWords(result, k.value, aim.value) : START}</p>
    </div>
    <div data-about=${looked ? cellWords(result, k.value, looked) : ""}><${Cell} cell=${cell} /></div>
  </div>`;
};

// Pointer on the map: shows a cell, keeps it with a click, or drags a zoom rectangle.
/** @param {{ canvas: any, painter: any, frame: Signal<any>, keep: (at: Cell) => unknown, preview: (at: Cell) => unknown, aim: Signal<Cell | null>, look: (how: () => unknown) => unknown }} given */
const usePointer = ({ canvas, painter, frame, keep, preview, aim, look }) => {
  const drag = useRef(null);
  const framed = useRef(false); // true if the next click must not keep a cell
  const end = () => {
    drag.current = null;
    frame.value = null;
  };
  return {
    /** @param {PointerEvent} event */
    onPointerDown: (event) => {
      framed.current = false;
      if (event.button !== 0 || event.pointerType === "touch" || !painter.current.cellAt(event)) return;
      drag.current = { x: event.clientX, y: event.clientY, from: painter.current.sharesAt(event) };
      canvas.current.setPointerCapture(event.pointerId);
    },
    /** @param {PointerEvent} event */
    onPointerMove: (event) => {
      const at = painter.current.cellAt(event);
      if (!drag.current) return at && !same(at, aim.value) ? preview(at) : undefined;
      const { x, y, from } = drag.current;
      const moved = Math.min(Math.abs(event.clientX - x), Math.abs(event.clientY - y)) >= SHORTEST;
      if (moved || frame.value) frame.value = [from, painter.current.sharesAt(event)];
      return undefined;
    },
    onPointerUp: () => {
      const shares = frame.value;
      end();
      if (!shares) return;
      framed.current = true;
      /** @param {number} axis */
      const between = (axis) => shares.map((/** @type {number[]} */ point) => Math.min(1, Math.max(0, point[axis]))).sort((/** @type {number} */ a, /** @type {number} */ b) => a - b);
      look(() => painter.current.look(between(0), between(1)));
    },
    onPointerCancel: end,
    /** @param {MouseEvent} event */
    onClick: (event) => {
      const at = painter.current.cellAt(event);
      if (at && !framed.current) keep(at);
      framed.current = false;
    },
  };
};
