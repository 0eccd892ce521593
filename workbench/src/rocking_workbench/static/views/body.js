/** Body view: shape, typed sizes, drawing, table or file, with the properties of the body. */

import { batch, html, render, signal, useLayoutEffect } from "/parts/preact.js";
import { Pictured } from "/charts/pictured.js";
import { bodyPicture } from "/drawing/body-picture.js";
import { Card, Note } from "/parts/fields.js";
import { Drawn } from "/parts/made.js";
import { aboutOf } from "/views/about.js";
import { Editor, createEditor } from "/views/body-editor.js";
import { Facts, Warnings } from "/views/body-facts.js";
import { BodyFile } from "/views/body-file.js";
import { Form } from "/views/body-form.js";
import { t } from "/app/words.js";

const OLDER = "The picture and the numbers belong to the last valid sizes.";

/** Show the view. @param {HTMLElement} section @param {App} app */
export const mount = (section, app) => {
  const [body, facts, refusal, faulty] = [app.inputs.get().body, app.body.get(), app.body.error(), ""].map(signal);
  const others = signal(0); // number of replacements of the whole document
  let was = JSON.stringify(app.inputs.get());
  const editor = createEditor(app);
  app.inputs.subscribe((inputs, changed) => changed.has("body") && batch(() => {
    body.value = inputs.body;
    if (changed.size > 1 && JSON.stringify(inputs) !== was) others.value += 1; // all data are requested again, also after signing in
    was = JSON.stringify(inputs);
    editor.tell();
  }));
  const look = () => (faulty.value = app.faults.sentence({ view: "body", but: app.body.error()?.message }));
  app.faults.subscribe(look);
  app.body.subscribe((described, error) => batch(() => {
    [facts.value, refusal.value] = [described, error];
    look();
    editor.tell();
  }));
  render(html`<${Body} app=${app} editor=${editor} body=${body} others=${others} facts=${facts} refusal=${refusal} faulty=${faulty} />`, section);
  return { shown: editor.tell };
};

/** @param {{ app: App, editor: Editor, body: Signal<Server.BodyInput>, others: Signal<number>, facts: Signal<Server.DescribedBody>, refusal: Signal<Refusal | null>, faulty: Signal<string> }} props */
const Body = ({ app, editor, body, others, facts, refusal, faulty }) => {
  useLayoutEffect(() => app.faults.refresh(), [body.value]); // fields were added or removed
  return html`
    <header class="view-head"><h1>Body</h1>
      <p class="lead">Enter sizes, draw the body, paste points or drop a drawing. The results update at once.</p></header>
    <div class="body-columns">
      <div class="area-form"><${Card} title="Outline and size">
        <${Form} key=${others.value} app=${app} body=${body.value} refusal=${refusal.value} /><//></div>
      <div class="area-results stack">
        <${Editor} editor=${editor} />
        <div class="columns two"><${Results} app=${app} facts=${facts} refusal=${refusal} faulty=${faulty} /></div></div>
      <div class="area-file"><${Card} title="From a file"><${BodyFile} app=${app} /><//></div>
    </div>`;
};

/** @param {{ app: App, facts: Signal<Server.DescribedBody>, refusal: Signal<Refusal | null>, faulty: Signal<string> }} props */
const Results = ({ app, facts: { value: facts }, refusal: { value: refused }, faulty: { value: faulty } }) => {
  const kind = refused || faulty ? "stale" : "";
  return html`
    <${Card} title="To scale" kind=${kind}>
      <div class="refusal" role="alert" data-testid="body-refusal">
        ${refused && html`<${Note} kind="error" text=${refused.message} />`}
        ${faulty && html`<${Note} kind="warning" text=${`${faulty} ${t(OLDER)}`} />`}</div>
      <div ...${facts && aboutOf(facts)}><${Pictured} title="The body to scale"><${Drawn} draw=${drawn} of=${[facts]} /><//></div>
      <div class="stack" data-testid="body-warnings">${facts && html`<${Warnings} facts=${facts} />`}</div><//>
    <${Card} title="Numbers" kind=${kind}>
      <div class="stack" data-testid="body-facts">${facts && html`<${Facts} app=${app} facts=${facts} />`}</div><//>`;
};

/** @param {Server.DescribedBody} facts @param {number} width */
const drawn = (facts, width) => facts && bodyPicture(facts, { width, height: 430 });
