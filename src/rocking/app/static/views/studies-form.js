/** What a new study computes: chosen here, about the body and the motion of the other steps. */
import { el } from "/app/dom.js";
import { button, segmented } from "/app/fields.js";
import { mapQuestion } from "/views/studies-form-map.js";
import { fragilityQuestion } from "/views/studies-form-fragility.js";
import { spectrumQuestion } from "/views/studies-form-spectrum.js";

const QUESTIONS = {
  "overturning-map": mapQuestion,
  fragility: fragilityQuestion,
  "rocking-spectrum": spectrumQuestion,
};

/** The restitution table of a job, from the one of the inputs. */
const restitutionOf = (inputs) => inputs.restitution || { model: "ked" };

const onScreen = (node) => node.offsetParent !== null;

/** A name that no study has yet. */
const fresh = (name, taken) => {
  let found = name;
  for (let k = 2; taken.has(found); k += 1) found = `${name} ${k}`;
  return found;
};

/** Form with one question at a time; calls onLaunched(id); `taken` says which names there are. */
export function studyForm(app, { onLaunched, taken }) {
  const name = el("input", { type: "text", id: "study-name", maxlength: 100, autocomplete: "off" });
  const place = el("div", { class: "study-question" });
  const problem = el("p", { class: "error-text", role: "alert", id: "study-problem" });
  let kind = "overturning-map";
  let question = null;

  const choose = (chosen) => {
    kind = chosen;
    question = QUESTIONS[kind](app);
    question.refresh?.();
    place.replaceChildren(question.node);
    problem.textContent = "";
  };

  /** A field in error holds its last good number, which is not the one on the screen. */
  const faultOf = () => {
    const wrong = [...node.querySelectorAll("[aria-invalid=true]")].find(onScreen);
    if (wrong) {
      wrong.focus();
      return "A number of this form is marked as wrong: correct it first.";
    }
    return app.faults?.any({ inputs: true }) ? app.faults.sentence({ inputs: true }) : "";
  };

  const launch = async () => {
    problem.textContent = faultOf();
    if (problem.textContent) return;
    const inputs = app.inputs.get();
    go.disabled = true;
    try {
      const tables = await question.tables(inputs);
      const called = fresh(name.value.trim() || question.name(inputs), taken());
      const job = {
        campaign: { name: called, kind: tables.kind },
        restitution: restitutionOf(inputs),
        ...tables.job,
      };
      if (inputs.settings && Object.keys(inputs.settings).length) job.settings = inputs.settings;
      const answer = await app.call("/api/studies", {
        json: { name: job.campaign.name, job, project: app.project.here.value.id },
      });
      name.value = "";
      onLaunched(answer.id);
    } catch (error) {
      problem.textContent = error.message;
    } finally {
      go.disabled = false;
    }
  };

  const go = button({ text: "Launch", kind: "primary", onClick: launch });
  go.dataset.testid = "study-launch";
  const kinds = segmented({
    label: "Kind",
    options: [
      { value: "overturning-map", text: "Overturning map" },
      { value: "fragility", text: "Fragility" },
      { value: "rocking-spectrum", text: "Rocking spectra" },
    ],
    value: kind,
    onChange: choose,
  });
  choose(kind);
  const label = el("label", { for: "study-name", class: "field-label" }, "Name");
  const node = el(
    "form",
    { class: "study-form", onsubmit: (event) => (event.preventDefault(), launch()) },
    kinds,
    place,
    el("div", { class: "field" }, label, name),
    problem,
    el("div", { class: "toolbar" }, go),
  );
  return { node, refresh: () => question.refresh && question.refresh() };
}
