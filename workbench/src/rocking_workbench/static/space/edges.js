/** Restitution of a 3D body with each model, for each edge of its base, which is marked on the body. */

import { html } from "/parts/preact.js";
import { number } from "/app/format.js";
import { Rows } from "/parts/table.js";
import { Scene } from "/space/scene.js";
import { t } from "/app/words.js";

/** Edges of the body of a run. @param {{ question: Server.WholeQuestion, answer: any, children: any }} props */
export const Edges = ({ question, answer, children }) => {
  const round = answer.body.base.kind !== "polygon";
  const models = Object.keys(answer.edges[0].coefficients);
  const doubts = [...new Set(answer.edges.flatMap((/** @type {any} */ { coefficients }) => Object.entries(coefficients)
    .flatMap(([name, { flags }]) => Object.values(flags).map((flag) => `${t(name)}: ${t(flag)}`))))];
  return html`
    <p class="verdict" data-testid="verdict">Coefficient of restitution of each base edge, by model.</p>
    <${Scene} question=${question} title="Edges of the base" label="Body with numbered base edges" onSpace=${() => {}}
      onStage=${(stage) => {
        stage.number(stage.model.edges);
        stage.draw();
      }}
      description=${round ? "The base is round. The table lists four directions."
        : t("The base has {count} edges. Edge 0 runs from corner 0 to corner 1.", { count: answer.edges.length + answer.edges_left_out })}
      legend=${[["holds", "edge with its number"], ["base", "corner"], ["plumb", "centre of mass and plumb line"]]} />
    ${children}
    <${Rows} caption="Edges and corners" head=${[round ? "from" : "from edge", "onto", "slenderness [\u00b0]", ...models]}
      rows=${answer.edges.map((/** @type {any} */ edge) => [edge.edge, edge.lands_on, number((edge.slenderness_angle * 180) / Math.PI, 3),
        ...models.map((name) => number(edge.coefficients[name].coefficient, 4))])} />
    ${[...doubts, ...answer.notes].map((note) => html`<p class="field-help" key=${note}>${note}</p>`)}`;
};
