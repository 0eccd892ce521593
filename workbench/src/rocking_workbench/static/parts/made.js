/** Components for existing nodes and for pictures. */

import { html, useLayoutEffect, useRef, useSignal } from "/parts/preact.js";
import { fill } from "/app/dom.js";

/** An existing node. @param {{ node: Child, [more: string]: any }} props */
export const Made = ({ node, ...more }) => {
  const element = useRef(null);
  useLayoutEffect(() => void fill(element.current, node), [node]);
  return html`<div ref=${element} ...${more}></div>`;
};

/** Picture in the available width from `draw(...of, width)`.
 * @param {{ draw: (...given: any[]) => Child, of: any[] }} props */
export const Drawn = ({ draw, of }) => {
  const element = useRef(null);
  const width = useSignal(0);
  useLayoutEffect(() => {
    const watcher = new ResizeObserver(([entry]) => (width.value = Math.floor(entry.contentRect.width) || width.value));
    watcher.observe(element.current);
    return () => watcher.disconnect();
  }, []);
  useLayoutEffect(() => void (width.value && fill(element.current, draw(...of, width.value))), [width.value, ...of]);
  return html`<div ref=${element} class="responsive"></div>`;
};
