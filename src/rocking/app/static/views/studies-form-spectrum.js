/** The question of rocking spectra: slendernesses and periods of blocks under the motion of the inputs. */
import { el } from "/app/dom.js";
import { motionsOf, rangeFields } from "/views/studies-form-parts.js";

/** Form of rocking spectra; `tables` gives the tables of its job. */
export function spectrumQuestion() {
  const angles = rangeFields({
    name: "Slenderness angles \u03b1",
    unit: "rad",
    from: 0.1,
    to: 0.3,
    count: 3,
  });
  const periods = rangeFields({
    name: "Periods 2\u03c0/p of the blocks",
    unit: "s",
    from: 1,
    to: 12,
    count: 60,
    log: true,
  });
  return {
    node: el("div", { class: "question" }, angles.node, periods.node),
    name: () => "rocking spectra",
    tables: (inputs) => {
      const spectrum = { slenderness_angles: angles.range(), periods: periods.range() };
      return { kind: "rocking-spectrum", job: { motions: motionsOf(inputs), spectrum } };
    },
  };
}
