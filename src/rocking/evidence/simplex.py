"""The adaptive simplex search of Nelder and Mead for many functions at once, which take their steps together."""

from collections.abc import Callable

import numpy as np

from rocking.conventions import FloatArray, IntArray

Function = Callable[[FloatArray, IntArray], FloatArray]


def minimise_many(
    function: Function, starts: FloatArray, sizes: IntArray, *, tolerance: float, evaluations: int
) -> FloatArray:
    """Return the lowest point that each search finds, of shape (searches, n).

    Each search takes the steps of ``scipy.optimize.minimize(method="Nelder-Mead", options={"adaptive": True})`` and
    ends where that ends: where its simplex is smaller than the tolerance in place and value, or after a number of
    evaluations. A search of fewer than n variables has zeros behind them. The function takes points, of shape
    (points, n), and the number of the search of each, and returns their values.
    """
    count, width = starts.shape
    simplices = np.repeat(starts[:, None], width + 1, axis=1)
    for k in range(width):
        simplices[:, k + 1, k] = np.where(starts[:, k] != 0.0, 1.05 * starts[:, k], 0.00025)
    values = np.full((count, width + 1), np.inf)
    search, corner = np.nonzero(np.arange(width + 1) <= sizes[:, None])
    values[search, corner] = function(simplices[search, corner], search)
    left = evaluations - sizes - 1
    best = np.empty_like(starts)
    search = np.arange(count)
    while search.size:
        order = np.argsort(values, axis=1)  # corners that a search of fewer variables does not have are last
        simplices = np.take_along_axis(simplices, order[:, :, None], axis=1)
        values = np.take_along_axis(values, order, axis=1)
        has = np.arange(1, width + 1) <= sizes[:, None]
        reach = np.abs(simplices[:, 1:] - simplices[:, :1]).max(axis=2).max(axis=1, where=has, initial=0.0)
        rise = values[np.arange(search.size), sizes] - values[:, 0]
        ends = (left <= 0) | ((reach <= tolerance) & (rise <= tolerance))
        if ends.any():
            best[search[ends]] = simplices[ends, 0]
            search, sizes, simplices, values, left = (each[~ends] for each in (search, sizes, simplices, values, left))
        if search.size:
            _step(function, search, sizes, simplices, values, left)
    return best


def _step(
    function: Function, search: IntArray, sizes: IntArray, simplices: FloatArray, values: FloatArray, left: IntArray
) -> None:
    """Replace the highest corner of each sorted simplex, or shrink the simplex, as far as evaluations are left."""
    own, number = np.arange(search.size), sizes[:, None]
    expand, contract = 1.0 + 2.0 / number, 0.75 - 1.0 / (2.0 * number)  # Gao and Han 2012
    highest, last, second_last = simplices[own, sizes], values[own, sizes], values[own, sizes - 1]
    others = np.arange(simplices.shape[1]) < number
    middle = np.add.reduce(np.where(others[:, :, None], simplices, 0.0), axis=1) / number
    first = 2.0 * middle - highest
    value = function(first, search)
    left -= 1
    lowest, worst = value < values[:, 0], value >= last
    kept = ~lowest & (value < second_last)
    # a second point: beyond the first, between the middle and the first, or before the middle
    factor = np.where(lowest[:, None], expand, np.where(worst[:, None], -contract, contract))
    second = (1.0 + factor) * middle - factor * highest
    tried = ~kept & (left > 0)
    found = np.full(search.size, np.inf)
    if tried.any():
        found[tried] = function(second[tried], search[tried])
        left -= tried
    lower = tried & np.where(lowest, found < value, np.where(worst, found < last, found <= value))
    for taken, points, at in ((kept | (tried & lowest & ~lower), first, value), (lower, second, found)):
        simplices[taken, sizes[taken]] = points[taken]
        values[taken, sizes[taken]] = at[taken]
    for lane in np.flatnonzero(tried & ~lowest & ~lower).tolist():
        size = int(sizes[lane])
        count = min(size, int(left[lane]))
        simplices[lane, 1:] = simplices[lane, 0] + (1.0 - 1.0 / size) * (simplices[lane, 1:] - simplices[lane, 0])
        values[lane, 1 : count + 1] = function(simplices[lane, 1 : count + 1], np.repeat(search[lane], count))
        left[lane] -= count
