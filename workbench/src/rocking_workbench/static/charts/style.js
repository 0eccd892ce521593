/** Colours of the page for canvases, and style of the axes. */

import { number, pretty } from "/app/format.js";
import { t } from "/app/words.js";

const resolved = new Map();

/** Colour for a canvas; "--name" is a variable of the page. @param {string} [paint] @returns {string} */
export const colour = (paint) => {
  if (!paint?.startsWith("--") && !paint?.startsWith("var(")) return paint ?? colour("--ink");
  const name = paint.replace(/^var\(|\)$/g, "");
  if (!resolved.has(name)) resolved.set(
    name, getComputedStyle(document.documentElement).getPropertyValue(name).trim()
  );
  return resolved.get(name);
};

const listeners = new Set();
document.addEventListener("rocking:theme", () => {
  resolved.clear();
  listeners.forEach((listener) => listener());
});

/** Run a function at each change of the theme; returns a function that removes the listener. @param {() => unknown} listener */
export const onTheme = (listener) => {
  listeners.add(listener);
  return () => listeners.delete(listener);
};

/** Result of `make` in the light theme, since files use light colours. The page does not change visibly. @type {<Of>(make: () => Of) => Of} */
export const inLight = (make) => {
  const { dataset } = document.documentElement;
  const { theme } = dataset;
  if (theme !== "dark") return make();
  try {
    dataset.theme = "light";
    resolved.clear();
    return make();
  } finally {
    dataset.theme = theme;
    document.dispatchEvent(new CustomEvent("rocking:theme")); // figures that now have light colours are updated
  }
};

/** The two axes of a chart. @param {ChartAxis} x @param {ChartAxis} y */
export const axes = (x, y) => [
  { ...look(x), size: 32, space: 60 },
  { ...look(y), size: 62, space: 34 },
];

/** @param {ChartAxis} axis */
const look = ({ label, unit, log }) => ({
  label: unit && unit !== "-" ? `${t(label)} [${pretty(unit)}]` : t(label),
  labelSize: 18,
  labelFont: "12px system-ui, sans-serif",
  font: "12px system-ui, sans-serif",
  stroke: "transparent", // positioned by uPlot, painted by drawChart
  grid: { show: false },
  ticks: { show: false },
  /** @param {unknown} _ @param {(number | null)[]} ticks */
  values: (_, ticks) => ticks.map((tick) => (tick === null ? "" : number(tick, log ? 1 : 6))),
});
