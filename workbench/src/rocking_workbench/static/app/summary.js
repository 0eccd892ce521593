/** Summary of the body in the side column. */

import { html, render, signal, useMemo } from "/parts/preact.js";
import { number, quantity } from "/app/format.js";
import { bodyPicture } from "/drawing/body-picture.js";
import { Button, Note } from "/parts/fields.js";
import { Made } from "/parts/made.js";

/** Keep the column up to date. @param {HTMLElement} aside @param {App} app */
export const mountSummary = (aside, app) => {
  const [facts, wrong] = [signal(app.body.get()), signal("")]; // errors, one per line
  const look = () => {
    const refused = app.body.error()?.message;
    wrong.value = [app.faults.sentence({ inputs: true, but: refused }), refused].filter(Boolean).join("\n");
    aside.classList.toggle("stale", wrong.value !== "");
  };
  app.faults.subscribe(look);
  app.body.subscribe((described) => {
    look();
    facts.value = described;
  });
  render(html`<${Summary} app=${app} facts=${facts} wrong=${wrong} />`, aside);
};

/** @param {{ app: App, facts: Signal<Server.DescribedBody | null>, wrong: Signal<string> }} props */
const Summary = ({ app, facts: { value: facts }, wrong }) => html`
  <h2>The body</h2>
  <div class="refusal" data-testid="summary-faults">
    ${wrong.value.split("\n").filter(Boolean).map((text) => html`<${Note} key=${text} kind="error" text=${text} />`)}</div>
  ${facts && html`<${Facts} facts=${facts} />`}
  <${Button} kind="quiet" onClick=${() => app.go("body")}>Change the body<//>`;

/** @param {{ facts: Server.DescribedBody }} props */
const Facts = ({ facts }) => html`
  ${facts.name && html`<p class="summary-name" translate=${false}>${facts.name}</p>`}
  <${Made} class="summary-picture" node=${useMemo(() => bodyPicture(facts, { height: 190, plain: true }), [facts])} />
  <dl class="facts compact" data-testid="summary">${rows(facts).map(([term, text]) => html`<dt key=${term}>${term}</dt><dd>${text}</dd>`)}</dl>`;

/** @param {Server.DescribedBody} facts */
const rows = ({ sides, mass }) => {
  const { left, right } = sides;
  /** @param {keyof Server.SideFacts} key @param {(value: number) => string} show */
  const both = (key, show) =>
    show(left[key]) === show(right[key]) ? show(right[key]) : `${show(left[key])} | ${show(right[key])}`;
  return [
    ["h/b", both("slenderness_ratio", (value) => number(value))],
    ["\u03b1", both("slenderness_angle", (value) => quantity((value * 180) / Math.PI, "\u00b0"))],
    ["R", both("semi_diagonal", (value) => quantity(value, "m"))],
    ["p", both("frequency_parameter", (value) => quantity(value, "rad/s"))],
    ["uplift", both("uplift_acceleration", (value) => quantity(value, "m/s2"))],
    ["mass", quantity(mass, "kg")],
  ];
};
