/** Outcome as text and as a sign independent of color. */
import { html } from "/parts/preact.js";
import { curveKey, wordsOf } from "/views/response-labels.js";
import { t } from "/app/words.js";

/** @type {{ [outcome: string]: { kind: string, sign: string, word: string } }} */
const OUTCOMES = {
  no_uplift: { kind: "calm", sign: "\u25a0", word: "stays at rest" },
  rocked: { kind: "rocks", sign: "\u2713", word: "rocks, does not overturn" },
  overturned: { kind: "falls", sign: "\u25b2", word: "overturns" },
  failed: { kind: "unknown", sign: "?", word: "could not be computed" },
};
/** @type {Words} */
const SIGNS = { differs: "\u21c4", falls: "\u25b2", rocks: "\u2713", calm: "\u25a0", unknown: "?" };

/** Display of an outcome: kind (a class), sign and word. @param {{ outcome?: string }} answer */
export const outcomeOf = (answer) => OUTCOMES[answer.outcome ?? "failed"] || OUTCOMES.failed;

/** Kind of an outcome over several models: the common one, or "differs".
 * @param {{ outcome?: string }[]} answers */
export const verdictKind = (answers) => {
  const kinds = new Set(answers.map((answer) => outcomeOf(answer).kind));
  return kinds.size > 1 ? "differs" : [...kinds][0] || "unknown";
};

/** The verdict over several models: a sign, and sentences.
 * @param {{ kind: string, sentences: string[], testid?: string }} props */
export const Banner = ({ kind, sentences, testid = "verdict" }) => html`
  <div class=${`verdict verdict-${kind}`} role="status" data-testid=${testid} data-kind=${kind}>
    <span class="verdict-sign" aria-hidden="true">${SIGNS[kind]}</span>
    <div>${sentences.map((line) => html`<p key=${line}>${line}</p>`)}</div>
  </div>`;

/** A sentence of the server with the models by their titles; numbers stay as they are.
 * @param {string} sentence @param {{ label: string }[]} answers */
export const inWords = (sentence, answers) =>
  answers.map(({ label }) => label)
    .filter((label) => curveKey(label) === label)
    .sort((a, b) => b.length - a.length)
    .reduce((text, label) => text.replaceAll(wordOf(label), wordsOf(label)), t(sentence));

/** @param {string} label */
const wordOf = (label) => new RegExp(`(?<![\\w-])${label.replace(/[.*+?^${}()|[\]\\]/g, "\\$&")}(?![\\w-])`, "g");

/** Sentence for screen readers in place of the animation. @param {Server.ResponseFacts[]} answers */
export const sceneWords = (answers) => {
  const lines = answers.map((answer) => `${t(wordsOf(answer.label))}: ${t(answer.summary || outcomeOf(answer).word)}`);
  return t("Rocking body on the moving ground. {outcomes}.", { outcomes: lines.join("; ") });
};
