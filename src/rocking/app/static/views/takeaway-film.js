/** The animation as a GIF: its frames take a while, so it says so, starts once, and can be stopped. */
import { saveBlob } from "/app/api.js";
import { el, fill } from "/app/dom.js";
import { button } from "/app/fields.js";
import { pathOfChosen } from "/views/response-chosen.js";

const NAME = "rocking-animation.gif";

/** Returns a button and the place of its progress. */
export const filmButton = (app, { text, label, testid }) => {
  const words = el("span", { role: "status" });
  const stop = button({ text: "Cancel", label: "Cancel the GIF", onClick: () => abort?.abort() });
  const look = { class: "film-progress", hidden: true, "data-testid": "film-progress" };
  const progress = el("div", look, words, stop);
  let abort = null;

  const draw = async () => {
    if (app.faults?.any({ inputs: true })) return app.say(app.faults.sentence({ inputs: true }), "warning");
    if (abort) return undefined;
    abort = new AbortController();
    const started = performance.now();
    const tell = () => {
      const seconds = Math.round((performance.now() - started) / 1000);
      fill(words, `The frames of the GIF are being drawn: ${seconds} s so far; half a minute is usual.`);
    };
    show(true);
    tell();
    const clock = setInterval(tell, 5000);
    try {
      const inputs = app.inputs.get();
      await save(`/api/${pathOfChosen("animation.gif", inputs.restitution)}`, inputs, abort.signal);
      app.say("The GIF is saved.");
    } catch (error) {
      if (error.name === "AbortError") app.say("The GIF is cancelled.");
      else app.say(error.message, "error");
    } finally {
      clearInterval(clock);
      abort = null;
      const focused = progress.contains(document.activeElement);
      show(false);
      if (focused) start.focus();
    }
    return undefined;
  };
  const start = button({ text, label, testid, onClick: draw });
  const show = (on) => {
    progress.hidden = !on;
    start.setAttribute("aria-disabled", String(on));
  };
  return { button: start, progress };
};

const save = async (path, inputs, signal) => {
  const headers = { "Content-Type": "application/json" };
  const asked = { method: "POST", headers, body: JSON.stringify(inputs), signal, credentials: "same-origin" };
  const answer = await fetch(path, asked);
  if (!answer.ok) {
    const told = await answer.json().catch(() => ({}));
    if (answer.status === 401) document.dispatchEvent(new CustomEvent("rocking:signed-out"));
    throw new Error(told.error?.message ?? `the server answered ${answer.status}`);
  }
  const header = answer.headers.get("Content-Disposition") ?? "";
  saveBlob(await answer.blob(), header.match(/filename="([^"]+)"/)?.[1] ?? NAME);
};
