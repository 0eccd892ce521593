/** Answers of the API that follow the inputs while their view is on the screen. */

import { batch, signal } from "/parts/preact.js";

/** Ask for a response: `question()` says what, null where nothing moves; only what `keys` name matters. */
export const createAnswer = (app, name, keys, question) => {
  const [answer, refused, part] = [signal(null), signal(""), signal(null)];
  let [visible, dirty, queued] = [false, true, false];
  const become = (found, words = "") => batch(() => {
    [answer.value, refused.value, part.value] = [found, words, null];
  });
  const refresh = async () => {
    [queued, dirty] = [false, false];
    const given = question();
    if (!given) return become(null);
    try {
      const found = await app.latest(name, "response", given);
      if (question()) become(found); // else nothing moves any more
    } catch (error) {
      if (!app.superseded(error)) become(null, error.message);
    }
    return undefined;
  };
  // several changes of one moment are one question
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
    answer, refused, part,
    ask,
    /** Ask again for the part of the time that the figures show; null shows all of it. */
    look: async (window) => {
      const whole = answer.value;
      part.value = window && { window, answers: [] };
      if (!window) return undefined;
      try {
        const found = await app.latest(`${name}-part`, "response", { ...question(), window });
        if (whole === answer.value && part.value?.window === window) part.value = { window, answers: found.answers };
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
