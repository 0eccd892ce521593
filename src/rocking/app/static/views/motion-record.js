/** A record file: dropped or chosen, with what it does not say asked for. */
import { el, fill } from "/app/dom.js";
import { button, note } from "/app/fields.js";
import { contentOf } from "/app/file-content.js";
import { componentFields } from "/views/motion-components.js";
import { allAnswered, answersOf, blamed, questionsOf } from "/views/motion-record-needs.js";
import { rememberTold } from "/views/motion-told.js";

const TOLD = ["format", "units", "time_step"];

/** Returns the editor of a record; `onWait` hears when a file begins or ends to wait for answers. */
export const recordEditor = (app, onChange, onWait) => new RecordEditor(app, onChange, onWait);

const labelOf = (input) => (input ? input.closest(".field")?.querySelector("label").textContent ?? "" : null);

class RecordEditor {
  constructor(app, onChange, onWait) {
    this.app = app;
    this.onChange = onChange;
    this.onWait = onWait;
    this.waiting = false;
    this.file = null;
    this.questions = [];
    this.said = el("div", { "aria-live": "polite", "data-testid": "record-answer" });
    this.asked = el("div", { "data-testid": "record-needs" });
    this.name = el("p", { class: "record-name", tabindex: "-1" });
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
      onchange: () => {
        const [file] = input.files;
        input.value = ""; // or the same file, mended, could not be chosen again
        this.take(file);
      },
    });
    const choose = button({ text: "Choose a file", kind: "primary", onClick: () => input.click() });
    const formats = this.app.info.formats.map(({ name }) => name).join(", ");
    const words =
      `Formats: ${formats}. miniSEED must hold accelerations: counts need a StationXML, which is not read here.`;
    this.chooser = choose;
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
  async take(file) {
    if (!file) return undefined;
    [this.file, this.content, this.given] = [file, null, {}];
    this.forget();
    this.wait(true);
    const most = this.app.info.limits?.upload_bytes;
    if (most && file.size > most) {
      const room = Math.round(most / 2 ** 20);
      return this.unread(`${file.name} is larger than the ${room} MiB that the server takes.`);
    }
    return this.send();
  }

  /** Takes away what was asked about an earlier file. */
  forget() {
    const lost = this.asked.contains(document.activeElement);
    this.questions = [];
    fill(this.asked);
    if (lost) this.chooser.focus();
  }

  wait(on) {
    this.waiting = on;
    this.onWait?.();
  }

  async send() {
    const { file } = this;
    fill(this.said, note(`Reading ${file.name}`));
    try {
      this.content ??= await contentOf(file);
      const query = { name: file.name, ...this.told() };
      const answer = await this.app.call("records", { method: "POST", body: this.content, query });
      if (file === this.file) this.took(answer);
    } catch (error) {
      if (file === this.file) this.refuse(error);
    }
  }

  /** What was answered stays as it was typed, with the refusal beside the field that it is about. */
  refuse(error) {
    if (error.needs?.length) {
      this.unread(error.message);
      this.ask(error);
    } else if (!this.questions.length) {
      this.unread(error.message);
    } else if (blamed(this.questions, error.message)) {
      fill(this.said);
    } else {
      this.tellWhy(error.message);
    }
  }

  /** Says why a file was not read; what was asked about an earlier one goes with it. */
  unread(words) {
    this.tellWhy(words);
    this.forget();
    this.wait(false);
  }

  tellWhy(words) {
    const stays = this.app.inputs.get().motion ? " The motion stays as it was." : "";
    const named = words.startsWith(`${this.file.name}:`) ? `The file ${words}` : words;
    fill(this.said, note(`${named.replace(/([^.?!])$/, "$1.")}${stays}`, "error"));
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
    this.questions = [];
    fill(this.asked);
    fill(this.said, ...(answer.doubts ? [note(`Check the input: ${answer.doubts}.`, "warning")] : []));
    this.choose();
  }

  // the components are chosen here, the server is not asked again
  enough({ needs }) {
    return needs.every((one) => (one.name || one) === "component") && this.given.component !== undefined;
  }

  ask(answer) {
    const questions = questionsOf(answer, this.app.info, this.given);
    this.questions = questions;
    const go = button({
      text: "Read it so",
      kind: "primary",
      onClick: () => {
        if (!allAnswered(questions)) return;
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
    this.wait(true);
    form.querySelector("input, select")?.focus();
  }

  choose() {
    const { record, file_name } = this.answer;
    const motion = { record, file_name };
    for (const key of [...TOLD, "component"]) {
      if (this.given[key] !== undefined) motion[key] = this.given[key];
    }
    this.wait(false);
    this.onChange(motion);
    this.app.say(`${file_name} is read.`);
    // the button that was pressed is gone
    if (document.activeElement === document.body) this.name.focus();
  }

  /** Shows which record is the motion. */
  show(motion) {
    rememberTold(motion);
    this.shown = motion;
    fill(this.name, motion.file_name || `record ${motion.record.slice(0, 12)}`);
    const known = this.answer?.record === motion.record;
    const names = known ? (this.answer.components || []).map(({ name }) => name) : [];
    const before = labelOf(this.held.contains(document.activeElement) && document.activeElement);
    const fields = componentFields(names, motion, (next) => this.onChange(next));
    fill(this.held, this.name, ...fields);
    if (before !== null) (fields.find((one) => labelOf(one.input) === before)?.input ?? this.name).focus();
    if (!known) this.lookUp(motion);
  }

  /** Asks what a file holds that was sent before this page was loaded. */
  async lookUp({ record, format, units, time_step }) {
    if (this.asking === record) return;
    this.asking = record;
    try {
      const found = await this.app.call(`records/${record}`, { query: { format, units, time_step } });
      if (this.shown?.record !== record) return;
      this.answer = found;
      this.show(this.shown);
    } catch {
      // the motion itself is refused in words
    } finally {
      this.asking = null;
    }
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
