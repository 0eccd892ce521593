/** The body in the scene: its paths are created once, and each frame moves them. */

import { highest } from "/app/extremes.js";
import { pathOf } from "/charts/pen.js";

/** @param {number[][]} ring */
const ringOf = (ring) => `M${ring.map((point) => point.join(" ")).join("L")}Z`;

/**
 * Returns the shape of a body of the API [m]: regions with shades, mass points, feet and centre of mass. The ground is
 * at y = 0 and the middle between the feet at x = 0.
 * @param {Server.DrawnBody} body @returns {Shape} */
export const shapeOf = ({ outline, foot_positions: base, ground = 0, points = [], masses = [], centre }) => {
  const middle = 0.5 * (base[0] + base[1]);
  /** @param {number[][]} ring */
  const moved = (ring) => ring.map(([x, y]) => [x - middle, y - ground]);
  const densest = highest(outline.map(({ density }) => density || 0), 0);
  const heaviest = highest(masses, 0);
  const regions = outline.map(({ outline: ring, holes, density }) => ({
    outline: moved(ring),
    holes: (holes || []).map(moved),
    shade: densest > 0 ? (density || densest) / densest : 1,
  }));
  return {
    regions: regions.map((region) => ({ ...region, path: pathOf([region.outline, ...region.holes].map(ringOf).join("")) })),
    points: points.map(([x, y], k) => [x - middle, y - ground, heaviest > 0 ? masses[k] / heaviest : 1]),
    feet: base.map((x) => x - middle),
    centre: [centre[0] - middle, centre[1] - ground],
  };
};
