/** A map on a canvas: cells, axes, and which cell is under a point. */
import { svg } from "/app/dom.js";
import { SvgPen } from "/charts/pen.js";
import { colour } from "/charts/style.js";
import { number, pretty } from "/app/format.js";
import { t } from "/app/words.js";
import { greek } from "/views/studies-words.js";

const LEFT = 64;
const BOTTOM = 52;
const TOP = 12;
const RIGHT = 14;
const FINE = 2; // pixels of a file per pixel of the page

/** @param {number[]} values */
const isGeometric = (values) => {
  if (values.length < 3 || values[0] <= 0) return false;
  const first = values[1] / values[0];
  const even = values.every((value, k) => k === 0 || Math.abs(value / values[k - 1] / first - 1) < 1e-6);
  const step = values[1] - values[0];
  return even && Math.abs(values[2] - values[1] - step) > 1e-9 * Math.abs(step);
};

/** @param {number[]} places */
const edgesOf = (places) => {
  if (places.length === 1) return [places[0] - 0.5, places[0] + 0.5];
  const inner = places.slice(1).map((position, k) => 0.5 * (position + places[k]));
  return [1.5 * places[0] - 0.5 * places[1], ...inner, 1.5 * places[places.length - 1] - 0.5 * places[places.length - 2]];
};

/** Positions of an axis: value to fraction of its length, and edges of its cells. @param {{ values: number[] }} axis */
export const axisOf = ({ values }) => {
  const log = isGeometric(values);
  const positionOf = log ? Math.log : Number;
  const edges = edgesOf(values.map(positionOf));
  const span = edges[edges.length - 1] - edges[0] || 1;
  return {
    log,
    /** @param {number} value */
    share: (/** @type {number} */ value) => (positionOf(value) - edges[0]) / span,
    edges: edges.map((edge) => (edge - edges[0]) / span),
    value: (/** @type {number} */ share) => (log ? Math.exp : Number)(edges[0] + share * span),
  };
};

/** Round numbers for an axis from low to high. @param {{ low: number, high: number, log: boolean }} range */
export const ticksOf = ({ low, high, log }) => {
  if (log && high / low > 8) {
    return [1, 2, 5]
      .flatMap((m) => Array.from({ length: 13 }, (_, k) => m * 10 ** (k - 6)))
      .filter((value) => value >= low && value <= high)
      .sort((a, b) => a - b);
  }
  const rough = (high - low) / 6;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = ([1, 2, 5].find((m) => m * power >= rough) ?? 10) * power;
  const first = Math.ceil(low / step);
  return Array.from({ length: Math.floor(high / step) - first + 1 }, (_, k) =>
    Number(((first + k) * step).toPrecision(12)),
  );
};

/** Index of the cell at the middle of every pixel along the visible part of an axis.
 * @param {number[]} edges @param {number} dots @param {number[]} part */
const cellsOf = (edges, dots, [from, to]) => {
  let k = 0;
  return Array.from({ length: dots }, (_, dot) => {
    const share = from + ((dot + 0.5) / dots) * (to - from);
    while (k < edges.length - 2 && edges[k + 1] <= share) k += 1;
    return k;
  });
};

const WHOLE = [0, 1];
const LEAST = 4; // smallest number of visible cells along an axis

/** Interval of a given length around a position, within the axis. @param {number} position @param {number} length */
const around = (position, length) => {
  const from = Math.min(Math.max(position - length / 2, 0), 1 - length);
  return [from, from + length];
};

/** Color "#rrggbb" as a pixel of an image, least significant byte first. @param {string} paint */
const wordOf = (paint) => {
  const rgb = parseInt(paint.slice(1), 16);
  return (0xff000000 | ((rgb & 0xff) << 16) | (rgb & 0xff00) | (rgb >> 16)) >>> 0;
};

/** Painter of a map: draw(paintOf, [kept, aim], lines, drag), cellAt(event), and the visible part.
 * @param {HTMLCanvasElement} canvas @param {MapAxis} x @param {MapAxis} y */
