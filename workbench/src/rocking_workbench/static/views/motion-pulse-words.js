/** Pulses as the API writes them: `sine:amplitude=3,period=0.8`. */

/** Returns [name, parameters] from the text of a pulse.
 * @param {string} text @returns {[string, { [key: string]: number }]} */
export const readPulse = (text) => {
  const [name, tail = ""] = text.split(/:(.*)/s);
  const pairs = tail.split(",").filter(Boolean).map((item) => item.split("="));
  return [name.trim(), Object.fromEntries(pairs.map(([key, value]) => [key.trim(), Number(value)]))];
};

/** Returns the text of a pulse. @param {string} name @param {{ [key: string]: number }} parameters */
export const writePulse = (name, parameters) => {
  const items = Object.entries(parameters).map(([key, value]) => `${key}=${value}`);
  return items.length ? `${name}:${items.join(",")}` : name;
};
