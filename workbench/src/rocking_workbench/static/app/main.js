/** Start: sign in, read the link, create the app object, show the first view. */

import { t } from "/app/words.js"; // loaded first, because other modules translate their texts with it
import { language } from "/app/language.js";
import * as address from "/app/address.js";
import { call, download, latest, superseded } from "/app/api.js";
import { copyTable } from "/app/copy.js";
import { createBodyFacts } from "/app/facts.js";
import { faults } from "/app/faults.js";
import { FIRST, createInputs, decode, encode, kept } from "/app/inputs.js";
import { createForms } from "/app/forms.js";
import { followAddress, UNREADABLE } from "/app/navigation.js";
import { learnModels } from "/app/palette.js";
import { whenBack } from "/app/offline.js";
import { mountLent } from "/app/lent.js";
import { inPlainWords } from "/app/refusal.js";
import { say } from "/app/say.js";
import { showFailure } from "/app/failure.js";
import { exchange, linkForAnother, showDoor } from "/app/session.js";
import { mountSummary } from "/app/summary.js";
import { createTabs } from "/app/tabs.js";
import { createViews } from "/app/views.js";
import { mountProject } from "/project/bar.js";
import { createProjects } from "/project/saving.js";

const start = async () => {
  const { token, in: shared, view } = address.read();
  if (token) address.write({ in: shared, view });
  const refusal = token ? await exchange(token) : "";
  const info = await call("info").catch((error) => {
    if (error.status !== 401) throw error;
  });
  if (!info) return waitAtTheDoor(refusal);
  learnModels(info.models);
  if (shared) address.write({ view });
  const fromLink = shared ? decode(shared) : null;
  const app = createApp(kept() ?? fromLink, info);
  app.project = createProjects(app, FIRST);
  await app.project.start(fromLink);
  if (fromLink && app.inputs.wereKept) app.inputs.lend(fromLink, "a link");
  if (shared && !fromLink) say(t("{reason}. The default inputs are shown.", { reason: UNREADABLE }), "warning");
  run(app, view);
};

/** @param {Server.Inputs | null} inputs @param {Server.Info} info */
const createApp = (inputs, info) => {
  const app = /** @type {App} */ ({ inputs: createInputs(inputs), forms: createForms(), info, language, superseded, copyTable, say, faults });
  /** @param {(...given: any[]) => Promise<any>} ask @returns {(...given: any[]) => Promise<any>} */
  const plainly = (ask) => (...given) => ask(...given).catch((error) => {
    if (error.kind) inPlainWords(error, app.inputs.get().body);
    throw error;
  });
  [app.call, app.latest] = [call, latest].map(plainly);
  const save = plainly(download);
  app.link = () => {
    const parts = new URLSearchParams({ in: encode(app.inputs.get()), view: app.view() });
    return `${location.origin}/#${parts}`;
  };
  // The file must contain the inputs on the screen.
  app.download = async (path, json, name) => {
    const wrong = json === undefined ? "" : faults.sentence({ inputs: true });
    if (wrong) return say(t("Not saved. Correct these inputs first: {faults}", { faults: wrong }), "error");
    return save(path, json, name).catch((error) => {
      say(error.message, "error");
      return error;
    });
  };
  app.linkForAnother = () => linkForAnother(app).catch((error) => say(error.message, "error"));
  app.body = createBodyFacts(app);
  return app;
};

/** @param {App} app @param {string} [view] */
const run = (app, view) => {
  const views = createViews(app);
  const steps = document.getElementById("steps");
  const tabs = createTabs(steps, (name, before, quiet) => {
    if (before && !quiet) address.write({ view: name }, { push: true });
    document.body.dataset.view = name;
    views.show(name, before);
  });
  app.view = tabs.current;
  app.go = (name) => tabs.show(name, { focus: true });
  mountSummary(document.getElementById("summary"), app);
  mountProject(document.getElementById("project"), app.project, app);
  mountLent(/** @type {Element} */ (document.querySelector(".views")), app.inputs);
  tabs.show(view && tabs.names.includes(view) ? view : "body");
  steps.inert = false; // clicks before this line have no effect
  document.body.dataset.started = "true";
  followAddress(app, tabs);
  signingIn(app, views, tabs);
};

// An expired session is detected by the first rejected call; afterwards all data are requested again.
/** @param {App} app @param {ReturnType<typeof createViews>} views @param {ReturnType<typeof createTabs>} tabs */
const signingIn = (app, views, tabs) => {
  document.addEventListener("rocking:signed-out", () => showDoor(""));
  /** @param {string} text */
  const again = (text) => () => {
    say(text);
    app.inputs.touch();
    app.project.save();
    views.show(tabs.current());
  };
  document.addEventListener("rocking:signed-in", again("Signed in."));
  whenBack(again("The server responds again."));
  document.getElementById("another").addEventListener("click", app.linkForAnother);
};

/** @param {string} refusal */
const waitAtTheDoor = (refusal) => {
  showDoor(refusal);
  addEventListener("hashchange", () => location.reload());
};

document.getElementById("theme").addEventListener("click", () => {
  document.dispatchEvent(new CustomEvent("rocking:toggle-theme"));
});
document.querySelector(".skip")?.addEventListener("click", (event) => {
  event.preventDefault();
  document.getElementById("main").focus();
});

start().catch((error) => (error.status === 401 ? showDoor(error.message) : showFailure(error.message)));
