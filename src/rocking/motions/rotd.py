"""Response spectra of two components over all directions: RotD50, RotD100 and whatever lies between.

The oscillator is followed once along each component, exactly; turned into another direction its displacement is a sum
of both. Only points near the outline of its path matter, whatever the direction, and few are.
"""

import math

import numpy as np
from numpy.typing import ArrayLike

from rocking import checks
from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.motions.components import ANGLES, matching
from rocking.motions.motion import GroundMotion
from rocking.motions.spectrum import FREE_POINTS, POINTS_PER_PERIOD, TOGETHER, ComplexArray, oscillators, phi, states

_TURN = np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=1)  # one direction a row: every degree of half a turn
_COARSE = _TURN[::12]  # in which the first points of the outline are looked for
_OVER_COSINE = 1.0 / np.maximum(np.abs(_TURN @ _TURN.T), 1e-9)  # of the angle between two directions
_SLACK = 0.9998  # between two directions of a degree an outline lies no further inside than this [-]
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
    parts = np.ceil(POINTS_PER_PERIOD * first.time_step / given).astype(np.int64).tolist()
    found = np.empty((given.size, len(_TURN)))
    size = max(1, TOGETHER // (2 * len(first)))
    for start in range(0, given.size, size):
        some = slice(start, start + size)
        along, across = states(first, rates[some]), states(second, rates[some])
        for k, rate in enumerate(rates[some].tolist()):
            path = np.stack([along[k], across[k]])
            found[start + k] = _Path(first, second, rate, path).peaks(parts[start + k])
    return np.asarray(found * (2.0 * np.pi / given[:, None]) ** 2, dtype=np.float64)  # Eq. 149


class _Path:
    """The path of one oscillator that two components drive, by its states at the samples."""

    def __init__(self, first: GroundMotion, second: GroundMotion, rate: complex, path: ComplexArray) -> None:
        self.step, self.rate, self.states = first.time_step, rate, path
        self.ground = np.stack([first.acceleration, second.acceleration])
        self.best = np.zeros(len(_TURN))  # largest displacement in every direction so far

    def peaks(self, parts: int) -> FloatArray:
        """Return the largest displacement in every direction, looked for on so many parts of each step [m]."""
        swing = np.exp(self.rate * math.pi / self.rate.imag * np.linspace(0.0, 1.0, FREE_POINTS))
        places = self._places(self.states)
        self._raise(places[:, np.abs(_COARSE @ places).argmax(axis=1)])
        self._raise(self._places(self.states[:, -1:] * swing))
        self._raise(self._outside(places))
        at = self._close_steps()
        start, rise = self.states[:, at], self.ground[:, at + 1] - self.ground[:, at]
        left, h = start, self.step
        for k in range(1, parts + 1):
            t = k * h / parts
            one, two = phi(self.rate * t)
            right = np.exp(self.rate * t) * start - t * one * self.ground[:, at] - t * t / h * two * rise
            self._cubics(left, right, h / parts)
            left = right
        return self.best

    def _cubics(self, left: ComplexArray, right: ComplexArray, step: float) -> None:
        """Raise the best to what cubics between the ends of stretches reach."""
        y, z = self._places(left), self._places(right)
        d, e = (step * (side.real + self.rate.real * at) for side, at in ((left, y), (right, z)))
        # a cubic lies within the hull of its ends and two points on its tangents
        near = np.zeros(y.shape[1], dtype=bool)
        radius = self._radius()
        for point in (z, y + d / 3.0, z - e / 3.0):
            near |= _is_outside(point, radius)
        y, z, d, e = y[:, near], z[:, near], d[:, near], e[:, near]
        rise = z - y
        for t in _WITHIN:
            self._raise(y + t * (d + t * (3.0 * rise - 2.0 * d - e + t * (d + e - 2.0 * rise))))
        self._raise(z)

    def _places(self, of: ComplexArray) -> FloatArray:
        return np.asarray(of.imag / self.rate.imag, dtype=np.float64)  # Eq. 150

    def _raise(self, places: FloatArray) -> None:
        if places.size:
            np.maximum(self.best, np.abs(_TURN @ places).max(axis=1), out=self.best)  # Eq. 156

    def _outside(self, places: FloatArray) -> FloatArray:
        return places[:, _is_outside(places, self._radius())]

    def _radius(self) -> FloatArray:
        """Return how far the outline that has these peaks is from the middle, in every direction."""
        return np.asarray((self.best * _OVER_COSINE).min(axis=1), dtype=np.float64)

    def _close_steps(self) -> IntArray:
        """Return the steps within which the path may leave the outline."""
        # within a step a state changes by no more than the push of the ground, seen from either of its ends
        size = np.hypot(*np.abs(self.states))
        push = self.step * np.hypot(*np.maximum(np.abs(self.ground[:, :-1]), np.abs(self.ground[:, 1:])))
        bound = size[:-1] + math.exp(-self.rate.real * self.step) * (size[1:] + push)
        return np.asarray(np.flatnonzero(bound >= 2.0 * self.rate.imag * float(self.best.min())), np.int64)


def _is_outside(places: FloatArray, radius: FloatArray) -> BoolArray:
    """Return which places lie beyond an outline given by its radius at every degree of half a turn."""
    size = np.hypot(places[0], places[1])
    beyond: BoolArray = size > _SLACK * radius.min()
    near = np.flatnonzero(beyond)
    direction = np.degrees(np.arctan2(places[1, near], places[0, near])) % 180.0
    low = direction.astype(np.int64) % len(radius)
    beyond[near] = size[near] > _SLACK * np.minimum(radius[low], radius[(low + 1) % len(radius)])
    return beyond
