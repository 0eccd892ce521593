/** The open project: automatic saving, undo and redo, synchronization with other tabs. */

import { signal } from "/parts/preact.js";
import { hush } from "/app/say.js";
import { formsOf, inputsOf } from "/app/shape.js";
import { t, userText } from "/app/words.js";

const OPEN = "rocking.project";
const PAUSE = 400; // after the last change, before it is saved [ms]
/** @typedef {{ inputs: Server.Inputs }} Own */

/** Names of the parts of a project. @type {{ [key: string]: string | undefined }} */
export const PARTS = {
  body: "body", motion: "motion", restitution: "restitution", response: "initial conditions", settings: "gravity", decide: "Assessment",
  inventory: "Inventory", measure: "Identification", records: "Records", space: "3D", bed: "contact bed",
};

/** State of the open project; `first`: content of a new project. @param {App} app @param {Server.Inputs} first */
export const createProjects = (app, first) => {
  /** @type {Signal<Server.ProjectFacts>} */
  const here = signal(null); // null until the call of `start`
  const saving = signal("saved");
  /** @type {Signal<{ theirs: Server.WholeProject, mine: Own } | null>} */
  const clash = signal(null);
  const channel = "BroadcastChannel" in globalThis ? new BroadcastChannel("rocking.projects") : null;
  /** @type {Set<string>} */
  const changed = new Set();
  let timer = 0;
  let taking = false;
  /** @type {Own | null} */
  let last = null; // last saved content
  /** @type {Own[]} */
  let sent = []; // content being sent, or sent without an answer
  let refused = false; // the last sent content was rejected permanently
  let complaint = ""; // message about unsaved content, until it is saved
  /** @type {Promise<any>} */
  let line = Promise.resolve();
  saving.subscribe((state) => state === "saved" && hush(complaint));

  // Inputs of a link are shown but not part of the project.
  const own = () => {
    const aside = app.inputs.aside();
    const forms = app.forms.get();
    return { inputs: aside?.mine ? aside.inputs : app.inputs.get(), ...(Object.keys(forms).length ? { forms } : {}) };
  };
  /** @param {Server.ProjectFacts & { document?: any }} facts */
  const adopt = (facts) => {
    const { document, ...fields } = facts;
    here.value = fields;
    note();
    return document;
  };
  // State saved for a reload: version and content of this tab, and a flag for unsaved changes.
  const note = () =>
    remember({ id: here.value.id, version: here.value.version, more: changed.size > 0 || sent.length > 0, sent, last });
  const tell = () => channel?.postMessage({ id: here.value.id, version: here.value.version });
  /** @param {any} document */
  const show = (document) => {
    taking = true;
    app.inputs.take(inputsOf(document?.inputs) ?? first);
    app.forms.take(document?.forms);
    taking = false;
    changed.clear();
    [sent, last, refused] = [[], own(), false];
    saving.value = "saved";
    note();
  };
  // Changes during a request form a separate state; a rejected state is replaced.
  /** @param {any} document */
  const showUnlessTyped = (document) => {
    if (changed.size && !refused) save();
    else show(document);
  };
  let leaving = false; // later requests continue after the page is closed
  /** @param {string} suffix @param {unknown} [json] @returns {Promise<any>} */
  const ask = (suffix, json) => app.call(`projects/${here.value.id}${suffix}`, { json, keepalive: leaving });
  // Requests are sent in order, because every change contains the number of the previous version.
  /** @type {<Of>(work: () => Promise<Of>) => Promise<Of>} */
  const inLine = (work) => {
    line = line.then(work, work);
    return line;
  };

  const save = () => inLine(async () => {
    clearTimeout(timer);
    if (!changed.size || clash.value) return;
    const document = own();
    const description = [...changed].join(", ");
    const mine = [...changed];
    changed.clear();
    saving.value = "saving";
    sent = [...sent.slice(-3), document];
    note();
    try {
      const facts = await ask("", { version: here.value.version, document, description });
      [sent, refused, last] = [[], false, document];
      adopt(facts);
      saving.value = changed.size ? "saving" : "saved";
      tell();
    } catch (error) {
      for (const key of mine) changed.add(key);
      saving.value = "unsaved";
      refused = error.status >= 400 && error.status < 500 && ![401, 403, 408, 409, 429].includes(error.status);
      if (error.kind !== "offline") sent.pop();
      if (error.kind === "conflict") await differ(document);
      else if (!["offline", "forbidden"].includes(error.kind)) app.say(complaint = t("Not saved: {reason}", { reason: error.message }), "error");
    }
  });
  /** @param {Own} mine */
  const differ = async (mine) => {
    let theirs = await ask("");
    if (theirs.deleted) {
      const alone = theirs.version === here.value.version + 1; // no other change happened
      theirs = { ...theirs, ...(await app.call(`projects/${theirs.id}/back`, { method: "POST" })) };
      app.say("The project was deleted elsewhere. It is restored with your changes.");
      if (alone) {
        adopt(theirs);
        save(); // starts after the end of the present save
        return;
      }
    }
    const [done, ours] = [same(mine, theirs.document), isOwn(theirs, here.value.version, sent)];
    if (!done && !ours && !join(theirs.document)) {
      clash.value = { theirs, mine };
      return;
    }
    const all = done && same(own(), mine); // no input in the meantime
    sent = [];
    if (all) changed.clear();
    last = theirs.document;
    adopt(theirs);
    saving.value = all ? "saved" : "saving";
    if (!all) save(); // starts after the end of the present save
  };

  // Shows remote changes of other parts. If both sides changed the same part: no effect, returns false.
  /** @param {any} document */
  const join = (document) => {
    const [before, mine, theirs] = [last, own(), document].map(partsOf);
    if (!last || !inputsOf(document?.inputs) || app.inputs.aside()?.mine) return false;
    const keys = [...new Set([before, mine, theirs].flatMap((parts) => Object.keys(parts)))];
    /** @param {{ [key: string]: any }} first @param {{ [key: string]: any }} other */
    const differs = (first, other) => keys.filter((key) => JSON.stringify(first[key]) !== JSON.stringify(other[key]));
    const [apart, there] = [differs(mine, theirs), differs(before, theirs)];
    if (differs(before, mine).some((key) => there.includes(key) && apart.includes(key))) return false;
    taking = true;
    for (const key of there) {
      const [kind, name] = key.split(".");
      if (kind === "inputs") app.inputs.set(name, theirs[key]);
      else app.forms.take({ ...app.forms.get(), [name]: theirs[key] });
    }
    taking = false;
    return true;
  };

  /** @param {string} direction */
  const step = (direction) => async () => {
    await save();
    return inLine(async () => {
      try {
        if (refused && direction === "redo") return;
        // The last state could not be saved: undo shows the state before, which is saved.
        showUnlessTyped(adopt(await (refused ? ask("") : ask(`/${direction}`, { version: here.value.version }))));
        tell();
      } catch (error) {
        app.say(error.message, "error");
      }
    });
  };
  // Another project is opened only after this project is saved.
  /** @param {() => Promise<Server.WholeProject>} get */
  const change = async (get) => {
    await save();
    if (changed.size || clash.value) throw new Error("Your changes are not saved yet. They stay on this page.");
    return inLine(async () => {
      const facts = await get();
      if (changed.size) save();
      else show(adopt(facts));
    });
  };
  /** @param {string} id */
  const open = (id) => change(() => app.call(`projects/${id}`));

  app.inputs.subscribe((_, keys) => !app.inputs.aside()?.mine && touched(keys));
  app.forms.subscribe((view) => touched([view]));
  /** @param {Iterable<string>} keys */
  const touched = (keys) => {
    if (taking || !here.value) return;
    // Displaying the same state again changes nothing.
    if (!changed.size && same(own(), last)) return;
    for (const key of keys) changed.add(key);
    if (!changed.size) return;
    refused = false;
    note();
    saving.value = "saving";
    clearTimeout(timer);
    timer = setTimeout(save, PAUSE);
  };
  channel?.addEventListener("message", async ({ data }) => {
    if (!here.value || data.id !== here.value.id || data.version <= here.value.version) return;
    if (changed.size) await save();
    else await inLine(async () => {
      const theirs = await ask("");
      // Changes in the meantime are based on the previous version: saving merges them, or needs a decision.
      if (changed.size) save();
      else show(adopt(theirs));
    }).catch(() => {}); // it is checked again at the next change
  });
  addEventListener("pagehide", () => {
    leaving = true;
    save();
  });
  addEventListener("pageshow", () => (leaving = false));
  document.addEventListener("rocking:signed-in", () => save());

  return {
    here, saving, clash, open, save,
    /** Wait for data of the open project; they are discarded after a change of the project.
     * @type {<Of>(work: Promise<Of>) => Promise<Of>} */
    within: async (work) => {
      const { id } = here.value;
      const result = await work;
      if (id === here.value.id) return result;
      throw new Error("Another project was opened before this action finished. Repeat the action.");
    },
    undo: step("undo"),
    redo: step("redo"),
    /** Retry saving. */
    again: () => save(),
    /** Start a new project: with the default content, or with the shown content.
     * @param {string} name @param {unknown} [document] */
    begin: (name, document) => change(() => app.call("projects", { json: { name, document: document ?? {} } })),
    /** Copy of a project under another name. @param {string} id @param {string} name @param {string} of */
    copy: (id, name, of) => change(() => app.call("projects", { json: { name, copy_of: id, description: t("copy of {name}", { name: userText(of) }) } })),
    /** @param {File} file */
    bring: (file) => change(async () => app.call("projects/import", { body: await file.arrayBuffer() })),
    /** @param {string} name */
    rename: async (name) => {
      await save();
      return inLine(async () => {
        adopt(await ask("/name", { version: here.value.version, name }));
        tell();
      });
    },
    /** @param {number} state */
    restore: async (state) => {
      await save();
      return inLine(async () => {
        showUnlessTyped(adopt(await ask("/restore", { version: here.value.version, state })));
        tell();
      });
    },
    /** After a change elsewhere: show the saved version, or keep the shown version as a copy.
     * @param {boolean} keepMine */
    settle: (keepMine) => inLine(async () => {
      if (!clash.value) return;
      const { theirs } = clash.value;
      try {
        const facts = keepMine
          ? await app.call("projects", { json: { name: t("{name} (mine)", { name: userText(theirs.name) }), document: own() } }) : theirs;
        clash.value = null;
        show(adopt(facts));
      } catch (error) {
        app.say(t("Not saved: {reason}", { reason: error.message }), "error");
      }
    }),
    /** Open the project of this tab, otherwise the last changed project, otherwise a new project.
     * @param {Server.Inputs | null} fromLink */
    start: async (fromLink) => {
      const { projects } = await app.call("projects");
      const kept = remembered();
      const id = [kept?.id, ...projects.map((project) => project.id)].find((candidate) =>
        projects.some((project) => project.id === candidate));
      if (!id) {
        adopt(await app.call("projects", { json: { name: "My first project", document: own() } }));
        last = own();
        return;
      }
      const mine = own();
      const project = await app.call(`projects/${id}`);
      // After a reload the tab may contain unsaved changes; inputs of a link are shown in place of those of the project.
      if (id === kept?.id && kept.more && app.inputs.wereKept && !same(mine, project.document)) {
        const ours = project.version === kept.version || isOwn(project, kept.version, kept.sent);
        last = ours ? /** @type {Own} */ (project.document) : kept.last ?? null;
        const joined = ours || join(project.document);
        if (joined) last = /** @type {Own} */ (project.document);
        changed.add("inputs");
        adopt(joined ? project : { ...project, version: kept.version }); // another reload needs the decision again
        if (joined) await save();
        else clash.value = { theirs: project, mine };
        return;
      }
      if (id === kept?.id && app.inputs.wereKept && same(mine, project.document)) {
        adopt(project);
        last = mine;
        return;
      }
      show(adopt(project));
      if (fromLink) app.inputs.lend(fromLink, "a link");
    },
  };
};

