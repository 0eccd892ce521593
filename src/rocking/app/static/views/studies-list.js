/** The studies there are: how far each is, and what can be done with it. */
import { el } from "/app/dom.js";
import { button } from "/app/fields.js";
import { number } from "/app/format.js";

const WORDS = {
  waiting: "waiting for its turn",
  running: "running",
  cancelled: "cancelled; what is finished is kept",
  interrupted: "interrupted; what is finished is kept",
  failed: "failed",
  done: "finished",
};
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

/** Seconds in words that a person would use. */
export function duration(seconds) {
  if (seconds < 1.5) return "a second";
  if (seconds < 90) return `${Math.round(seconds)} s`;
  if (seconds < 5400) return `${Math.round(seconds / 60)} min`;
  return `${(seconds / 3600).toFixed(1)} h`;
}

const left = (study) => {
  if (study.seconds_left == null) return "measuring the time left";
  const [low, high] = study.seconds_left_between.map(duration);
  const between = low === high ? "" : ` (${low} to ${high})`;
  return `about ${duration(study.seconds_left)} left${between}`;
};

const pace = (study) => {
  const parts = [`${number(study.histories_done || 0)} of ${number(study.histories || 0)} histories`];
  if (study.state === "running" && study.rate) parts.push(`${number(study.rate, 3)} a second`);
  if (study.state === "running") parts.push(left(study));
  return parts.join(" \u00b7 ");
};

const named = (text, study, more) => button({ text, label: `${text}: ${study.name}`, ...more });

/** List of cards; `update` takes the studies, `expect` opens one as soon as it is done. */
export function studyList(app, { onShow, onGone }) {
  const empty = el(
    "p",
    { class: "quiet" },
    "None yet. A study is many histories of the body and motion of the other steps.",
  );
  const node = el("ul", { class: "study-list", "data-testid": "study-list" });
  const rows = new Map();
  let expected = null;
  let names = new Set();

  // a button that was pressed may vanish: the one that took its place has the focus then
  const refocus = (part) => Object.values(part.buttons).find((each) => !each.hidden)?.focus();
  const act =
    (study, what, method = "POST") =>
    async () => {
      try {
        await app.call(`/api/studies/${study.id}${what}`, {
          method,
          json: method === "POST" ? {} : undefined,
        });
      } catch (error) {
        app.say(error.message, "error");
      }
    };
  const remove = (study) => async () => {
    if (!window.confirm(`Delete \u201c${study.name}\u201d and its results?`)) return;
    await act(study, "", "DELETE")();
    onGone(study.id);
  };

  const make = (study) => {
    const bar = el("progress", { max: 1, value: 0, "aria-label": `Progress of ${study.name}` });
    const state = el("span", { class: "study-state" });
    const facts = el("span", { class: "study-facts" });
    const tools = el("div", { class: "toolbar" });
    const row = el(
      "li",
      { class: "study", "data-testid": `study-${study.id}` },
      el(
        "div",
        { class: "study-head" },
        el("strong", { translate: "no" }, study.name),
        el("span", { class: "quiet" }, KINDS[study.kind] || study.kind),
      ),
      bar,
      el("div", { class: "study-line" }, state, facts),
      tools,
    );
    const buttons = {
      show: named("Show result", study, { kind: "primary", onClick: () => onShow(study) }),
      cancel: named("Cancel", study, { onClick: act(study, "/cancel") }),
      resume: named("Resume", study, { onClick: act(study, "/resume") }),
      remove: named("Delete", study, { onClick: remove(study) }),
    };
    tools.append(...Object.values(buttons));
    return { row, bar, state, facts, buttons, known: "" };
  };

  const draw = (part, study) => {
    const focused = part.row.contains(document.activeElement) ? document.activeElement : null;
    part.row.dataset.state = study.state;
    part.bar.value = study.histories ? (study.histories_done || 0) / study.histories : 0;
    part.bar.hidden = study.state === "done";
    part.state.textContent =
      study.message && study.state === "failed" ? study.message : WORDS[study.state] || study.state;
    part.facts.textContent = pace(study);
    part.buttons.show.hidden = study.state !== "done";
    part.buttons.cancel.hidden = !["waiting", "running"].includes(study.state);
    part.buttons.resume.hidden = !["cancelled", "interrupted", "failed"].includes(study.state);
    part.buttons.remove.hidden = ["waiting", "running"].includes(study.state);
    if (focused?.hidden) refocus(part);
    if (part.known && part.known !== study.state)
      app.say(`${study.name}: ${WORDS[study.state] || study.state}`);
    part.known = study.state;
  };

  const update = (studies) => {
    const there = new Set(studies.map((study) => study.id));
    names = new Set(studies.map((study) => study.name));
    for (const [id, part] of rows) if (!there.has(id)) (part.row.remove(), rows.delete(id), onGone(id));
    for (const study of studies) {
      if (!rows.has(study.id)) rows.set(study.id, make(study));
      draw(rows.get(study.id), study);
      if (study.id === expected && study.state === "done") {
        expected = null;
        onShow(study);
      }
    }
    const order = studies.map((study) => rows.get(study.id).row);
    if (order.some((row, k) => node.children[k] !== row)) node.replaceChildren(...order);
    empty.hidden = studies.length > 0;
  };
  return {
    node: el("div", {}, empty, node),
    update,
    expect: (id) => (expected = id),
    names: () => names,
  };
}
