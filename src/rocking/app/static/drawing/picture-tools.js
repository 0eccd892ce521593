/** Buttons that save a picture as the command line would draw it. */

import { button, toolbar } from "/app/controls.js";

/** PNG and SVG of one of the pictures of the API; `query` says more, such as the foot. */
export const pictureTools = (app, what, query = () => "") => {
  const tools = toolbar(["png", "svg"].map((kind) =>
    button({
      text: kind.toUpperCase(), kind: "quiet", label: `Save the ${what} picture as ${kind.toUpperCase()}`,
      onClick: () => app.download(`picture/${what}.${kind}${query()}`, app.inputs.get(), `${what}.${kind}`),
    })));
  tools.classList.add("picture-tools");
  return tools;
};
