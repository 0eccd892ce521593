/** The project that is open: saved by itself, with undo and redo, in agreement with other tabs. */

import { batch, signal } from "/parts/preact.js";
import { inputsOf } from "/app/shape.js";

const OPEN = "rocking.project";
const PAUSE = 400; // after the last change, before it is saved [ms]
const WORDS = {
  body: "body", motion: "motion", restitution: "restitution", response: "start", settings: "gravity",
};

/** The keeper of the open project; `first` is what a new one holds. */
export const createProjects = (app, first) => {
  const here = signal(null);
  const saving = signal("saved");
  const clash = signal(null);
  const channel = "BroadcastChannel" in globalThis ? new BroadcastChannel("rocking.projects") : null;
  const changed = new Set();
  let timer = 0;
  let taking = false;
  let line = Promise.resolve();

  // What is lent from elsewhere is on the screen, and not in the project.
  const own = () => {
    const aside = app.inputs.aside();
    return { inputs: aside?.mine ? aside.inputs : app.inputs.get() };
  };
  const known = (facts) => {
    const { document, ...rest } = facts;
    here.value = rest;
    remember(rest.id);
    return document;
  };
  const tell = () => channel?.postMessage({ id: here.value.id, version: here.value.version });
  const show = (document) => {
    taking = true;
    app.inputs.take(inputsOf(document?.inputs) ?? first);
    taking = false;
    changed.clear();
    saving.value = "saved";
  };
  let leaving = false; // what is sent then outlives the page
  const ask = (what, json) => app.call(`projects/${here.value.id}${what}`, { json, keepalive: leaving });
  // One after the other: every change names the version that it follows.
  const inLine = (work) => {
    line = line.then(work, work);
    return line;
  };

  const save = () => inLine(async () => {
    clearTimeout(timer);
    if (!changed.size || clash.value) return;
    const document = own();
    const words = `${[...changed].map((key) => WORDS[key] ?? key).join(", ")} changed`;
    const mine = [...changed];
    changed.clear();
    saving.value = "saving";
    try {
      known(await ask("", { version: here.value.version, document, words }));
      saving.value = changed.size ? "saving" : "saved";
      tell();
    } catch (error) {
      for (const key of mine) changed.add(key);
      saving.value = "unsaved";
      if (error.kind === "conflict") await differ(document);
      else if (!["offline", "forbidden"].includes(error.kind)) app.say(`Not saved: ${error.message}`, "error");
    }
  });
  const differ = async (mine) => {
    let theirs = await ask("");
    if (theirs.deleted) {
      const alone = theirs.version === here.value.version + 1; // nothing else happened to it
      theirs = { ...theirs, ...(await app.call(`projects/${theirs.id}/back`, { method: "POST" })) };
      app.say("The project had been deleted elsewhere; it is back, with what you do here.");
      if (alone) {
        known(theirs);
        save(); // after this one, which waits for what is returned here
        return;
      }
    }
    if (same(mine, theirs.document)) {
      known(theirs);
      changed.clear();
      saving.value = "saved";
    } else clash.value = { theirs, mine };
  };

  const step = (what) => async () => {
    await save();
    return inLine(async () => {
      try {
        show(known(await ask(`/${what}`, { version: here.value.version })));
        tell();
      } catch (error) {
        app.say(error.message, "error");
      }
    });
  };
  const take = async (facts) => {
    await save();
    batch(() => {
      clash.value = null;
      show(known(facts));
    });
  };
  const open = async (id) => take(await app.call(`projects/${id}`));

  app.inputs.subscribe((_, keys) => {
    if (taking || !here.value || app.inputs.aside()?.mine) return;
    for (const key of keys) changed.add(key);
    if (!changed.size) return;
    saving.value = "saving";
    clearTimeout(timer);
    timer = setTimeout(save, PAUSE);
  });
  channel?.addEventListener("message", async ({ data }) => {
    if (!here.value || data.id !== here.value.id || data.version <= here.value.version) return;
    if (changed.size) await save();
    else await inLine(async () => show(known(await ask(""))));
  });
  addEventListener("pagehide", () => {
    leaving = true;
    save();
  });
  addEventListener("pageshow", () => (leaving = false));
  document.addEventListener("rocking:signed-in", () => save());

  return {
    here, saving, clash, open, save,
    undo: step("undo"),
    redo: step("redo"),
    /** Try again to save what could not be saved. */
    again: () => save(),
    /** Begin another project: with the usual start, or with what is on the screen. */
    begin: async (name, document) => take(await app.call("projects", { json: { name, document: document ?? {} } })),
    copy: async (id, name) => take(await app.call("projects", { json: { name, copy_of: id } })),
    bring: async (file) => take(await app.call("projects/import", { body: await file.arrayBuffer() })),
    rename: async (name) => {
      await save();
      known(await ask("/name", { version: here.value.version, name }));
      tell();
    },
    restore: async (state) => {
      await save();
      show(known(await ask("/restore", { version: here.value.version, state })));
      tell();
    },
    /** Of a project that was changed elsewhere too: show what is there, or keep what is on the screen as a copy. */
    settle: async (keepMine) => {
      const { theirs, mine } = clash.value;
      changed.clear();
      clash.value = null;
      if (keepMine) {
        return take(await app.call("projects", { json: { name: `${theirs.name} (mine)`, document: mine } }));
      }
      return show(known(theirs));
    },
    /** Open the project of this tab, else the one that was changed last, else a first one. */
    start: async (fromLink) => {
      const { projects } = await app.call("projects");
      const id = [remembered(), ...projects.map((each) => each.id)].find((each) =>
        projects.some((one) => one.id === each));
      const reloaded = id === remembered() && app.inputs.wereKept;
      if (!id) {
        known(await app.call("projects", { json: { name: "My first project", document: own() } }));
        return;
      }
      const document = known(await app.call(`projects/${id}`));
      // After a reload the tab may hold what was not saved yet; what a link holds is lent over the project's own.
      if (reloaded) {
        if (same(own(), document)) return;
        changed.add("inputs");
        await save();
      } else {
        show(document);
        if (fromLink) app.inputs.lend(fromLink, "what a link holds");
      }
    },
  };
};

// The order of keys says nothing.
const same = (one, other) => {
  const [first, second] = [one, other].map((each) => JSON.stringify(inputsOf(each?.inputs)));
  return first === second;
};

const remembered = () => {
  try {
    return sessionStorage.getItem(OPEN);
  } catch {
    return null;
  }
};

const remember = (id) => {
  try {
    sessionStorage.setItem(OPEN, id);
  } catch {
    // The next reload opens the project that was changed last.
  }
};
