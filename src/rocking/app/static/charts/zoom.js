/** A chart that is looked into is asked for again: what is in sight has every sample, or the extremes of every dot. */

const MOST = 2000;

/** Over how many dots of the screen the charts in a place are drawn. @param {Element} place */
export const dotsOf = (place) => Math.min(MOST, Math.ceil((place.clientWidth || 800) * (window.devicePixelRatio || 1)));

/** Curves ({time, ...}) in which a part of the time is replaced by what was asked for it.
 * @type {<Of extends { time: number[] }>(whole: Of, part: any) => Of} */
export const detailed = (whole, part) => {
  const [first, last] = [part.time[0], part.time.at(-1)];
  const from = whole.time.findIndex((instant) => instant >= first);
  const after = whole.time.findIndex((instant) => instant > last);
  const begin = from < 0 ? whole.time.length : from;
  const end = after < 0 ? whole.time.length : after;
  /** @param {[string, any]} curve */
  const spliced = ([name, values]) =>
    [name, Array.isArray(values) ? [...values.slice(0, begin), ...part[name], ...values.slice(end)] : values];
  return Object.fromEntries(Object.entries(whole).map(spliced));
};
