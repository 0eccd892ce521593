/** Studies: many histories at once, launched as campaigns; their progress, and their results. */
import { el } from "/app/dom.js";
import { card, switchField } from "/app/fields.js";
import { studyForm } from "/views/studies-form.js";
import { studyList } from "/views/studies-list.js";
import { liveStudies } from "/views/studies-live.js";
import { showMap } from "/views/studies-map.js";
import { showFragility } from "/views/studies-fragility.js";
import { showSpectrum } from "/views/studies-spectrum.js";
import { showCounts } from "/views/studies-counts.js";
import { exportsOf } from "/views/studies-exports.js";

const SHOW = {
  "overturning-map": showMap,
  "rocking-spectrum": showSpectrum,
  stripes: showFragility,
  incremental: showFragility,
  cloud: showFragility,
};

/** Build the view inside its section. */
export function mount(section, app) {
  const result = el("div", { class: "study-result", "data-testid": "study-result" });
  const heading = el("h2", { class: "study-result-title", tabindex: "-1" });
  const outcome = el("section", { class: "card study-outcome", hidden: true }, heading, result);
  let open = null;
  let undo = () => {};

  const close = () => {
    undo();
    undo = () => {};
    open = null;
    outcome.hidden = true;
    result.replaceChildren();
  };

  const show = async (study) => {
    close();
    open = study.id;
    outcome.hidden = false;
    heading.textContent = study.name;
    result.replaceChildren(el("p", { class: "quiet" }, "Reading the result \u2026"));
    try {
      const found = await app.call(`/api/studies/${study.id}/result`, { method: "GET" });
      if (open !== study.id) return;
      result.replaceChildren();
      const chosen = { restitution: 0 };
      undo = (SHOW[study.kind] || showCounts)(result, app, study, found, chosen) || undo;
      if (found.contact) result.prepend(el("p", { class: "note", "data-testid": "study-contact" }, found.contact));
      result.append(exportsOf(app, study, found, chosen));
      heading.focus();
    } catch (error) {
      result.replaceChildren(el("p", { class: "error-text" }, error.message));
    }
  };

  const list = studyList(app, {
    onShow: show,
    onGone: (id) => id === open && close(),
    isOpen: (id) => id === open,
  });
  let known = [];
  // What was launched elsewhere than in a project is everybody's.
  const mine = ({ project }) => all.value || !project || project === app.project.here.value.id;
  const look = (studies) => list.update((known = studies).filter(mine));
  const all = switchField({ label: "Studies of all projects", onChange: () => look(known) });
  const live = liveStudies(app, look);
  const form = studyForm(app, {
    taken: () => list.names(),
    onLaunched: (id) => {
      app.say("The study has been launched.");
      list.expect(id);
      live.refresh();
    },
  });
  const lead = "Many histories at once: maps, spectra and fragility. They go on while you do something else.";
  section.append(
    el("header", { class: "view-head" }, el("h1", {}, "Studies"), el("p", { class: "lead" }, lead)),
    el(
      "div",
      { class: "studies" },
      el("div", { class: "studies-left" }, card("New study", form.node), card("Studies", all, list.node)),
      outcome,
    ),
  );
  return { shown: () => (live.start(), form.refresh()), hidden: () => live.stop() };
}
