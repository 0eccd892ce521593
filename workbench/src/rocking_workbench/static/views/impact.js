/** Impact view: restitution of every model, with measurements. */

import { html, render, useSignal } from "/parts/preact.js";
import { Pictured } from "/charts/pictured.js";
import { ledgerPicture } from "/drawing/ledger-picture.js";
import { stagesPicture } from "/drawing/stages-picture.js";
import { Card, Note, Segmented, sentence } from "/parts/fields.js";
import { Drawn } from "/parts/made.js";
import { aboutOf } from "/views/about.js";
import { OLDER, createAnswer, faultsOf } from "/views/answer.js";
import { Laboratory } from "/views/impact-bed.js";
import { Evidence, slendernessOf } from "/views/impact-evidence.js";
import { impulseRows } from "/views/impact-impulse.js";
import { Coefficients, Warnings } from "/views/impact-table.js";
import { t } from "/app/words.js";

/** @type {{ [foot in Foot]: string }} */
const ONTO = { left: "Impact onto the left foot", right: "Impact onto the right foot" };

/** Show the view. @param {HTMLElement} section @param {App} app */
export const mount = (section, app) => {
  const question = () => {
    const { body, settings } = app.inputs.get();
    return { body, settings };
  };
  const request = createAnswer(app, "impact", ["body", "settings"], question, { path: "impact", keeps: true });
  const faulty = faultsOf(app, "body");
  render(html`<${Impact} app=${app} request=${request} faulty=${faulty} />`, section);
  return {
    shown: () => {
      app.faults.refresh();
      request.shown();
    },
    hidden: request.hidden,
  };
};

const FEET = [["left", "left foot"], ["right", "right foot"]];

/** @param {{ app: App, request: Asked<Server.ImpactAnswered>, faulty: Signal<string> }} props */
const Impact = ({ app, request, faulty }) => {
  const { answer: { value: answer }, refused } = request;
  const wrong = refused.value?.message ?? faulty.value;
  return html`
    <header class="view-head"><h1>Impact</h1>
      <p class="lead">The body loses energy at each impact. Each model gives a coefficient of restitution. Published measurements give its accuracy.</p></header>
    <div class="refusal" role="alert" data-testid="impact-refusal">
      ${wrong && html`<${Note} kind="error" text=${`${sentence(wrong)}${answer ? ` ${t(OLDER)}` : ""}`} />`}</div>
    ${!answer && !wrong && html`<p class="waiting">Computing</p>`}
    <div class=${`stack results ${wrong ? "stale" : ""}`} data-testid="impact-results" hidden=${!answer} ...${answer && aboutOf(answer.body)}>
      ${answer && html`<${Results} app=${app} answer=${answer} />`}</div>`;
};

/** @param {{ app: App, answer: Server.ImpactAnswered }} props */
const Results = ({ app, answer }) => {
  const chosenFoot = useSignal("right");
  const feet = /** @type {Foot[]} */ (Object.keys(answer.coefficients));
  const foot = feet.find((candidate) => candidate === chosenFoot.value) ?? feet[0];
  const of = [answer, foot];
  const about = ONTO[foot];
  /** @param {string} title @param {(answer: Server.ImpactAnswered, foot: Foot, width: number) => Child} draw @param {string} [lead] */
  const pictured = (title, draw, lead = "") => html`<${Pictured} title=${title} about=${about}>
    ${lead && html`<p class="lead">${lead}</p>`}<${Drawn} draw=${draw} of=${of} /><//>`;
  return html`
    ${feet.length > 1 && html`<${Segmented} label="Impact on the" options=${FEET} value=${foot}
      on=${(next) => (chosenFoot.value = next)} />`}
    <${Card} title="Coefficient of restitution">
      <${Coefficients} app=${app} answer=${answer} foot=${foot} /><${Warnings} answer=${answer} foot=${foot} /><//>
    <${Card} title="Comparison with published measurements">
      <${Evidence} answer=${answer} foot=${foot} about=${about} /><//>
    <div class="columns two">
      <${Card} title="Impulse position">
        ${pictured("Impulse position", impulseRows, "Position along the base: 0 below the centre of mass of a block, 1 at the foot.")}<//>
      <${Card} title="Energy loss by KED">
        ${pictured("Energy loss by KED", ledgerOf, "Kinetic energy that remains after each stage, and lost energy (hatched), in percent of the energy before the impact.")}<//>
    </div>
    <${Card} title="The three stages of KED">${pictured("The three stages of KED", stagesOf)}<//>
    <${Card} title="The contact bed">
      <p class="lead">Impact of finite duration: a block with the slenderness and width of this body on springs and dashpots. The chart compares it with instantaneous models.</p>
      <${Laboratory} app=${app} body=${blockLike(answer, foot)} /><//>`;
};

/** @param {Server.ImpactAnswered} answer @param {Foot} foot @param {number} width */
const ledgerOf = (answer, foot, width) => ledgerPicture(answer.ked_energy_fractions[foot], { width });

/** @param {Server.ImpactAnswered} answer @param {Foot} foot @param {number} width */
const stagesOf = ({ body, stages: of }, foot, width) => {
  const { points, stages } = of[foot];
  const shown = stages.map(({ name, fraction, velocity: velocities }) => ({ name, fraction, velocities }));
  return stagesPicture(body, { points, stages: shown }, foot, { width });
};

/** @param {Server.ImpactAnswered} answer @param {Foot} foot */
const blockLike = (answer, foot) => ({
  slenderness: slendernessOf(answer, foot), width: answer.body.foot_positions[1] - answer.body.foot_positions[0],
});
