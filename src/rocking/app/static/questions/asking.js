/** Questions that take longer than a page waits: asked, watched, stopped, and looked at again. */

import { computed, signal } from "/parts/preact.js";

const EVERY = 500; // a look at a question that is being answered [ms]
const ENDED = new Set(["done", "refused", "stopped"]);

/** The questions of one command in the open project. */
export const createQuestions = (app, command) => {
  const shown = signal(null);
  const all = signal([]);
  let timer = 0;
  const here = () => app.project.here.value.id;
  const busy = computed(() => shown.value && !ENDED.has(shown.value.state));

  const look = async () => {
    const { questions } = await app.call("questions");
    all.value = questions.filter((each) => each.command === command && each.project === here());
  };
  const follow = async (id) => {
    clearTimeout(timer);
    const question = await app.call(`questions/${id}`).catch((error) => {
      if (error.kind !== "offline") throw error;
      return shown.value; // the server is back in a moment, and goes on with it
    });
    if (shown.value && shown.value.id !== id) return;
    shown.value = question;
    if (ENDED.has(question.state)) await look();
    else timer = setTimeout(() => follow(id).catch(tell), EVERY);
  };
  const tell = (error) => app.say(error.message, "error");
  const safely = (work) => (...given) => work(...given).catch(tell);

  return {
    shown, all, busy,
    look: safely(look),
    ask: safely(async (tables, files, name) => {
      await app.project.save();
      shown.value = null;
      const question = await app.call("questions", { json: { command, tables, files, name, project: here() } });
      shown.value = { ...question, answer: null };
      await follow(question.id);
    }),
    open: safely(async (id) => {
      shown.value = null;
      await follow(id);
    }),
    stop: safely(async () => {
      await app.call(`questions/${shown.value.id}/stop`, { method: "POST" });
      await follow(shown.value.id);
    }),
    remove: safely(async (id) => {
      await app.call(`questions/${id}`, { method: "DELETE" });
      if (shown.value?.id === id) shown.value = null;
      await look();
    }),
    /** Send a file; resolves to its hash and the plain name that tables call it. */
    send: async (file) => {
      const kept = await app.call("files", { method: "POST", body: await file.arrayBuffer(), query: { name: file.name } });
      return { name: kept.file_name, sha: kept.record };
    },
    take: (name) => app.download(`questions/${shown.value.id}/${name}`, undefined, name),
  };
};

/** The motion of the inputs as a job has it, and the files that it needs. */
export const motionOf = (inputs) => {
  if (!inputs.motion) return null;
  const { record, file_name: name, pulse, synthetic, member, ...rest } = inputs.motion;
  if (record) {
    const called = plainName(name, record);
    return { motion: { records: [called], ...rest }, files: { [called]: record } };
  }
  if (synthetic) return { motion: { synthetic, count: (member ?? 0) + 1, ...rest }, files: {} };
  return { motion: { pulse: [pulse], ...rest }, files: {} };
};

const plainName = (name, record) => {
  const ending = /\.[A-Za-z0-9]{1,8}$/.exec(name ?? "")?.[0] ?? ".txt";
  return `record-${record.slice(0, 12)}${ending}`;
};
