/** Document of all inputs of the user: immutable, observable, and part of links. */

import { inputsOf } from "/app/shape.js";

const KEPT = "rocking.inputs";
const ASIDE = "rocking.aside";

/** The default restitution model, and the models for the comparison. */
export const DEFAULT_MODELS = ["calibrated", "ked", "housner"];

/** Initial content of a new project. */
/** @type {Server.Inputs} */
export const FIRST = {
  body: { units: "m", width: 0.5, height: 2.0, depth: 0.5, density: 2400 },
  motion: { pulse: "sine:amplitude=3,period=0.8" },
  restitution: { models: DEFAULT_MODELS },
};

/** The store of the inputs: get, set by path, subscribe, lend. @param {Server.Inputs | null} start */
export const createInputs = (start) => {
  let current = freeze(start ?? FIRST);
  const wereKept = kept() !== null;
  /** @type {Aside | null} */
  let aside = keptAside();
  keep(KEPT, current);
  /** @type {Set<(inputs: Server.Inputs, changed: Set<string>) => unknown>} */
  const watchers = new Set();
  /** @param {Server.Inputs} next @param {Set<string>} changed */
  const become = (next, changed) => {
    current = freeze(next);
    keep(KEPT, current);
    for (const watcher of [...watchers]) watcher(current, changed);
  };
  /** @param {Server.Inputs} document */
  const replace = (document) => become(document, new Set([...Object.keys(current), ...Object.keys(document)]));
  /** @param {Aside | null} next */
  const put = (next) => {
    aside = next;
    keep(ASIDE, next);
  };
  return {
    get: () => current,
    /** True if this tab had inputs before it was loaded. */
    wereKept,
    /** Load the inputs of a project; the present inputs are discarded. @param {Server.Inputs} document */
    take: (document) => {
      put(null);
      replace(document);
    },
    /** @param {string} path @param {unknown} value */
    set: (path, value) => {
      const [top] = path.split(".");
      const [before, next] = [/** @type {any} */ (current), changedAt(current, path.split("."), value)];
      if (JSON.stringify(next[top]) !== JSON.stringify(before[top])) become(next, new Set([top]));
    },
    /** Show other inputs, and keep the inputs of the user: {inputs, label, mine}; null without other inputs.
     * @param {Server.Inputs} document @param {string} text */
    lend: (document, text) => {
      const own = aside?.mine ? aside.inputs : current;
      const same = [FIRST, document].some((other) => JSON.stringify(other) === JSON.stringify(own));
      put(same ? null : { inputs: own, label: text, mine: true });
      replace(document);
    },
    aside: () => aside,
    /** Exchange the shown inputs and the inputs set aside. */
    swap: () => {
      if (!aside) return;
      const next = aside.inputs;
      put({ ...aside, inputs: current, mine: !aside.mine });
      replace(next);
    },
    forget: () => {
      put(null);
      become(current, new Set());
    },
    /** Make all watchers request their data again. */
    touch: () => become(current, new Set(Object.keys(current))),
    /** @param {(inputs: Server.Inputs, changed: Set<string>) => unknown} watcher */
    subscribe: (watcher) => {
      watchers.add(watcher);
      return () => watchers.delete(watcher);
    },
  };
};

/** Inputs as text in a link. @param {Server.Inputs} inputs */
export const encode = (inputs) => {
  const bytes = new TextEncoder().encode(JSON.stringify(inputs));
  const text = btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
  return text.replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
};

/** Inputs of a link; null if the text is not valid. @param {string} text */
export const decode = (text) => {
  try {
    const raw = atob(text.replaceAll("-", "+").replaceAll("_", "/"));
    return inputsOf(JSON.parse(new TextDecoder().decode(Uint8Array.from(raw, (character) => character.charCodeAt(0)))));
  } catch {
    return null;
  }
};

/** Inputs of this browser tab before a reload. */
export const kept = () => inputsOf(stored(KEPT));

const keptAside = () => {
  const entry = stored(ASIDE);
  const inputs = inputsOf(entry?.inputs);
  return inputs && { inputs, label: String(entry.label), mine: Boolean(entry.mine) };
};

/** Stored value of this tab; null if there is none. @param {string} key */
export const stored = (key) => {
  try {
    return JSON.parse(sessionStorage.getItem(key) ?? "null");
  } catch {
    return null;
  }
};

/** Keep a value in this tab. @param {string} key @param {unknown} value */
export const keep = (key, value) => {
  try {
    sessionStorage.setItem(key, JSON.stringify(value));
  } catch {
    // Browsers without storage work too; a reload discards their inputs.
  }
};

/** Tree with one changed value at a path of keys; undefined removes the value and does not create tables.
 * @param {any} tree @param {string[]} path @param {unknown} value @returns {any} */
export const changedAt = (tree, [key, ...path], value) => {
  const next = { ...(tree ?? {}) };
  if (value === undefined && !(key in next)) return next;
  if (path.length) next[key] = changedAt(next[key], path, value);
  else if (value === undefined) delete next[key];
  else next[key] = value;
  return next;
};

/** @type {<T>(value: T) => T} */
const freeze = (value) => {
  const copy = structuredClone(value);
  /** @param {any} node */
  const seal = (node) => {
    if (node && typeof node === "object") Object.values(Object.freeze(node)).forEach(seal);
    return node;
  };
  return seal(copy);
};
