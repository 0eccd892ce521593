/** Regions of a polygon body, changed one step at a time, with undo and redo. */

import { lowest, spanOf } from "/app/extremes.js";
// A place is {region, ring, vertex}: ring -1 is the outline, others are holes.

/** The ring at a place. */
export const ringAt = (regions, { region, ring }) =>
  ring < 0 ? regions[region]?.outline : regions[region]?.holes?.[ring];

/** Every ring with its place. */
export const ringsOf = (regions) =>
  regions.flatMap((each, region) =>
    [each.outline, ...(each.holes ?? [])].map((points, index) => ({ region, ring: index - 1, points })));

/** Move one vertex. */
export const moved = (regions, place, point) =>
  withRing(regions, place, (ring) => ring.map((each, index) => (index === place.vertex ? point : each)));

/** A new vertex after one. */
export const inserted = (regions, place, point) =>
  withRing(regions, place, (ring) => ring.toSpliced(place.vertex + 1, 0, point));

/** Without one vertex; a triangle keeps all three. */
export const removed = (regions, place) =>
  ringAt(regions, place).length <= 3
    ? regions
    : withRing(regions, place, (ring) => ring.toSpliced(place.vertex, 1));

/** Without a whole ring; the last region stays. */
export const withoutRing = (regions, { region, ring }) => {
  if (ring < 0) return regions.length > 1 ? regions.toSpliced(region, 1) : regions;
  return regions.with(
    region, tidied({ ...regions[region], holes: regions[region].holes.toSpliced(ring, 1) }),
  );
};

/** With one more region. */
export const withRegion = (regions, outline, density) =>
  [...regions, density === undefined ? { outline } : { outline, density }];

/** With one more hole in a region. */
export const withHole = (regions, region, hole) =>
  regions.with(region, { ...regions[region], holes: [...(regions[region].holes ?? []), hole] });

/** With another density of a region; null takes it away. */
export const withDensity = (regions, region, density) =>
  regions.with(region, tidied({ ...regions[region], density: density ?? undefined }));

/** Shifted so that the lowest point stands on y = 0. */
export const onTheGround = (regions, exact = (value) => value) => {
  const low = lowest(regions.flatMap((each) => each.outline).map((point) => point[1]));
  const shift = (ring) => ring.map(([x, y]) => [x, exact(y - low)]);
  return regions.map(
    (each) => tidied({ ...each, outline: shift(each.outline), holes: each.holes?.map(shift) })
  );
};

/** A hole in the middle of an outline, a quarter of its size. */
export const middleHole = (outline, exact = (value) => value) => {
  const [xs, ys] = [0, 1].map((axis) => outline.map((point) => point[axis]));
  const [x, y] = [xs, ys].map((each) => each.reduce((sum, value) => sum + value, 0) / each.length);
  const [dx, dy] = [xs, ys].map((each) => spanOf(each) / 8);
  return [
    [x - dx, y - dy], [x + dx, y - dy], [x + dx, y + dy], [x - dx, y + dy],
  ].map((point) => point.map(exact));
};

/** Round a point to a grid; a step of nothing leaves it. */
export const snapped = (point, step, exact = (value) => value) =>
  step > 0 ? point.map((value) => exact(Math.round(value / step) * step)) : point;

/** The past and the future of a value. */
export const createHistory = (most = 200) => {
  let past = [];
  let future = [];
  return {
    keep: (value) => {
      past = [...past, value].slice(-most);
      future = [];
    },
    undo: (nowLike) => travel(past, future, nowLike),
    redo: (nowLike) => travel(future, past, nowLike),
    clear: () => [past, future] = [[], []],
    canUndo: () => past.length > 0,
    canRedo: () => future.length > 0,
  };
};

// What is left behind is kept as the value that takes its place was.
const travel = (from, to, nowLike) => {
  if (!from.length) return null;
  const found = from.pop();
  to.push(nowLike(found));
  return found;
};

const withRing = (regions, { region, ring }, change) => {
  const each = regions[region];
  const next = ring < 0
    ? { ...each, outline: change(each.outline) }
    : { ...each, holes: each.holes.with(ring, change(each.holes[ring])) };
  return regions.with(region, next);
};

const tidied = (region) =>
  Object.fromEntries(Object.entries(region).filter(([key, value]) =>
    value !== undefined && !(key === "holes" && !value.length)));
