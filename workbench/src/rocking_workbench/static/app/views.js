/** Loading the views: each is mounted when it is first shown. */

import { inPlaceOf } from "/app/failure.js";
import { Button, Note } from "/parts/fields.js";
import { html } from "/parts/preact.js";
import { t } from "/app/words.js";

/** Set of views: show(name, before) mounts them. @param {App} app */
export const createViews = (app) => {
  const mounted = new Map();
  /** @param {string} name */
  const mount = (name) => {
    if (!mounted.has(name)) mounted.set(name, load(name, app, () => mounted.delete(name)));
    return mounted.get(name);
  };
  let current = "";
  return {
    // Loading of one view does not block other views. A loaded view is shown only if it is still selected.
    /** @param {string} name @param {string | null} [before] */
    show: async (name, before) => {
      current = name;
      if (before) mounted.get(before)?.then((/** @type {any} */ view) => current !== before && view.hidden?.());
      const view = await mount(name);
      if (current === name) view?.shown?.();
    },
  };
};

// Browsers may cache a failed module: a retry uses a new address.
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

// A failed module is requested again when the view is next shown. A reload keeps the inputs.
/** @param {any} error */
const failure = (error) => (error instanceof TypeError
  ? "The server did not send this view. Check that `rocking serve` is running."
  : t("This view could not be loaded: {reason}", { reason: error.message }));
