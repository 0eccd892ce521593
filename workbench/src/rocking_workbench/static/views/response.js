/** Response of the body: outcome, animation and linked figures, for several restitution models. */
import { html, render, signal, useLayoutEffect, useMemo, useRef } from "/parts/preact.js";
import { Button, Note } from "/parts/fields.js";
import { createTime } from "/charts/figure.js";
import { dotsOf } from "/charts/zoom.js";
import { Player } from "/scene/player.js";
import { aboutOf } from "/views/about.js";
import { OLDER, createAnswer, faultsOf } from "/views/answer.js";
import { chosenOf } from "/views/response-chosen.js";
import { Controls, lean } from "/views/response-controls.js";
import { Figures, marksWords } from "/views/response-figures.js";
import { wordsOf } from "/views/response-labels.js";
import { Cards, Impacts, TakeAway } from "/views/response-results.js";
import { Scene } from "/views/response-scene.js";
import { Banner, inWords, verdictKind } from "/views/response-words.js";
import { t } from "/app/words.js";

const KEYS = ["body", "motion", "restitution", "response", "settings"];
const FIGURES = ["rotation", "velocity", "ground", "energy", "force", "friction"];

/** Shows the view of the response in a section. @param {HTMLElement} section @param {App} app */
export const mount = (section, app) => {
  const question = () => {
    const { body, motion, restitution, response, settings } = app.inputs.get();
    const free = response?.initial_rotation ?? null;
    if (!motion && free === null) return null;
    const points = dotsOf(section.querySelector("[data-testid=chart-rotation]") ?? section);
    return { body, motion: free === null ? motion : undefined, restitution, response, settings, points };
  };
  /** @type {Asked<Server.ResponseAnswered>} */
  const request = createAnswer(app, "response", KEYS, question);
  const time = createTime((instant) => player.glance(instant), request.look);
  const player = new Player(time.show);
  const inputs = signal(app.inputs.get());
  const stale = signal(false);
  const faulty = faultsOf(app, "body", "motion");
  app.inputs.subscribe((now) => (inputs.value = now));
  render(html`<${Response} app=${app} request=${request} inputs=${inputs} player=${player} time=${time} stale=${stale} faulty=${faulty} />`, section);
  // figures show the last valid inputs while a field is in error
  const look = () => (stale.value = section.querySelector(".response-controls [aria-invalid=true]") !== null);
  for (const kind of ["input", "change"]) section.addEventListener(kind, look);
  section.addEventListener("keydown", (event) => onKey(event, player));
  return {
    shown: () => {
      app.faults.refresh();
      request.shown();
    },
    hidden: () => {
      request.hidden();
      player.pause();
    },
  };
};

/** @param {any} event @param {Player} player */
const onKey = (event, player) => {
  if (event.key !== " " || event.ctrlKey || event.altKey || event.metaKey) return;
  if (event.target.closest("button, select, summary, a, input:not([type=range]), textarea")) return;
  event.preventDefault();
  player.toggle();
};

/** @type {any[]} */
const NONE = [];
/** @param {{ outcome?: string }} answer */
const falls = ({ outcome }) => outcome === "overturned";
const FALL = "The animation shows the fall until a corner touches the ground. Motion after this contact is not computed.";

/** @param {{ app: App, request: Asked<Server.ResponseAnswered>, inputs: Signal<Server.Inputs>, player: Player, time: Time, stale: Signal<boolean>, faulty: Signal<string> }} props */
const Response = ({ app, request, inputs, player, time, stale: wrongHere, faulty }) => {
  const { answer, refused, closeup } = request;
  const results = useRef(null);
  const answers = answer.value?.answers ?? NONE;
  const there = useMemo(() => answers.filter((answer) => answer.series), [answers]);
  const lead = chosenOf(there.map(({ label }) => label));
  const followed = there.find(({ label }) => label === lead);
  const ticked = useMemo(() => (followed ? [followed] : NONE), [followed]);
  const { motion, restitution, response } = inputs.value;
  const friction = response?.assumed_friction ?? 0.5;
  const stale = wrongHere.value || faulty.value !== "";
  const old = stale ? "stale" : "";
  useLayoutEffect(() => {
    if (answer.value) results.current.dataset.drawn = String(Number(results.current.dataset.drawn || 0) + 1);
  }, [answer.value]);
  return html`
    <header class="view-head"><h1>Response</h1>
      <p class="lead">Response of one body to one motion, with several restitution models.</p></header>
    <div aria-live="polite" data-testid="response-refusal">
      ${refused.value && html`<${Note} kind="error" text=${refused.value.message} />`}
      ${answer.value && faulty.value && html`<${Note} kind="error" text=${`${faulty.value} ${t(OLDER)}`} />`}
      ${!motion && response?.initial_rotation == null && html`<${NothingMoves} app=${app} />`}</div>
    ${answer.value && html`<div class=${`verdict-part ${old}`}>
      <${Banner} kind=${answer.value.verdict.decides ? "differs" : verdictKind(there)} sentences=${[answer.value.verdict.sentence, ...answer.value.verdict.doubts, answer.value.verdict.headline].map((line) => inWords(line, answers))} />
      <${Cards} answers=${answers} lead=${lead} /></div>`}
    <div class="response" ...${answer.value && aboutOf(answer.value.body, answer.value.motion, there.length === 1 ? [wordsOf(there[0].label)] : [])}>
      <div class="response-stage">
        <section class="card stage-scene" aria-label="The body on the ground"><h2>The body on the ground</h2>
          <${Scene} player=${player} body=${answer.value?.body} answers=${there} lead=${lead} stale=${stale} /></section>
        ${followed && html`<section class=${`card stage-figures ${old}`} aria-label="Over time"><h2>Over time</h2>
          <div data-window=${closeup.value?.window.join(" ") ?? ""}>
            <div class="figures" data-testid="response-charts">
              <${Figures} kinds=${FIGURES} answers=${there} lead=${lead} ticked=${ticked} closeup=${closeup.value} friction=${friction} time=${time} /></div>
            <p class="field-help">${marksWords(there, wordsOf(lead))} ${there.some(falls) && t(FALL)}</p>
            ${closeup.value && html`<${Button} onClick=${() => request.look(null)}>Show the full duration<//>`}
          </div></section>`}
      </div>
      <${Controls} app=${app} inputs=${inputs.value} />
      <div ref=${results} class=${`response-results ${old}`} hidden=${!followed}>
        ${followed && html`<${Impacts} app=${app} answers=${there} answer=${followed} /><${TakeAway} app=${app} restitution=${restitution} />`}</div>
    </div>`;
};

/** @param {{ app: App }} props */
const NothingMoves = ({ app }) => html`
  <${Note} text="No motion is selected. Choose a motion, or start from an initial rotation." />
  <div class="toolbar"><${Button} kind="primary" onClick=${() => app.go("motion")}>Choose a motion<//>
    <${Button} onClick=${() => lean(app)}>Start from an initial rotation<//></div>`;
