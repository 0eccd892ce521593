/** Loading the views: each is mounted when it is first shown. */

import { note } from "/app/controls.js";
import { fill } from "/app/dom.js";

/** A keeper of views: show(name, before) mounts and tells them. */
export const createViews = (app) => {
  const mounted = new Map();
  const mount = (name) => {
    if (!mounted.has(name)) mounted.set(name, load(name, app));
    return mounted.get(name);
  };
  return {
    mount,
    show: async (name, before) => {
      if (before) (await mounted.get(before))?.hidden?.();
      const view = await mount(name);
      view?.shown?.();
    },
  };
};

const load = async (name, app) => {
  const section = document.getElementById(`view-${name}`);
  try {
    const { mount } = await import(`/views/${name}.js`);
    fill(section);
    const view = (await mount(section, app)) ?? {};
    section.dataset.ready = "true";
    return view;
  } catch (error) {
    fill(section, note(`This part could not be shown: ${error.message}`, "error"));
    section.dataset.ready = "failed";
    return {};
  }
};
