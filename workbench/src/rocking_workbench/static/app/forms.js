/** Form values of the views. They are part of the project, like the inputs. */

import { batch, signal } from "/parts/preact.js";
import { changedAt, keep, stored } from "/app/inputs.js";
import { formsOf } from "/app/shape.js";

const KEPT = "rocking.forms";

/** Store of the forms of all views: get, take and subscribe; `of` gives the form of one view. */
export const createForms = () => {
  let all = formsOf(stored(KEPT));
  /** @type {Map<string, Signal<Forms[string] | undefined>>} */
  const byView = new Map(); // a change in one view does not redraw others
  /** @type {Set<(view: string) => unknown>} */
  const watchers = new Set();
  /** @param {Forms} next */
  const become = (next) => {
    all = next;
    keep(KEPT, next);
    batch(() => byView.forEach((typed, view) => (typed.value = next[view])));
  };
  return {
    get: () => all,
    /** Load the form values of a project. @param {unknown} forms */
    take: (forms) => become(formsOf(forms)),
    /** @param {(view: string) => unknown} watcher */
    subscribe: (watcher) => watchers.add(watcher),
    /** Form of a view; `first`: initial values, `at(...path)`: signal of one field.
     * @param {string} view @param {{ [name: string]: any }} first @returns {Form} */
    of: (view, first) => {
      const here = byView.get(view) ?? signal(all[view]);
      byView.set(view, here);
      const form = () => {
        const typed = Object.entries(here.value ?? {}).filter(([name, value]) => alike(value, first[name]));
        return { ...first, ...Object.fromEntries(typed) };
      };
      return {
        get value() { return form(); },
        /** @param {...string} path */
        at: (...path) => ({
          get value() { return path.reduce((tree, name) => tree?.[name], form()) ?? ""; },
          set value(next) {
            const changed = changedAt(all, [view, ...path], next);
            if (JSON.stringify(changed) === JSON.stringify(all)) return;
            become(changed);
            watchers.forEach((watcher) => watcher(view));
          },
        }),
      };
    },
  };
};

// Files from other sources may contain anything: values of another type are ignored.
/** @param {unknown} value @param {unknown} first */
const alike = (value, first) => first === undefined || first === null
  || (typeof value === typeof first && Array.isArray(value) === Array.isArray(first));
