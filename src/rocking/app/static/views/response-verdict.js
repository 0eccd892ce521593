/** The verdict in words, and a card for every model. */
import { el, fill } from "/app/dom.js";
import { number, quantity } from "/app/format.js";
import { chosenOf, look } from "/views/response-chosen.js";
import { curveKey, swatch, wordsOf } from "/views/response-labels.js";
import { outcomeOf, verdictKind } from "/views/response-words.js";

const SIGNS = { differs: "\u21c4", falls: "\u25b2", rocks: "\u2713", calm: "\u25a0", unknown: "?" };

/** Returns banner and cards; choosing a card makes its model the one that is looked at. */
export const verdictOf = () => {
  const banner = el("div", { class: "verdict", role: "status", "data-testid": "verdict" });
  const cards = el("fieldset", { class: "outcomes", "data-testid": "outcomes" });
  const element = el("div", { class: "verdict-part" }, banner, cards);
  const show = ({ answers, verdict }) => {
    const found = answers.filter((one) => !one.error);
    const kind = verdict.decides ? "differs" : verdictKind(found);
    banner.className = `verdict verdict-${kind}`;
    banner.dataset.kind = kind;
    const sign = el("span", { class: "verdict-sign", "aria-hidden": "true" }, SIGNS[kind]);
    fill(banner, sign, el("p", {}, inWords(verdict.sentence, answers)));
    const chosen = curveKey(chosenOf(found.map(({ label }) => label)));
    const focused = cards.contains(document.activeElement);
    const legend = el("legend", { class: "visually-hidden" }, "Model that is drawn solid in the animation");
    const cardOf = (one) => (one.error ? refusedCard(one) : outcomeCard(one, chosen, look));
    fill(cards, legend, answers.map(cardOf));
    if (focused) cards.querySelector("input:checked")?.focus();
  };
  const mark = () => {
    const inputs = [...cards.querySelectorAll("input")];
    const chosen = chosenOf(inputs.map(({ value }) => value));
    for (const input of inputs) input.checked = input.value === chosen;
  };
  return { element, show, mark };
};

/** A sentence of the server with the models by their titles; numbers stay as they are. */
const inWords = (sentence, answers) =>
  answers.map(({ label }) => label)
    .filter((label) => curveKey(label) === label)
    .sort((a, b) => b.length - a.length)
    .reduce((text, label) => text.replaceAll(wordOf(label), wordsOf(label)), sentence);

const wordOf = (label) => new RegExp(`(?<![\\w-])${escaped(label)}(?![\\w-])`, "g");

const escaped = (text) => text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");

const headOf = (label) => el("span", { class: "outcome-model" }, swatch(label), wordsOf(label));

const outcomeCard = (answer, chosen, onChoose) => {
  const { kind, sign, word } = outcomeOf(answer);
  const { label } = answer;
  const checked = curveKey(label) === chosen;
  const input = el("input", { type: "radio", name: "followed", value: label, checked });
  input.addEventListener("change", () => onChoose(answer.label));
  return el(
    "label",
    { class: `outcome outcome-${kind}`, "data-testid": `outcome-${label}`, "data-outcome": answer.outcome },
    input,
    headOf(answer.label),
    el("span", { class: "outcome-word" }, signOf(sign), word),
    el("span", { class: "outcome-facts" }, factsOf(answer)),
    ...(answer.warnings || []).map((words) => el("span", { class: "outcome-warning" }, words)),
  );
};

const factsOf = (answer) => {
  const { right, left } = answer.body.sides;
  const same = Math.abs(right.coefficient - left.coefficient) < 1e-12;
  const [onto, other] = [number(right.coefficient, 4), number(left.coefficient, 4)];
  const r = same ? onto : `${other} left, ${onto} right`;
  const peak = answer.outcome === "overturned"
    ? `no return at ${quantity(answer.overturning_time_s, "s", 4)}`
    : `peak ${quantity(answer.peak_rotation_over_alpha, "\u03b1", 3)}`;
  const count = (answer.impacts || []).length;
  return `r = ${r} \u00b7 ${peak} \u00b7 ${count} impact${count === 1 ? "" : "s"}`;
};

const signOf = (sign) => el("span", { class: "outcome-sign", "aria-hidden": "true" }, sign);

const refusedCard = ({ label, error }) => {
  const why = el("span", { class: "outcome-facts" }, error);
  return el("div", { class: "outcome outcome-unknown outcome-refused" }, headOf(label), why);
};
