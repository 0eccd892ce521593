/** A record file: dropped or chosen, with what it does not say asked for. */
import { el, fill } from "/app/dom.js";
import { button, note, selectField } from "/app/fields.js";
import { answersOf, questionsOf } from "/views/motion-record-needs.js";

const TOLD = ["format", "units", "time_step"];

/** Returns the editor of a record. */
export const recordEditor = (app, onChange) => new RecordEditor(app, onChange);

class RecordEditor {
  constructor(app, onChange) {
    this.app = app;
    this.onChange = onChange;
    this.file = null;
    this.said = el("div", { "aria-live": "polite", "data-testid": "record-answer" });
    this.asked = el("div", { "data-testid": "record-needs" });
    this.held = el("div", { class: "record-held", "data-testid": "record-held" });
    this.element = el("div", { class: "record-editor" }, this.dropZone(), this.said, this.asked, this.held);
  }

  dropZone() {
    const input = el("input", {
      type: "file",
      class: "visually-hidden",
      "aria-label": "Record file",
      "data-testid": "record-file",
      tabindex: "-1",
      onchange: () => this.take(input.files[0]),
    });
    const choose = button({ text: "Choose a file", kind: "primary", onClick: () => input.click() });
    const words = "PEER, ESM, COSMOS, CSMIP, USGS, K-NET, CWA, GeoNet, BHRC, miniSEED, SAC or columns";
    const zone = el(
      "div",
      { class: "drop", "data-testid": "record-drop" },
      el("p", {}, "Drop a record here, or"),
      choose,
      input,
      el("p", { class: "field-help" }, words),
    );
    const mark = (over) => (event) => {
      event.preventDefault();
      zone.classList.toggle("over", over);
    };
    zone.addEventListener("dragover", mark(true));
    zone.addEventListener("dragleave", mark(false));
    zone.addEventListener("drop", (event) => {
      mark(false)(event);
      this.take(event.dataTransfer.files[0]);
    });
    return zone;
  }

  /** Sends a file that the user gave. */
  take(file) {
    if (!file) return;
    this.file = file;
    this.given = {};
    this.send();
  }

  async send() {
    const most = this.app.info.limits?.upload_bytes;
    if (most && this.file.size > most) {
      const room = Math.round(most / 2 ** 20);
      const words = `${this.file.name} is larger than the ${room} MiB that the server takes.`;
      return fill(this.said, note(words, "error"));
    }
    fill(this.said, note(`Reading ${this.file.name}`));
    try {
      const query = { name: this.file.name, ...this.told() };
      this.took(await this.app.call("records", { method: "POST", body: this.file, query }));
    } catch (error) {
      fill(this.said, note(error.message, "error"));
      if (error.needs?.length) this.ask(error);
    }
    return undefined;
  }

  told() {
    return Object.fromEntries(Object.entries(this.given).filter(([key]) => TOLD.includes(key)));
  }

  took(answer) {
    this.answer = answer;
    if (answer.needs?.length && !this.enough(answer)) {
      fill(this.said, note(`${answer.message.split("; say ")[0]}.`, "warning"));
      this.ask(answer);
      return;
    }
    fill(this.asked);
    fill(this.said);
    this.choose();
  }

  // the components are chosen here, the server is not asked again
  enough({ needs }) {
    return needs.every((one) => (one.name || one) === "component") && this.given.component !== undefined;
  }

  ask(answer) {
    const questions = questionsOf(answer, this.app.info, this.given);
    const go = button({
      text: "Read it so",
      kind: "primary",
      onClick: () => {
        this.given = { ...this.given, ...answersOf(questions) };
        this.send();
      },
    });
    const form = el("form", { class: "record-form" }, ...questions.map(({ field }) => field), go);
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      go.click();
    });
    fill(this.asked, form);
    form.querySelector("input, select")?.focus();
  }

  choose() {
    const { record, file_name } = this.answer;
    const motion = { record, file_name };
    for (const key of [...TOLD, "component"]) {
      if (this.given[key] !== undefined) motion[key] = this.given[key];
    }
    this.onChange(motion);
    this.app.say(`${file_name} is read.`);
  }

  /** Shows which record is the motion. */
  show(motion) {
    const name = motion.file_name || `record ${motion.record.slice(0, 12)}`;
    const choices = this.answer?.record === motion.record ? this.componentChoices(motion) : [];
    fill(this.held, el("p", { class: "record-name" }, name), ...choices);
  }

  componentChoices(motion) {
    const components = (this.answer.components || []).map(({ name }) => name);
    if (components.length < 2) return [];
    const options = components.map((name) => ({ value: name, text: name }));
    const none = { value: "", text: "none" };
    const main = selectField({
      label: "Horizontal component",
      options,
      value: motion.component ?? components[0],
      onChange: (component) => this.onChange({ ...motion, component }),
    });
    const vertical = selectField({
      label: "Vertical component",
      options: [none, ...options],
      value: motion.vertical ?? "",
      onChange: (name) => this.onChange(name ? { ...motion, vertical: name } : without(motion, "vertical")),
    });
    return [main, vertical];
  }

  /** Nothing is chosen of itself: a file has to be given. */
  usual() {
    return null;
  }

  /** Says what to do when the server no longer has the file. */
  refused(error) {
    const words = "The server no longer has this file: drop it once more.";
    if (error.status === 404) fill(this.said, note(words, "warning"));
  }
}

const without = (given, key) => Object.fromEntries(Object.entries(given).filter(([name]) => name !== key));
