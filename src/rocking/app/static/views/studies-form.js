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

/** Form with one question at a time; calls onLaunched(id). */
export function studyForm(app, { onLaunched }) {
    const name = el("input", { type: "text", id: "study-name", maxlength: 100, autocomplete: "off" });
    const place = el("div", { class: "study-question" });
    const problem = el("p", { class: "error-text", role: "alert", id: "study-problem" });
    let kind = "overturning-map";
    let question = null;

    const choose = (chosen) => {
        kind = chosen;
        question = QUESTIONS[kind](app);
        place.replaceChildren(question.node);
        problem.textContent = "";
    };

    const launch = async () => {
        problem.textContent = "";
        const inputs = app.inputs.get();
        try {
            const tables = await question.tables(inputs);
            const job = {
                campaign: { name: name.value.trim() || question.name(inputs), kind: tables.kind },
                restitution: restitutionOf(inputs),
                ...tables.job,
            };
            if (inputs.settings && Object.keys(inputs.settings).length) job.settings = inputs.settings;
            const answer = await app.call("/api/studies", { json: { name: job.campaign.name, job } });
            onLaunched(answer.id);
        } catch (error) {
            problem.textContent = error.message;
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
