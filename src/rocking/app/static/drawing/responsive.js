/** Pictures drawn for the width that they have, so that their words stay readable on a phone. */

import { el, fill } from "/app/dom.js";

/** A box that draws itself anew when its width changes; call redraw() when the data changes. */
export const responsive = (draw, attributes = {}) => {
  const box = el("div", { class: "responsive", ...attributes });
  let width = 0;
  const redraw = () => {
    if (width) fill(box, draw(width));
  };
  new ResizeObserver(([entry]) => {
    const next = Math.floor(entry.contentRect.width);
    if (next === width || next === 0) return;
    width = next;
    redraw();
  }).observe(box);
  return Object.assign(box, { redraw });
};
