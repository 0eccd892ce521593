/** Regions of a polygon body, changed one step at a time, with undo and redo. */

import { highest, lowest, spanOf } from "/app/extremes.js";
// A place is {region, ring, vertex}: ring -1 is the outline, others are holes.

/** Ring of an index {region, ring, vertex}. @param {Region[]} regions @param {{ region: number, ring: number }} place @returns {Ring} */
export const ringAt = (regions, { region, ring }) =>
  /** @type {Ring} */ (ring < 0 ? regions[region]?.outline : regions[region]?.holes?.[ring]);

/** All rings with their indices. @param {Region[]} regions */
export const ringsOf = (regions) =>
  regions.flatMap((item, region) =>
    [item.outline, ...(item.holes ?? [])].map((points, index) => ({ region, ring: index - 1, points })));

/** Move one vertex. @param {Region[]} regions @param {Place} position @param {number[]} point */
export const moved = (regions, position, point) =>
  withRing(regions, position, (ring) => ring.map((corner, index) => (index === position.vertex ? point : corner)));

/** Insert a vertex after a vertex. @param {Region[]} regions @param {Place} position @param {number[]} point */
export const inserted = (regions, position, point) =>
  withRing(regions, position, (ring) => ring.toSpliced(position.vertex + 1, 0, /** @type {Point} */ (point)));

/** Remove a vertex; a triangle remains unchanged. @param {Region[]} regions @param {Place} position */
export const removed = (regions, position) =>
  ringAt(regions, position).length <= 3
    ? regions
    : withRing(regions, position, (ring) => ring.toSpliced(position.vertex, 1));

/** Remove a ring; the last region remains. @param {Region[]} regions @param {Place} place @returns {Region[]} */
export const withoutRing = (regions, { region, ring }) => {
  if (ring < 0) return regions.length > 1 ? regions.toSpliced(region, 1) : regions;
  return regions.with(
    region, tidied({ ...regions[region], holes: regions[region].holes?.toSpliced(ring, 1) }),
  );
};

/** Add a region.
 * @param {Region[]} regions @param {Ring} outline @param {number | null} [density] @returns {Region[]} */
export const withRegion = (regions, outline, density) =>
  [...regions, density === undefined ? { outline } : { outline, density }];

/** Add a hole to a region. @param {Region[]} regions @param {number} region @param {Ring} hole */
export const withHole = (regions, region, hole) =>
  regions.with(region, { ...regions[region], holes: [...(regions[region].holes ?? []), hole] });

/** Set the density of a region; null removes it.
 * @param {Region[]} regions @param {number} region @param {number | null} density @returns {Region[]} */
export const withDensity = (regions, region, density) =>
  regions.with(region, tidied({ ...regions[region], density: density ?? undefined }));

/** Regions moved vertically such that the lowest point is at y = 0.
 * @param {Region[]} regions @param {Exact} [exact] @returns {Region[]} */
export const onTheGround = (regions, exact = (value) => value) => {
  const low = lowest(regions.flatMap((region) => region.outline).map((point) => point[1]));
  /** @param {Ring} ring */
  const shift = (ring) => ring.map(([x, y]) => [x, exact(y - low)]);
  return regions.map(
    (region) => tidied({ ...region, outline: shift(region.outline), holes: region.holes?.map(shift) })
  );
};

/** A hole in the middle of an outline, a quarter of its size.
 * @param {Ring} outline @param {Exact} [exact] @returns {Ring} */
export const middleHole = (outline, exact = (value) => value) => {
  const [xs, ys] = [0, 1].map((axis) => outline.map((point) => point[axis]));
  const [x, y] = [xs, ys].map((values) => values.reduce((sum, value) => sum + value, 0) / values.length);
  const [dx, dy] = [xs, ys].map((values) => spanOf(values) / 8);
  return [
    [x - dx, y - dy], [x + dx, y - dy], [x + dx, y + dy], [x - dx, y + dy],
  ].map((point) => /** @type {Point} */ (point.map(exact)));
};

/** The edge after a vertex: both ends, its length and its angle from the horizontal in degrees.
 * @param {Region[]} regions @param {Place} position */
export const edgeAt = (regions, position) => {
  const ring = ringAt(regions, position);
  const [from, to] = [ring[position.vertex], ring[(position.vertex + 1) % ring.length]];
  const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
  return { from, to, length: Math.hypot(dx, dy), angle: (Math.atan2(dy, dx) * 180) / Math.PI };
};

/** Set the length or angle of an edge; its second end moves.
 * @param {Region[]} regions @param {Place} position @param {{ length: number, angle: number }} edge @param {Exact} [exact] */
export const withEdge = (regions, position, { length, angle }, exact = (value) => value) => {
  const { from } = edgeAt(regions, position);
  const turn = (angle * Math.PI) / 180;
  const end = [from[0] + length * Math.cos(turn), from[1] + length * Math.sin(turn)].map((coordinate) => exact(coordinate));
  return moved(regions, { ...position, vertex: (position.vertex + 1) % ringAt(regions, position).length }, end);
};

/** Edge as an arc with the given outward rise: {regions, chords, error}, with at most the required error.
 * @param {Region[]} regions @param {Place} position @param {number} rise @param {number} most @param {Exact} [exact] */
