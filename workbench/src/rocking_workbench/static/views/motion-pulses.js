/** Pulses of the server, as form fields. */

/** @type {{ [parameter: string]: { label: string, low: number, high: number, log: boolean, limits?: Limits, integer?: boolean, usual: number } | undefined }} */
const RANGES = {
  amplitude: { label: "Peak acceleration", low: 0.1, high: 20, log: true, usual: 3, limits: { min: -1e6, max: 1e6, moves: true } },
  velocity: { label: "Velocity", low: 0.05, high: 3, log: true, usual: 0.6, limits: { moves: true } },
  period: { label: "Period", low: 0.1, high: 5, log: true, usual: 0.8, limits: { min: 1e-6, max: 1e6 } },
  duration: { label: "Duration", low: 0.05, high: 5, log: true, usual: 0.4, limits: { above: 0 } },
  cycles: { label: "Cycles", low: 1, high: 20, log: false, usual: 2 },
  phase: { label: "Phase", low: 0, high: 6.2832, log: false, usual: 0 },
  n: { label: "Main cycles", low: 1, high: 10, log: false, integer: true, usual: 1, limits: { min: 1, max: 1000, integer: true } },
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

// in order of frequency of use
const ORDER = ["sine", "cosine", "half-sine", "half-cosine", "rectangular", "ricker", "antisymmetric-ricker"];
/** @param {string} name */
const rank = (name) => (ORDER.includes(name) ? ORDER.indexOf(name) : ORDER.length);

/** @param {string} name */
const titleOf = (name) => TITLES[name] || name.replaceAll("-", " ");

/** @param {[string, Server.ParameterFacts]} parameter */
const parameterOf = ([name, { unit, description: text, default: usual }]) => {
  const range = RANGES[name] || { label: text || name, low: 0.01, high: 100, log: true, usual: 1 };
  return { name, unit: unit === "-" ? "" : unit, needed: usual === null, ...range, usual: typeof usual === "number" ? usual : range.usual };
};

/** The pulses by name: {title, summary, parameters: [{name, label, unit, usual, low, high, ...}]}. @param {Pick<Server.Info, "pulses">} info */
export const pulsesOf = ({ pulses }) => new Map(Object.entries(pulses).sort(([first], [other]) => rank(first) - rank(other))
  .map(([name, { summary, parameters }]) => [name, { title: titleOf(name), summary, parameters: Object.entries(parameters).map(parameterOf) }]));
