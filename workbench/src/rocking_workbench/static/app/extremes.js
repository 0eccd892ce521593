/** Extremes of data: a call that takes all values as its arguments ends at some 100,000 of them. */

/** Largest of some values, at least `most`; NaN is ignored.
 * @param {ArrayLike<number | null> & Iterable<number | null>} values @param {number} [most] */
export const highest = (values, most = -Infinity) => {
  for (const value of values) if (value !== null && value > most) most = value;
  return most;
};

/** The smallest of some values, not above `least`.
 * @param {ArrayLike<number | null> & Iterable<number | null>} values @param {number} [limit] */
export const lowest = (values, limit = Infinity) => {
  for (const value of values) if (value !== null && value < limit) limit = value;
  return limit;
};

/** From the smallest to the largest. @param {ArrayLike<number | null> & Iterable<number | null>} values */
export const spanOf = (values) => highest(values) - lowest(values);