export const withArc = (regions, position, rise, most, exact = (value) => value) => {
  const { from, to, length } = edgeAt(regions, position);
  const radius = (length ** 2 / 4 + rise ** 2) / (2 * Math.abs(rise));
  const arcAngle = 4 * Math.atan((2 * Math.abs(rise)) / length);
  const chords = Math.max(2, Math.ceil(arcAngle / (2 * Math.acos(Math.max(0, 1 - most / radius))) - 1e-9));
  if (!(chords <= MOST_CHORDS)) return null;
  const out = Math.sign(rise) * Math.sign(signedArea(ringAt(regions, position)) || 1);
  const [ux, uy] = [(to[0] - from[0]) / length, (to[1] - from[1]) / length];
  const points = Array.from({ length: chords - 1 }, (_, k) => {
    const at = ((k + 1) / chords - 0.5) * arcAngle;
    const [along, up] = [length / 2 + radius * Math.sin(at), out * (radius * Math.cos(at) - radius + Math.abs(rise))];
    return /** @type {Point} */ ([from[0] + along * ux + up * uy, from[1] + along * uy - up * ux].map((coordinate) => exact(coordinate)));
  });
  const next = withRing(regions, position, (ring) => ring.toSpliced(position.vertex + 1, 0, ...points));
  return { regions: next, chords, error: radius * (1 - Math.cos(arcAngle / (2 * chords))) };
};

const MOST_CHORDS = 1000;

/** Twice the area of a ring, positive if it runs counter-clockwise. @param {Ring} ring */
const signedArea = (ring) => ring.reduce((sum, [x, y], index) => {
  const [nextX, nextY] = ring[(index + 1) % ring.length];
  return sum + x * nextY - nextX * y;
}, 0);

/** Mirror a section about its middle, with its feet and centre of mass.
 * @param {any} section @param {Region[]} regions @param {Exact} [exact] */
export const mirrored = (section, regions, exact = (value) => value) => {
  const xs = regions.flatMap((region) => region.outline).map((point) => point[0]);
  const sum = lowest(xs) + highest(xs);
  /** @param {number} x */
  const turned = (x) => exact(sum - x);
  /** @param {Ring} points */
  const ring = (points) => points.map(([x, y]) => [turned(x), y]).reverse();
  const { feet, centre } = section;
  return {
    ...section,
    region: regions.map((region) => tidied({ ...region, outline: ring(region.outline), holes: region.holes?.map(ring) })),
    ...(feet ? { feet: [turned(feet[1]), turned(feet[0])] } : {}),
    ...(centre ? { centre: [turned(centre[0]), centre[1]] } : {}),
  };
};

/** Join a ring and its mirror image at an edge: half a profile becomes the complete profile.
 * @param {Region[]} regions @param {Place} position @param {Exact} [exact] */
export const doubled = (regions, position, exact = (value) => value) => {
  const { from, to, length } = edgeAt(regions, position);
  const [ux, uy] = [(to[0] - from[0]) / length, (to[1] - from[1]) / length];
  /** @param {number[]} point */
  const image = ([x, y]) => {
    const along = (x - from[0]) * ux + (y - from[1]) * uy;
    return [2 * (from[0] + along * ux) - x, 2 * (from[1] + along * uy) - y].map((coordinate) => exact(coordinate));
  };
  return withRing(regions, position, (ring) => {
    const others = Array.from({ length: ring.length - 2 }, (_, k) => ring[(position.vertex + 2 + k) % ring.length]);
    return [to, ...others, from, ...others.map(image).reverse()];
  });
};

/** Index of the vertex nearest to a point within reach, with priority for the chosen vertex; null if there is none.
 * @param {Region[]} regions @param {number[]} point @param {number} reach @param {Place} chosen @returns {Place | null} */
export const nearest = (regions, [x, y], reach, chosen) => {
  let best = reach;
  /** @type {Place | null} */
  let closest = null;
  for (const { region, ring, points } of ringsOf(regions)) {
    points.forEach((point, vertex) => {
      const away = Math.hypot(point[0] - x, point[1] - y);
      const same = chosen.region === region && chosen.ring === ring && chosen.vertex === vertex;
      if (away < best || (away === best && same)) [best, closest] = [away, { region, ring, vertex }];
    });
  }
  return closest;
};

/** Round a point to a grid; without a step the point is unchanged.
 * @param {number[]} point @param {number} step @param {Exact} [exact] */
export const snapped = (point, step, exact = (value) => value) =>
  step > 0 ? point.map((value) => exact(Math.round(value / step) * step)) : point;

/** Undo and redo states of a value. */
export const createHistory = (most = 200) => {
  /** @type {any[]} */
  let past = [];
  /** @type {any[]} */
  let future = [];
  return {
    /** @param {any} value */
    keep: (value) => {
      past = [...past, value].slice(-most);
      future = [];
    },
    /** @param {(entry: any) => any} nowLike */
    undo: (nowLike) => travel(past, future, nowLike),
    /** @param {(entry: any) => any} nowLike */
    redo: (nowLike) => travel(future, past, nowLike),
    canUndo: () => past.length > 0,
    canRedo: () => future.length > 0,
  };
};

// The previous value is kept in the same unit as its replacement.
/** @param {any[]} from @param {any[]} to @param {(entry: any) => any} nowLike */
const travel = (from, to, nowLike) => {
  if (!from.length) return null;
  const entry = from.pop();
  to.push(nowLike(entry));
  return entry;
};

/** @param {Region[]} regions @param {{ region: number, ring: number }} place @param {(ring: Ring) => any} change @returns {Region[]} */
const withRing = (regions, { region, ring }, change) => {
  const old = regions[region];
  const next = ring < 0
    ? { ...old, outline: change(old.outline) }
    : { ...old, holes: old.holes?.with(ring, change(old.holes[ring])) };
  return regions.with(region, next);
};

/** @param {any} region @returns {Region} */
const tidied = (region) =>
  /** @type {any} */ (Object.fromEntries(Object.entries(region).filter(([key, value]) =>
    value !== undefined && !(key === "holes" && !value.length))));
