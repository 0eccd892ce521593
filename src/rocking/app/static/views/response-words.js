/** What came out, in words and with a sign that needs no colour. */
import { wordsOf } from "/views/response-labels.js";

export const OUTCOMES = {
  no_uplift: { kind: "calm", sign: "\u25a0", word: "stays at rest" },
  rocked: { kind: "rocks", sign: "\u2713", word: "rocks and stays standing" },
  overturned: { kind: "falls", sign: "\u25b2", word: "overturns" },
  failed: { kind: "unknown", sign: "?", word: "could not be computed" },
};

/** Returns how an outcome is shown: kind (a class), sign and word. */
export const outcomeOf = (answer) => OUTCOMES[answer.outcome] || OUTCOMES.failed;

/** Returns the kind of a verdict over several models: what they agree on, or that they do not. */
export const verdictKind = (answers) => {
  const kinds = new Set(answers.map((answer) => outcomeOf(answer).kind));
  return kinds.size > 1 ? "differs" : [...kinds][0] || "unknown";
};

/** Returns the sentence for the screen reader that stands for the animation. */
export const sceneWords = (answers) => {
  const each = answers.map((answer) => `${wordsOf(answer.label)}: ${answer.summary || outcomeOf(answer).word}`);
  return `The body rocking on the moving ground. ${each.join("; ")}.`;
};
