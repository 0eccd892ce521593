/** Inventory: a list of objects, as a museum keeps it, and which of them stay standing. */

import { html, render } from "/parts/preact.js";
import { number } from "/app/format.js";
import { createQuestions } from "/questions/asking.js";
import { Choice, Field, FileDrop, QuestionView, Rows, useSignal } from "/questions/parts.js";

const LIGHTS = { red: "bad", amber: "fair", green: "good" };

/** Build the view inside its section. */
export const mount = (section, app) => {
  const questions = createQuestions(app, "inventory");
  render(html`<${Inventory} app=${app} questions=${questions} />`, section);
  return { shown: () => questions.look() };
};

const Inventory = ({ app, questions }) => {
  const files = useSignal([]);
  const [kind, level, family, count] = ["pga", "0.3", "firm-ground", "200"].map(useSignal);
  const wrong = useSignal("");
  const ask = (event) => {
    event.preventDefault();
    const strength = Number(level.value.replace(",", "."));
    const many = Number(count.value);
    wrong.value = !files.value.length ? "No list was sent yet."
      : !(strength > 0) ? "How strong is the shaking? A number above 0 is needed."
        : !(Number.isInteger(many) && many > 0) ? "The number of motions is a whole number above 0." : "";
    if (wrong.value) return;
    const [list] = files.value;
    const tables = {
      campaign: { name: list.name, kind: "inventory" },
      inventory: { objects: list.name, [kind.value]: kind.value === "pga" ? `${strength}g` : `${strength}cm/s` },
      motions: [{ synthetic: family.value, count: many, seed: 1 }],
    };
    questions.ask(tables, { [list.name]: list.sha }, `Which objects stand? ${list.name}`);
  };
  return html`
    <${QuestionView} questions=${questions} wrong=${wrong.value} onSubmit=${ask} answer=${Ranking}
      title="Which objects stay standing?"
      lead="A list of objects with their sizes, as it is kept; every row is assessed, or the reason is said.">
      <${FileDrop} label="Drop a list here, or" accept=".csv,.xlsx,.ods,.txt,.tsv" files=${files} questions=${questions} app=${app}
        help="Columns such as name, width_cm, depth_cm, height_cm; count, base, weight and notes if there are." />
      <${Choice} label="How strong it is said by" value=${kind}
        options=${[["pga", "peak acceleration [g]"], ["pgv", "peak velocity [cm/s]"]]} />
      <${Field} label="Strength" unit=${kind.value === "pga" ? "g" : "cm/s"} value=${level} inputmode="decimal" />
      <${Choice} label="Motions" value=${family} options=${[
        ["firm-ground", "firm ground"], ["soft-ground", "soft ground"], ["point-source", "point source"],
        ["pulse-like", "near a fault, pulse-like"]]} />
      <${Field} label="How many motions" value=${count} inputmode="numeric" help="More are surer: 200 tell 5 % from 10 %." />
    <//>`;
};

const Ranking = ({ answer }) => {
  const counts = ["red", "amber", "green"].map((light) => `${answer.counts[light]} ${light}`).join(", ");
  const missing = answer.not_assessed.length;
  const rows = answer.objects.map((each) => [
    `${each.name}${each.count > 1 ? ` (${each.count})` : ""}`, [each.light.toUpperCase(), LIGHTS[each.light]],
    each.overturned_interval.map((end) => number(100 * end, 2)).join(" to "), each.in_words, each.what_to_do,
  ]);
  return html`
    <p class="verdict" data-testid="verdict">${counts}${missing ? `, ${missing} not assessed` : ""}, at ${answer.hazard.level}.</p>
    ${rows.length > 0 && html`<${Rows} caption="Objects, the worst first"
      head=${["object", "light", "overturns [%]", "what it does", "what to do"]} rows=${rows} />`}
    ${missing > 0 && html`<h3>Not assessed</h3><${Rows} caption="Rows without a verdict" head=${["object", "line", "why"]}
      rows=${answer.not_assessed.map((each) => [each.name || "no name", String(each.row), each.reason])} />`}
    ${answer.columns_not_read.length > 0 && html`<p class="field-help">Columns that were not read:
      ${answer.columns_not_read.join(", ")}</p>`}`;
};
