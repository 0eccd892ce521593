/** Compare: outcome and effect of the restitution model, for all models. */

import { computed, html, render, signal, useEffect, useMemo, useSignal } from "/parts/preact.js";
import { Button, Note } from "/parts/fields.js";
import { highest, lowest } from "/app/extremes.js";
import { number } from "/app/format.js";
import { createTime } from "/charts/figure.js";
import { dotsOf } from "/charts/zoom.js";
import { createQuestions, motionOf } from "/questions/asking.js";
import { aboutOf } from "/views/about.js";
import { OLDER, createAnswer, faultsOf } from "/views/answer.js";
import { About } from "/views/compare-about.js";
import { Studies } from "/views/compare-studies.js";
import { Figures, marksWords } from "/views/response-figures.js";
import { Swatch, wordsOf } from "/views/response-labels.js";
import { complete } from "/views/response-controls.js";
import { readRestitution } from "/views/response-restitution.js";
import { Banner, inWords, outcomeOf, verdictKind } from "/views/response-words.js";
import { t, userText } from "/app/words.js";

/** Build the view inside its section. @param {HTMLElement} section @param {App} app */
export const mount = (section, app) => {
  const question = () => {
    const { body, motion, restitution, response, settings } = app.inputs.get();
    const free = response?.initial_rotation ?? null;
    if (!motion && free === null) return null;
    const own = readRestitution(restitution);
    const completeLabels = app.info.models.filter(complete).map(({ label }) => label);
    const typed = own.value === null ? {} : { values: [own.value] };
    return {
      body, motion: free === null ? motion : undefined, response, settings,
      restitution: { models: [...new Set([...completeLabels, ...own.models])], ...typed }, points: dotsOf(section),
    };
  };
  /** @type {Asked<Server.ResponseAnswered>} */
  const request = createAnswer(app, "compare", ["body", "motion", "restitution", "response", "settings"], question);
  const margins = createMargins(app);
  const time = createTime(undefined, request.look);
  const studies = { look: () => {} };
  render(html`<${Compare} app=${app} request=${request} margins=${margins} time=${time} studies=${studies} faulty=${faultsOf(app, "body", "motion")} />`, section);
  return {
    shown: () => {
      app.faults.refresh();
      request.shown();
      studies.look();
    },
    hidden: request.hidden,
  };
};

/** Smallest scale factors with overturning, by model, as in `rocking assess`; for the present inputs.
 * @param {App} app */
const createMargins = (app) => {
  const questions = createQuestions(app, "assess");
  /** @param {Server.Inputs} inputs */
  const keyOf = ({ body, motion, settings }) => JSON.stringify([body, motion, settings]);
  const [now, of] = [signal(keyOf(app.inputs.get())), signal("")];
  app.inputs.subscribe((inputs) => (now.value = keyOf(inputs)));
  const ended = signal(null);
  // The run is not listed on the page Assessment; its result is kept here and removed from the server.
  questions.shown.subscribe((shownQuestion) => {
    if (!shownQuestion || !["done", "refused", "stopped"].includes(shownQuestion.state)) return;
    ended.value = shownQuestion;
    questions.remove(shownQuestion.id);
  });
  const question = computed(() => (now.value === of.value ? questions.shown.value ?? ended.value : null));
  return {
    questions,
    question,
    answer: computed(() => question.value?.answer?.models ?? null),
    ask: () => {
      const inputs = app.inputs.get();
      const { tables, files } = /** @type {NonNullable<ReturnType<typeof motionOf>>} */ (motionOf(inputs));
      [of.value, ended.value] = [keyOf(inputs), null];
      const name = t("Margins of {name}", { name: userText(inputs.body.name || app.project.here.value.name) });
      return questions.ask({ body: inputs.body, ...tables, assess: {}, ...(inputs.settings && { settings: inputs.settings }) }, files, name, { project: "" });
    },
  };
};

