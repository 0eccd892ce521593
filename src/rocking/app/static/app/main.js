/** The start: sign in, read the link, build the app object, show the first view. */

import * as address from "/app/address.js";
import { call, download, latest, superseded } from "/app/api.js";
import { copyTable } from "/app/copy.js";
import { createBodyFacts } from "/app/facts.js";
import { createInputs, decode, encode, kept } from "/app/inputs.js";
import { say } from "/app/say.js";
import { exchange, showDoor } from "/app/session.js";
import { mountSummary } from "/app/summary.js";
import { createTabs } from "/app/tabs.js";
import { createViews } from "/app/views.js";

const start = async () => {
  const { token, in: shared, view } = address.read();
  if (token) address.write(view ? { view } : {});
  const refusal = token ? await exchange(token) : "";
  const info = await call("info").catch((error) => {
    if (error.status !== 401) throw error;
  });
  if (!info) return showDoor(refusal);
  const fromLink = shared ? decode(shared) : null;
  const app = createApp(fromLink ?? kept(), info);
  if (shared && !fromLink) say("The link carries no readable inputs; the usual start is shown.", "warning");
  run(app, view);
};

const createApp = (inputs, info) => {
  const app = { inputs: createInputs(inputs), info, call, latest, superseded, copyTable, say };
  app.link = () => {
    const parts = new URLSearchParams({ in: encode(app.inputs.get()), view: app.view() });
    return `${location.origin}/#${parts}`;
  };
  app.inputs.link = app.link;
  app.download = (path, json, name) => download(path, json, name).catch(
    (error) => say(error.message, "error")
  );
  app.body = createBodyFacts(app);
  return app;
};

const run = (app, view) => {
  const views = createViews(app);
  const tabs = createTabs(document.getElementById("steps"), (name, before) => {
    if (before) address.write({ view: name }, { push: true });
    document.body.dataset.view = name;
    views.show(name, before);
  });
  app.view = tabs.current;
  app.go = (name) => tabs.show(name, { focus: true });
  mountSummary(document.getElementById("summary"), app);
  tabs.show(tabs.names.includes(view) ? view : "body");
  addEventListener("popstate", () => tabs.show(address.read().view ?? "body"));
  addEventListener("hashchange", () => followLink(app));
};

const followLink = (app) => {
  const { in: shared, view } = address.read();
  const inputs = shared ? decode(shared) : null;
  if (inputs) app.inputs.replace(inputs);
  if (view) app.go(view);
};

document.getElementById("theme").addEventListener("click", () => {
  document.dispatchEvent(new CustomEvent("rocking:toggle-theme"));
});
document.addEventListener("rocking:signed-out", () => {
  if (!document.body.classList.contains("at-the-door")) say("This browser is no longer signed in.", "error");
});

start().catch((error) => showDoor(error.message));
