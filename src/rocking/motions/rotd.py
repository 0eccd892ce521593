"""Response spectra of two components over all directions: RotD50, RotD100 and whatever lies between.

The oscillator is followed once along each component, exactly; turned into another direction its displacement is a sum
of both.
"""

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import ArrayLike

from rocking import checks
from rocking.conventions import FloatArray
from rocking.motions.components import ANGLES, matching
from rocking.motions.filters import compiled
from rocking.motions.motion import GroundMotion
from rocking.motions.spectrum import FREE_POINTS, POINTS_PER_PERIOD, oscillators, phi, states

_TURN = np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=1)  # one direction a row: every degree of half a turn
_WITHIN = (0.25, 0.5, 0.75)  # places in a step where a cubic is looked at: 144 points a period miss at most 0.024 %


def rotd_spectrum(
    first: GroundMotion,
    second: GroundMotion,
    periods: ArrayLike,
    damping: float = 0.05,
    percentiles: ArrayLike = (50.0, 100.0),
) -> FloatArray:
    """Return percentiles over all directions of the pseudo-spectral acceleration.

    Boore (2010), DOI 10.1785/0120090400: the directions are every degree over half a turn. Exact for straight lines
    between the samples but for the look for peaks, which misses less than 0.03 %.

    Parameters
    ----------
    first, second : GroundMotion
        Perpendicular horizontal components, of one step and length.
    periods : array_like
        Undamped natural periods, at least 1/20 of the time step [s].
    damping : float
        Damping ratio, from 0 to below 1 [-].
    percentiles : array_like
        50 for RotD50, 100 for RotD100, 0 for RotD00 [%].

    Returns
    -------
    ndarray, shape (percentiles, periods)
        PSA [m/s2].

    Raises
    ------
    InvalidValueError
        If the components do not match, or a period, the damping or a percentile is outside of its range.

    Examples
    --------
    >>> along, across = GroundMotion([3.0] * 101, 0.01), GroundMotion([4.0] * 101, 0.01)
    >>> rotd_spectrum(along, across, [0.1, 0.2], damping=0.0, percentiles=[100]).round(2).tolist()
    [[10.0, 10.0]]
    """
    wanted = np.atleast_1d(checks.real_array("percentiles", percentiles, "%"))
    for each in wanted.tolist():
        checks.within("percentiles", each, 0.0, 100.0, unit="%")
    peaks = directional_spectra(first, second, periods, damping)
    return np.asarray(np.percentile(peaks, wanted, axis=1), dtype=np.float64)


def directional_spectra(
    first: GroundMotion, second: GroundMotion, periods: ArrayLike, damping: float = 0.05
) -> FloatArray:
    """Return the pseudo-spectral acceleration in every direction, one row a period [m/s2]."""
    matching(first, second)
    given, _, rates = oscillators(first, periods, damping)
    parts = np.ceil(POINTS_PER_PERIOD * first.time_step / given).astype(np.int64)
    found = np.zeros((given.size, len(ANGLES)))
    if (module := compiled()) is not None:
        both, step = (first.acceleration, second.acceleration), first.time_step
        module.directions(*both, step, rates, np.cos(ANGLES), np.sin(ANGLES), parts, FREE_POINTS, found)
    else:
        for row, rate, number in zip(found, rates, parts.tolist(), strict=True):
            for places in _path(first, second, rate, number):
                np.maximum(row, np.abs(_TURN @ places).max(axis=1), out=row)  # Eq. 156
    return np.asarray(found * (2.0 * np.pi / given[:, None]) ** 2, dtype=np.float64)  # Eq. 149


def _path(first: GroundMotion, second: GroundMotion, rate: complex, parts: int) -> Iterator[FloatArray]:
    """Yield places on the path of one oscillator that two components drive, on so many parts of each step [m]."""
    h, one = first.time_step, np.array([rate])
    state = np.concatenate([states(first, one), states(second, one)])
    ground = np.stack([first.acceleration, second.acceleration])
    swing = np.exp(rate * math.pi / rate.imag * np.linspace(0.0, 1.0, FREE_POINTS))
    yield (state[:, -1:] * swing).imag / rate.imag
    start, rise, left = state[:, :-1], np.diff(ground), state[:, :-1]
    for k in range(1, parts + 1):
        t = k * h / parts
        level, slope = phi(rate * t)
        right = np.exp(rate * t) * start - t * level * ground[:, :-1] - t * t / h * slope * rise  # Eq. 151
        y, z = left.imag / rate.imag, right.imag / rate.imag  # Eq. 150
        d, e = (h / parts * (side.real + rate.real * at) for side, at in ((left, y), (right, z)))
        for at in (*_WITHIN, 1.0):
            yield y + at * (d + at * (3.0 * (z - y) - 2.0 * d - e + at * (d + e - 2.0 * (z - y))))
        left = right
