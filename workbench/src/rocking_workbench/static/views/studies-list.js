/** List of the studies with progress and actions. */
import { html, useLayoutEffect, useRef } from "/parts/preact.js";
import { fixed, number } from "/app/format.js";
import { t, userText } from "/app/words.js";

/** @type {Words} */
const WORDS = {
  waiting: "queued",
  running: "running",
  cancelled: "cancelled; finished simulations are kept",
  interrupted: "interrupted; finished simulations are kept",
  failed: "failed",
  done: "finished",
};
/** @type {Words} */
const KINDS = {
  "overturning-map": "overturning map",
  "rocking-spectrum": "rocking spectra",
  stripes: "fragility, multiple stripes",
  incremental: "fragility, incremental",
  cloud: "fragility, cloud",
  histories: "histories",
  "minimum-acceleration": "minimum overturning acceleration",
  inventory: "inventory",
};
const BUSY = ["waiting", "running"];

/** A duration in seconds as text with a suitable unit. @param {number} seconds */
const duration = (seconds) => {
  if (seconds < 1.5) return t("1 s");
  if (seconds < 90) return `${Math.round(seconds)} s`;
  if (seconds < 5400) return `${Math.round(seconds / 60)} min`;
  return `${fixed(seconds / 3600, 1)} h`;
};

/** @param {Server.StudyFacts} study */
const left = (study) => {
  if (study.seconds_left == null) return t("estimating the remaining time");
  const [low, high] = (study.seconds_left_between ?? []).map(duration);
  const time = duration(study.seconds_left);
  return low === high ? t("about {time} remaining", { time }) : t("about {time} remaining ({low} to {high})", { time, low, high });
};

/** @param {Server.StudyFacts} study */
const pace = (study) => {
  const parts = [t("{done} of {count} simulations", { done: number(study.histories_done || 0), count: number(study.histories || 0) })];
  if (study.state === "running" && study.rate) parts.push(t("{count} per second", { count: number(study.rate, 3) }));
  if (study.state === "running") parts.push(left(study));
  return parts.join(" \u00b7 ");
};

/** Text of the state of a study. @param {{ state: string }} study */
export const stateWords = ({ state }) => WORDS[state] || state;

/** Actions of a study; `after` is called after each. @param {App} app @param {() => unknown} after */
export const actsOf = (app, after) => {
  /** @param {Server.StudyFacts} study @param {string} action @param {CallOptions} options */
  const act = (study, action, options) =>
    app.call(`studies/${study.id}${action}`, options).then(after, (error) => app.say(error.message, "error"));
  return {
    /** @param {Server.StudyFacts} study */
    cancel: (study) => act(study, "/cancel", { json: {} }),
    /** @param {Server.StudyFacts} study */
    resume: (study) => act(study, "/resume", { json: {} }),
    /** @param {Server.StudyFacts} study */
    remove: (study) => window.confirm(t("Delete \u201c{name}\u201d and its results?", { name: userText(study.name) }))
      && act(study, "", { method: "DELETE" }),
  };
};

/** Table of the studies, one row per study.
 * @param {{ studies: Server.StudyFacts[], onShow: (study: Server.StudyFacts) => unknown, acts: ReturnType<typeof actsOf> }} props */
export const StudyList = ({ studies, onShow, acts }) => html`
  <div>
    <p class="quiet" hidden=${studies.length > 0}>No studies yet. A study runs many simulations with the body and the motion of this project.</p>
    <ul class="study-list" data-testid="study-list">${studies.map((study) => html`
      <${Study} key=${study.id} study=${study} onShow=${onShow} acts=${acts} />`)}</ul>
  </div>`;

/** @param {{ study: Server.StudyFacts, onShow: (study: Server.StudyFacts) => unknown, acts: ReturnType<typeof actsOf> }} props */
const Study = ({ study, onShow, acts }) => {
  const { state, name } = study;
  const row = useRef(null);
  /** @type {[string, (study: Server.StudyFacts) => unknown, boolean, string?][]} */
  const buttons = [
    ["Show result", onShow, state === "done", "primary"],
    ["Cancel", acts.cancel, BUSY.includes(state)],
    ["Resume", acts.resume, ["cancelled", "interrupted", "failed"].includes(state)],
    ["Delete", acts.remove, !BUSY.includes(state)],
  ];
  // a pressed button may disappear; then another button of the row receives the focus
  const focused = /** @type {HTMLElement | null} */ (document.activeElement);
  useLayoutEffect(() => {
    if (focused?.hidden && row.current.contains(focused)) row.current.querySelector("button:not([hidden])")?.focus();
  }, [state]);
  return html`
    <li ref=${row} class="study" data-testid=${`study-${study.id}`} data-state=${state}>
      <div class="study-head"><strong translate=${false}>${name}</strong><span class="quiet">${KINDS[study.kind] || study.kind}</span></div>
      <progress max="1" value=${study.histories ? (study.histories_done || 0) / study.histories : 0} hidden=${state === "done"}
        aria-label=${t("Progress of {name}", { name: userText(name) })}></progress>
      <div class="study-line">
        <span class="study-state">${(state === "failed" && study.message) || stateWords(study)}</span>
        <span class="study-facts">${pace(study)}</span>
      </div>
      <div class="toolbar">${buttons.map(([text, does, there, kind = "plain"]) => html`
        <button type="button" key=${text} class=${`button ${kind}`} aria-label=${`${t(text)}: ${name}`} hidden=${!there}
          onClick=${() => does(study)}>${text}</button>`)}</div>
    </li>`;
};
