/** Form of a study without a special form: one field for each key of its table. */
import { html, useSignal } from "/parts/preact.js";
import { KeyField } from "/parts/fields.js";
import { filled } from "/questions/parts.js";
import { motionsOf } from "/views/studies-form-parts.js";

/** Form of the keys of a table. @param {{ app: App, question: StudyQuestion, kind: Server.KindOfStudy, label: string }} props */
export const KeysQuestion = ({ app, question, kind: { name, table, has_body: hasBody, has_motions: moves }, label }) => {
  /** @type {Signal<{ [key: string]: string }>} */
  const texts = useSignal({});
  const keys = app.info.keys[table];
  question.current = {
    name: label.toLowerCase(),
    tables: (inputs) => {
      if (hasBody && !inputs.body) throw new Error("This study needs a body. Choose a body in the step Body.");
      const body = hasBody ? { body: inputs.body } : {};
      const motions = moves ? { motions: motionsOf(inputs) } : {};
      return { kind: name, job: { ...body, ...motions, [table]: filled(texts.value, keys) } };
    },
  };
  return html`<div class="question"><div class="fields">${Object.entries(keys).map(([key, facts]) => html`
    <${KeyField} key=${key} name=${key} facts=${facts} value=${texts.value[key]}
      on=${(/** @type {string} */ text) => (texts.value = { ...texts.value, [key]: text })} />`)}</div></div>`;
};
