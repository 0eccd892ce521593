/** The body column beside every other view: what stands there, at a glance. */

import { note } from "/app/controls.js";
import { el, fill } from "/app/dom.js";
import { number, quantity } from "/app/format.js";
import { bodyPicture } from "/drawing/body-picture.js";

/** Keep the column up to date. */
export const mountSummary = (aside, app) => {
  const picture = el("div", { class: "summary-picture" });
  const facts = el("dl", { class: "facts compact", "data-testid": "summary" });
  const name = el("p", { class: "summary-name" });
  const edit = el(
    "button", { type: "button", class: "button quiet", onclick: () => app.go("body") }, "Change the body",
  );
  const refusal = el("div", { class: "refusal", "data-testid": "summary-faults" });
  fill(aside, el("h2", {}, "The body"), refusal, name, picture, facts, edit);
  const look = () => {
    const refused = app.body.error()?.message;
    const wrong = [app.faults.sentence({ inputs: true, but: refused }), refused].filter(Boolean);
    aside.classList.toggle("stale", wrong.length > 0);
    if (refusal.dataset.words === wrong.join()) return;
    refusal.dataset.words = wrong.join();
    fill(refusal, wrong.map((words) => note(words, "error")));
  };
  app.faults.subscribe(look);
  app.body.subscribe((body) => {
    look();
    if (!body) return;
    fill(name, body.name ?? "");
    name.hidden = !body.name;
    fill(picture, bodyPicture(body, { height: 190, plain: true }));
    fill(facts, ...rows(body).map(([term, text]) => [el("dt", {}, term), el("dd", {}, text)]));
  });
};

const rows = ({ sides, mass_kg: mass }) => {
  const { left, right } = sides;
  const both = (key, show) =>
    show(left[key]) === show(right[key]) ? show(right[key]) : `${show(left[key])} | ${show(right[key])}`;
  return [
    ["h/b", both("slenderness_ratio", (value) => number(value))],
    ["\u03b1", both("slenderness_angle_rad", (value) => quantity((value * 180) / Math.PI, "\u00b0"))],
    ["R", both("semi_diagonal_m", (value) => quantity(value, "m"))],
    ["p", both("frequency_parameter_rad_s", (value) => quantity(value, "rad/s"))],
    ["uplift", both("uplift_acceleration_m_s2", (value) => quantity(value, "m/s2"))],
    ["mass", quantity(mass, "kg")],
  ];
};
