"""Simultaneous searches for the minima of many functions, with vectorised steps."""

import math
from collections.abc import Callable

import numpy as np

from rocking.conventions import BoolArray, FloatArray, IntArray

Values = Callable[[FloatArray, IntArray], FloatArray]


def minimise_many(
    function: Values, starts: FloatArray, sizes: IntArray, *, tolerance: float, evaluations: int
) -> FloatArray:
    """Return the lowest point of each search, shape (searches, n).

    Each search has the steps of ``scipy.optimize.minimize(method="Nelder-Mead", options={"adaptive": True})`` and an
    equal criterion for its end: a simplex smaller than the tolerance in position and value, or a maximum number of
    evaluations. Searches with fewer than n variables are padded with zeros. The arguments of the function are points,
    shape (points, n), and the index of the search of each point. The function returns values.
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
        order = np.argsort(values, axis=1)  # unused corners of a search with fewer variables come last
        simplices = np.take_along_axis(simplices, order[:, :, None], axis=1)
        values = np.take_along_axis(values, order, axis=1)
        has = np.arange(1, width + 1) <= sizes[:, None]
        reach = np.abs(simplices[:, 1:] - simplices[:, :1]).max(axis=2).max(axis=1, where=has, initial=0.0)
        rise = values[np.arange(search.size), sizes] - values[:, 0]
        ends = (left <= 0) | ((reach <= tolerance) & (rise <= tolerance))
        if ends.any():
            best[search[ends]] = simplices[ends, 0]
            search, sizes, simplices, values, left = (
                array[~ends] for array in (search, sizes, simplices, values, left)
            )
        if search.size:
            _step(function, search, sizes, simplices, values, left)
    return best


def _step(
    function: Values, search: IntArray, sizes: IntArray, simplices: FloatArray, values: FloatArray, left: IntArray
) -> None:
    """Replace the highest corner of each sorted simplex, or shrink the simplex, within the remaining evaluations."""
    own, number = np.arange(search.size), sizes[:, None]
    expand, contract = 1.0 + 2.0 / number, 0.75 - 1.0 / (2.0 * number)  # Gao and Han 2012
    highest, last, second_last = simplices[own, sizes], values[own, sizes], values[own, sizes - 1]
    others = np.arange(simplices.shape[1]) < number
    middle = np.add.reduce(np.where(others[:, :, None], simplices, 0.0), axis=1) / number
    first = 2.0 * middle - highest
    value = function(first, search)
    left -= 1
    lowest, worst = value < values[:, 0], value >= last
    is_kept = ~lowest & (value < second_last)
    # second point: beyond the first point, between the middle and the first point, or before the middle
    factor = np.where(lowest[:, None], expand, np.where(worst[:, None], -contract, contract))
    second = (1.0 + factor) * middle - factor * highest
    is_tried = ~is_kept & (left > 0)
    second_value = np.full(search.size, np.inf)
    if is_tried.any():
        second_value[is_tried] = function(second[is_tried], search[is_tried])
        left -= is_tried
    lower = is_tried & np.where(
        lowest, second_value < value, np.where(worst, second_value < last, second_value <= value)
    )
    for taken, points, point_values in (
        (is_kept | (is_tried & lowest & ~lower), first, value),
        (lower, second, second_value),
    ):
        simplices[taken, sizes[taken]] = points[taken]
        values[taken, sizes[taken]] = point_values[taken]
    for lane in np.flatnonzero(is_tried & ~lowest & ~lower).tolist():
        size = int(sizes[lane])
        count = min(size, int(left[lane]))
        simplices[lane, 1:] = simplices[lane, 0] + (1.0 - 1.0 / size) * (simplices[lane, 1:] - simplices[lane, 0])
        values[lane, 1 : count + 1] = function(simplices[lane, 1 : count + 1], np.repeat(search[lane], count))
        left[lane] -= count


_GOLDEN, _ROOT = 0.5 * (3.0 - math.sqrt(5.0)), math.sqrt(2.2e-16)


def minimise_between(function: Values, bounds: tuple[float, float], count: int, *, tolerance: float) -> FloatArray:
    """Return the lowest point of each search between bounds, shape (count,).

    Each search has the steps of ``scipy.optimize.minimize_scalar(method="bounded")``: parabolas and golden sections
    (Brent 1973). The arguments of the function are points and the index of the search of each point. The function
    returns values.
    """
    low, high = np.repeat(np.array(bounds)[:, None], count, axis=1)
    lowest = low + _GOLDEN * (high - low)
    value = function(lowest, np.arange(count))
    points, values = np.tile(lowest, (3, 1)), np.tile(value, (3, 1))  # the three lowest points and their values
    step, before = np.zeros((2, count))
    while True:
        best, middle = points[0], 0.5 * (low + high)
        min_step = _ROOT * np.abs(best) + tolerance / 3.0
        is_active = np.abs(best - middle) > 2.0 * min_step - 0.5 * (high - low)
        if not is_active.any():
            return np.asarray(best)
        section = np.where(best >= middle, low, high) - best
        parabolic, fits = _parabola(points, values, low, high, np.where(np.abs(before) > min_step, before, 0.0))
        at_edge = np.minimum(best + parabolic - low, high - best - parabolic) < 2.0 * min_step
        parabolic = np.where(at_edge, np.where(middle >= best, min_step, -min_step), parabolic)
        step, before = np.where(fits, parabolic, _GOLDEN * section), np.where(fits, step, section)
        trial = best + np.where(step >= 0.0, 1.0, -1.0) * np.maximum(np.abs(step), min_step)
        value = np.full(count, np.inf)
        value[is_active] = function(trial[is_active], np.flatnonzero(is_active))
        lower, right = value <= values[0], trial >= best
        low = np.where(is_active & (lower == right), np.where(lower, best, trial), low)
        high = np.where(is_active & (lower != right), np.where(lower, best, trial), high)
        second = ~lower & ((value <= values[1]) | (points[1] == best))
        third = ~lower & ~second & ((value <= values[2]) | (points[2] == best) | (points[2] == points[1]))
        for best_three, trial_values in ((points, trial), (values, value)):
            best_three[2] = np.where(
                is_active & (lower | second), best_three[1], np.where(is_active & third, trial_values, best_three[2])
            )
            best_three[1] = np.where(
                is_active & lower, best_three[0], np.where(is_active & second, trial_values, best_three[1])
            )
            best_three[0] = np.where(is_active & lower, trial_values, best_three[0])


def _parabola(
    points: FloatArray, values: FloatArray, low: FloatArray, high: FloatArray, before: FloatArray
) -> tuple[FloatArray, BoolArray]:
    """Return the step to the minimum of the parabola through three points, and flags of valid steps."""
    best, second, third = points
    r = (best - second) * (values[0] - values[2])
    q = (best - third) * (values[0] - values[1])
    p = (best - third) * q - (best - second) * r
    q = 2.0 * (q - r)
    p, q = np.where(q > 0.0, -p, p), np.abs(q)
    fits = (np.abs(p) < np.abs(0.5 * q * before)) & (p > q * (low - best)) & (p < q * (high - best))
    return np.divide(p, q, out=np.zeros_like(p), where=fits), fits
