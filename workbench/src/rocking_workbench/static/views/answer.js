/** Results of the API that follow the inputs while their view is visible. */

import { batch, signal } from "/parts/preact.js";

export const OLDER = "The results below belong to the last valid inputs.";

/** Errors in the views on which a view depends, as text. @param {App} app @param {...string} views */
export const faultsOf = (app, ...views) => {
  const wrong = signal("");
  app.faults.subscribe(() => (wrong.value = views.map((view) => app.faults.sentence({ view })).filter(Boolean).join(" ")));
  app.faults.refresh();
  return wrong;
};

/** Request `path` of the API: `question()` gives the inputs, null without motion; only changes of `keys` matter.
 * A time window is requested with `detail`; with `keeps`, the last answer remains after a rejection.
 * @param {App} app @param {string} name @param {string[]} keys @param {() => object | null} question
 * @param {{ path?: string, detail?: object, keeps?: boolean }} [how] @returns {Asked<any>} */
export const createAnswer = (app, name, keys, question, { path = "response", detail = {}, keeps = false } = {}) => {
  const [answer, refused, closeup] = [signal(null), signal(null), signal(null)];
  let [visible, dirty, queued] = [false, true, false];
  /** @param {any} value @param {Refusal | null} [error] */
  const become = (value, error = null) => batch(() => {
    [answer.value, refused.value, closeup.value] = [value, error, null];
  });
  const refresh = async () => {
    [queued, dirty] = [false, false];
    const query = question();
    if (!query) return become(null);
    try {
      const value = await app.latest(name, path, query);
      if (question()) become(value); // otherwise the view would not be updated
    } catch (error) {
      if (app.superseded(error)) return undefined;
      dirty = true; // a failed request is repeated at the next show of the view
      become(keeps ? answer.value : null, error);
    }
    return undefined;
  };
  // several simultaneous changes cause one request
  const ask = () => {
    if (!queued) queueMicrotask(refresh);
    queued = true;
  };
  app.inputs.subscribe((_, changed) => {
    if (!keys.some((key) => changed.has(key))) return;
    dirty = true;
    if (visible) ask();
  });
  return {
    answer, refused, closeup,
    ask,
    /** Request the visible interval of the figures; null: the complete time. @param {Point | null} window */
    look: async (window) => {
      const shownAnswer = answer.value;
      closeup.value = window && { window };
      if (!window) return undefined;
      try {
        const detailedAnswer = await app.latest(`${name}-part`, path, { ...question(), ...detail, window });
        if (shownAnswer === answer.value && closeup.value?.window === window) closeup.value = { window, ...detailedAnswer };
      } catch (error) {
        if (!app.superseded(error)) app.say(error.message, "error");
      }
      return undefined;
    },
    shown: () => {
      visible = true;
      if (dirty) ask();
    },
    hidden: () => (visible = false),
  };
};
