/** Line charts with uPlot, in the colours of the page, with a table for screen readers. */

import uPlot from "/vendor/uplot/uPlot.esm.js";
import { chartTable } from "/charts/chart-table.js";
import { chartStill, drawChart } from "/charts/curves.js";
import { chartFiles } from "/charts/save.js";
import { axes, colour, onTheme } from "/charts/style.js";
import { el, fill, freshId } from "/app/dom.js";
import { highest, lowest } from "/app/extremes.js";
import { number, pretty, quantity } from "/app/format.js";
import { dashKey } from "/app/palette.js";
import { t } from "/app/words.js";

/** Draw curves over one abscissa; methods: see the returned object.
 * @param {HTMLElement} container @param {ChartOptions} options */
export const lineChart = (container, options) => {
  const { title, x, y, height = 220 } = options;
  const id = freshId("chart");
  const stage = el("div", { class: "chart-stage" });
  const figure = el("figure", { class: "chart" },
    el("figcaption", { id }, title), legendOf(options.series), stage);
  container.append(figure);
  /** @type {Columns} */
  let data = [[], ...options.series.map(() => [])];
  /** @type {Marks} */
  let marks = {};
  /** @type {((index: number, instant: number) => unknown) | null} */
  let hook = null;
  /** @type {Point | null} */
  let zoomed = null;
  const table = chartTable(options, () => data);
  const still = () => ({ node: chartStill(plot, options, data, marks), alt: stage.getAttribute("aria-label"), note: marks.description });
  const csv = () => csvOf(options, data);
  figure.append(el("div", { class: "chart-foot" }, table.element, chartFiles(title, still, "chart", csv)));

  const shown = el("p", { class: "chart-readout", "aria-hidden": "true" });
  stage.after(shown);
  /** @param {uPlot} self */
  const readout = (self) => {
    const at = self.cursor.idx;
    const values = at === null || at === undefined ? [] : data.map((column) => column[at]);
    fill(shown, values.length ? readoutText(options, values) : "\u00a0");
  };

  /** @param {uPlot} self */
  const look = ({ scales: { x: { min, max } } }) => {
    const [first, last] = [Number(data[0][0]), Number(data[0].at(-1))];
    const now = /** @type {Point | null} */ (min > first || max < last ? [min, max] : null);
    if (String(now) !== String(zoomed)) options.onZoom?.((zoomed = now));
  };

  const plot = new uPlot({
    width: widthOf(stage), height,
    legend: { show: false },
    cursor: { points: { size: 7 }, drag: { x: true, y: false } },
    scales: { x: { time: false, ...(x.log ? WHOLE : {}) }, y: scaleOf(y) },
    axes: axes(x, y),
    series: [{ label: axisWords(x) }, ...options.series.map(seriesOf)],
    hooks: {
      setCursor: [(/** @type {uPlot} */ self) => {
        readout(self);
        if (
          self.cursor.idx !== null && self.cursor.idx !== undefined
        ) hook?.(self.cursor.idx, Number(data[0][self.cursor.idx]));
      }],
      setScale: [(/** @type {uPlot} */ self, /** @type {string} */ key) => key === "x" && data[0].length && look(self)],
      draw: [(/** @type {uPlot} */ self) => {
        const ratio = self.ctx.canvas.width / self.width;
        self.ctx.save();
        self.ctx.scale(ratio, ratio);
        drawChart(self.ctx, self, options, data, marks);
        self.ctx.restore();
      }],
    },
  }, data, stage);

  const resize = () => plot.setSize({ width: widthOf(stage), height });
  const observer = new ResizeObserver(() => widthOf(stage) !== plot.width && resize());
  observer.observe(stage);
  const forget = onTheme(() => plot.redraw(false, true));
  stage.setAttribute("role", "img");

  return {
    plot,
    element: figure,
    /** Set columns; with an interval [from, to] the chart remains zoomed.
     * @param {Columns} next @param {Point | null} [interval] */
    setData: (next, interval = null) => {
      data = next;
      zoomed = interval;
      if (interval) plot.batch(() => {
        plot.setData(next, false);
        plot.setScale("x", { min: interval[0], max: interval[1] });
      });
      else plot.setData(next);
      stage.setAttribute("aria-label", summary(options, next));
      table.refresh();
    },
    /** @param {(index: number, instant: number) => unknown} fn */
    setCursorHook: (fn) => (hook = fn),
    /** @param {Marks} next */
    setMarks: (next) => {
      marks = next;
      plot.redraw(false, true);
    },
    /** Set the cursor to an instant, without a call of the listeners. @param {number} instant */
    point: (instant) => {
      const left = plot.valToPos(instant, "x");
      plot.setCursor({ left: left * devicePixelRatio <= plot.bbox.width ? left : -10, top: -10 }, false, false);
      readout(plot);
    },
    resize,
    destroy: () => {
      observer.disconnect();
      forget();
      plot.destroy();
      figure.remove();
    },
  };
};

