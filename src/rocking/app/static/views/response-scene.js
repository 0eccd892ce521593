/** The animation of the answers: which body is solid, which are ghosts, and where the ground is. */
import { el } from "/app/dom.js";
import { highest } from "/app/extremes.js";
import { chartFiles } from "/charts/save.js";
import { Player } from "/scene/player.js";
import { actorOf } from "/scene/sampled.js";
import { shapeOf } from "/scene/shape.js";
import { peakInstant, Track } from "/scene/track.js";
import { chosenOf } from "/views/response-chosen.js";
import { styleOf, wordsOf } from "/views/response-labels.js";
import { sceneWords } from "/views/response-words.js";

const SETTLE = 0.4;

const groundOf = (answers) => {
  const ends = answers.map(({ series }) => series.time.at(-1));
  const { time, ground_displacement: moved } = answers[ends.indexOf(highest(ends))].series;
  return new Track(time, moved);
};

// after everything lies or rests nothing happens: the animation ends there
const lastOf = ({ rotation, falls }) => (falls ? rotation.end + SETTLE : quietAfter(rotation));
const endOf = (actors) => highest(actors.map(lastOf));

const quietAfter = (track) => {
  let k = track.values.length - 1;
  while (k > 0 && Math.abs(track.values[k]) < 1e-6) k -= 1;
  return Math.min(track.time[k] + SETTLE, track.end) || track.end;
};

const restOf = (actor) => (actor.falls ? actor.rotation.end : peakInstant(actor.rotation));

/** Returns the player of the view, fed with answers of the API. */
export const sceneOf = () => {
  const player = new Player();
  const words = "Space plays and pauses; with the picture in focus the arrow keys step.";
  const keys = el("p", { class: "field-help" }, words);
  let actors = [];
  const still = () => player.still(actors.map(({ label }) => wordsOf(label)));
  const files = chartFiles("The body at this instant", still, "picture");
  const foot = el("div", { class: "chart-foot" }, keys, files);
  const element = el("div", { class: "scene-holder" }, player.element, foot);
  const leadOf = () => {
    const labels = actors.map(({ label }) => label);
    return Math.max(0, labels.indexOf(chosenOf(labels)));
  };
  const show = (answer, answers) => {
    element.hidden = !answers.length;
    if (!answers.length) return;
    const shape = shapeOf(answer.body);
    actors = answers.map((one) => actorOf(one, styleOf(one.label)));
    const lead = leadOf();
    const end = endOf(actors);
    const about = { rest: restOf(actors[lead]), words: sceneWords(answers) };
    player.show({ shape, actors, ground: groundOf(answers), end, ...about }, lead);
  };
  const follow = () => {
    if (player.play) player.show(player.play, leadOf());
  };
  return {
    element, show, follow,
    toggle: () => player.toggle(),
    pause: () => player.pause(),
    glance: (instant) => player.glance(instant),
  };
};
