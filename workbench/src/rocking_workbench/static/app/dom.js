/** Creation of HTML and SVG elements; text is never parsed as markup. */

import { attributesInWords, childrenInWords } from "/app/words.js";

const SVG = "http://www.w3.org/2000/svg";

/** Make an HTML element: el("p", {class: "note"}, "text", child).
 * @type {<Tag extends keyof HTMLElementTagNameMap>(tag: Tag, attributes?: Attributes | null, ...children: Child[]) => HTMLElementTagNameMap[Tag]} */
export const el = (tag, attributes, ...children) => furnish(
  document.createElement(tag), attributes, children,
);

/** Make an SVG element in the same way.
 * @type {<Tag extends keyof SVGElementTagNameMap>(tag: Tag, attributes?: Attributes | null, ...children: Child[]) => SVGElementTagNameMap[Tag]} */
export const svg = (tag, attributes, ...children) =>
  furnish(document.createElementNS(SVG, tag), attributes, children);

/** Replace the content of a node.
 * @type {<Place extends Element | DocumentFragment>(node: Place, ...children: Child[]) => Place} */
export const fill = (node, ...children) => {
  node.replaceChildren();
  return within(node, node instanceof Element ? childrenInWords(node.localName, { translate: node.getAttribute("translate") }, children) : children);
};

/** Set attributes, properties and listeners on a node.
 * @type {<Of extends Element>(node: Of, attributes?: Attributes | null) => Of} */
export const set = (node, attributes) => {
  for (const [key, value] of Object.entries(attributesInWords(node.localName, attributes) ?? {})) setOne(node, key, value);
  return node;
};

let count = 0;

/** New id, which connects labels and descriptions with their fields. @param {string} stem */
export const freshId = (stem) => `${stem}-${(count += 1)}`;

const PROPERTIES = new Set(["value", "checked", "disabled", "hidden", "indeterminate", "open", "readOnly"]);

/** @param {Child} child */
const shown = (child) => child !== null && child !== undefined && child !== false && child !== true;

/** @param {Child} child */
const asNode = (child) => (child instanceof Node ? child : document.createTextNode(String(child)));

/** @type {<Place extends Element | DocumentFragment>(node: Place, children: readonly Child[]) => Place} */
const within = (node, children) => {
  for (const child of /** @type {any} */ (children).flat(Infinity)) if (shown(child)) node.append(asNode(child));
  return node;
};

/** @type {<Of extends Element>(node: Of, attributes: Attributes | null | undefined, children: readonly Child[]) => Of} */
const furnish = (node, attributes, children) => {
  set(node, attributes);
  return within(node, childrenInWords(node.localName, attributes, children));
};

/** @param {any} node @param {string} key @param {any} value */
const setOne = (node, key, value) => {
  if (typeof value === "function" && key.startsWith("on")) {
    node.addEventListener(key.slice(2).toLowerCase(), value);
  } else if (key === "dataset") {
    Object.assign(node.dataset, value);
  } else if (key === "style") {
    Object.assign(node.style, value);
  } else if (PROPERTIES.has(key) && key in node) {
    node[key] = value;
  } else if (value === null || value === undefined || value === false) {
    node.removeAttribute(key);
  } else {
    node.setAttribute(key, value === true && !key.startsWith("aria-") ? "" : String(value));
  }
};
