/** Curves of several models on a common time axis, for the charts.
 * @param {number[]} time @param {(number | null)[]} values @param {number[]} grid */

const straight = (time, values, grid) => {
  const interpolated = new Array(grid.length);
  let k = 0;
  for (let j = 0; j < grid.length; j += 1) {
    const instant = grid[j];
    if (instant > time[time.length - 1]) {
      interpolated[j] = null;
      continue;
    }
    while (k < time.length - 2 && time[k + 1] < instant) k += 1;
    const width = time[k + 1] - time[k];
    const share = width > 0 ? (instant - time[k]) / width : 1;
    const [first, second] = [values[k], values[k + 1]];
    interpolated[j] = first === null || second === null ? null : first + (second - first) * share;
  }
  return interpolated;
};

/** Returns every instant of several histories once, in order [s]. @param {number[][]} histories */
const commonTime = (histories) => {
  const all = Float64Array.from(histories.flatMap((time) => time)).sort();
  const grid = [];
  for (const instant of all) if (!grid.length || instant > grid[grid.length - 1]) grid.push(instant);
  return grid;
};

const grids = new WeakMap(); // common times by responses, for all their curves

/** @param {Server.ResponseFacts[]} answers */
const gridOf = (answers) => {
  if (!grids.has(answers)) grids.set(answers, commonTime(answers.map((answer) => answer.series.time)));
  return grids.get(answers);
};

/** Returns [time, values of the first answer, of the second, ...]; null after a history has ended.
 * @param {Server.ResponseFacts[]} answers @param {(answer: Server.ResponseFacts) => (number | null)[]} valuesOf @returns {Columns} */
export const together = (answers, valuesOf) => {
  const grid = gridOf(answers);
  return [grid, ...answers.map((answer) => straight(answer.series.time, valuesOf(answer), grid))];
};
