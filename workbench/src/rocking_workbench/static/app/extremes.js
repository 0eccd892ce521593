/** Extremes of data. `Math.max` with all values as arguments fails for about 100,000 values. */

/** Largest value, at least `most`; NaN is ignored.
 * @param {ArrayLike<number | null> & Iterable<number | null>} values @param {number} [most] */
export const highest = (values, most = -Infinity) => {
  for (const value of values) if (value !== null && value > most) most = value;
  return most;
};

/** Smallest value, at most `least`; NaN is ignored.
 * @param {ArrayLike<number | null> & Iterable<number | null>} values @param {number} [limit] */
export const lowest = (values, limit = Infinity) => {
  for (const value of values) if (value !== null && value < limit) limit = value;
  return limit;
};

/** The smallest and the largest value. @param {ArrayLike<number | null> & Iterable<number | null>} values */
export const spanOf = (values) => highest(values) - lowest(values);
