/** Sign-in: exchange the one-time link from the terminal for a cookie that scripts cannot read. */

import { html, render, signal, useLayoutEffect, useRef, useSignal } from "/parts/preact.js";
import { call } from "/app/api.js";
import { inPlaceOf } from "/app/failure.js";
import { Button, Field, Note, toWrong } from "/parts/fields.js";

const doorMessage = signal(null); // message of the sign-in page; null if there is none

/** Exchange the token of a link for the cookie; shows the error if this fails. @param {string} token */
export const exchange = async (token) => {
  try {
    await call("session", { json: { token } });
    return "";
  } catch (error) {
    return error.message;
  }
};

const signedIn = () => document.dispatchEvent(new CustomEvent("rocking:signed-in"));
/** @param {() => unknown} done */
const onSignedIn = (done) => document.addEventListener("rocking:signed-in", done, { once: true });

/** Sign-in page before the application; the fragment of the address is kept.
 * @param {string} message */
export const showDoor = (message) => {
  const open = doorMessage.value !== null;
  doorMessage.value = message || (doorMessage.value ?? "");
  if (open) return;
  if (document.body.dataset.started === "true") return openOver();
  inPlaceOf(document.getElementById("main"), html`<${Door} />`);
  document.body.classList.add("at-the-door");
  onSignedIn(() => location.reload());
};

// Sign-in over the running application: typed and drawn inputs are kept.
const openOver = () => {
  const close = over("Sign in again", html`<${Door} running />`, { stays: true });
  const look = async () => {
    if (document.hidden) return;
    const { signed_in: inside } = await call("session").catch(() => ({ signed_in: false }));
    if (inside) signedIn();
  };
  addEventListener("focus", look);
  onSignedIn(() => {
    removeEventListener("focus", look);
    doorMessage.value = null;
    close();
  });
};

/** Dialog over the page; returns a function that closes it.
 * @param {string} label @param {VNode} content @param {{ stays?: boolean }} [how] */
const over = (label, content, { stays = false } = {}) => {
  const holder = document.body.appendChild(document.createElement("div"));
  let open = true;
  const gone = () => {
    render(null, holder);
    holder.remove();
  };
  render(html`<dialog class="over" aria-label=${label} onCancel=${(event) => stays && event.preventDefault()}
    onClose=${() => (stays && open ? dialog.showModal() : gone())}>${content}</dialog>`, holder);
  const dialog = /** @type {HTMLDialogElement} */ (holder.firstElementChild);
  dialog.showModal();
  return () => {
    open = false;
    dialog.close();
  };
};

const Door = ({ running = false }) => {
  const form = useRef(null);
  const [link, wrong] = [useSignal(""), useSignal("")];
  /** @param {Event} event */
  const enter = async (event) => {
    event.preventDefault();
    const token = link.value.trim().replace(/^.*token=/s, "").split("&")[0];
    wrong.value = token ? "" : "Paste the link first.";
    if (!token) return toWrong(form.current);
    doorMessage.value = await exchange(token);
    return doorMessage.value || signedIn();
  };
  return html`
    <form ref=${form} class="card door" onSubmit=${enter} data-testid="door">
      <h1>${running ? "Sign in again" : "Open the link from the terminal"}</h1>
      ${running && html`<p>${"The session has ended. The server was probably restarted. "}${"Your inputs are kept."}</p>`}
      <p>${"`rocking serve` prints a one-time link to this server. "}
        ${"Open the link, or paste it here. If the link was used, select \u201cLink for another browser\u201d "}
        ${"at the bottom of the page in a signed-in browser, or restart the server."}</p>
      <div class="refusal" role="alert">${doorMessage.value && html`<${Note} kind="warning" text=${doorMessage.value} />`}</div>
      <${Field} label="Link or token" value=${link} error=${wrong.value} help="The line that begins with http:// in the terminal." />
      <${Button} type="submit" kind="primary">Sign in<//>
    </form>`;
};

/** Show a new one-time link for another browser, and copy it if the browser allows that. @param {App} app */
export const linkForAnother = async (app) => {
  const { url } = await app.call("session/link", { method: "POST" });
  const close = over("Link for another browser", html`<${Another} app=${app} url=${url} close=${() => close()} />`);
};

/** @param {{ app: App, url: string, close: () => unknown }} props */
const Another = ({ app, url, close }) => {
  const box = useRef(null);
  const mark = () => box.current.querySelector("input").select();
  useLayoutEffect(() => void setTimeout(mark), []);
  const copy = () => navigator.clipboard.writeText(url).then(() => app.say("Link copied."), mark);
  return html`
    <div ref=${box} class="card door" data-testid="another"><h1>Link for another browser</h1>
      <${Field} label="Sign-in link for another browser" value=${url} readonly
        help="The link works once, within 15 minutes. Anyone with the link can use this server." />
      <div class="toolbar"><${Button} kind="primary" onClick=${copy}>Copy link<//><${Button} onClick=${close}>Close<//></div>
    </div>`;
};
