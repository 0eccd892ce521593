/** Record file: dropped or chosen, with a form for its missing data. */
import { batch, html, signal, useEffect, useLayoutEffect, useRef } from "/parts/preact.js";
import { contentOf } from "/app/file-content.js";
import { freshId } from "/app/dom.js";
import { Drop } from "/parts/drop.js";
import { Note, sentence } from "/parts/fields.js";
import { sendFile } from "/questions/asking.js";
import { Components } from "/views/motion-components.js";
import { Needs, blamedOf } from "/views/motion-record-needs.js";
import { rememberTold } from "/views/motion-told.js";
import { t } from "/app/words.js";

/** @type {Words} */
const FOCUSED = { read: ".record-name", unread: ".drop button" };
const TOLD = ["format", "units", "time_step"];

/** @param {any} from @param {string[]} keys @returns {any} */
const picked = (from, keys) => Object.fromEntries(keys.filter((key) => from[key] !== undefined).map((key) => [key, from[key]]));

/** @param {string} name */
const isStations = (name) => /\.xml$/i.test(name);

/** State of the last uploaded files: `take(files)` uploads them, `onChange(motion)` is called after the import.
 * @param {App} app @param {(motion: Server.MotionInput) => unknown} onChange */
export const createRecord = (app, onChange) => {
  const [status, openNeeds, blamed, waiting, answer] = [null, null, null, false, null].map(signal);
  /** @type {any} */
  let held = null; // the file, its content, and the given data

  /** @param {object} [statement] */
  const send = async (statement) => {
    const sent = held;
    Object.assign(sent.stated, statement);
    status.value = { text: t("Reading {name}", { name: sent.file.name }) };
    try {
      sent.content ??= await contentOf(sent.file);
      const query = { name: sent.file.name, ...picked(sent.stated, TOLD) };
      const facts = await app.call("records", { method: "POST", body: sent.content, query });
      if (sent === held) batch(() => took(facts));
    } catch (error) {
      if (sent === held) batch(() => refuse(error));
    }
  };
  // the components are chosen here, without a request
  /** @param {Need[]} needs */
  const enough = (needs) => needs.every((need) => need === "component") && held.stated.component !== undefined;
  /** @param {Server.RecordFacts} facts */
  const took = (facts) => {
    if (facts.needs.length && !enough(facts.needs)) {
      status.value = { text: sentence(facts.message), kind: "warning" };
      return ask(facts);
    }
    answer.value = facts;
    end(facts.doubts ? { text: t("Check the input: {doubts}.", { doubts: facts.doubts }), kind: "warning" } : {}, "read");
    onChange({ record: facts.record, file_name: facts.file_name, ...picked(held.stated, [...TOLD, "component"]) });
    return app.say(t("{name} is read.", { name: facts.file_name }));
  };
  /** @param {LeftOpen} facts */
  const ask = (facts) => ([openNeeds.value, blamed.value, waiting.value] = [{ answer: facts, initial: { ...held.stated } }, null, true]);
  /** @param {object} note @param {string} as */
  const end = (note, as) => ([status.value, openNeeds.value, waiting.value] = [{ ...note, as }, null, false]);
  /** @param {string} text @param {any[]} [places] */
  const reasonNote = (text, places = []) => {
    const stays = app.inputs.get().motion ? ` ${t("The motion is unchanged.")}` : "";
    const named = places.some(({ kind }) => kind === "file") ? t("The file {refusal}", { refusal: text }) : text;
    return { text: `${sentence(named)}${stays}`, kind: "error" };
  };
  // Given data are kept as typed, with the error next to its field.
  /** @param {any} error */
  const refuse = ({ message, ...error }) => {
    if (!openNeeds.value || error.needs?.length) {
      end(reasonNote(message, error.places), "unread");
      if (error.needs?.length) ask({ message, ...error });
      return;
    }
    blamed.value = blamedOf(openNeeds.value.answer.needs, error, message);
    status.value = blamed.value ? null : reasonNote(message, error.places);
  };
  // Counts become accelerations with their StationXML file. One step receives both files.
  /** @param {File[]} files */
  const together = async (files) => {
    try {
      const sent = await Promise.all(files.map((file) => sendFile(app, file)));
      const [stations, records] = [true, false].map((are) => sent.filter(({ name }) => isStations(name) === are));
      const form = app.forms.of("records", { files: [], steps: [] });
      const { files: before, steps } = form.value;
      form.at("files").value = [...before.filter((/** @type {SentFile} */ { sha, name }) => sent.every((file) => file.sha !== sha && file.name !== name)), ...sent];
      form.at("steps").value = [{ name: "response", id: freshId("step"), keys: { stations: stations[0].name } },
        ...steps.filter((/** @type {RecordStep} */ { name }) => name !== "response")];
      form.at("shown").value = records[0].name;
      app.go("records");
      app.say(t("{name} and its StationXML file are added. Select Compute, then use the result as the motion.", { name: records[0].name }));
    } catch (error) {
      app.say(error.message, "error");
    }
  };
  /** @param {File[]} files */
  const take = (files) => {
    const [file] = files;
    const described = files.filter(({ name }) => isStations(name)).length;
    if (described && described < files.length) {
      forget();
      return together(files);
    }
    held = { file, content: null, stated: {} };
    if (files.length > 1) return end({ text: "A motion is one record. Add several records in the step Records.", kind: "error" }, "unread");
    [openNeeds.value, waiting.value] = [null, true];
    const most = app.info.limits?.upload_bytes;
    if (!most || file.size <= most) return send();
    return end(reasonNote(t("{name} exceeds the limit of {size} MiB.", { name: file.name, size: Math.round(most / 2 ** 20) })), "unread");
  };
  const forget = () => batch(() => {
    held = null;
    [status.value, openNeeds.value, blamed.value, waiting.value] = [null, null, null, false];
  });
  return { status, openNeeds, blamed, waiting, answer, take, send, forget };
};

