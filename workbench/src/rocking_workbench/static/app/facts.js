/** Properties of the body for all views, requested once per change of the body. */

import { superseded } from "/app/api.js";

/** Follow the body of the inputs: {get, subscribe((facts, error) => ...)}. @param {App} app */
export const createBodyFacts = (app) => {
  /** @type {Server.DescribedBody | null} */
  let facts = null;
  /** @type {Refusal | null} */
  let error = null;
  /** @type {Set<(facts: Server.DescribedBody | null, error: Refusal | null) => unknown>} */
  const watchers = new Set();
  /** @param {Server.DescribedBody | null} nextFacts @param {Refusal | null} nextError */
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
    /** @param {(facts: Server.DescribedBody | null, error: Refusal | null) => unknown} watcher */
    subscribe: (watcher) => {
      watchers.add(watcher);
      if (facts || error) watcher(facts, error);
      return () => watchers.delete(watcher);
    },
  };
};
