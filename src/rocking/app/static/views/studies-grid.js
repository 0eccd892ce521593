/** A map on a canvas: cells, axes, and which cell is under a point. */
import { colour } from "/charts/style.js";
import { number, pretty } from "/app/format.js";
import { greek } from "/views/studies-words.js";

const LEFT = 64;
const BOTTOM = 52;
const TOP = 12;
const RIGHT = 14;

const isGeometric = (values) => {
  if (values.length < 3 || values[0] <= 0) return false;
  const first = values[1] / values[0];
  const even = values.every((value, k) => k === 0 || Math.abs(value / values[k - 1] / first - 1) < 1e-6);
  const step = values[1] - values[0];
  return even && Math.abs(values[2] - values[1] - step) > 1e-9 * Math.abs(step);
};

const edgesOf = (places) => {
  if (places.length === 1) return [places[0] - 0.5, places[0] + 0.5];
  const inner = places.slice(1).map((place, k) => 0.5 * (place + places[k]));
  return [1.5 * places[0] - 0.5 * places[1], ...inner, 1.5 * places.at(-1) - 0.5 * places.at(-2)];
};

/** Places of an axis: value to share of its length, and edges of its cells. */
export const axisOf = ({ values }) => {
  const log = isGeometric(values);
  const place = log ? Math.log : (value) => value;
  const edges = edgesOf(values.map(place));
  const span = edges.at(-1) - edges[0] || 1;
  return {
    log,
    share: (value) => (place(value) - edges[0]) / span,
    edges: edges.map((edge) => (edge - edges[0]) / span),
    low: log ? Math.exp(edges[0]) : edges[0],
    high: log ? Math.exp(edges.at(-1)) : edges.at(-1),
  };
};

/** Round numbers for an axis from low to high. */
export const ticksOf = ({ low, high, log }) => {
  if (log && high / low > 8) {
    return [1, 2, 5]
      .flatMap((m) => Array.from({ length: 13 }, (_, k) => m * 10 ** (k - 6)))
      .filter((value) => value >= low && value <= high)
      .sort((a, b) => a - b);
  }
  const rough = (high - low) / 6;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].find((m) => m * power >= rough) * power;
  const first = Math.ceil(low / step);
  return Array.from({ length: Math.floor(high / step) - first + 1 }, (_, k) =>
    Number(((first + k) * step).toPrecision(12)),
  );
};

/** The cell under the middle of each of some dots along an axis. */
const cellsOf = (edges, dots) => {
  let k = 0;
  return Array.from({ length: dots }, (_, dot) => {
    while (k < edges.length - 2 && edges[k + 1] <= (dot + 0.5) / dots) k += 1;
    return k;
  });
};

/** A colour "#rrggbb" as a dot of an image has it, the least byte first. */
const wordOf = (paint) => {
  const rgb = parseInt(paint.slice(1), 16);
  return (0xff000000 | ((rgb & 0xff) << 16) | (rgb & 0xff00) | (rgb >> 16)) >>> 0;
};