/** @param {ChartOptions} options @param {Columns} data */
const csvOf = ({ x, series, y }, data) => {
  const head = [axisWords(x), ...series.map(({ label }) => axisWords({ label, unit: y.unit }))];
  /** @param {string} text */
  const quoted = (text) => `"${String(text).replaceAll('"', '""')}"`;
  const rows = data[0].map((_, k) => data.map((column) => column[k] ?? "").join(","));
  return [head.map(quoted).join(","), ...rows, ""].join("\n");
};

// A logarithmic axis ends with the data and not at the next power of ten.
/** @type {{ distr: number, range: (plot: unknown, low: number, high: number) => Point }} */
const WHOLE = { distr: 3, range: (_, low, high) => (low > 0 && high > low ? [low, high] : [0.1, 10]) };

/** @param {HTMLElement} stage */
const widthOf = (stage) => Math.max(200, Math.floor(stage.clientWidth));

/** @param {{ label: string, unit?: string }} axis */
const axisWords = ({ label, unit }) => (unit && unit !== "-" ? `${label} [${pretty(unit)}]` : label);

/** @param {ChartAxis} y */
const scaleOf = (y) => {
  if (y.log) return { distr: 3 };
  return { range: y.range ?? around };
};

// A constant zero would give an axis from 0 to 100; the axis is set to 1.
/** @param {uPlot} _ @param {number | null} low @param {number | null} high */
const around = (_, low, high) => {
  if (low === null || high === null) return [null, null];
  return low === 0 && high === 0 ? [-1, 1] : uPlot.rangeNum(low, high, 0.1, true);
};

// uPlot provides the scales, the cursor and the zoom; drawChart draws the curves.
/** @param {ChartSeries} series */
const seriesOf = ({ label, colour: paint }) => ({ label, stroke: () => colour(paint), paths: () => null, points: { show: false } });

/** @param {ChartSeries[]} series */
const legendOf = (series) => {
  if (series.length < 2) return null;
  return el("ul", { class: "legend" }, series.map((curve) => el("li", {}, legendKey(curve), curve.label)));
};

/** @param {ChartSeries} series */
const legendKey = ({ colour: paint, dash, points, width }) =>
  dashKey({ colour: paint, dash, dots: Boolean(points) && width === 0 });

/** @param {ChartOptions} options @param {(number | null)[]} values */
const readoutText = ({ x, y, series }, [at, ...values]) =>
  [`${t(x.label)} ${quantity(at, x.unit)}`]
    .concat(values.map((value, index) => `${t(series[index].label)} ${quantity(value, y.unit)}`))
    .join(" \u00b7 ");

/** @param {ChartOptions} options @param {Columns} data */
const summary = ({ title, x, y, series }, [xs, ...columns]) => {
  if (!xs.length) return t("{chart}: no data yet", { chart: title });
  const ranges = columns.map((column, index) => {
    const [low, high] = [lowest(column), highest(column)];
    return t("{label} from {low} to {high} {unit}", { label: series[index].label, low: number(low), high: number(high), unit: y.unit ?? "" });
  });
  const span = t("{low} to {high} {unit}", { low: number(xs[0]), high: number(xs.at(-1)), unit: x.unit ?? "" });
  return t("{chart}, over {axis} from {range}: {curves}", { chart: title, axis: x.label, range: span, curves: ranges.join("; ") });
};
