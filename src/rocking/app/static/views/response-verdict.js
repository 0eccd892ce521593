/** The verdict in words, and a card for every model. */
import { el, fill } from "/app/dom.js";
import { number, quantity } from "/app/format.js";
import { curveKey, swatch, wordsOf } from "/views/response-labels.js";
import { outcomeOf, verdictKind } from "/views/response-words.js";

const SIGNS = { differs: "\u21c4", falls: "\u25b2", rocks: "\u2713", calm: "\u25a0", unknown: "?" };

/** Returns banner and cards; choosing a card calls back with its label. */
export const verdictOf = (onFollow) => {
  const banner = el("div", { class: "verdict", role: "status", "data-testid": "verdict" });
  const cards = el("fieldset", { class: "outcomes", "data-testid": "outcomes" });
  const element = el("div", { class: "verdict-part" }, banner, cards);
  let chosen = null;
  const show = ({ answers, verdict }) => {
    const found = answers.filter((one) => !one.error);
    const kind = verdict.decides ? "differs" : verdictKind(found);
    banner.className = `verdict verdict-${kind}`;
    banner.dataset.kind = kind;
    const sign = el("span", { class: "verdict-sign", "aria-hidden": "true" }, SIGNS[kind]);
    fill(banner, sign, el("p", {}, verdict.sentence));
    const keys = found.map(({ label }) => curveKey(label));
    if (!keys.includes(chosen)) chosen = keys[0] ?? null;
    const choose = (label) => {
      chosen = curveKey(label);
      onFollow(label);
    };
    const legend = el("legend", { class: "visually-hidden" }, "Model that is drawn solid in the animation");
    const cardOf = (one) => (one.error ? refusedCard(one) : outcomeCard(one, chosen, choose));
    fill(cards, legend, answers.map(cardOf));
  };
  return { element, show };
};

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
