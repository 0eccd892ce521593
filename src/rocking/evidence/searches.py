"""Searches of the minima of many functions at once, which take their steps together."""

import math
from collections.abc import Callable

import numpy as np

from rocking.conventions import BoolArray, FloatArray, IntArray

Values = Callable[[FloatArray, IntArray], FloatArray]


def minimise_many(
    function: Values, starts: FloatArray, sizes: IntArray, *, tolerance: float, evaluations: int
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
    function: Values, search: IntArray, sizes: IntArray, simplices: FloatArray, values: FloatArray, left: IntArray
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


_GOLDEN, _ROOT = 0.5 * (3.0 - math.sqrt(5.0)), math.sqrt(2.2e-16)


def minimise_between(function: Values, bounds: tuple[float, float], count: int, *, tolerance: float) -> FloatArray:
    """Return the lowest place that each of some searches finds between bounds, of shape (count,).

    Each search takes the steps of ``scipy.optimize.minimize_scalar(method="bounded")``: parabolas and golden sections
    (Brent 1973). The function takes places and the number of the search of each, and returns their values.
    """
    low, high = np.repeat(np.array(bounds)[:, None], count, axis=1)
    lowest = low + _GOLDEN * (high - low)
    value = function(lowest, np.arange(count))
    places, values = np.tile(lowest, (3, 1)), np.tile(value, (3, 1))  # the lowest place, the second and the third
    step, before = np.zeros((2, count))
    while True:
        best, middle = places[0], 0.5 * (low + high)
        least = _ROOT * np.abs(best) + tolerance / 3.0
        goes_on = np.abs(best - middle) > 2.0 * least - 0.5 * (high - low)
        if not goes_on.any():
            return np.asarray(best)
        section = np.where(best >= middle, low, high) - best
        parabolic, fits = _parabola(places, values, low, high, np.where(np.abs(before) > least, before, 0.0))
        at_edge = np.minimum(best + parabolic - low, high - best - parabolic) < 2.0 * least
        parabolic = np.where(at_edge, np.where(middle >= best, least, -least), parabolic)
        step, before = np.where(fits, parabolic, _GOLDEN * section), np.where(fits, step, section)
        place = best + np.where(step >= 0.0, 1.0, -1.0) * np.maximum(np.abs(step), least)
        value = np.full(count, np.inf)
        value[goes_on] = function(place[goes_on], np.flatnonzero(goes_on))
        lower, right = value <= values[0], place >= best
        low = np.where(goes_on & (lower == right), np.where(lower, best, place), low)
        high = np.where(goes_on & (lower != right), np.where(lower, best, place), high)
        second = ~lower & ((value <= values[1]) | (places[1] == best))
        third = ~lower & ~second & ((value <= values[2]) | (places[2] == best) | (places[2] == places[1]))
        for held, new in ((places, place), (values, value)):
            held[2] = np.where(goes_on & (lower | second), held[1], np.where(goes_on & third, new, held[2]))
            held[1] = np.where(goes_on & lower, held[0], np.where(goes_on & second, new, held[1]))
            held[0] = np.where(goes_on & lower, new, held[0])


def _parabola(
    places: FloatArray, values: FloatArray, low: FloatArray, high: FloatArray, before: FloatArray
) -> tuple[FloatArray, BoolArray]:
    """Return the step to the minimum of the parabola through three places, and where it is to be taken."""
    best, second, third = places
    r = (best - second) * (values[0] - values[2])
    q = (best - third) * (values[0] - values[1])
    p = (best - third) * q - (best - second) * r
    q = 2.0 * (q - r)
    p, q = np.where(q > 0.0, -p, p), np.abs(q)
    fits = (np.abs(p) < np.abs(0.5 * q * before)) & (p > q * (low - best)) & (p < q * (high - best))
    return np.divide(p, q, out=np.zeros_like(p), where=fits), fits
