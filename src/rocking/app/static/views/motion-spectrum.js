/** The response spectrum: acceleration, velocity or displacement over the period. */
import { lineChart } from "/charts/line.js";
import { el } from "/app/dom.js";
import { segmented } from "/app/fields.js";

const KINDS = {
  acceleration: { text: "Acceleration", label: "pseudo-acceleration", unit: "m/s2", colour: "#0070B2" },
  velocity: { text: "Velocity", label: "pseudo-velocity", unit: "m/s", colour: "#009960" },
  displacement: { text: "Displacement", label: "relative displacement", unit: "m", colour: "#D96C00" },
};

// a logarithmic axis has no place for a period or a value of zero
const positive = (periods, values) => {
  const kept = periods.map((_, k) => k).filter((k) => periods[k] > 0 && values[k] > 0);
  return [kept.map((k) => periods[k]), kept.map((k) => values[k])];
};

const chartOf = (place, { label, unit, colour }) =>
  lineChart(place, {
    title: `${label[0].toUpperCase()}${label.slice(1)} over period, 5 % damping`,
    x: { label: "period", unit: "s", log: true },
    y: { label: "", unit, log: true },
    series: [{ label, colour, width: 1.8 }],
    height: 260,
  });

/** Returns the spectrum with a choice of what it shows. */
export const spectrumChart = () => {
  const place = el("div", { "data-testid": "motion-spectrum" });
  const options = Object.entries(KINDS).map(([value, { text }]) => ({ value, text }));
  const onChange = (next) => turn(next);
  const choice = segmented({ label: "Spectrum of", options, value: "acceleration", onChange });
  const element = el("div", { class: "motion-spectrum" }, choice, place);
  let kind = "acceleration";
  let chart = null;
  let spectrum = null;
  const draw = () => {
    if (spectrum) chart.setData(positive(spectrum.period, spectrum[kind]));
  };
  const turn = (next) => {
    kind = next;
    chart?.destroy();
    chart = chartOf(place, KINDS[kind]);
    draw();
  };
  const show = (found) => {
    spectrum = found;
    if (chart) draw();
    else turn(kind);
  };
  return { element, show };
};
