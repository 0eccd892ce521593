/** Properties of a body: one column, or one column per side if the sides differ. */

import { html } from "/parts/preact.js";
import { number, numbers, quantity } from "/app/format.js";
import { sameSides } from "/drawing/body-picture.js";
import { Note } from "/parts/fields.js";
import { Table } from "/parts/table.js";
import { t } from "/app/words.js";

/** The table of facts. @param {{ app: App, facts: Server.DescribedBody }} props */
export const Facts = ({ app, facts: body }) => {
  const { left, right } = body.sides;
  const differ = !sameSides(body.sides);
  const sides = differ ? [left, right] : [right];
  const columns = [
    "Quantity", ...(differ ? ["Left", "Right"] : ["Value"]).map((label) => ({ label, digits: 5, numeric: true })),
    { label: "Unit", numeric: false, nowrap: true },
  ];
  /** @param {string} label @param {string} unit @param {(side: Server.SideFacts) => number} read */
  const row = (label, unit, read) => [label, ...sides.map(read), unit];
  /** @param {string} label @param {string} unit @param {number} value */
  const sameRow = (label, unit, value) => [label, ...sides.map(() => value), unit];
  const feet = body.foot_positions.map((foot) => settled(foot, body));
  const rows = [
    row("Slenderness h/b", "", (side) => side.slenderness_ratio),
    row("Slenderness angle \u03b1", "rad", (side) => side.slenderness_angle),
    row("Slenderness angle \u03b1", "\u00b0", (side) => (side.slenderness_angle * 180) / Math.PI),
    row("Semi-diagonal R", "m", (side) => side.semi_diagonal),
    row("Frequency parameter p", "rad/s", (side) => side.frequency_parameter),
    row("Uplift acceleration", "m/s\u00b2", (side) => side.uplift_acceleration),
    row("Uplift acceleration", "g", (side) => side.uplift_acceleration / body.gravity),
    ["Foot, x", ...(differ ? feet : [numbers(feet)]), "m"],
    sameRow("Centre of mass, x", "m", settled(body.centre[0], body)),
    sameRow("Centre of mass, y", "m", settled(body.centre[1], body)),
    sameRow("Mass", "kg", body.mass),
    sameRow("Moment of inertia", "kg m\u00b2", body.moment_of_inertia),
  ];
  return html`<${Table} columns=${columns} rows=${rows} testid="facts-table"
    caption=${differ ? "By foot of rotation" : "Both feet"}
    csv=${() => app.download("table/body.csv", app.inputs.get(), "body.csv")} />`;
};

// Rounding errors, below 1e-14 of the semi-diagonal, are shown as 0.
/** @param {number} length @param {Server.DescribedBody} body */
const settled = (length, { sides }) =>
  (Math.abs(length) < 1e-14 * sides.right.semi_diagonal ? 0 : length);

/** Warnings as text, or a substitute. @param {{ facts: Server.DescribedBody }} props */
export const Warnings = ({ facts: { warnings = [], assumed = [], ...body } }) => html`
  ${warnings.map((text) => html`<${Note} key=${text} kind="warning" text=${text} />`)}
  ${!warnings.length && html`<${Note} kind="good" text=${t("Uplift at a ground acceleration of {acceleration}.", { acceleration: upliftWords(body) })} />`}
  ${assumed.map((text) => html`<${Note} key=${text} text=${text} />`)}`;

/** @param {Pick<Server.DescribedBody, "sides" | "gravity">} body */
const upliftWords = ({ sides, gravity }) => {
  const lowest = Math.min(sides.left.uplift_acceleration, sides.right.uplift_acceleration);
  return `${quantity(lowest, "m/s2", 3)} (${quantity(lowest / gravity, "g", 3)})`;
};
