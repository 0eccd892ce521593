/** A line chart as an SVG of its own: what is on the screen, in lines and letters. */

import { freshId, svg } from "/app/dom.js";
import { words as inLanguage } from "/app/words.js";
import { measured } from "/charts/letters.js";
import { colour } from "/charts/style.js";

/** @typedef {import("/vendor/uplot/uPlot.esm.js").default} uPlot @typedef {ReturnType<typeof frameOf>} Frame */

/** Height of a row of ticks on the axis [px]. */
export const TICK = 6;

const [ROW, BELOW, EDGE] = [20, 50, 2]; // of a legend, below the frame, and of curves that lie on its edge [px]

/** What a chart shows, with its legend. @param {uPlot} plot @param {ChartOptions} options @param {Columns} data @param {Marks} marks */
export const vectorOf = (plot, { series, bands = [] }, data, marks) => {
  const legend = series.length > 1 ? legendOf(series, plot.width) : null;
  const frame = frameOf(plot);
  const clip = freshId("clip");
  const inside = svg("g", { "clip-path": `url(#${clip})`, fill: "none" },
    bands.map((band) => bandOf(frame, band, data)),
    (marks.vertical ?? []).map((value) => markOf(frame, frame.x(value), null)),
    (marks.horizontal ?? []).map((value) => markOf(frame, null, frame.y(value))),
    (marks.ticks ?? []).map((row, k) => ticksOf(frame, row, k)),
    series.map((each, index) => curveOf(frame, each, data[0], data[index + 1] ?? [])));
  const { left, top, width, height } = frame.box;
  return under(legend, plot.width, Math.min(plot.height, Math.ceil(top + height + BELOW)),
    svg("clipPath", { id: clip }, svg("rect", { x: left, y: top - EDGE, width, height: height + 2 * EDGE })), axesOf(plot, frame), inside,
    series.map((each, index) => dotsOf(frame, each, data[0], data[index + 1] ?? [])));
};

/** A drawing under its legend. @param {SVGElement | null} legend @param {number} width @param {number} height @param {...Child} drawing */
export const under = (legend, width, height, ...drawing) => {
  const head = Number(legend?.dataset.height ?? 0);
  const size = { width, height: head + height, viewBox: `0 0 ${width} ${head + height}` };
  return svg("svg", { ...size, "font-family": "system-ui, sans-serif", "font-size": 12 },
    legend, svg("g", { transform: `translate(0 ${head})` }, ...drawing));
};

/** @param {uPlot} plot */
const frameOf = (plot) => {
  const ratio = plot.ctx.canvas.width / plot.width;
  const box = /** @type {uPlot["bbox"]} */ (Object.fromEntries(Object.entries(plot.bbox).map(([side, value]) => [side, value / ratio])));
  /** @param {string} scale */
  const along = (scale) => (/** @type {number} */ value) => plot.valToPos(value, scale, true) / ratio;
  return { box, x: along("x"), y: along("y") };
};

/** @param {number} x @param {number} y @param {string} words @param {Attributes} [more] */
const text = (x, y, words, more) => svg("text", { x, y, fill: colour("--ink-soft"), ...more }, words);

/** @param {uPlot} plot @param {Frame} frame */
const axesOf = (plot, { box, x, y }) => {
  const [across, up] = plot.axes;
  const [right, bottom] = [box.left + box.width, box.top + box.height];
  /** @param {uPlot["axes"][number]} axis @returns {[number, string][]} */
  const ticks = (axis) => (axis._splits ?? []).map((at, k) => [at, axis._values?.[k] ?? ""]);
  /** @param {Attributes} ends */
  const line = (ends) => svg("line", { ...ends, stroke: colour("--grid") });
  const middle = box.top + box.height / 2;
  return [
    ticks(across).map(([at, words]) => [
      line({ x1: x(at), x2: x(at), y1: box.top, y2: bottom + 4 }),
      text(x(at), bottom + 19, words, { "text-anchor": "middle" })]),
    ticks(up).map(([at, words]) => [
      line({ x1: box.left - 4, x2: right, y1: y(at), y2: y(at) }),
      text(box.left - 9, y(at) + 4, words, { "text-anchor": "end" })]),
    text(box.left + box.width / 2, /** @type {any} */ (across)._lpos + 11, across.label, { "text-anchor": "middle" }),
    text(0, 0, up.label, { "text-anchor": "middle", transform: `translate(${/** @type {any} */ (up)._lpos - 3} ${middle}) rotate(-90)` }),
  ];
};

