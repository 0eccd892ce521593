"""Response spectra of linear oscillators, exact for straight lines between the samples."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.motions.kinematics import quadratic_roots
from rocking.motions.motion import GroundMotion, checked_motion

POINTS_PER_PERIOD = 36
"""Steps are divided until there are so many points a period; between these, peaks are those of cubics."""

FREE_POINTS = 288
"""Points in the half period of free vibration: between, a sine hides at most (pi / 287)^2 / 8 = 0.0015 %."""

SHORTEST_PERIOD = 0.05
"""Shortest period in time steps: below, the record says nothing about what the oscillator feels."""

ComplexArray = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class ResponseSpectrum:
    """Largest response of linear oscillators to one motion.

    Parameters
    ----------
    periods : ndarray
        Undamped natural periods [s].
    damping : float
        Damping ratio [-].
    displacement : ndarray
        Sd, displacement relative to the ground [m].
    velocity : ndarray
        Sv, velocity relative to the ground [m/s].
    absolute_acceleration : ndarray
        Sa, true acceleration of the mass in space [m/s2].
    """

    periods: FloatArray
    damping: float
    displacement: FloatArray
    velocity: FloatArray
    absolute_acceleration: FloatArray

    @property
    def pseudo_velocity(self) -> FloatArray:
        """PSV: Sd times the natural frequency [m/s]."""
        return 2.0 * np.pi / self.periods * self.displacement

    @property
    def pseudo_acceleration(self) -> FloatArray:
        """PSA: Sd times the squared natural frequency; equal to Sa only without damping [m/s2]."""
        return (2.0 * np.pi / self.periods) ** 2 * self.displacement


def response_spectrum(motion: GroundMotion, periods: ArrayLike, damping: float = 0.05) -> ResponseSpectrum:
    """Return the response spectrum of a motion.

    The recurrence is exact for straight lines between the samples (Nigam & Jennings 1969, DOI
    10.1785/BSSA0590020909), here in its complex form. The only error is that
    of looking for peaks: within each step they are those of cubics through values and slopes, on at least 36 points
    a period, and miss the true ones by less than 0.01 %, for periods down to 2 time steps and below. Half a period of
    free vibration after the last sample is included.

    Parameters
    ----------
    motion : GroundMotion
        The motion; its horizontal part counts.
    periods : array_like
        Undamped natural periods, at least 1/20 of the time step [s].
    damping : float
        Damping ratio, from 0 to below 1 [-].

    Returns
    -------
    ResponseSpectrum
        One value of each kind for each period.

    Raises
    ------
    InvalidValueError
        If a period is not a finite number of at least 1/20 of the time step, or the damping is outside its range.

    Examples
    --------
    >>> step = GroundMotion([1.0] * 101, time_step=0.01)
    >>> spectrum = response_spectrum(step, [0.1, 0.2], damping=0.0)
    >>> spectrum.pseudo_acceleration.round(2).tolist()
    [2.0, 2.0]
    """
    motion = checked_motion(motion)
    damping = checks.within("damping", damping, 0.0, 1.0, open_high=True, hint="a ratio, not a percentage")
    given = np.atleast_1d(checks.positive_array("periods", periods, "s"))
    if given.ndim != 1 or not given.size:
        raise InvalidValueError(f"periods must be a row of at least 1 number [s], got shape {given.shape}")
    shortest = SHORTEST_PERIOD * motion.time_step
    if given.min() < shortest:
        raise InvalidValueError(f"periods must be at least {shortest:g} s for this time step, got {given.min():g}")
    peaks = np.array([_peaks(motion, float(period), damping) for period in given])
    return ResponseSpectrum(given.copy(), damping, peaks[:, 0], peaks[:, 1], peaks[:, 2])


def phi(x: complex) -> tuple[complex, complex]:
    """Return the first two phi functions of exponential integrators.

    Parameters
    ----------
    x : complex
        Rate times step [-].

    Returns
    -------
    tuple of complex
        ``(exp(x) - 1) / x`` and ``(exp(x) - 1 - x) / x^2``, to rounding also near zero.

    Examples
    --------
    >>> phi(0.0)
    (1.0, 0.5)
    """
    if abs(x) > 1.0:
        first = (np.exp(x) - 1.0) / x
        return first, (first - 1.0) / x
    second = 0.0 + 0.0 * x
    for k in range(20, 1, -1):
        second = 1.0 / math.factorial(k) + x * second
    return 1.0 + x * second, second


def _peaks(motion: GroundMotion, period: float, damping: float) -> tuple[float, float, float]:
    """Return the largest displacement, velocity and absolute acceleration of one oscillator."""
    # with the complex rate s, the state z = u' - conj(s) u obeys z' = s z - a, and u = Im z / Im s
    omega = 2.0 * math.pi / period
    rate = complex(-damping * omega, omega * math.sqrt(1.0 - damping * damping))
    states = _states(motion, rate)
    h, a = motion.time_step, motion.acceleration
    rise = np.diff(a)
    parts = math.ceil(POINTS_PER_PERIOD * h / period)
    best = np.zeros(3)
    left = _response(states[:-1], a[:-1], rate)
    for k in range(1, parts + 1):
        t = k * h / parts
        first, second = phi(rate * t)
        inside = np.exp(rate * t) * states[:-1] - t * first * a[:-1] - (t * t / h * second) * rise
        right = _response(inside, a[:-1] + k / parts * rise, rate)
        best = np.maximum(best, [_peak(*pair, h / parts) for pair in zip(left, right, strict=True)])
        left = right
    # afterwards it swings freely: half a period holds one extreme of each
    free = states[-1] * np.exp(rate * np.linspace(0.0, math.pi / rate.imag, FREE_POINTS))
    best = np.maximum(best, [np.abs(value).max() for value, _ in _response(free, np.zeros(FREE_POINTS), rate)])
    return float(best[0]), float(best[1]), float(best[2])


def _states(motion: GroundMotion, rate: complex) -> ComplexArray:
    from scipy.signal import lfilter

    h, a = motion.time_step, motion.acceleration
    first, second = phi(rate * h)
    pushes = np.zeros(a.size, dtype=np.complex128)
    pushes[1:] = -h * ((first - second) * a[:-1] + second * a[1:])
    result: Any = lfilter([1.0], [1.0, -np.exp(rate * h)], pushes)
    return np.asarray(result, dtype=np.complex128)


def _response(states: ComplexArray, ground: FloatArray, rate: complex) -> list[tuple[FloatArray, FloatArray]]:
    """Return displacement, velocity and absolute acceleration, each with its rate of change."""
    u = states.imag / rate.imag
    v = states.real + rate.real * u
    omega2, friction = abs(rate) ** 2, -2.0 * rate.real
    absolute = -friction * v - omega2 * u
    change = absolute - ground
    return [(u, v), (v, change), (absolute, -friction * change - omega2 * v)]


def _peak(left: tuple[FloatArray, FloatArray], right: tuple[FloatArray, FloatArray], step: float) -> float:
    """Return the largest magnitude of cubics through values and slopes at both ends."""
    ends = max(float(np.abs(left[0]).max()), float(np.abs(right[0]).max()))
    # no cubic leaves the range of its ends by more than 4/27 of its slopes: most need no closer look
    reach = np.maximum(np.abs(left[0]), np.abs(right[0])) + 4.0 / 27.0 * step * (np.abs(left[1]) + np.abs(right[1]))
    (y, d), (z, e) = ((side[0][reach > ends], step * side[1][reach > ends]) for side in (left, right))
    rise = z - y
    best = ends
    for root in quadratic_roots(3.0 * (d + e - 2.0 * rise), 2.0 * (3.0 * rise - 2.0 * d - e), d):
        t = np.where((root > 0.0) & (root < 1.0), root, 0.0)
        inside = y + t * (d + t * (3.0 * rise - 2.0 * d - e + t * (d + e - 2.0 * rise)))
        best = max(best, float(np.abs(inside).max(initial=0.0)))
    return best
