/** The body's facts, asked for once whenever the body changes, and shared by every view. */

import { superseded } from "/app/api.js";

/** Follow the body of the inputs: {get, subscribe((facts, error) => ...)}. */
export const createBodyFacts = (app) => {
  let facts = null;
  let error = null;
  const watchers = new Set();
  const tell = (nextFacts, nextError) => {
    [facts, error] = [nextFacts ?? facts, nextError];
    for (const watcher of [...watchers]) watcher(facts, error);
  };
  const ask = async () => {
    const { body, settings } = app.inputs.get();
    try {
      tell(await app.latest("body", "body", settings ? { body, settings } : { body }), null);
    } catch (refusal) {
      if (!superseded(refusal)) tell(null, refusal);
    }
  };
  app.inputs.subscribe((_, changed) => {
    if (changed.has("body") || changed.has("settings")) ask();
  });
  ask();
  return {
    get: () => facts,
    error: () => error,
    subscribe: (watcher) => {
      watchers.add(watcher);
      if (facts || error) watcher(facts, error);
      return () => watchers.delete(watcher);
    },
  };
};
