/** The response spectrum: acceleration, velocity or displacement over the period. */
import { html, useMemo, useSignal } from "/parts/preact.js";
import { Figure } from "/charts/figure.js";
import { Segmented } from "/parts/fields.js";

const KINDS = {
  pseudo_acceleration: { label: "pseudo-acceleration", unit: "m/s2", colour: "#0070B2" },
  pseudo_velocity: { label: "pseudo-velocity", unit: "m/s", colour: "#009960" },
  spectral_displacement: { label: "relative displacement", unit: "m", colour: "#D96C00" },
};
/** @type {Words} */
const TITLES = {
  pseudo_acceleration: "Pseudo-acceleration against period, 5 % damping",
  pseudo_velocity: "Pseudo-velocity against period, 5 % damping",
  spectral_displacement: "Relative displacement against period, 5 % damping",
};
const WORDS = [["pseudo_acceleration", "Acceleration"], ["pseudo_velocity", "Velocity"], ["spectral_displacement", "Displacement"]];

// a logarithmic axis cannot show a period or a value of zero
/** @param {number[]} periods @param {number[]} values */
const positive = (periods, values) => {
  const kept = periods.map((_, k) => k).filter((k) => periods[k] > 0 && values[k] > 0);
  return [kept.map((k) => periods[k]), kept.map((k) => values[k])];
};

/** Spectrum with a choice of its quantity. @param {{ spectrum: Server.SpectrumFacts }} props */
export const Spectrum = ({ spectrum }) => {
  /** @type {Signal<keyof typeof KINDS>} */
  const kind = useSignal("pseudo_acceleration");
  const { label, unit, colour } = KINDS[kind.value];
  const data = useMemo(() => positive(spectrum.period, spectrum[kind.value]), [spectrum, kind.value]);
  const shape = {
    title: TITLES[kind.value], x: { label: "period", unit: "s", log: true },
    y: { label: "", unit, log: true }, series: [{ label, colour, width: 1.8 }], height: 260,
  };
  return html`
    <div class="motion-spectrum"><${Segmented} label="Spectrum of" options=${WORDS} value=${kind} />
      <${Figure} shape=${shape} data=${data} interval=${null} testid="motion-spectrum" /></div>`;
};
