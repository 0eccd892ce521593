/** Data given for a record file, stored by its hash in this browser. */

const KEPT = "rocking.told";
const KEYS = ["format", "units", "time_step", "component", "vertical"];
const MOST = 500;

const all = () => {
  try {
    return JSON.parse(localStorage.getItem(KEPT) ?? "null") ?? {};
  } catch {
    return {};
  }
};

/** @param {[string, any][]} entries */
const write = (entries) => {
  try {
    localStorage.setItem(KEPT, JSON.stringify(Object.fromEntries(entries.slice(-MOST))));
  } catch {
    // without storage in the browser, the user must enter the data again
  }
};

/** @param {string} record */
const others = (record) => Object.entries(all()).filter(([hash]) => hash !== record);

/** Data given for a record: format, units, time_step, component, vertical. @param {string} record */
export const toldOf = (record) => all()[record] ?? {};

/** Store the record data of a motion. @param {any} motion */
export const rememberTold = ({ record, ...motion }) => {
  const stated = KEYS.filter((key) => motion[key] !== undefined);
  const options = Object.fromEntries(stated.map((key) => [key, motion[key]]));
  if (record) write([...others(record), [record, options]]);
};

/** Forgets a record that was deleted. @param {string} record */
export const forgetTold = (record) => write(others(record));
