/** From lengths (y up) to pixels (y down), to scale, centred. */

/** A viewport that fits a box of lengths into pixels: {x, y, scale, back}.
 * @param {Box} box @param {{ width: number, height: number, margin?: Partial<Box> }} size @returns {Viewport} */
export const viewport = (box, { width, height, margin }) => {
  const sides = { left: 12, right: 12, top: 12, bottom: 12, ...margin };
  // at least one pixel: a picture may be narrower than its margins
  const inner = { width: Math.max(width - sides.left - sides.right, 1), height: Math.max(height - sides.top - sides.bottom, 1) };
  const spanX = Math.max(box.right - box.left, 1e-12);
  const spanY = Math.max(box.top - box.bottom, 1e-12);
  const scale = Math.min(inner.width / spanX, inner.height / spanY);
  const left = sides.left + (inner.width - scale * spanX) / 2;
  const bottom = sides.top + inner.height - (inner.height - scale * spanY) / 2;
  return {
    scale,
    x: (length) => left + scale * (length - box.left),
    y: (length) => bottom - scale * (length - box.bottom),
    back: (px, py) => [box.left + (px - left) / scale, box.bottom + (bottom - py) / scale],
  };
};

/** A viewport about a point in the middle of the pixels.
 * @param {number[]} point @param {number} scale @param {{ width: number, height: number }} size @returns {Viewport} */
export const viewportAt = ([x, y], scale, { width, height }) => ({
  scale,
  x: (length) => width / 2 + scale * (length - x),
  y: (length) => height / 2 - scale * (length - y),
  back: (px, py) => [x + (px - width / 2) / scale, y + (height / 2 - py) / scale],
});

/** The box around points. @param {number[][]} points */
export const boxOf = (points) => {
  const box = { left: Infinity, right: -Infinity, bottom: Infinity, top: -Infinity };
  for (const [x, y] of points) {
    box.left = Math.min(box.left, x);
    box.right = Math.max(box.right, x);
    box.bottom = Math.min(box.bottom, y);
    box.top = Math.max(box.top, y);
  }
  return box;
};

/** A round step so that about `count` of them fill the span. @param {number} span @param {number} count */
export const roundStep = (span, count) => {
  const rough = span / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map((mantissa) => mantissa * power).find((candidate) => candidate >= rough) ?? 10 * power;
};

/** Multiples of a step inside a range. @param {number} low @param {number} high @param {number} step */
export const multiples = (low, high, step) => {
  const values = [];
  for (
    let index = Math.ceil(low / step - 1e-9); index * step <= high + step * 1e-9; index += 1
  ) values.push(index * step);
  return values;
};
