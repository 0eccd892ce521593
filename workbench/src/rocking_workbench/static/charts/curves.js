/** Content of a line chart for a pen: the canvas of uPlot or an SVG writer. */

import { svg } from "/app/dom.js";
import { t } from "/app/words.js";
import { measured } from "/charts/letters.js";
import { SvgPen } from "/charts/pen.js";
import { colour } from "/charts/style.js";

/** @typedef {import("/vendor/uplot/uPlot.esm.js").default} uPlot @typedef {ReturnType<typeof frameOf>} Frame */

const [ROW, BELOW, EDGE] = [20, 50, 2]; // height of a legend row, height below the frame, margin for curves on the edge of the frame [px]
const TICK = 6; // height of a row of ticks on the axis [px]

/** Chart content with its legend. @param {uPlot} plot @param {ChartOptions} options @param {Columns} data @param {Marks} marks */
export const chartStill = (plot, options, data, marks) => {
  const pen = new SvgPen();
  drawChart(/** @type {any} */ (pen), plot, options, data, marks);
  const { top, height } = frameOf(plot);
  const legend = options.series.length > 1 ? legendOf(options.series, plot.width) : null;
  return under(legend, plot.width, Math.min(plot.height, Math.ceil(top + height + BELOW)), pen.node);
};

/** A drawing under its legend. @param {SVGElement | null} legend @param {number} width @param {number} height @param {...Child} drawing */
export const under = (legend, width, height, ...drawing) => {
  const head = Number(legend?.dataset.height ?? 0);
  const size = { width, height: head + height, viewBox: `0 0 ${width} ${head + height}` };
  return svg("svg", { ...size, "font-family": "system-ui, sans-serif", "font-size": 12 },
    legend, svg("g", { transform: `translate(0 ${head})` }, ...drawing));
};

/** Axes, bands, marks and curves at the positions of uPlot, in pixels of the page.
 * @param {CanvasRenderingContext2D} pen @param {uPlot} plot @param {ChartOptions} options @param {Columns} all @param {Marks} marks */
export const drawChart = (pen, plot, { series, bands = [] }, all, marks) => {
  const [frame, data] = [frameOf(plot), inSight(plot.scales.x, all)];
  const { left, top, width, height } = frame;
  drawAxes(pen, plot, frame);
  pen.save();
  pen.beginPath();
  pen.rect(left, top - EDGE, width, height + 2 * EDGE);
  pen.clip();
  bands.forEach((band) => drawBand(pen, frame, band, data));
  drawMarks(pen, frame, marks);
  series.forEach((curve, k) => drawCurve(pen, frame, curve, data[0], data[k + 1] ?? []));
  pen.restore();
  series.forEach((curve, k) => curve.points && drawDots(pen, frame, curve, data[0], data[k + 1] ?? []));
};

/** Columns of the visible range, with one value on either side. @param {{ min: number, max: number }} scale @param {Columns} data */
const inSight = ({ min, max }, data) => {
  const end = data[0].length - 1;
  const gap = (/** @type {number} */ k) => k > 0 && k < end && data.some((column) => (column[k] ?? null) === null);
  let [from, to] = [0, end];
  while (from < end && Number(data[0][from + 1]) < min) from += 1;
  while (to > 0 && Number(data[0][to - 1]) > max) to -= 1;
  while (gap(from)) from -= 1;
  while (gap(to)) to += 1;
  return data.map((column) => column.slice(from, to + 1));
};

/** @param {uPlot} plot */
const frameOf = (plot) => {
  const ratio = plot.ctx.canvas.width / plot.width;
  const { left, top, width, height } = plot.bbox;
  /** @param {string} scale */
  const along = (scale) => (/** @type {number | null} */ value) => plot.valToPos(Number(value), scale, true) / ratio;
  return { left: left / ratio, top: top / ratio, width: width / ratio, height: height / ratio, x: along("x"), y: along("y") };
};

/** @param {CanvasRenderingContext2D} pen @param {string} paint @param {number} width @param {number[]} dash @param {...number} ends */
const line = (pen, paint, width, dash, ...ends) => {
  if (!ends.every(Number.isFinite)) return; // the axis is missing
  Object.assign(pen, { strokeStyle: colour(paint), lineWidth: width });
  pen.setLineDash(dash);
  pen.beginPath();
  pen.moveTo(ends[0], ends[1]);
  pen.lineTo(ends[2], ends[3]);
  pen.stroke();
};

