/** Files of the response to take away. */
import { button, card, toolbar } from "/app/fields.js";

const FILES = [
  ["Picture, PNG", "picture/response.png"],
  ["Picture, SVG", "picture/response.svg"],
  ["Curves, CSV", "table/response.csv"],
  ["Animation, page", "animation.html"],
  ["Animation, GIF", "animation.gif"],
];

/** Returns the buttons. */
export const filesOf = (app) => {
  const buttons = FILES.map(([text, path]) =>
    button({ text, onClick: () => app.download(path, app.inputs.get(), path.replaceAll("/", "-")) }),
  );
  return card("Take away", toolbar(...buttons));
};
