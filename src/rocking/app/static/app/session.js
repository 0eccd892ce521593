/** Signing in: a one-time link from the terminal becomes a cookie that no script can read. */

import { call } from "/app/api.js";
import { button, note } from "/app/controls.js";
import { el, fill } from "/app/dom.js";
import { textField } from "/app/fields.js";

let door = null;

/** Exchange the token of a link for the cookie; says why not if it did not work. */
export const exchange = async (token) => {
  try {
    await call("session", { json: { token } });
    return "";
  } catch (error) {
    return error.message;
  }
};

/** A page that says how to get in, before the application; what the address holds is kept for after. */
export const showDoor = (message) => {
  if (door) return door.tell(message);
  const running = document.body.dataset.started === "true";
  const form = doorForm(message, running);
  if (running) return openOver(form);
  fill(document.getElementById("main"), form.element);
  document.body.classList.add("at-the-door");
  door = { tell: form.tell };
  document.addEventListener("rocking:signed-in", () => location.reload(), { once: true });
};

// Over the running application: nothing that was typed or drawn is lost.
const openOver = (form) => {
  const dialog = el("dialog", { class: "over", "aria-label": "Sign in again", oncancel: stay }, form.element);
  const look = async () => {
    if (document.hidden) return;
    const { signed_in: inside } = await call("session").catch(() => ({}));
    if (inside) document.dispatchEvent(new CustomEvent("rocking:signed-in"));
  };
  document.body.append(dialog);
  dialog.showModal();
  addEventListener("focus", look);
  door = { tell: form.tell };
  document.addEventListener("rocking:signed-in", () => {
    removeEventListener("focus", look);
    dialog.close();
    dialog.remove();
    door = null;
  }, { once: true });
};

const stay = (event) => event.preventDefault();

const doorForm = (message, running) => {
  const said = el("div", { class: "refusal", role: "alert" });
  const tell = (words) => fill(said, words ? note(words, "warning") : null);
  const link = textField(
    { label: "Link or token", help: "The line that begins with http:// in the terminal." }
  );
  const enter = async (event) => {
    event.preventDefault();
    const token = link.value.trim().split("token=").at(-1).split("&")[0];
    if (!token) return link.setError("Paste the link first.");
    const refusal = await exchange(token);
    if (refusal) return tell(refusal);
    document.dispatchEvent(new CustomEvent("rocking:signed-in"));
  };
  tell(message);
  const element = el("form", { class: "card door", onsubmit: enter, "data-testid": "door" },
    el("h1", {}, running ? "Sign in again" : "Open the link from the terminal"),
    running ? el("p", {}, "The server no longer knows this browser; it was probably started again. ",
      "Your inputs are still here.") : null,
    el("p", {}, "`rocking serve` prints a link that works once, so that only you can use this server. ",
      "Open that link, or paste it here. If it has been used, press \u201cLink for another browser\u201d ",
      "at the foot of the page in a browser that is signed in, or start the server again."),
    said, link, button({ text: "Sign in", kind: "primary", onClick: enter }));
  return { element, tell };
};

/** Show a new one-time link for another browser, on the clipboard where that is allowed. */
export const linkForAnother = async (app) => {
  const { url } = await app.call("session/link", { method: "POST" });
  const box = textField({ label: "Link that signs one more browser in", value: url,
    help: "It works once, within 15 minutes. Whoever has it can use this server." });
  box.input.readOnly = true;
  const copy = () => navigator.clipboard.writeText(url)
    .then(() => app.say("The link is on the clipboard."), () => box.input.select());
  const dialog = el("dialog", {
    class: "over", "aria-label": "Link for another browser", onclose: () => dialog.remove(),
  },
    el("div", { class: "card door", "data-testid": "another" }, el("h1", {}, "Link for another browser"), box,
      el("div", { class: "toolbar" }, button({ text: "Copy link", kind: "primary", onClick: copy }),
        button({ text: "Close", onClick: () => dialog.close() }))));
  document.body.append(dialog);
  dialog.showModal();
  box.input.select();
};