/** @param {CanvasRenderingContext2D} pen @param {uPlot} plot @param {Frame} frame */
const drawAxes = (pen, plot, { left, top, width, height, x, y }) => {
  const [across, up] = plot.axes;
  const [right, bottom] = [left + width, top + height];
  Object.assign(pen, { font: "12px system-ui, sans-serif", fillStyle: colour("--ink-soft"), textAlign: "center", textBaseline: "alphabetic" });
  if (across._show) across._splits?.forEach((value, k) => {
    line(pen, "--grid", 1, [], x(value), top, x(value), bottom + 4);
    pen.fillText(across._values?.[k] ?? "", x(value), bottom + 19);
  });
  if (across._show) pen.fillText(across.label, left + width / 2, across._lpos + 11);
  if (!up._show) return; // without values there is no position for a text
  pen.save();
  pen.translate(up._lpos - 3, top + height / 2);
  pen.rotate(-Math.PI / 2);
  pen.fillText(up.label, 0, 0);
  pen.restore();
  pen.textAlign = "right";
  up._splits?.forEach((value, k) => {
    line(pen, "--grid", 1, [], left - 4, y(value), right, y(value));
    pen.fillText(up._values?.[k] ?? "", left - 9, y(value) + 4);
  });
};

/** @param {CanvasRenderingContext2D} pen @param {Frame} frame @param {Marks} marks */
const drawMarks = (pen, { left, top, width, height, x, y }, { vertical = [], horizontal = [], ticks = [] }) => {
  vertical.forEach((value) => line(pen, "--mark", 1, [2, 3], x(value), top, x(value), top + height));
  horizontal.forEach((value) => line(pen, "--mark-strong", 1, [6, 4], left, y(value), left + width, y(value)));
  ticks.forEach(({ colour: paint, at }, row) => {
    const foot = top + height - row * TICK;
    at.forEach((value) => line(pen, paint, 1.5, [], x(value), foot, x(value), foot - TICK + 1));
  });
};

/** Sequences of samples that all have values. @param {(number | null)[]} xs @param {...(number | null)[]} columns */
const runsOf = (xs, ...columns) => {
  /** @type {number[][]} */
  const runs = [[]];
  xs.forEach((_, k) => {
    if (columns.every((column) => (column[k] ?? null) !== null)) runs[runs.length - 1].push(k);
    else if (runs[runs.length - 1].length) runs.push([]);
  });
  return runs.filter((run) => run.length);
};

/** @param {CanvasRenderingContext2D} pen @param {number[][]} places */
const follow = (pen, places) => places.forEach(([x, y], k) => (k ? pen.lineTo(x, y) : pen.moveTo(x, y)));

/** @param {CanvasRenderingContext2D} pen @param {Frame} frame @param {ChartSeries} series @param {(number | null)[]} xs @param {(number | null)[]} ys */
const drawCurve = (pen, { x, y }, { colour: paint, dash = [], width = 1.6 }, xs, ys) => {
  const runs = runsOf(xs, ys);
  if (width === 0 || !runs.length) return;
  Object.assign(pen, { strokeStyle: colour(paint), lineWidth: width, lineJoin: "round" });
  pen.setLineDash(dash);
  pen.beginPath();
  runs.forEach((run) => follow(pen, run.map((k) => [x(xs[k]), y(ys[k])])));
  pen.stroke();
};

// Curves on the edge of the frame are not clipped.
/** @param {CanvasRenderingContext2D} pen @param {Frame} frame @param {ChartSeries} series @param {(number | null)[]} xs @param {(number | null)[]} ys */
const drawDots = (pen, { left, top, width, height, x, y }, { colour: paint }, xs, ys) => {
  pen.fillStyle = colour(paint);
  runsOf(xs, ys).flat().map((k) => [x(xs[k]), y(ys[k])])
    .filter(([at, up]) => at > left - 1 && at < left + width + 1 && up > top - 1 && up < top + height + 1)
    .forEach(([at, up]) => {
      pen.beginPath();
      pen.arc(at, up, 2.5, 0, 2 * Math.PI);
      pen.fill();
    });
};

/** @param {CanvasRenderingContext2D} pen @param {Frame} frame @param {Band} band @param {Columns} data */
const drawBand = (pen, { x, y }, { series: [high, low], fill }, data) => {
  const xs = data[0];
  pen.fillStyle = fill;
  pen.beginPath();
  for (const run of runsOf(xs, data[high] ?? [], data[low] ?? [])) {
    follow(pen, [...run.map((k) => [x(xs[k]), y(data[high][k])]), ...run.map((k) => [x(xs[k]), y(data[low][k])]).reverse()]);
    pen.closePath();
  }
  pen.fill();
};

/** Symbols and labels of several curves, in rows. @param {ChartSeries[]} series @param {number} width */
export const legendOf = (series, width) => {
  let [x, row] = [0, 0];
  const entries = series.map(({ label, colour: paint, dash, points, width: thick }) => {
    const text = t(label);
    const wide = 36 + measured(text).width;
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
    return [key, svg("text", { x: at + 36, y: y + 4, fill: colour("--ink-soft") }, text)];
  });
  return svg("g", { "data-height": (row + 1) * ROW }, entries);
};