/** Painter of a map: draw(paintOf, [kept, aim], lines) and cellAt(event). */
export const createGrid = (canvas, x, y) => {
  const across = axisOf(x);
  const up = axisOf(y);
  let size = { width: 300, height: 300 };
  let dense = 1;
  let painted = {};

  const fit = () => {
    const width = Math.max(240, canvas.parentElement.clientWidth);
    size = { width, height: Math.round(Math.min(0.78 * width, 520)) };
    dense = window.devicePixelRatio || 1;
    painted = {};
    canvas.width = Math.round(size.width * dense);
    canvas.height = Math.round(size.height * dense);
    canvas.style.height = `${size.height}px`;
    canvas.getContext("2d").setTransform(dense, 0, 0, dense, 0, 0);
  };
  const inner = () => ({ w: size.width - LEFT - RIGHT, h: size.height - TOP - BOTTOM });
  const xAt = (share) => LEFT + share * inner().w;
  const yAt = (share) => TOP + (1 - share) * inner().h;

  const cell = (pen, ix, iy, grow = 0) => {
    const left = xAt(across.edges[ix]);
    const top = yAt(up.edges[iy + 1]);
    pen.rect(
      left - grow,
      top - grow,
      xAt(across.edges[ix + 1]) - left + 2 * grow,
      yAt(up.edges[iy]) - top + 2 * grow,
    );
  };

  // Every dot of the screen has the colour of its cell: a map of a million cells costs no more than a small one.
  const imageOf = (pen, paintOf) => {
    const dots = (from, length) => Math.floor((from + length) * dense) - Math.ceil(from * dense);
    const [wide, high] = [dots(LEFT, inner().w), dots(TOP, inner().h)];
    if (!(wide > 0 && high > 0)) return null;
    const image = pen.createImageData(wide, high);
    const dotsOf = new Uint32Array(image.data.buffer);
    const [columns, rows] = [cellsOf(across.edges, wide), cellsOf(up.edges, high).reverse()];
    rows.forEach((iy, row) => columns.forEach((ix, column) => {
      dotsOf[row * wide + column] = wordOf(paintOf(ix, iy));
    }));
    return image;
  };

  const drawAxes = (pen) => {
    pen.fillStyle = colour("--ink-soft");
    pen.strokeStyle = colour("--line-strong");
    pen.lineWidth = 1;
    pen.font = "12px system-ui, sans-serif";
    pen.strokeRect(LEFT, TOP, inner().w, inner().h);
    pen.textAlign = "center";
    pen.textBaseline = "top";
    for (const value of ticksOf(across)) {
      pen.fillRect(xAt(across.share(value)), TOP + inner().h, 1, 4);
      pen.fillText(number(value), xAt(across.share(value)), TOP + inner().h + 7);
    }
    pen.fillText(words(x, size.width), LEFT + inner().w / 2, size.height - 20);
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    for (const value of ticksOf(up)) {
      pen.fillRect(LEFT - 4, yAt(up.share(value)), 4, 1);
      pen.fillText(number(value), LEFT - 8, yAt(up.share(value)));
    }
    pen.save();
    pen.translate(14, TOP + inner().h / 2);
    pen.rotate(-Math.PI / 2);
    pen.textAlign = "center";
    pen.fillText(words(y, size.height), 0, 0);
    pen.restore();
  };

  const draw = (paintOf, [kept, aim], lines = []) => {
    const pen = canvas.getContext("2d");
    pen.clearRect(0, 0, size.width, size.height);
    if (painted.by !== paintOf) painted = { by: paintOf, image: imageOf(pen, paintOf) };
    if (painted.image) pen.putImageData(painted.image, Math.ceil(LEFT * dense), Math.ceil(TOP * dense));
    drawLines(pen, lines);
    drawAxes(pen);
    if (aim && aim !== kept) frame(pen, aim, 1.25);
    if (kept) frame(pen, kept, 3);
  };

  const frame = (pen, { ix, iy }, thick) => {
    pen.beginPath();
    cell(pen, ix, iy, 1.5);
    pen.lineWidth = thick;
    pen.strokeStyle = colour("--focus");
    pen.stroke();
  };

  const drawLines = (pen, lines) => {
    pen.strokeStyle = "#1d1f1e"; // the map has the same colours in the dark
    pen.lineWidth = 1.5;
    for (const line of lines) {
      pen.beginPath();
      line.forEach(([a, b], k) => pen[k ? "lineTo" : "moveTo"](xAt(across.share(a)), yAt(up.share(b))));
      pen.stroke();
    }
  };

  const indexOf = (edges, share) => edges.findIndex((edge, k) => k > 0 && share <= edge) - 1;
  const cellAt = (event) => {
    const box = canvas.getBoundingClientRect();
    const right = (event.clientX - box.left - LEFT) / inner().w;
    const high = 1 - (event.clientY - box.top - TOP) / inner().h;
    if (right < 0 || right > 1 || high < 0 || high > 1) return null;
    return { ix: Math.max(0, indexOf(across.edges, right)), iy: Math.max(0, indexOf(up.edges, high)) };
  };
  return { fit, draw, cellAt };
};

const words = (axis, room) => {
  const unit = axis.unit && axis.unit !== "1" ? ` [${pretty(axis.unit)}]` : "";
  const all = greek(axis.words);
  return (7 * all.length > room ? all.split(/[,;]/)[0] : all) + unit;
};