// A version that was saved without this tab remains separate.
/** @param {Server.WholeProject} theirs @param {number} version @param {Own[]} [sent] */
const isOwn = (theirs, version, sent = []) =>
  theirs.version === version + 1 && sent.some((document) => same(document, theirs.document));

// Parts of a document that change independently: tables of the inputs, forms of views.
/** @param {any} document @returns {{ [key: string]: any }} */
const partsOf = (document) => Object.fromEntries(
  [["inputs", inputsOf(document?.inputs)], ["forms", formsOf(document?.forms)]].flatMap(([kind, all]) =>
    Object.entries(all ?? {}).map(([name, value]) => [`${kind}.${name}`, value])),
);

// The order of keys has no meaning.
/** @param {any} left @param {any} right */
const same = (left, right) => {
  const [first, second] = [left, right].map((document) => JSON.stringify([inputsOf(document?.inputs), formsOf(document?.forms)]));
  return first === second;
};

const remembered = () => {
  try {
    return JSON.parse(sessionStorage.getItem(OPEN) ?? "null");
  } catch {
    return null;
  }
};

/** @param {{ id: string, version: number, more: boolean, sent: Own[], last: Own | null }} facts */
const remember = (facts) => {
  for (const more of [{}, { sent: [], last: null }]) { // a reload needs a decision if the changes are too large to be stored twice
    try {
      return sessionStorage.setItem(OPEN, JSON.stringify({ ...facts, ...more }));
    } catch {
      // The next reload opens the project that was changed last.
    }
  }
};
