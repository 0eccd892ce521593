/** Signing in: a one-time link from the terminal becomes a cookie that no script can read. */

import { call } from "/app/api.js";
import { button, note } from "/app/controls.js";
import { el, fill } from "/app/dom.js";
import { textField } from "/app/fields.js";

/** Exchange the token of a link for the cookie; says why not if it did not work. */
export const exchange = async (token) => {
  try {
    await call("session", { json: { token } });
    return "";
  } catch (error) {
    return error.message;
  }
};

/** A page that says how to get in, in place of the application. */
export const showDoor = (message) => {
  const link = textField(
    { label: "Link or token", help: "The line that begins with http:// in the terminal." }
  );
  const enter = (event) => {
    event.preventDefault();
    const token = link.value.trim().split("token=").at(-1);
    if (!token) return link.setError("Paste the link first.");
    location.hash = `token=${encodeURIComponent(token)}`;
    location.reload();
  };
  const form = el("form", { class: "card door", onsubmit: enter, "data-testid": "door" },
    el("h1", {}, "Open the link from the terminal"),
    el("p", {}, "`rocking serve` prints a link that works once, so that only you can use this server. ",
      "Open that link, or paste it here. If it has been used, start the server again or ask a signed-in ",
      "browser for a new one."),
    message ? note(message, "warning") : null,
    link,
    button({ text: "Sign in", kind: "primary", onClick: enter }));
  fill(document.getElementById("main"), form);
  document.body.classList.add("at-the-door");
};
