/** A record file: dropped or chosen, with what it does not say asked for. */
import { el, fill } from "/app/dom.js";
import { button, note } from "/app/fields.js";
import { componentFields } from "/views/motion-components.js";
import { answersOf, questionsOf } from "/views/motion-record-needs.js";
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
      onchange: () => this.take(input.files[0]),
    });
    const choose = button({ text: "Choose a file", kind: "primary", onClick: () => input.click() });
    const words = 
      "PEER, ESM, COSMOS, CSMIP, USGS, K-NET, CWA, GeoNet, BHRC, SAC, columns, " +
      "and miniSEED that holds accelerations (counts need a StationXML, which is not read here)";
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
  take(file) {
    if (!file) return;
    this.file = file;
    this.given = {};
    fill(this.asked);
    this.wait(true);
    this.send();
  }

  wait(on) {
    this.waiting = on;
    this.onWait?.();
  }

  async send() {
    const most = this.app.info.limits?.upload_bytes;
    if (most && this.file.size > most) {
      const room = Math.round(most / 2 ** 20);
      const words = `${this.file.name} is larger than the ${room} MiB that the server takes.`;
      return this.unread(words);
    }
    fill(this.said, note(`Reading ${this.file.name}`));
    try {
      const query = { name: this.file.name, ...this.told() };
      this.took(await this.app.call("records", { method: "POST", body: this.file, query }));
    } catch (error) {
      this.unread(error.message);
      if (error.needs?.length) this.ask(error);
    }
    return undefined;
  }

  /** Says why a file was not read; what was asked about an earlier one goes with it. */
  unread(words) {
    const stays = this.app.inputs.get().motion ? " The motion stays as it was." : "";
    const named = words.startsWith(`${this.file.name}:`) ? `The file ${words}` : words;
    fill(this.said, note(`${named.replace(/([^.?!])$/, "$1.")}${stays}`, "error"));
    const lost = this.asked.contains(document.activeElement);
    fill(this.asked);
    if (lost) this.chooser.focus();
    this.wait(false);
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
