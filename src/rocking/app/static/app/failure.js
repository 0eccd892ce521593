/** A start that failed: what went wrong in words, and the way to try again. */

import { button, note } from "/app/controls.js";
import { el, fill } from "/app/dom.js";

/** Say why the page could not start; what the address holds is kept for the next try. */
export const showFailure = (message) => {
  const words = `${message[0].toUpperCase()}${message.slice(1)}`.replace(/([^.?!])$/, "$1.");
  const again = button({ text: "Try again", kind: "primary", onClick: () => location.reload() });
  fill(document.getElementById("main"),
    el("div", { class: "card door", "data-testid": "failure" },
      el("h1", {}, "rocking could not start"),
      el("div", { class: "refusal", role: "alert" }, note(words, "error")),
      el("p", {}, "You need not sign in again, and your inputs are kept in this browser."),
      again));
  document.body.classList.add("at-the-door");
  again.focus();
};