/** The editor of a record; `lost`: the server no longer has the file.
 * @param {{ app: App, record: ReturnType<typeof createRecord>, motion: Server.MotionInput | null, lost: boolean, onChange: (motion: Server.MotionInput) => unknown }} props */
export const Record = ({ app, record, motion, lost, onChange }) => {
  const { status, openNeeds, blamed, answer } = record;
  const editor = useRef(null);
  /** @param {string} selector */
  const focus = (selector) => editor.current.querySelector(selector)?.focus();
  const before = useRef([status.value, openNeeds.value]);
  useLayoutEffect(() => {
    const [note, form] = before.current;
    before.current = [status.value, openNeeds.value];
    if (openNeeds.value && openNeeds.value !== form) return focus(".record-form :is(input, select)");
    if (status.value === note || document.activeElement !== document.body) return undefined;
    return focus(FOCUSED[status.value?.as] ?? "none"); // the pressed control is removed
  }, [status.value, openNeeds.value]);
  const formats = app.info.formats.map(({ name }) => name).join(", ");
  const isAnswered = answer.value?.record === motion?.record;
  useEffect(() => void (motion && rememberTold(motion)), [motion]);
  useEffect(() => {
    if (isAnswered || !motion) return;
    // requests the data of a file that was uploaded before this page was loaded
    /** @param {Server.RecordFacts} facts */
    const learn = (facts) => app.inputs.get().motion?.record === motion.record && (answer.value = facts);
    app.call(`records/${motion.record}`, { query: picked(motion, TOLD) }).then(learn, () => {});
  }, [motion?.record]);
  return html`
    <div ref=${editor} class="record-editor">
      <${Drop} label="Drop a record here, or" name="Record file" many folders=${false} on=${record.take} testid="record-file" data-testid="record-drop">
        <p class="field-help">${t("Formats: {formats}. For counts (miniSEED), add the StationXML file.", { formats })}</p><//>
      <div aria-live="polite" data-testid="record-answer">
        ${status.value?.text && html`<${Note} ...${status.value} />`}
        ${lost && html`<${Note} kind="warning" text="The server no longer has this file. Add the file again." />`}</div>
      <div data-testid="record-needs">
        ${openNeeds.value && html`<${Needs} key=${openNeeds.value} ...${openNeeds.value} class="record-form" info=${app.info} blamed=${blamed.value}
          button=${{ kind: "primary" }} take=${record.send} />`}</div>
      <div class="record-held" data-testid="record-held">${motion && html`
        <p class="record-name" tabindex="-1" translate=${!motion.file_name}>${motion.file_name || t("record {number}", { number: motion.record?.slice(0, 12) })}</p>
        <${Components} names=${isAnswered ? (answer.value.components ?? []).map((/** @type {any} */ component) => component.name) : []} motion=${motion} onChange=${onChange} />`}
      </div>
    </div>`;
};
