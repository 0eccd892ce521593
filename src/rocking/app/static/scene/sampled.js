/** Answers of the API as tracks that the scene plays. */
import { cornersOf, lyingAngle } from "/scene/geometry.js";
import { Track } from "/scene/track.js";

const QUARTER = 0.5 * Math.PI;

/** Returns the fall after the last sample: from there to the ground, ever faster, as [times, rotations]. */
export const fallOf = (time, rotation, velocity, lying) => {
  const last = rotation.length - 1;
  const side = Math.sign(rotation[last]) || 1;
  const left = lying - Math.abs(rotation[last]);
  if (!(left > 1e-6)) return [[], []];
  const speed = Math.max(Math.abs(velocity[last] || 0), 0.5);
  const long = left / speed;
  const steps = Array.from({ length: 12 }, (_, k) => (k + 1) / 12);
  return [
    steps.map((share) => time[last] + share * long),
    steps.map((share) => side * (Math.abs(rotation[last]) + left * share)),
  ];
};

const clipped = (rotation, lying) => rotation.map((theta) => {
  const most = theta > 0 ? lying.right : lying.left;
  return Math.sign(theta) * Math.min(Math.abs(theta), most);
});

/** Returns one model's history for the scene; a body that overturned goes on to lie on the ground. */
export const actorOf = (answer, shape, style) => {
  const corners = cornersOf(shape);
  const [left, right] = shape.feet;
  const lying = { left: lyingAngle(corners, left, -1), right: lyingAngle(corners, right, 1) };
  for (const side of ["left", "right"]) if (!(lying[side] < Math.PI)) lying[side] = QUARTER;
  const { time, rotation, velocity } = answer.series;
  const seen = clipped(rotation, lying);
  const falls = answer.outcome === "overturned";
  const side = (seen.at(-1) || 0) > 0 ? "right" : "left";
  const [later, lower] = falls ? fallOf(time, seen, velocity, lying[side]) : [[], []];
  const impacts = answer.impacts || [];
  return {
    label: answer.label,
    colour: style.colour,
    dash: style.dash || [],
    scaledDash: [],
    falls,
    rotation: new Track([...time, ...later], [...seen, ...lower]),
    share: new Track([...time, ...later], sharesOf([...seen, ...lower], answer.body)),
    impactTimes: Float64Array.from(impacts, (one) => one.time_s),
    impactFeet: Float64Array.from(impacts, (one) => (one.onto === "right" ? 1 : 0)),
    impactWords: impacts.map((one) => `r = ${one.coefficient.toFixed(3)}`),
  };
};

/** Returns rotations over the slenderness angle of the side that the body leans to. */
export const sharesOf = (rotation, body) => {
  const right = body.sides.right.slenderness_angle_rad;
  const left = body.sides.left.slenderness_angle_rad;
  return rotation.map((theta) => theta / (theta > 0 ? right : left));
};
