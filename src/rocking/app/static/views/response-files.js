/** Files of the response to take away. */
import { el, fill } from "/app/dom.js";
import { button, card } from "/app/fields.js";
import { chosenOf, labelsOf, onLook, pathOfChosen } from "/views/response-chosen.js";
import { wordsOf } from "/views/response-labels.js";
import { filmButton } from "/views/takeaway-film.js";

const PICTURES = [
  ["Picture, PNG", "picture/response.png"],
  ["Picture, SVG", "picture/response.svg"],
];
const OF_ONE = [
  ["Curves, CSV", "table/response.csv"],
  ["Animation, page", "animation.html"],
];

/** Returns the buttons; what holds one model holds the one that is looked at, and says so. */
export const filesOf = (app) => {
  const restitution = () => app.inputs.get().restitution;
  const saved = ([text, path], chosen) => {
    const name = path.replaceAll("/", "-");
    const address = () => (chosen ? pathOfChosen(path, restitution()) : path);
    return button({ text, onClick: () => app.download(address(), app.inputs.get(), name) });
  };
  const words = el("p", { class: "field-help", "data-testid": "files-model" });
  const pictures = PICTURES.map((file) => saved(file, false));
  const ones = OF_ONE.map((file) => saved(file, true));
  const tell = () => {
    const labels = labelsOf(restitution());
    const several = labels.length > 1;
    const one = wordsOf(chosenOf(labels));
    fill(words, several ? `Pictures show all models; curves and animation are those of ${one}.` : "");
  };
  onLook(tell);
  app.inputs.subscribe(tell);
  tell();
  const film = filmButton(app, { text: "Animation, GIF", label: "Animation, GIF" });
  const tools = el("div", { class: "toolbar" }, pictures, ones, film.button);
  return card("Take away", tools, film.progress, words);
};
