/** Form of rocking spectra: slenderness values and periods of blocks under the motion of the inputs. */
import { html, useRef } from "/parts/preact.js";
import { Range, motionsOf, rangeOf } from "/views/studies-form-parts.js";

/** Form of rocking spectra. @param {{ app: App, question: StudyQuestion }} props */
export const SpectrumQuestion = ({ app, question }) => {
  const { slenderness_angles: { unit: angle }, periods: { unit: time } } = app.info.keys.spectrum;
  const angles = useRef({ from: 0.1, to: 0.3, count: 3 }).current;
  const periods = useRef({ from: 1, to: 12, count: 60, spacing: "log" }).current;
  question.current = {
    name: "rocking spectra",
    tables: (inputs) => {
      const spectrum = { slenderness_angles: rangeOf(angles), periods: rangeOf(periods) };
      return { kind: "rocking-spectrum", job: { motions: motionsOf(inputs), spectrum } };
    },
  };
  return html`<div class="question">
    <${Range} name="Slenderness angles \u03b1" unit=${angle} range=${angles} />
    <${Range} name="Periods 2\u03c0/p of the blocks" unit=${time} range=${periods} /></div>`;
};
