/** The pulses that the server knows, as the form shows them. */

/** @type {{ [parameter: string]: { label: string, low: number, high: number, log: boolean, limits?: Limits, whole?: boolean, usual: number } | undefined }} */
const RANGES = {
  amplitude: { label: "Peak acceleration", low: 0.1, high: 20, log: true, usual: 3, limits: { min: -1e6, max: 1e6, moves: true } },
  velocity: { label: "Velocity", low: 0.05, high: 3, log: true, usual: 0.6, limits: { moves: true } },
  period: { label: "Period", low: 0.1, high: 5, log: true, usual: 0.8, limits: { min: 1e-6, max: 1e6 } },
  duration: { label: "Duration", low: 0.05, high: 5, log: true, usual: 0.4, limits: { above: 0 } },
  cycles: { label: "Cycles", low: 1, high: 20, log: false, usual: 2 },
  phase: { label: "Phase", low: 0, high: 6.2832, log: false, usual: 0 },
  n: { label: "Main cycles", low: 1, high: 10, log: false, whole: true, usual: 1, limits: { min: 1, max: 1000, whole: true } },
};
/** @type {Words} */
const TITLES = {
  "type-a": "type A, forward",
  "type-b": "type B, forward and back",
  "type-c": "type C, n cycles",
  ricker: "Ricker wavelet",
  "antisymmetric-ricker": "antisymmetric Ricker",
  "mavroeidis-papageorgiou": "near-fault (M & P)",
  harmonic: "many cycles",
};

// the usual ones first
const ORDER = ["sine", "cosine", "half-sine", "half-cosine", "rectangular", "ricker", "antisymmetric-ricker"];
/** @param {string} name */
const rank = (name) => (ORDER.includes(name) ? ORDER.indexOf(name) : ORDER.length);

/** @param {string} name */
const titleOf = (name) => TITLES[name] || name.replaceAll("-", " ");

/** @param {any} given @returns {any[]} */
const listed = (given) =>
  Array.isArray(given) ? given : Object.entries(given).map(([name, one]) => ({ name, ...one }));

/** @param {any} parameter */
const parameterOf = ({ name, unit, default: usual, ...more }) => {
  const range = RANGES[name] || { label: more.words || name, low: 0.01, high: 100, log: true, usual: 1 };
  const needed = usual === undefined || usual === null;
  const shown = unit === "-" ? "" : unit || "";
  return { name, unit: shown, needed, ...range, usual: needed ? range.usual : usual };
};

/** Returns the pulses by name: {title, summary, parameters: [{name, label, unit, usual, low, high, ...}]}.
 * @param {{ pulses: Server.Info["pulses"] }} info @returns {Map<string, { title: string, summary: string, parameters: any[] }>} */
export const pulsesOf = ({ pulses }) => {
  const ordered = listed(pulses).sort((one, other) => rank(one.name) - rank(other.name));
  /** @param {any} pulse @returns {[string, any]} */
  const told = ({ name, summary = "", parameters = {} }) => {
    return [name, { title: titleOf(name), summary, parameters: listed(parameters).map(parameterOf) }];
  };
  return new Map(ordered.map(told));
};
