/** Positions of the points of a rocking body; a positive rotation is clockwise about the right foot. */

/** Position of a point of the body after a rotation about the foot of support.
 * @param {number} x @param {number} y @param {number} rotation @param {number[]} feet */
export const turned = (x, y, rotation, feet) => {
  const pivot = rotation > 0 ? feet[1] : feet[0];
  const c = Math.cos(rotation);
  const s = Math.sin(rotation);
  return [pivot + c * (x - pivot) + s * y, -s * (x - pivot) + c * y];
};

/** Returns all vertices and mass points of a shape, its feet and its centre of mass, as [[x, y]].
 * @param {Pick<Shape, "regions" | "feet" | "points" | "centre">} shape */
export const cornersOf = (shape) => {
  const corners = shape.regions.flatMap((region) => region.outline);
  const feet = shape.feet.map((x) => [x, 0]);
  return [...corners, ...shape.points.map(([x, y]) => [x, y]), ...feet, shape.centre];
};

const DIRECTIONS = 48;

/** Returns the farthest point in each of several directions. @param {number[][]} corners */
export const farthest = (corners) => {
  const extreme = new Set();
  for (let k = 0; k < DIRECTIONS; k += 1) {
    const c = Math.cos((2 * Math.PI * k) / DIRECTIONS);
    const s = Math.sin((2 * Math.PI * k) / DIRECTIONS);
    let best = corners[0];
    for (const corner of corners) if (c * corner[0] + s * corner[1] > c * best[0] + s * best[1]) best = corner;
    extreme.add(best);
  }
  return [...extreme];
};

/** @param {number[][]} corners @param {number[]} rotations @param {number[]} feet @param {number[]} shifts */
const reached = (corners, rotations, feet, shifts) => {
  const box = { left: Infinity, right: -Infinity, low: 0, high: -Infinity };
  rotations.forEach((rotation, k) => {
    for (const [x, y] of corners) {
      const [X, Y] = turned(x, y, rotation, feet);
      box.left = Math.min(box.left, X + shifts[k]);
      box.right = Math.max(box.right, X + shifts[k]);
      box.low = Math.min(box.low, Y);
      box.high = Math.max(box.high, Y);
    }
  });
  return box;
};

/** Returns the box {left, right, low, high} [m] that holds the body in all these poses.
 * @param {Pick<Shape, "regions" | "feet" | "points" | "centre">} shape @param {{ rotation: number, ground: number }[]} poses */
export const boxOf = (shape, poses) => {
  const corners = farthest(cornersOf(shape));
  const rotations = [0, ...poses.map(({ rotation }) => rotation)];
  const shifts = [0, ...poses.map(({ ground }) => ground)];
  return reached(corners, rotations, shape.feet, shifts);
};
