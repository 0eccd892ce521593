/** Published measurements over slenderness, curves of the models, and this body. */

import { svg } from "/app/dom.js";
import { highest, lowest } from "/app/extremes.js";
import { number } from "/app/format.js";
import { GROUPS, modelStyle, modelWords } from "/app/palette.js";
import { axisOf, bottomAxis, leftAxis } from "/drawing/axis.js";
import { marker } from "/drawing/markers.js";
import { t } from "/app/words.js";

/** Draw {measured: [{slenderness_ratio, coefficient, coefficient_low, coefficient_high, group}], curves, rows, slenderness}.
 * @param {{ measured: Server.MeasuredPoint[], curves: Server.ModelCurve[], rows: { model: string, value: number }[], slenderness: number }} facts @param {{ width: number, height?: number }} size */
export const measuredPicture = ({ measured, curves, rows, slenderness }, { width, height = 380 }) => {
  const all = [...measured.map((point) => point.slenderness_ratio), slenderness];
  const values = [...measured.map((measurement) => measurement.coefficient), ...rows.map((row) => row.value)];
  const x = axisOf(0, highest(all) * 1.06, 60, width - 14, width < 500 ? 5 : 8);
  const y = axisOf(Math.max(0, Math.floor(lowest(values) * 10 - 0.3) / 10), 1.005, height - 48, 12, 6);
  const frame = { left: 60, right: width - 14, top: 12, bottom: height - 48 };
  return svg("svg", {
    class: "picture", viewBox: `0 0 ${width} ${height}`, width, height, role: "img",
    "data-testid": "measured-picture",
    "aria-label": t("{count} published coefficients of restitution over slenderness, and this body at h/b {slenderness} with {models} models.",
      { count: measured.length, slenderness: number(slenderness), models: rows.length }),
  },
    bottomAxis(x, { ...frame, label: "slenderness ratio h/b" }),
    leftAxis(y, { ...frame, label: "coefficient of restitution r" }),
    curves.map((modelCurve) => curve(modelCurve, x, y)),
    svg("path", { class: "thin dashed", d: `M${x.at(slenderness)} ${frame.top}V${frame.bottom}` }),
    measured.map((measurement) => point(measurement, x, y)),
    rows.map(({ model, value }) => value < y.low ? null
      : svg("circle", {
        cx: x.at(slenderness), cy: y.at(value), r: 6, fill: modelStyle(model).colour, class: "dot-halo",
      },
        svg("title", {}, `${modelWords(model)}: ${number(value)}`))));
};

/** @param {Server.ModelCurve} curve @param {Axis} x @param {Axis} y */
const curve = ({ model, slenderness_ratio: ratios, coefficient }, x, y) => {
  const { colour, dash } = modelStyle(model);
  const places = ratios.map((ratio, index) => [ratio, coefficient[index]])
    .filter(([ratio, value]) => ratio <= x.high && value !== null && value >= y.low)
    .map(([ratio, value]) => `${x.at(ratio)} ${y.at(value)}`);
  return places.length < 2 ? null : svg("path", {
    d: `M${places.join("L")}`, fill: "none", stroke: colour, "stroke-width": 1.75,
    "stroke-dasharray": dash?.join(" "),
  });
};

/** @param {Server.MeasuredPoint} measurement @param {Axis} x @param {Axis} y */
const point = (measurement, x, y) => {
  const { marker: shape, label: text } = GROUPS[measurement.group] ?? { marker: "circle", label: measurement.group };
  const [px, py] = [x.at(measurement.slenderness_ratio), y.at(measurement.coefficient)];
  const bar = measurement.coefficient_low === undefined || measurement.coefficient_low === null || measurement.coefficient_low === measurement.coefficient_high ? null
    : svg(
      "path", { class: "marker-bar", d: `M${px} ${y.at(measurement.coefficient_low)}V${y.at(Math.min(measurement.coefficient_high, y.high))}` },
    );
  return svg("g", {}, bar, marker(shape, px, py),
    svg("title", {}, `${t(text)}: h/b ${number(measurement.slenderness_ratio)}, r ${number(measurement.coefficient)}`));
};
