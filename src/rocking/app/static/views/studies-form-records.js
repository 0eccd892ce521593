/** The uploaded records, to be ticked for a study, told what they do not say, and deleted. */
import { el, fill } from "/app/dom.js";
import { button } from "/app/fields.js";
import { quantity } from "/app/format.js";
import { allAnswered, answersOf, questionsOf } from "/views/motion-record-needs.js";
import { forgetTold, rememberTold, toldOf } from "/views/motion-told.js";

const EMPTY = "No record has been uploaded yet: drop some files in the step Motion.";

/** List of the records; `tables` gives those that are ticked as motions of a job. */
export const recordChoice = (app) => {
  const list = el("ul", { class: "record-list", "aria-label": "Uploaded records" });
  const words = el("p", { class: "quiet", "aria-live": "polite" });
  const node = el("div", { class: "question", "data-testid": "record-choice" }, words, list);
  const rows = new Map();

  const count = () => {
    const ticked = [...rows.values()].filter((row) => row.ticked()).length;
    fill(words, rows.size ? `${ticked} of ${rows.size} records are taken.` : EMPTY);
  };
  const refresh = async () => {
    try {
      const answer = await app.call("records");
      const stored = answer.records ?? answer;
      const there = new Set(stored.map(({ record }) => record));
      for (const record of [...rows.keys()]) if (!there.has(record)) rows.delete(record);
      const fresh = stored.filter(({ record }) => !rows.has(record));
      for (const one of fresh) rows.set(one.record, rowOf(app, one, count, gone));
      fill(list, ...stored.map(({ record }) => rows.get(record).node));
      count();
      for (const { record } of stored) await rows.get(record)?.look();
    } catch (error) {
      fill(words, error.message);
    }
  };
  const gone = (record) => {
    rows.delete(record);
    forgetTold(record);
    refresh();
    list.querySelector("input, button")?.focus();
  };
  const tables = () => {
    const taken = [...rows.values()].filter((row) => row.ticked());
    if (!rows.size) throw new Error(EMPTY);
    if (!taken.length) throw new Error("No record is ticked: tick at least one.");
    return together(taken.map((row) => row.table()));
  };
  return { node, refresh, tables };
};

/** Records that were told the same stand in one table. */
const together = (tables) => {
  const found = new Map();
  for (const { records, ...told } of tables) {
    const key = JSON.stringify(told);
    found.set(key, { records: [...(found.get(key)?.records ?? []), ...records], ...told });
  }
  return [...found.values()];
};

const nameOf = (one) => one.name || one;

const rowOf = (app, { record, file_name: name }, onChange, onGone) => {
  const box = el("input", { type: "checkbox", checked: true, onchange: onChange });
  const about = el("span", { class: "quiet" });
  const asked = el("div", { class: "record-asked" });
  let open = true;
  let wanted = true;

  const show = (found, told) => {
    const missing = (found.needs ?? []).filter((one) => told[nameOf(one)] === undefined);
    open = missing.length > 0;
    box.disabled = open;
    box.checked = !open && wanted;
    fill(about, open ? "something must still be told:" : factsOf(found, told));
    fill(asked, open ? form(found, missing, told) : null);
    onChange();
  };
  const look = async () => {
    const told = toldOf(record);
    const { format, units, time_step } = told;
    try {
      show(await app.call(`records/${record}`, { query: { format, units, time_step } }), told);
    } catch (error) {
      box.checked = false;
      box.disabled = true;
      fill(about, error.message);
      onChange();
    }
  };
  const form = (found, missing, told) => {
    const questions = questionsOf({ ...found, needs: missing }, app.info, told);
    const take = async () => {
      if (!allAnswered(questions)) return;
      rememberTold({ record, ...told, ...answersOf(questions) });
      await look();
      (box.disabled ? asked.querySelector("input, select") : box)?.focus();
    };
    const go = button({ text: "Read it so", label: `Read ${name} so`, onClick: take });
    return [...questions.map(({ field }) => field), go];
  };
  const remove = async () => {
    if (!window.confirm(`Delete \u201c${name}\u201d from this server?`)) return;
    try {
      await app.call(`records/${record}`, { method: "DELETE" });
      app.say(`${name} is deleted.`);
      onGone(record);
    } catch (error) {
      app.say(error.message, "error");
    }
  };
  box.addEventListener("change", () => (wanted = box.checked));
  const node = el(
    "li",
    { class: "record-row" },
    el("label", { class: "record-tick" }, box, el("span", {}, name)),
    button({ text: "Delete", kind: "quiet", label: `Delete ${name}`, onClick: remove }),
    about,
    asked,
  );
  return {
    node,
    look,
    ticked: () => box.checked && !box.disabled && !open,
    table: () => ({ records: [record], ...toldOf(record) }),
  };
};

const factsOf = ({ components = [] }, { units, component, vertical }) => {
  const chosen = components.find(({ name }) => name === component) ?? components[0];
  const step = chosen?.time_step_s;
  return [
    component,
    vertical && `${vertical} upwards`,
    units && `in ${units}`,
    step ? `every ${quantity(step, "s")}` : null,
  ]
    .filter(Boolean)
    .join(", ");
};
