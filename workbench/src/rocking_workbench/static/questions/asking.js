/** Runs longer than a request: started, followed, stopped and reopened. */

import { computed, signal } from "/parts/preact.js";

const [SOON, EVERY] = [100, 500]; // intervals between requests for the state of a run, first and last [ms]
const ENDED = new Set(["done", "refused", "stopped"]);

/** Runs of some commands in the open project; the default command is the first.
 * @param {App} app @param {...string} commands */
export const createQuestions = (app, ...commands) => {
  /** @type {Signal<Server.WholeQuestion | null>} */
  const shown = signal(null);
  /** @type {Signal<Server.QuestionFacts[]>} */
  const all = signal([]);
  let timer = 0;
  let ticket = 0;
  let mine = ""; // id of the last started run, while it is shown
  const here = () => app.project.here.value.id;
  computed(here).subscribe(() => { // results remain in their project
    ticket += 1;
    clearTimeout(timer);
    mine = "";
    [shown.value, all.value] = [null, []];
  });
  const busy = computed(() => shown.value && !ENDED.has(shown.value.state));

  const look = async () => {
    const { questions } = await app.call("questions");
    all.value = questions.filter((question) => commands.includes(question.command) && question.project === here());
  };
  /** @param {string} id @param {number} [mine] @param {number} [pause] */
  const follow = async (id, mine = (ticket += 1), pause = SOON) => {
    clearTimeout(timer);
    const question = await app.call(`questions/${id}`).catch((error) => {
      if (error.kind !== "offline") throw error;
      return null; // the server restarts and continues the run
    });
    if (mine !== ticket) return; // another run is shown now
    if (question) shown.value = question;
    if (question && ENDED.has(question.state)) await look();
    else timer = setTimeout(() => follow(id, mine, Math.min(EVERY, 1.5 * pause)).catch(tell), pause);
  };
  /** @param {any} error */
  const tell = (error) => app.say(error.message, "error");
  /** @type {<Given extends any[]>(work: (...given: Given) => Promise<unknown>) => (...given: Given) => Promise<unknown>} */
  const safely = (work) => (...args) => work(...args).catch(tell);

  return {
    app, shown, all, busy,
    /** True if a run was started from the present form. @param {string} id */
    isOfForm: (id) => id === mine,
    look: safely(look),
    /** Request the state, and show the last run after a reload. */
    reopen: safely(async () => {
      await look();
      if (!shown.value && all.value.length) await follow(all.value[0].id);
    }),
    ask: safely(async (tables, files, name, { command = commands[0], format = "", project = here() } = {}) => {
      const projectId = here();
      shown.value = null;
      await app.project.save();
      const json = { command, tables, files, name, format, project };
      const question = await app.call("questions", { json });
      if (projectId !== here()) return; // the run belongs to the project in which it was started
      mine = question.id;
      shown.value = { ...question, answer: null, toml: "" };
      await follow(question.id);
    }),
    open: safely(async (/** @type {string} */ id) => {
      [shown.value, mine] = [null, ""];
      await follow(id);
    }),
    stop: safely(async () => {
      if (!shown.value) return;
      await app.call(`questions/${shown.value.id}/stop`, { method: "POST" });
      await follow(shown.value.id);
    }),
    remove: safely(async (/** @type {string} */ id) => {
      await app.call(`questions/${id}`, { method: "DELETE" });
      if (shown.value?.id === id) shown.value = null;
      await look();
    }),
    /** @param {File} file */
    send: (file) => sendFile(app, file),
    /** @param {string} name */
    take: (name) => app.download(`questions/${shown.value?.id}/${name}`, undefined, name),
  };
};

/** Upload a file for runs; resolves to its hash and its name in tables.
 * @param {App} app @param {File} file @returns {Promise<SentFile>} */
export const sendFile = async (app, file) => {
  const kept = await app.project.within(file.arrayBuffer().then((body) => app.call("files", { method: "POST", body, query: { name: file.name } })));
  atHand.set(kept.record, file);
  return { name: apart(kept.file_name, kept.record), sha: kept.record };
};

const atHand = new Map();

/** File uploaded by this tab, by its hash; undefined for other files. @param {string} sha */
export const fileAtHand = (sha) => atHand.get(sha);

// Names of results.
const TAKEN = /^(inventory|table|report|picture|space|answer|state|log|question|record|provenance)\.|^(matplotlibrc|records$)/i;
/** @param {string} name @param {string} sha */
const apart = (name, sha) => (TAKEN.test(name) ? `${sha.slice(0, 8)}-${name}` : name);

/** Motion of the inputs in the form of a run, and its files. @param {Server.Inputs} inputs */
export const motionOf = (inputs) => {
  if (!inputs.motion) return null;
  const { record, file_name: name, ...keys } = inputs.motion;
  if (!record) return { tables: { motion: keys }, files: {} };
  const called = plainName(name, record);
  return { tables: { motion: { record: called, ...keys } }, files: { [called]: record } };
};

/** @param {string | null | undefined} name @param {string} record */
const plainName = (name, record) => {
  const ending = /\.[A-Za-z0-9]{1,8}$/.exec(name ?? "")?.[0] ?? ".txt";
  return `record-${record.slice(0, 12)}${ending}`;
};
