/** The fragment of the address: a one-time token, the inputs of a link, the view. */

const OURS = ["token", "in", "view"];

/** Content of the fragment as an object. @returns {{ [key: string]: string | undefined }} */
export const read = () => Object.fromEntries(new URLSearchParams(location.hash.slice(1)));

/** True if a fragment is for the application: it is empty, or begins with a name of the application.
 * @param {{ [key: string]: string | undefined }} parts */
export const isOurs = (parts) => !Object.keys(parts).length || OURS.some((key) => parts[key] !== undefined);

/** Show a view in the address, without a new entry for every keystroke.
 * @param {{ [key: string]: string | undefined }} parts @param {{ push?: boolean }} [how] */
export const write = (parts, { push = false } = {}) => {
  const entries = /** @type {[string, string][]} */ (Object.entries(parts).filter(([, value]) => value !== undefined));
  const fragment = new URLSearchParams(entries).toString();
  history[push ? "pushState" : "replaceState"](null, "", fragment ? `#${fragment}` : location.pathname);
};
