/** Small drawings of the pulses: acceleration over time, without numbers. */
import { html } from "/parts/preact.js";

const WIDE = 72;
const TALL = 30;
const SAMPLES = 96;
const turn = 2 * Math.PI;
// phase of type C1: its velocity and displacement end at zero
const PHASE_C1 = 0.0697 * Math.PI;

/** @param {number} x */
const ricker = (x) => (1 - x * x) * Math.exp(-0.5 * x * x);
/** @param {number} x */
const antisymmetric = (x) => (x * (x * x - 3) * Math.exp(-0.5 * x * x)) / 1.38;

/** @param {number} t */
const nearFault = (t) => {
  /** @param {number} s */
  const velocity = (s) => (1 + Math.cos((turn * s) / 1.5)) * Math.cos(turn * s);
  return (velocity(t + 0.005) - velocity(t - 0.005)) / 0.11;
};

/** Shape of each pulse over its own duration, from 0 to 1; largest size about 1. */
/** @type {{ [pulse: string]: ((t: number) => number) | undefined }} */
export const SHAPES = {
  rectangular: () => 1,
  /** @param {number} t */
  "half-sine": (t) => Math.sin(0.5 * turn * t),
  /** @param {number} t */
  sine: (t) => Math.sin(turn * t),
  /** @param {number} t */
  "half-cosine": (t) => Math.cos(0.5 * turn * t),
  /** @param {number} t */
  cosine: (t) => Math.cos(turn * t),
  /** @param {number} t */
  "type-a": (t) => Math.sin(turn * t),
  /** @param {number} t */
  "type-b": (t) => Math.cos(turn * t),
  /** @param {number} t */
  "type-c": (t) => Math.cos(turn * t * (1.5 - PHASE_C1 / Math.PI) + PHASE_C1),
  /** @param {number} t */
  ricker: (t) => ricker(10 * (t - 0.5)),
  /** @param {number} t */
  "antisymmetric-ricker": (t) => antisymmetric(10 * (t - 0.5)),
  /** @param {number} t */
  "mavroeidis-papageorgiou": (t) => nearFault(1.5 * (t - 0.5)),
  /** @param {number} t */
  harmonic: (t) => Math.sin(4 * turn * t),
};

/** Drawing of a pulse; empty for an unknown name. @param {{ name: string }} props */
export const Sketch = ({ name }) => {
  const shape = SHAPES[name];
  if (!shape) return null;
  /** @param {number} t */
  const x = (t) => (3 + (WIDE - 6) * t).toFixed(1);
  /** @param {number} a */
  const y = (a) => (0.5 * TALL - 0.42 * TALL * a).toFixed(1);
  const points = Array.from({ length: SAMPLES + 1 }, (_, k) => `${x(k / SAMPLES)},${y(shape(k / SAMPLES))}`);
  return html`
    <svg class="pulse-sketch" viewBox=${`0 0 ${WIDE} ${TALL}`} aria-hidden="true">
      <line x1="0" x2=${WIDE} y1=${0.5 * TALL} y2=${0.5 * TALL} class="pulse-axis" />
      <path d=${`M${x(0)},${y(0)}L${points.join("L")}L${x(1)},${y(0)}`} class="pulse-line" /></svg>`;
};
