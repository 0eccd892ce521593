/** Results of the API as tracks of the scene. */
import { fixed } from "/app/format.js";
import { Track } from "/scene/track.js";

/** Returns the history of a model for the scene, with the fall to the ground after overturning.
 * @param {Server.ResponseFacts} answer @param {Look} style @returns {Actor} */
export const actorOf = (answer, style) => {
  const { series, fall, impacts = [] } = answer;
  const [left, right] = fall.lying;
  const time = [...series.time, ...fall.time];
  const seen = [...series.rotation, ...fall.rotation].map((theta) => Math.min(Math.max(theta, left), right));
  return {
    label: answer.label,
    colour: style.colour,
    dash: style.dash || [],
    scaledDash: [],
    falls: answer.outcome === "overturned",
    rotation: new Track(time, seen),
    share: new Track(time, sharesOf(seen, answer.body)),
    impactTimes: Float64Array.from(impacts, (impact) => impact.time),
    impactFeet: Float64Array.from(impacts, (impact) => (impact.foot === "right" ? 1 : 0)),
    impactWords: impacts.map((impact) => `r = ${fixed(impact.coefficient, 3)}`),
  };
};

/** Rotations over the slenderness angle of the side of the rotation.
 * @param {number[]} rotation @param {{ sides: Server.Sides }} body */
export const sharesOf = (rotation, body) => {
  const right = body.sides.right.slenderness_angle;
  const left = body.sides.left.slenderness_angle;
  return rotation.map((theta) => theta / (theta > 0 ? right : left));
};