export const createGrid = (canvas, x, y) => {
  const across = axisOf(x);
  const up = axisOf(y);
  let size = { width: 300, height: 300 };
  let ratio = 1; // pixels of the screen per pixel of the page
  /** @type {{ by?: PaintOf, lines?: Lines }} */
  let painted = {};
  let seen = [WHOLE, WHOLE]; // fractions of the axes
  const still = document.createElement("canvas"); // all except the pointer marks: painted once, not at every move

  const fit = () => {
    const width = Math.max(240, canvas.parentElement?.clientWidth ?? 0);
    size = { width, height: Math.round(Math.min(0.78 * width, 520)) };
    ratio = window.devicePixelRatio || 1;
    painted = {};
    for (const board of [canvas, still]) {
      board.width = Math.round(size.width * ratio);
      board.height = Math.round(size.height * ratio);
      board.getContext("2d")?.setTransform(ratio, 0, 0, ratio, 0, 0);
    }
    canvas.style.height = `${size.height}px`;
  };
  const inner = () => ({ w: size.width - LEFT - RIGHT, h: size.height - TOP - BOTTOM });
  /** @param {number} share @param {number[]} range */
  const shareIn = (share, [from, to]) => (share - from) / (to - from);
  /** @param {number} share */
  const xAt = (share) => LEFT + shareIn(share, seen[0]) * inner().w;
  /** @param {number} share */
  const yAt = (share) => TOP + (1 - shareIn(share, seen[1])) * inner().h;
  /** @param {...number[]} parts */
  const look = (...parts) => {
    const shortest = [across, up].map(({ edges }) => Math.min(1, LEAST / (edges.length - 1)));
    seen = parts.map(([from, to], k) => around((from + to) / 2, Math.min(1, Math.max(shortest[k], to - from))));
    painted = {};
  };
  /** @param {GridAxis} axis @param {number} k */
  const middle = (axis, k) => (axis.edges[k] + axis.edges[k + 1]) / 2;
  /** @param {Cell} cell */
  const placeOf = ({ ix, iy }) => [middle(across, ix), middle(up, iy)];

  /** @param {CanvasRenderingContext2D} pen @param {number} ix @param {number} iy @param {number} [grow] */
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

  // Every pixel of the screen has the colour of its cell, so that the time does not depend on the number of cells.
  /** @param {CanvasRenderingContext2D} pen @param {PaintOf} paintOf @param {number} [dense] */
  const imageOf = (pen, paintOf, dense = ratio) => {
    /** @param {number} from @param {number} length */
    const dots = (from, length) => Math.floor((from + length) * dense) - Math.ceil(from * dense);
    const [wide, high] = [dots(LEFT, inner().w), dots(TOP, inner().h)];
    if (!(wide > 0 && high > 0)) return null;
    const image = pen.createImageData(wide, high);
    const dotsOf = new Uint32Array(image.data.buffer);
    const [columns, rows] = [cellsOf(across.edges, wide, seen[0]), cellsOf(up.edges, high, seen[1]).reverse()];
    rows.forEach((iy, row) => columns.forEach((ix, column) => {
      dotsOf[row * wide + column] = wordOf(paintOf(ix, iy));
    }));
    return image;
  };

  /** @param {CanvasRenderingContext2D} pen */
  const drawAxes = (pen) => {
    pen.fillStyle = colour("--ink-soft");
    pen.strokeStyle = colour("--line-strong");
    pen.lineWidth = 1;
    /** @param {GridAxis} axis @param {number[]} range */
    const ticks = ({ value, log }, [from, to]) => ticksOf({ log, low: value(from), high: value(to) });
    pen.font = "12px system-ui, sans-serif";
    pen.beginPath();
    pen.rect(LEFT, TOP, inner().w, inner().h);
    pen.stroke();
    pen.textAlign = "center";
    pen.textBaseline = "top";
    for (const value of ticks(across, seen[0])) {
      pen.fillRect(xAt(across.share(value)), TOP + inner().h, 1, 4);
      pen.fillText(number(value), xAt(across.share(value)), TOP + inner().h + 7);
    }
    pen.fillText(axisText(x, size.width), LEFT + inner().w / 2, size.height - 20);
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    for (const value of ticks(up, seen[1])) {
      pen.fillRect(LEFT - 4, yAt(up.share(value)), 4, 1);
      pen.fillText(number(value), LEFT - 8, yAt(up.share(value)));
    }
    pen.save();
    pen.translate(14, TOP + inner().h / 2);
    pen.rotate(-Math.PI / 2);
    pen.textAlign = "center";
    pen.fillText(axisText(y, size.height), 0, 0);
    pen.restore();
  };

  /** @param {CanvasRenderingContext2D} pen @param {() => void} drawing */
  const within = (pen, drawing) => {
    pen.save();
    pen.beginPath();
    pen.rect(LEFT - 2, TOP - 2, inner().w + 4, inner().h + 4);
    pen.clip();
    drawing();
    pen.restore();
  };

  /** @param {CanvasRenderingContext2D} pen @param {Lines} lines */
  const drawOver = (pen, lines) => {
    within(pen, () => drawLines(pen, lines));
    drawAxes(pen);
  };

  /** Visible part without the pointer marks, for a file. @param {PaintOf} paintOf @param {Lines} lines */
  const asSvg = (paintOf, lines) => {
    const cells = Object.assign(document.createElement("canvas"), { width: FINE * inner().w, height: FINE * inner().h });
    const brush = /** @type {CanvasRenderingContext2D} */ (cells.getContext("2d"));
    const image = imageOf(brush, paintOf, FINE);
    if (image) brush.putImageData(image, 0, 0);
    const pen = new SvgPen();
    drawOver(/** @type {any} */ (pen), lines);
    const where = { x: LEFT, y: TOP, width: inner().w, height: inner().h, preserveAspectRatio: "none" };
    return svg("svg", { viewBox: `0 0 ${size.width} ${size.height}` }, svg("image", { ...where, href: cells.toDataURL() }), pen.node);
  };

  /** @param {PaintOf} paintOf @param {Lines} lines */
  const drawStill = (paintOf, lines) => {
    const pen = /** @type {CanvasRenderingContext2D} */ (still.getContext("2d"));
    pen.clearRect(0, 0, size.width, size.height);
    const image = imageOf(pen, paintOf);
    if (image) pen.putImageData(image, Math.ceil(LEFT * ratio), Math.ceil(TOP * ratio));
    drawOver(pen, lines);
    painted = { by: paintOf, lines };
  };

  /** @param {PaintOf} paintOf @param {(Cell | null)[]} cells @param {Lines} [lines] @param {number[][] | null} [drag] */
  const draw = (paintOf, [kept, aim], lines = [], drag = null) => {
    const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
    if (painted.by !== paintOf || painted.lines !== lines) drawStill(paintOf, lines);
    pen.clearRect(0, 0, size.width, size.height);
    pen.drawImage(still, 0, 0, size.width, size.height);
    within(pen, () => {
      if (aim && aim !== kept) frame(pen, aim, 1.25);
      if (kept) frame(pen, kept, 3);
      if (drag) outline(pen, drag);
    });
  };

  /** @param {CanvasRenderingContext2D} pen @param {number[][]} frame */
  const outline = (pen, [from, to]) => {
    pen.lineWidth = 1.5;
    pen.strokeStyle = colour("--focus");
    pen.strokeRect(xAt(from[0]), yAt(from[1]), xAt(to[0]) - xAt(from[0]), yAt(to[1]) - yAt(from[1]));
  };

  /** @param {CanvasRenderingContext2D} pen @param {Cell} cell @param {number} thick */
  const frame = (pen, { ix, iy }, thick) => {
    pen.beginPath();
    cell(pen, ix, iy, 1.5);
    pen.lineWidth = thick;
    pen.strokeStyle = colour("--focus");
    pen.stroke();
  };

  /** @param {CanvasRenderingContext2D} pen @param {Lines} lines */
  const drawLines = (pen, lines) => {
    pen.strokeStyle = "#1d1f1e"; // the map has the same colours in the dark theme
    pen.lineWidth = 1.5;
    for (const line of lines) {
      pen.beginPath();
      line.forEach(([a, b], k) => pen[k ? "lineTo" : "moveTo"](xAt(across.share(a)), yAt(up.share(b))));
      pen.stroke();
    }
  };

  /** Fractions of the axes at the pointer, on the map or next to it. @param {MouseEvent} event */
  const sharesAt = (event) => {
    const box = canvas.getBoundingClientRect();
    const right = (event.clientX - box.left - LEFT) / inner().w;
    const high = 1 - (event.clientY - box.top - TOP) / inner().h;
    return [right, high].map((share, k) => seen[k][0] + share * (seen[k][1] - seen[k][0]));
  };
  /** @param {number[]} edges @param {number} share */
  const indexOf = (edges, share) => edges.findIndex((edge, k) => k > 0 && share <= edge) - 1;
  /** @param {MouseEvent} event */
  const cellAt = (event) => {
    const [right, high] = sharesAt(event);
    if ([right, high].some((share, k) => share < seen[k][0] || share > seen[k][1])) return null;
    return { ix: Math.max(0, indexOf(across.edges, right)), iy: Math.max(0, indexOf(up.edges, high)) };
  };
  /** Zoom at a cell by a factor; a factor below 1 zooms out.
   * @param {Cell | null} aim @param {number} factor */
  const closer = (aim, factor) => {
    const places = aim ? placeOf(aim) : seen.map(([from, to]) => (from + to) / 2);
    look(...places.map((position, k) => around(position, Math.min(1, (seen[k][1] - seen[k][0]) / factor))));
  };
  /** Move the visible part to include a cell. @param {Cell} aim */
  const reveal = (aim) => {
    const places = placeOf(aim);
    if (places.every((position, k) => position >= seen[k][0] && position <= seen[k][1])) return;
    look(...places.map((position, k) => around(position, seen[k][1] - seen[k][0])));
  };
  const isWhole = () => seen.every(([from, to]) => to - from > 1 - 1e-9);
  return { fit, draw, asSvg, cellAt, sharesAt, look, closer, reveal, isWhole, showAll: () => look(WHOLE, WHOLE) };
};

/** @param {MapAxis} axis @param {number} room */
const axisText = (axis, room) => {
  const unit = axis.unit && axis.unit !== "1" ? ` [${pretty(axis.unit)}]` : "";
  const all = t(greek(axis.description));
  return (7 * all.length > room ? all.split(/[,;，；]/)[0] : all) + unit;
};
