/** The fragment of the address, processed once: a token, the inputs of a link, or a view. */

import * as address from "/app/address.js";
import { decode } from "/app/inputs.js";
import { showDoor, exchange } from "/app/session.js";
import { t } from "/app/words.js";

/** Observe the address: Back, Forward and links pasted into the tab.
 * @param {App} app @param {ReturnType<typeof import("/app/tabs.js").createTabs>} tabs */
export const followAddress = (app, tabs) => {
  const follow = async () => {
    const parts = address.read();
    if (!address.isOurs(parts)) return;
    const { token, in: shared, view } = parts;
    // The fragment is removed after use, so that a reload does not revert later edits.
    if (token || shared) address.write({ view: view ?? tabs.current() });
    if (shared) take(app, shared);
    tabs.show(view ?? (token || shared ? tabs.current() : "body"), { quiet: true });
    if (token) await enter(token);
  };
  addEventListener("popstate", follow);
  addEventListener("hashchange", follow);
};

/** Message if the inputs of a link cannot be read. */
export const UNREADABLE = "The link contains no readable inputs";

/** @param {App} app @param {string} shared */
const take = (app, shared) => {
  const inputs = decode(shared);
  if (inputs) app.inputs.lend(inputs, "a link");
  else app.say(t("{reason}. Nothing was changed.", { reason: UNREADABLE }), "warning");
};

/** @param {string} token */
const enter = async (token) => {
  const refusal = await exchange(token);
  if (refusal) showDoor(refusal);
  else document.dispatchEvent(new CustomEvent("rocking:signed-in"));
};
