/** Inputs from elsewhere stand in place of the user's own, which are kept beside them and brought back by a button. */

import { button, note } from "/app/controls.js";
import { el, fill } from "/app/dom.js";

/** Keep a line over the views up to date that says whose inputs are on the screen, and changes them over. */
export const mountLent = (views, inputs) => {
  const line = el("div", { class: "lent", role: "status", "data-testid": "lent" });
  const look = () => {
    const aside = inputs.aside();
    line.hidden = !aside;
    if (!aside) return fill(line);
    const { words, mine } = aside;
    const told = mine
      ? `What you see is ${words}. Your own body, motion and restitution are kept.`
      : `Your own inputs are back; ${words} is kept beside them.`;
    return fill(line, note(told, mine ? "info" : "good"), el("div", { class: "toolbar" },
      button({ text: mine ? "Back to my inputs" : "Show it again", kind: "primary", onClick: inputs.swap }),
      button({ text: mine ? "Drop mine, keep these" : "Drop it", kind: "quiet", onClick: inputs.forget })));
  };
  views.prepend(line);
  inputs.subscribe(look);
  look();
};
