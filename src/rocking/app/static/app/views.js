/** Loading the views: each is mounted when it is first shown. */

import { inPlaceOf } from "/app/failure.js";
import { Button, Note } from "/parts/fields.js";
import { html } from "/parts/preact.js";
import { t } from "/app/words.js";

/** A keeper of views: show(name, before) mounts and tells them. @param {App} app */
export const createViews = (app) => {
  const mounted = new Map();
  /** @param {string} name */
  const mount = (name) => {
    if (!mounted.has(name)) mounted.set(name, load(name, app, () => mounted.delete(name)));
    return mounted.get(name);
  };
  let current = "";
  return {
    // One that is still on its way holds up no other; it is told that it is shown only if it still is when it comes.
    /** @param {string} name @param {string | null} [before] */
    show: async (name, before) => {
      current = name;
      if (before) mounted.get(before)?.then((/** @type {any} */ view) => current !== before && view.hidden?.());
      const view = await mount(name);
      if (current === name) view?.shown?.();
    },
  };
};

// A browser may keep that a module did not come: what is asked for again has an address of its own.
const attempts = new Map();
/** @param {string} name */
const address = (name) => {
  const before = attempts.get(name) ?? 0;
  attempts.set(name, before + 1);
  return `/views/${name}.js${before ? `?again=${before}` : ""}`;
};

/** @param {string} name @param {App} app @param {() => unknown} forget */
const load = async (name, app, forget) => {
  const section = document.getElementById(`view-${name}`);
  try {
    const { mount } = await import(address(name));
    section.replaceChildren();
    const view = (await mount(section, app)) ?? {};
    section.dataset.ready = "true";
    return view;
  } catch (error) {
    forget();
    inPlaceOf(section, html`<${Note} kind="error" text=${failure(error)} />
      <${Button} kind="primary" onClick=${() => location.reload()}>Reload the page<//>`);
    section.dataset.ready = "failed";
    return {};
  }
};

// A module that did not come is asked for again when the view is next shown; the inputs outlast a reload.
/** @param {any} error */
const failure = (error) => (error instanceof TypeError
  ? "The server did not send this view. Check that `rocking serve` is running."
  : t("This view could not be loaded: {reason}", { reason: error.message }));