/** @param {Frame} frame @param {number | null} x @param {number | null} y */
const markOf = ({ box }, x, y) => svg("line", {
  x1: x ?? box.left, x2: x ?? box.left + box.width, y1: y ?? box.top, y2: y ?? box.top + box.height,
  stroke: colour(x === null ? "--mark-strong" : "--mark"), "stroke-dasharray": x === null ? "6 4" : "2 3",
});

/** @param {Frame} frame @param {Ticks} ticks @param {number} row */
const ticksOf = ({ box, x }, { colour: paint, at }, row) => at.map((value) => {
  const foot = box.top + box.height - row * TICK;
  return svg("line", { x1: x(value), x2: x(value), y1: foot, y2: foot - TICK + 1, stroke: colour(paint), "stroke-width": 1.5 });
});

/** @param {unknown} value */
const known = (value) => value !== null && value !== undefined;

/** Runs of neighbouring samples that all have values. @param {(number | null)[]} xs @param {...(number | null)[]} columns */
const runsOf = (xs, ...columns) => {
  /** @type {number[][]} */
  const runs = [[]];
  xs.forEach((_, k) => {
    if (columns.every((column) => known(column[k]))) runs[runs.length - 1].push(k);
    else if (runs[runs.length - 1].length) runs.push([]);
  });
  return runs.filter((run) => run.length);
};

/** @param {Frame} frame @param {(number | null)[]} xs @param {(number | null)[]} ys @param {number[]} run */
const placed = ({ x, y }, xs, ys, run) => run.map((k) => `${x(Number(xs[k])).toFixed(2)} ${y(Number(ys[k])).toFixed(2)}`);

/** @param {Frame} frame @param {ChartSeries} series @param {(number | null)[]} xs @param {(number | null)[]} ys */
const curveOf = (frame, { colour: paint, dash, width = 1.6 }, xs, ys) => {
  const runs = runsOf(xs, ys);
  if (width === 0 || !runs.length) return null;
  const d = runs.map((run) => `M${placed(frame, xs, ys, run).join("L")}`).join("");
  const look = { stroke: colour(paint), "stroke-width": width, "stroke-linejoin": "round" };
  return svg("path", { d, ...look, "stroke-dasharray": dash?.length ? dash.join(" ") : null });
};

// Whole where they lie on the edge of the frame.
/** @param {Frame} frame @param {ChartSeries} series @param {(number | null)[]} xs @param {(number | null)[]} ys */
const dotsOf = (frame, { colour: paint, points = false }, xs, ys) => {
  const { left, top, width, height } = frame.box;
  const places = points ? runsOf(xs, ys).flat().map((k) => [frame.x(Number(xs[k])), frame.y(Number(ys[k]))]) : [];
  return places.filter(([x, y]) => x > left - 1 && x < left + width + 1 && y > top - 1 && y < top + height + 1)
    .map(([cx, cy]) => svg("circle", { cx, cy, r: 2.5, fill: colour(paint) }));
};

/** @param {Frame} frame @param {Band} band @param {Columns} data */
const bandOf = (frame, { series: [high, low], fill }, data) => {
  const xs = data[0];
  const d = runsOf(xs, data[high] ?? [], data[low] ?? []).map((run) =>
    `M${[...placed(frame, xs, data[high], run),
      ...placed(frame, xs, data[low], run).reverse()].join("L")}Z`).join("");
  return d ? svg("path", { d, fill }) : null;
};

/** Keys and words of several curves, in rows. @param {ChartSeries[]} series @param {number} width */
export const legendOf = (series, width) => {
  let [x, row] = [0, 0];
  const entries = series.map(({ label, colour: paint, dash, points, width: thick }) => {
    const said = inLanguage(label);
    const wide = 36 + measured(said).width;
    if (x > 0 && x + wide > width) [x, row] = [0, row + 1];
    const [at, y] = [x, row * ROW + 8];
    x += wide + 18;
    const stroke = colour(paint);
    const key = points && thick === 0
      ? svg("circle", { cx: at + 15, cy: y, r: 2.5, fill: stroke })
      : svg("line", {
        x1: at, x2: at + 30, y1: y, y2: y, stroke, "stroke-width": 2,
        "stroke-dasharray": dash?.length ? dash.join(" ") : null,
      });
    return [key, text(at + 36, y + 4, said)];
  });
  return svg("g", { "data-height": (row + 1) * ROW }, entries);
};