/** @param {{ app: App, request: Asked<Server.ResponseAnswered>, margins: Margins, time: Time, studies: { look: () => unknown }, faulty: Signal<string> }} props */
const Compare = ({ app, request, margins, time, studies, faulty }) => {
  const hidden = useSignal(new Set());
  const opened = useSignal(null);
  const { answer, refused, closeup } = request;
  const answers = answer.value?.answers ?? [];
  const there = useMemo(() => answers.filter((answer) => "series" in answer), [answers]);
  const shown = useMemo(() => there.filter(({ label }) => !hidden.value.has(label)), [there, hidden.value]);
  const lead = shown.find(({ label }) => label === opened.value)?.label;
  /** @param {string} label */
  const toggle = (label) => {
    const next = new Set(hidden.value);
    if (!next.delete(label)) next.add(label);
    hidden.value = next;
  };
  const old = faulty.value ? "stale" : "";
  return html`
    <header class="view-head"><h1>Comparison of models</h1>
      <p class="lead">The same body and motion with every restitution model.</p></header>
    ${refused.value && html`<${Note} kind="error" role="alert" text=${refused.value.message} />`}
    ${answer.value && faulty.value && html`<${Note} kind="error" role="alert" text=${`${faulty.value} ${t(OLDER)}`} />`}
    ${!answer.value && !refused.value && html`<p class="note toolbar" data-testid="nothing-moves">No motion is selected, or the result is being computed.
      <${Button} onClick=${() => app.go("motion")}>Choose a motion<//></p>`}
    ${there.length > 0 && html`
      <div class=${`verdict-part ${old}`}>
        <${Banner} kind=${verdictKind(there)} sentences=${answer.value && sentencesOf(answer.value, there)} testid="compare-verdict" /></div>
      <div class=${`compare ${old}`} ...${answer.value && aboutOf(answer.value.body, answer.value.motion, shown.length === 1 ? [wordsOf(shown[0].label)] : [])}>
        <div class="compare-models">
          <section class="card" aria-labelledby="compare-models-title"><h2 id="compare-models-title">Models</h2>
            <${Models} answers=${answers} hidden=${hidden.value} opened=${opened} toggle=${toggle} margins=${margins} />
            <${Margins} app=${app} margins=${margins} /></section>
          ${opened.value && html`<${About} app=${app} label=${opened.value} onClose=${() => (opened.value = null)} />`}
        </div>
        <section class="card" aria-labelledby="compare-time-title"><h2 id="compare-time-title">Over time</h2>
          ${shown.length ? html`
            <div class="figures" data-testid="compare-figures">
              <${Figures} kinds=${["rotation", "velocity", "lost", "ground"]} answers=${shown} lead=${lead} ticked=${shown}
                closeup=${closeup.value} friction=${0.5} time=${time} /></div>
            <p class="field-help">${marksWords(shown, "each model in its colour")}</p>
            ${closeup.value && html`<${Button} onClick=${() => request.look(null)}>Show the full duration<//>`}`
          : html`<p class="field-help">No model is shown. Select a model.</p>`}
        </section>
      </div>`}
    <${Studies} app=${app} handle=${studies} />`;
};

const VERDICTS = {
  falls: {
    all: "{count} of {total} models: the body overturns. The choice of the model does not change the outcome.",
    but: "{count} of {total} models: the body overturns. It does not overturn with {models}. The result depends on the restitution model.",
  },
  stands: {
    all: "{count} of {total} models: the body does not overturn. The choice of the model does not change the outcome.",
    but: "{count} of {total} models: the body does not overturn. It overturns with {models}. The result depends on the restitution model.",
  },
};

/** Summary of the computed results: the outcome of most models first.
 * @param {Server.ResponseAnswered} responses @param {Server.ResponseFacts[]} there */
const sentencesOf = (responses, there) => {
  /** @param {Server.ResponseFacts} answer */
  const falls = ({ outcome }) => outcome === "overturned";
  const [fallen, standing] = [there.filter(falls), there.filter((answer) => !falls(answer))];
  const [most, fewer] = fallen.length > standing.length ? [fallen, standing] : [standing, fallen];
  const text = VERDICTS[most === fallen ? "falls" : "stands"][fewer.length ? "but" : "all"];
  const counted = { count: most.length, total: there.length, models: fewer.map(({ label }) => wordsOf(label)).join(", ") };
  const peaks = standing.map((answer) => answer.peak_ratio);
  const [low, high] = [lowest(peaks), highest(peaks)].map((peak) => number(peak, 3));
  const ends = low === high ? low : t("{low} to {high}", { low, high });
  const lean = highest(peaks, 0) > 0 ? [t("Peak rotation: {angle} of the slenderness angle.", { angle: ends })] : [];
  return [t(text, counted), ...lean, ...responses.verdict.doubts.map((doubt) => inWords(doubt, there))];
};

/** @type {Words} */
const SHORT = { no_uplift: "no uplift", rocked: "does not overturn", overturned: "overturns" };

/** @param {{ answers: Server.ResponseAnswered["answers"], hidden: Set<string>, opened: Signal<string | null>, toggle: (label: string) => unknown, margins: Margins }} props */
const Models = ({ answers, hidden, opened, toggle, margins }) => html`
  <div class="table-scroll" tabindex="0" role="region" aria-label="Table of the models">
    <table data-testid="compare-models">
      <thead><tr><th scope="col"><span class="visually-hidden">Shown</span></th>
        ${["Model", "Outcome", "Peak \u03b8/\u03b1", "Impacts", "r", "Margin"].map((label) => html`<th scope="col" key=${label}>${label}</th>`)}</tr></thead>
      <tbody>${answers.map((answer) => html`<${Model} key=${answer.label} answer=${answer} shown=${!hidden.has(answer.label)}
        opened=${opened} toggle=${toggle} margin=${marginOf(margins, answer.label)} />`)}</tbody>
    </table>
  </div>`;

/** @param {{ answer: any, shown: boolean, opened: Signal<string | null>, toggle: (label: string) => unknown, margin: string }} props */
const Model = ({ answer, shown, opened, toggle, margin }) => {
  const { label } = answer;
  const open = opened.value === label;
  const name = wordsOf(label);
  const { kind, sign, word } = outcomeOf(answer);
  return html`<tr data-testid=${`compare-${label}`} data-outcome=${answer.outcome} class=${open ? "chosen" : null}>
    <td>${answer.series && html`<label class="tick"><input type="checkbox" aria-label=${t("Show {name}", { name })} checked=${shown} onChange=${() => toggle(label)} /></label>`}</td>
    <th scope="row"><button type="button" class="button quiet model-open" aria-expanded=${open} onClick=${() => (opened.value = open ? null : label)}>
      <${Swatch} label=${label} />${name}</button></th>
    ${answer.error ? html`<td colspan="5" class="text">${answer.error}</td>` : html`
      <td class=${`outcome-${kind} text`}><span class="outcome-word"><span aria-hidden="true">${sign}</span>${SHORT[answer.outcome] ?? word}</span></td>
      <td class="number">${answer.outcome === "overturned" ? "\u2013" : number(answer.peak_ratio, 3)}</td>
      <td class="number">${answer.impacts.length}</td>
      <td class="number">${coefficients(answer.coefficient)}</td>
      <td class="number">${margin}</td>`}
  </tr>`;
};

/** @param {{ left: number, right: number }} coefficient */
const coefficients = ({ left, right }) => {
  const [a, b] = [left, right].map((value) => number(value, 4));
  return a === b ? b : `${a} | ${b}`;
};

/** @param {Margins} margins @param {string} label */
const marginOf = (margins, label) => {
  const margin = margins.answer.value;
  if (!margin) return "\u2013";
  const key = Object.keys(margin).find((name) => name === label || (name.split(":")[0] === label));
  if (!key) return "\u2013";
  return margin[key].min_factor === null ? "none found" : number(margin[key].min_factor, 3);
};

/** @param {{ app: App, margins: Margins }} props */
const Margins = ({ app, margins }) => {
  const { questions } = margins;
  useEffect(() => void questions.look(), []);
  const inputs = app.inputs.get();
  if (!inputs.motion || inputs.response?.initial_rotation != null) return null;
  const question = margins.question.value;
  const wrong = question?.state === "refused" ? question.message : "";
  return html`<div class="toolbar">
      ${question && questions.busy.value ? html`<progress aria-label="Computing the margins"></progress>`
        : html`<${Button} disabled=${Boolean(margins.answer.value)} onClick=${margins.ask}>Compute the margins<//>`}
    </div>
    ${wrong && html`<p class="field-help field-error">${wrong}</p>`}
    <p class="field-help">Margin: smallest scale factor of this motion that overturns the body, both polarities. Details: Assessment.</p>`;
};
