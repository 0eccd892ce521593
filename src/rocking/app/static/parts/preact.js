/** What components of the page are made of: Preact, signals, and templates that need no compiler. */

import htm from "/vendor/htm/htm.mjs";
import { createContext, h, render } from "/vendor/preact/preact.mjs";
import { useContext, useEffect, useLayoutEffect, useMemo, useRef, useState } from "/vendor/preact/hooks.mjs";
import { batch, computed, signal } from "/vendor/signals/signals.mjs";

/** A template: html`<p class="note">${words}</p>`; text stays text. */
export const html = htm.bind(h);

export { batch, computed, createContext, render, signal, useContext, useEffect, useLayoutEffect, useMemo, useRef, useState };

/** A signal that lives as long as its component. */
export const useSignal = /** @type {typeof signal} */ ((/** @type {any} */ first) => useRef(signal(first)).current);
