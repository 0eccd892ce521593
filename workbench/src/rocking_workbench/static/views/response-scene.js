/** Animation of the responses: solid body, outlines of other models, and ground. */
import { html, useLayoutEffect, useMemo } from "/parts/preact.js";
import { highest } from "/app/extremes.js";
import { chartFiles } from "/charts/save.js";
import { Made } from "/parts/made.js";
import { actorOf } from "/scene/sampled.js";
import { shapeOf } from "/scene/shape.js";
import { peakInstant, Track } from "/scene/track.js";
import { longest } from "/views/response-figures.js";
import { styleOf, wordsOf } from "/views/response-labels.js";
import { sceneWords } from "/views/response-words.js";

const SETTLE = 0.4;

// the animation ends when all bodies are at rest
/** @param {Actor} actor */
const lastOf = ({ rotation, falls }) => (falls ? rotation.end + SETTLE : quietAfter(rotation));

/** @param {Track} track */
const quietAfter = (track) => {
  let k = track.values.length - 1;
  while (k > 0 && Math.abs(track.values[k]) < 1e-6) k -= 1;
  return k ? Math.min(track.time[k] + SETTLE, track.end) : track.end; // complete duration if the body does not move
};

/** @param {Actor} actor */
const restOf = (actor) => (actor.falls ? actor.rotation.end : peakInstant(actor.rotation));

/** Player of the responses of the API; the body of `lead` is solid.
 * @param {{ player: import("/scene/player.js").Player, body: Server.DrawnBody, answers: Server.ResponseFacts[], lead: string | null, stale: boolean }} props */
export const Scene = ({ player, body, answers, lead, stale }) => {
  const node = useMemo(() => {
    const names = () => (player.play?.actors ?? []).map(({ label }) => wordsOf(label));
    return chartFiles("The body at this instant", () => player.still(names()), "picture");
  }, [player]);
  const actors = useMemo(() => answers.map((answer) => actorOf(answer, styleOf(answer.label))), [answers]);
  useLayoutEffect(() => {
    if (!actors.length) return;
    const leadIndex = Math.max(0, actors.findIndex(({ label }) => label === lead));
    const { time, ground_displacement: moved } = longest(answers).series;
    const about = { restTime: restOf(actors[leadIndex]), description: sceneWords(answers), end: highest(actors.map(lastOf)) };
    player.show({ shape: shapeOf(body), actors, ground: new Track(time, moved), ...about }, leadIndex);
  }, [actors, lead]);
  return html`<div class=${`scene-holder ${stale ? "stale" : ""}`} hidden=${!answers.length}>
    <${Made} node=${player.element} />
    <div class="chart-foot"><p class="field-help">Space bar: play or pause. Arrow keys: step, while the picture has the focus.</p>
      <${Made} node=${node} class="pushed" /></div></div>`;
};
