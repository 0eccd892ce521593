/** Data of a zoomed chart are requested again: all samples of the range, or the extremes per pixel. */

const MOST = 2000;

/** Width in pixels of the charts in an element. @param {Element} element */
export const dotsOf = (element) => Math.min(MOST, Math.ceil((element.clientWidth || 800) * (window.devicePixelRatio || 1)));

/** Curves ({time, ...}) with the visible interval replaced by its detailed curves.
 * @type {<Of extends { time: number[] }>(curves: Of, detail: any) => Of} */
export const detailed = (curves, detail) => {
  const [first, last] = [detail.time[0], detail.time.at(-1)];
  const from = curves.time.findIndex((instant) => instant >= first);
  const after = curves.time.findIndex((instant) => instant > last);
  const begin = from < 0 ? curves.time.length : from;
  const end = after < 0 ? curves.time.length : after;
  /** @param {[string, any]} curve */
  const spliced = ([name, values]) =>
    [name, Array.isArray(values) ? [...values.slice(0, begin), ...detail[name], ...values.slice(end)] : values];
  return Object.fromEntries(Object.entries(curves).map(spliced));
};
