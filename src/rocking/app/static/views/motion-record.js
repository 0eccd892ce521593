/** A record file: dropped or chosen, with what it does not say asked for. */
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

/** What stands of the files that were given last: `take(files)` sends them, `onChange(motion)` hears when it is read.
 * @param {App} app @param {(motion: Server.MotionInput) => unknown} onChange */
export const createRecord = (app, onChange) => {
  const [said, asked, blamed, waiting, answer] = [null, null, null, false, null].map(signal);
  /** @type {any} */
  let held = null; // the file, its content, and what was answered about it

  /** @param {object} [given] */
  const send = async (given) => {
    const sent = held;
    Object.assign(sent.given, given);
    said.value = { words: t("Reading {name}", { name: sent.file.name }) };
    try {
      sent.content ??= await contentOf(sent.file);
      const query = { name: sent.file.name, ...picked(sent.given, TOLD) };
      const found = await app.call("records", { method: "POST", body: sent.content, query });
      if (sent === held) batch(() => took(found));
    } catch (error) {
      if (sent === held) batch(() => refuse(error));
    }
  };
  // the components are chosen here, the server is not asked again
  /** @param {Need[]} needs */
  const enough = (needs) => needs.every((one) => one === "component") && held.given.component !== undefined;
  /** @param {Server.RecordFacts} found */
  const took = (found) => {
    if (found.needs.length && !enough(found.needs)) {
      said.value = { words: sentence(found.message), kind: "warning" };
      return ask(found);
    }
    answer.value = found;
    end(found.doubts ? { words: t("Check the input: {doubts}.", { doubts: found.doubts }), kind: "warning" } : {}, "read");
    onChange({ record: found.record, file_name: found.file_name, ...picked(held.given, [...TOLD, "component"]) });
    return app.say(t("{name} is read.", { name: found.file_name }));
  };
  /** @param {LeftOpen} found */
  const ask = (found) => ([asked.value, blamed.value, waiting.value] = [{ answer: found, given: { ...held.given } }, null, true]);
  /** @param {object} words @param {string} as */
  const end = (words, as) => ([said.value, asked.value, waiting.value] = [{ ...words, as }, null, false]);
  /** @param {string} words @param {any[]} [places] */
  const why = (words, places = []) => {
    const stays = app.inputs.get().motion ? ` ${t("The motion is unchanged.")}` : "";
    const named = places.some(({ kind }) => kind === "file") ? t("The file {refusal}", { refusal: words }) : words;
    return { words: `${sentence(named)}${stays}`, kind: "error" };
  };
  // What was answered stays as it was typed, with the refusal beside the field that it is about.
  /** @param {any} error */
  const refuse = ({ message, ...error }) => {
    if (!asked.value || error.needs?.length) {
      end(why(message, error.places), "unread");
      if (error.needs?.length) ask({ message, ...error });
      return;
    }
    blamed.value = blamedOf(asked.value.answer.needs, error, message);
    said.value = blamed.value ? null : why(message, error.places);
  };
  // Counts are no accelerations without their StationXML: both go to the step that reads them together.
  /** @param {File[]} files */
  const together = async (files) => {
    try {
      const sent = await Promise.all(files.map((file) => sendFile(app, file)));
      const [stations, records] = [true, false].map((are) => sent.filter(({ name }) => isStations(name) === are));
      const form = app.forms.of("records", { files: [], steps: [] });
      const { files: before, steps } = form.value;
      form.at("files").value = [...before.filter((/** @type {SentFile} */ { sha, name }) => sent.every((one) => one.sha !== sha && one.name !== name)), ...sent];
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
    held = { file, content: null, given: {} };
    if (files.length > 1) return end({ words: "A motion is one record. Add several records in the step Records.", kind: "error" }, "unread");
    [asked.value, waiting.value] = [null, true];
    const most = app.info.limits?.upload_bytes;
    if (!most || file.size <= most) return send();
    return end(why(t("{name} exceeds the limit of {size} MiB.", { name: file.name, size: Math.round(most / 2 ** 20) })), "unread");
  };
  const forget = () => batch(() => {
    held = null;
    [said.value, asked.value, blamed.value, waiting.value] = [null, null, null, false];
  });
  return { said, asked, blamed, waiting, answer, take, send, forget };
};

/** The editor of a record; `lost`: the server no longer has the file.
 * @param {{ app: App, record: ReturnType<typeof createRecord>, motion: Server.MotionInput | null, lost: boolean, onChange: (motion: Server.MotionInput) => unknown }} props */
export const Record = ({ app, record, motion, lost, onChange }) => {
  const { said, asked, blamed, answer } = record;
  const place = useRef(null);
  /** @param {string} selector */
  const focus = (selector) => place.current.querySelector(selector)?.focus();
  const before = useRef([said.value, asked.value]);
  useLayoutEffect(() => {
    const [words, form] = before.current;
    before.current = [said.value, asked.value];
    if (asked.value && asked.value !== form) return focus(".record-form :is(input, select)");
    if (said.value === words || document.activeElement !== document.body) return undefined;
    return focus(FOCUSED[said.value?.as] ?? "none"); // what was pressed is gone
  }, [said.value, asked.value]);
  const formats = app.info.formats.map(({ name }) => name).join(", ");
  const known = answer.value?.record === motion?.record;
  useEffect(() => void (motion && rememberTold(motion)), [motion]);
  useEffect(() => {
    if (known || !motion) return;
    // what a file holds that was sent before this page was loaded; a motion that is refused says so itself
    /** @param {Server.RecordFacts} found */
    const learn = (found) => app.inputs.get().motion?.record === motion.record && (answer.value = found);
    app.call(`records/${motion.record}`, { query: picked(motion, TOLD) }).then(learn, () => {});
  }, [motion?.record]);
  return html`
    <div ref=${place} class="record-editor">
      <${Drop} label="Drop a record here, or" name="Record file" many folders=${false} on=${record.take} testid="record-file" data-testid="record-drop">
        <p class="field-help">${t("Formats: {formats}. For counts (miniSEED), add the StationXML file.", { formats })}</p><//>
      <div aria-live="polite" data-testid="record-answer">
        ${said.value?.words && html`<${Note} ...${said.value} />`}
        ${lost && html`<${Note} kind="warning" words="The server no longer has this file. Add the file again." />`}</div>
      <div data-testid="record-needs">
        ${asked.value && html`<${Needs} key=${asked.value} ...${asked.value} class="record-form" info=${app.info} blamed=${blamed.value}
          button=${{ kind: "primary" }} take=${record.send} />`}</div>
      <div class="record-held" data-testid="record-held">${motion && html`
        <p class="record-name" tabindex="-1" translate=${!motion.file_name}>${motion.file_name || t("record {number}", { number: motion.record?.slice(0, 12) })}</p>
        <${Components} names=${known ? (answer.value.components ?? []).map((/** @type {any} */ one) => one.name) : []} motion=${motion} onChange=${onChange} />`}
      </div>
    </div>`;
};
