/** Preact, signals, and templates without a compiler. */

import htm from "/vendor/htm/htm.mjs";
import { createContext, h, render } from "/vendor/preact/preact.mjs";
import { useContext, useEffect, useLayoutEffect, useMemo, useRef, useState } from "/vendor/preact/hooks.mjs";
import { batch, computed, signal } from "/vendor/signals/signals.mjs";
import { attributesInWords, childrenInWords } from "/app/words.js";

/** A template: html`<p class="note">${text}</p>`; a text is escaped and translated. */
export const html = htm.bind((/** @type {any} */ tag, /** @type {any} */ attributes, /** @type {any[]} */ ...children) => (typeof tag === "string"
  ? h(tag, attributesInWords(tag, attributes), ...childrenInWords(tag, attributes, children)) : h(tag, attributes, ...children)));

export { batch, computed, createContext, render, signal, useContext, useEffect, useLayoutEffect, useMemo, useRef, useState };

/** Signal with the lifetime of its component. */
export const useSignal = /** @type {typeof signal} */ ((/** @type {any} */ first) => useRef(signal(first)).current);
