/** The Body view: choose, type, draw, paste or drop a body, and see at once what it is. */

import { card, el, fill, note } from "/views/body-parts.js";
import { dropZone } from "/views/body-file.js";
import { createForm } from "/views/body-form.js";
import { mountEditor } from "/views/body-editor.js";
import { factsTable, warningsOf } from "/views/body-facts.js";
import { shapeOf } from "/views/body-shapes.js";
import { pictureTools } from "/drawing/picture-tools.js";
import { bodyPicture } from "/drawing/body-picture.js";
import { responsive } from "/drawing/responsive.js";

const OLDER = "The picture and the numbers are those of the last valid sizes.";

/** Show the view. */
export const mount = (section, app) => {
  const refusal = el("div", { class: "refusal", role: "alert", "data-testid": "body-refusal" });
  const warnings = el("div", { class: "stack", "data-testid": "body-warnings" });
  const numbers = el("div", { class: "stack", "data-testid": "body-facts" });
  const picture = responsive((width) => {
    const body = app.body.get();
    return body ? bodyPicture(body, { width, height: 430 }) : null;
  });
  const pictureCard = card("To scale", refusal, picture, warnings, pictureTools(app, "body"));
  const numbersCard = card("Numbers", numbers);
  const form = createForm(app);
  const editor = el("div", { class: "editor-place" });
  fill(section,
    el("header", { class: "view-head" },
      el("h1", {}, "What rocks?"),
      el(
        "p", { class: "lead" },
        "Type its sizes, draw it, paste its points or drop a drawing. Everything beside follows at once.",
      )),
    el("div", { class: "body-columns" },
      el("div", { class: "area-form" }, card("Outline and size", form.element)),
      el(
        "div", { class: "area-results stack" }, editor,
        el("div", { class: "columns two" }, pictureCard, numbersCard),
      ),
      el("div", { class: "area-file" }, card("From a file", dropZone(app)))));

  const drawing = mountEditor(editor, app);
  app.inputs.subscribe((_, changed) => changed.has("body") && form.follow());
  let said = "";
  const look = () => {
    const wrong = app.body.error()?.message ?? "";
    const typed = app.faults.sentence({ view: "body", but: wrong });
    for (const each of [pictureCard, numbersCard]) each.classList.toggle("stale", Boolean(wrong || typed));
    form.refuse(app.body.error());
    if (said === wrong + typed) return;
    said = wrong + typed;
    fill(refusal, wrong ? note(wrong, "error") : null,
      typed ? note(`${typed} ${OLDER}`, "warning") : null);
  };
  app.faults.subscribe(look);
  app.body.subscribe((body) => {
    look();
    drawing.follow();
    if (!body) return;
    picture.redraw();
    fill(warnings, warningsOf(body));
    fill(numbers, factsTable(body, app));
  });
  return { shown: () => shapeOf(app.inputs.get().body) === "section" && drawing.follow() };
};
