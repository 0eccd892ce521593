/** Animation as a GIF: shows its progress, starts once, can be cancelled. */
import { html, useLayoutEffect, useRef, useSignal } from "/parts/preact.js";
import { download } from "/app/api.js";
import { Button } from "/parts/fields.js";
import { pathOfChosen } from "/views/response-chosen.js";
import { t } from "/app/words.js";

const NAME = "rocking-animation.gif";

/** Button with the number of finished frames. @param {{ app: App, children?: any, [more: string]: any }} props */
export const Film = ({ app, children, ...more }) => {
  const seconds = useSignal(null); // seconds since the start; null while no frames are finished
  const [start, progress, abort] = [useRef(null), useRef(null), useRef(null)];
  const running = seconds.value !== null;
  const draw = async () => {
    if (app.faults.any({ inputs: true })) return app.say(app.faults.sentence({ inputs: true }), "warning");
    if (running) return undefined;
    abort.current = new AbortController();
    const started = performance.now();
    const tell = () => (seconds.value = Math.round((performance.now() - started) / 1000));
    tell();
    const clock = setInterval(tell, 5000);
    try {
      const inputs = app.inputs.get();
      await download(pathOfChosen("animation.gif", inputs.restitution), inputs, NAME, abort.current.signal);
      app.say("The GIF is saved.");
    } catch (error) {
      if (error.name === "AbortError") app.say("The GIF is cancelled.");
      else app.say(error.message, "error");
    }
    clearInterval(clock);
    seconds.value = null;
    return undefined;
  };
  useLayoutEffect(() => {
    if (!running && progress.current.contains(document.activeElement)) start.current.focus();
  }, [running]);
  return html`
    <button ref=${start} type="button" class="button" aria-disabled=${String(running)} onClick=${draw} ...${more}>${children}</button>
    <div ref=${progress} class="film-progress" hidden=${!running} data-testid="film-progress">
      <span role="status">${running && t("Drawing the frames of the GIF: {time} s so far, typically 30 s.", { time: seconds.value })}</span>
      <${Button} aria-label="Cancel the GIF" onClick=${() => abort.current.abort()}>Cancel<//></div>`;
};
