/** Pulses as the API writes them: `sine:amplitude=3,period=0.8`. */

/** Returns [name, parameters] of the words of a pulse. */
export const readPulse = (words) => {
  const [name, tail = ""] = words.split(/:(.*)/s);
  const pairs = tail.split(",").filter(Boolean).map((item) => item.split("="));
  return [name.trim(), Object.fromEntries(pairs.map(([key, value]) => [key.trim(), Number(value)]))];
};

/** Returns the words of a pulse. */
export const writePulse = (name, parameters) => {
  const items = Object.entries(parameters).map(([key, value]) => `${key}=${value}`);
  return items.length ? `${name}:${items.join(",")}` : name;
};
