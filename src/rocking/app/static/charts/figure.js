/** Line charts as components, several of them under one time. */

import { html, useLayoutEffect, useRef } from "/parts/preact.js";
import { lineChart } from "/charts/line.js";

/** One time of several charts: a pointer on one is told to `onInstant` and shown on all, `onZoom` when one is looked into. */
export const createTime = (onInstant, onZoom) => {
  const charts = new Set();
  const point = (instant, but = null) => charts.forEach((each) => each !== but && each.point(instant));
  return {
    point,
    onZoom,
    add: (chart) => {
      charts.add(chart);
      chart.setCursorHook((_, instant) => {
        point(instant, chart);
        onInstant?.(instant);
      });
      return () => charts.delete(chart);
    },
  };
};

/** A chart of some columns: drawn anew where `shape`, what `lineChart` takes, is another, else fed; `part` is in sight. */
export const Figure = ({ shape, data, part, marks, time, testid }) => {
  const place = useRef(null);
  const chart = useRef(null);
  const look = JSON.stringify(shape);
  useLayoutEffect(() => {
    chart.current = lineChart(place.current, { ...shape, onZoom: time.onZoom });
    const gone = time.add(chart.current);
    return () => {
      gone();
      chart.current.destroy();
    };
  }, [look]);
  useLayoutEffect(() => chart.current.setMarks(marks), [look, marks]);
  useLayoutEffect(() => chart.current.setData(data, part), [look, data, String(part)]);
  return html`<div ref=${place} class="figure" data-testid=${testid}></div>`;
};
