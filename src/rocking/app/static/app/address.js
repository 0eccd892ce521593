/** The fragment of the address: a one-time token, the inputs of a link, the view. */

/** What the fragment says, as a plain object. */
export const read = () => Object.fromEntries(new URLSearchParams(location.hash.slice(1)));

/** Show a view in the address, without a new entry for every keystroke. */
export const write = (parts, { push = false } = {}) => {
  const fragment = new URLSearchParams(parts).toString();
  history[push ? "pushState" : "replaceState"](null, "", fragment ? `#${fragment}` : location.pathname);
};
