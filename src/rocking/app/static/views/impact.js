/** The Impact view: what an impact costs under every model, against what was measured. */

import { card, note, segmented } from "/app/fields.js";
import { el, fill } from "/app/dom.js";
import { coefficientTable, warningNotes } from "/views/impact-table.js";
import { impulseRows } from "/views/impact-impulse.js";
import { evidenceParts } from "/views/impact-evidence.js";
import { bedPart } from "/views/impact-bed.js";
import { ledgerPicture } from "/drawing/ledger-picture.js";
import { pictureTools } from "/drawing/picture-tools.js";
import { chartFiles } from "/charts/save.js";
import { stillOf } from "/charts/still.js";
import { responsive } from "/drawing/responsive.js";
import { stagesPicture } from "/drawing/stages-picture.js";

/** Show the view. */
export const mount = (section, app) => {
  const state = { answer: null, foot: "right", error: null, seen: null, visible: false };
  const refusal = el("div", { class: "refusal", role: "alert", "data-testid": "impact-refusal" });
  const feet = segmented({
    label: "The body lands on its", value: "right",
    options: [{ value: "left", text: "left foot" }, { value: "right", text: "right foot" }],
    onChange: (foot) => {
      state.foot = foot;
      draw();
    },
  });
  const results = el("div", { class: "stack results", "data-testid": "impact-results", hidden: true });
  const waiting = el("p", { class: "waiting" }, "Computing");
  const table = el("div", {});
  const warnings = el("div", { class: "stack", "data-testid": "impact-warnings" });
  const evidence = evidenceParts();
  const bed = bedPart(app);
  feet.hidden = true;
  const drawn = (picture) => responsive(
    (width) => (state.answer ? picture(state.answer, state.foot, width) : null)
  );
  const impulse = drawn((answer, foot, width) => impulseRows(answer, foot, width));
  const ledger = drawn((answer, foot, width) => ledgerPicture(answer.ked_energy_shares[foot], { width }));
  const stages = drawn(
    (answer, foot, width) => stagesPicture(answer.body, fieldOf(answer.stages[foot]), foot, { width })
  );
  const still = (box, title) => {
    const named = () => stillOf(box.querySelector("svg"), `${title}, ${state.foot} foot`);
    return el("div", { class: "chart-foot" }, chartFiles(title, named, "picture"));
  };
  const tools = (what) => pictureTools(app, what, () => `?onto=${state.foot}`);
  fill(section,
    el("header", { class: "view-head" },
      el("h1", {}, "What does an impact cost?"),
      el("p", { class: "lead" },
        "Each time the body comes back to the ground it loses speed. Every model says how much; ",
        "the published measurements say how far to trust it.")),
    refusal, waiting, results);
  fill(results, feet,
    card("Coefficient of restitution", table, warnings),
    card("Against the published measurements", ...evidence.nodes, tools("coefficients")),
    el("div", { class: "columns two" },
      card(
        "Where the impulse acts",
        el(
          "p", { class: "lead" }, "Along the base: 0 is below the centre of mass of a block, 1 is the foot.",
        ),
        impulse, still(impulse, "Where the impulse acts"),
      ),
      card(
        "Where the energy goes, by KED",
        el("p", { class: "lead" }, "Kinetic energy kept and lost (hatched), from 100\u202f%."),
        ledger, still(ledger, "Where the energy goes, by KED"),
      )),
    card("The three stages of KED", stages, tools("stages")),
    card("The contact bed",
      el("p", { class: "lead" },
        "An impact that takes its time, on springs and dashpots under a block as slender and wide as this body: what comes "
          + "out of it, beside models of one instant."),
      bed.node));

  const draw = () => {
    const { answer } = state;
    const found = Object.keys(answer.coefficients);
    feet.hidden = found.length < 2;
    if (!found.includes(state.foot)) state.foot = found[0];
    feet.value = state.foot;
    fill(table, coefficientTable(answer, state.foot, app));
    fill(warnings, warningNotes(answer, state.foot));
    evidence.follow(answer, state.foot);
    bed.follow(answer, state.foot);
    for (const each of [impulse, ledger, stages]) each.redraw();
  };
  const look = () => {
    const wrong = state.error?.message ?? app.faults.sentence({ view: "body" });
    results.classList.toggle("stale", Boolean(wrong));
    results.hidden = !state.answer;
    waiting.hidden = Boolean(state.answer || wrong);
    const older = state.answer ? " What is shown below belongs to the last valid inputs." : "";
    if (shownWrong === wrong + older) return;
    shownWrong = wrong + older;
    fill(refusal, wrong ? note(`${ended(wrong)}${older}`, "error") : null);
  };
  let shownWrong = "";
  const ask = async () => {
    const { body, settings } = app.inputs.get();
    const key = JSON.stringify([body, settings]);
    if (!state.visible || key === state.seen) return;
    try {
      state.answer = await app.latest("impact", "impact", settings ? { body, settings } : { body });
      [state.seen, state.error] = [key, null];
      look();
      draw();
    } catch (error) {
      if (app.superseded(error)) return;
      [state.seen, state.error] = [null, error];
      look();
    }
  };
  app.faults.subscribe(look);
  app.inputs.subscribe((_, changed) => (changed.has("body") || changed.has("settings")) && ask());
  return {
    shown: () => {
      state.visible = true;
      look();
      return ask();
    },
    hidden: () => (state.visible = false),
  };
};

const ended = (words) => (/[.?!]$/.test(words) ? words : `${words}.`);

const fieldOf = ({ points_m: points, stages }) => ({
  points, stages: stages.map(({ name, share, velocity_m_s: velocities }) => ({ name, share, velocities })),
});
