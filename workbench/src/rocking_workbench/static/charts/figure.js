/** Line charts as components, with a common time. */

import { html, useLayoutEffect, useRef } from "/parts/preact.js";
import { lineChart } from "/charts/line.js";

/** Time shared by several charts: `onInstant` receives the pointer position, `onZoom` the interval.
 * @param {(instant: number) => unknown} [onInstant] @param {ChartOptions["onZoom"]} [onZoom] */
export const createTime = (onInstant, onZoom) => {
  /** @type {Set<Chart>} */
  const charts = new Set();
  /** @type {Chart | null} */
  let leading = null; // the chart under the pointer
  /** @param {number} instant */
  const point = (instant) => charts.forEach((chart) => chart !== leading && chart.point(instant));
  return {
    /** Show an instant of the animation or of another chart. @param {number} instant */
    show: (instant) => leading || point(instant),
    onZoom,
    /** @param {Chart} chart */
    add: (chart) => {
      charts.add(chart);
      chart.setCursorHook((_, instant) => {
        leading = chart;
        point(instant);
        onInstant?.(instant);
        leading = null;
      });
      return () => charts.delete(chart);
    },
  };
};

const UNMARKED = {};
/** @type {Time} */
const ALONE = { add: () => () => {} };

/** Chart of some columns: recreated after a change of `shape`, else updated; `interval` is the visible range.
 * @param {{ shape: ChartOptions, data: Columns, interval?: Point | null, marks?: Marks, time?: Time, testid?: string }} props */
export const Figure = ({ shape, data, interval, marks = UNMARKED, time = ALONE, testid }) => {
  const holder = useRef(null);
  /** @type {{ current: Chart }} */
  const chart = useRef(null);
  const look = JSON.stringify(shape);
  useLayoutEffect(() => {
    chart.current = lineChart(holder.current, { ...shape, onZoom: time.onZoom });
    const gone = time.add(chart.current);
    return () => {
      gone();
      chart.current.destroy();
    };
  }, [look]);
  useLayoutEffect(() => chart.current.setMarks(marks), [look, marks]);
  useLayoutEffect(() => chart.current.setData(data, interval), [look, data, String(interval)]);
  return html`<div ref=${holder} class="figure" data-testid=${testid}></div>`;
};
