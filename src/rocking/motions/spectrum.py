"""Response spectra of linear oscillators, exact for straight lines between the samples."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking import checks
from rocking.conventions import FloatArray, IntArray
from rocking.errors import InvalidValueError
from rocking.motions.integrals import quadratic_roots
from rocking.motions.motion import GroundMotion, checked_motion

POINTS_PER_PERIOD = 36
"""Steps are divided until there are so many points a period; between these, peaks are those of cubics."""

FREE_POINTS = 288
"""Points in the half period of free vibration: between, a sine hides at most (pi / 287)^2 / 8 = 0.0015 %."""

MARGIN = 1.001
"""Room for cubics, which leave the true response by less than 0.01 %, in the bound of what a step can hold [-]."""

HIGH = 0.8  # samples whose state is so large, compared with the largest, give the first guess of the peaks [-]
TOGETHER = 90_000  # steps times periods that are held at once: for more, the system is asked for room each time
_BLOCK = 16  # samples of a row that follow one another in the recurrence of its states

SHORTEST_PERIOD = 0.05  # shortest period in time steps: below, the record says nothing about what the oscillator feels
ComplexArray = NDArray[np.complex128]
Pairs = list[tuple[FloatArray, FloatArray]]
"""Displacement, velocity and absolute acceleration, each with its rate of change."""


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
        return 2.0 * np.pi / self.periods * self.displacement  # Eq. 149

    @property
    def pseudo_acceleration(self) -> FloatArray:
        """PSA: Sd times the squared natural frequency; equal to Sa only without damping [m/s2]."""
        return (2.0 * np.pi / self.periods) ** 2 * self.displacement  # Eq. 149


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
    given, damping, rates = oscillators(motion, periods, damping)
    found = _largest(motion, given, rates)
    return ResponseSpectrum(given, damping, found[:, 0], found[:, 1], found[:, 2])


def oscillators(motion: GroundMotion, periods: ArrayLike, damping: float) -> tuple[FloatArray, float, ComplexArray]:
    """Return periods [s] and damping of oscillators, checked, and their complex rates."""
    damping = checks.within("damping", damping, 0.0, 1.0, open_high=True, hint="a ratio, not a percentage")
    given = np.atleast_1d(checks.positive_array("periods", periods, "s"))
    if given.ndim != 1 or not given.size:
        raise InvalidValueError(f"periods must be a row of at least 1 number [s], got shape {given.shape}")
    shortest = SHORTEST_PERIOD * motion.time_step
    if given.min() < shortest:
        raise InvalidValueError(f"periods must be at least {shortest:g} s for this time step, got {given.min():g}")
    # with the complex rate s, the state z = u' - conj(s) u obeys z' = s z - a, and u = Im z / Im s
    rates = 2.0 * math.pi / given * complex(-damping, math.sqrt(1.0 - damping * damping))  # Eq. 150
    return given.copy(), damping, np.asarray(rates, dtype=np.complex128)


def phi(x: Any) -> tuple[Any, Any]:
    """Return the phi functions ``(exp(x) - 1) / x`` and ``(exp(x) - 1 - x) / x^2``, to rounding also near zero."""
    given = np.asarray(x, dtype=np.complex128)
    near = np.abs(given) <= 1.0
    small, large = np.where(near, given, 0.0), np.where(near, 1.0, given)
    series = np.zeros_like(given)
    for k in range(20, 1, -1):
        series = 1.0 / math.factorial(k) + small * series  # Eq. 152
    first = (np.exp(large) - 1.0) / large  # Eq. 152
    return np.where(near, 1.0 + small * series, first)[()], np.where(near, series, (first - 1.0) / large)[()]


def _largest(motion: GroundMotion, periods: FloatArray, rates: ComplexArray) -> FloatArray:
    """Return displacement, velocity and absolute acceleration, one row a period: as many periods at once as fit."""
    parts = np.ceil(POINTS_PER_PERIOD * motion.time_step / periods).astype(np.int64)
    result = np.empty((periods.size, 3))
    size = max(1, TOGETHER // len(motion))
    for number in sorted(set(parts.tolist())):  # NumPy's unique would load masked arrays
        same = np.flatnonzero(parts == number)
        for start in range(0, same.size, size):
            chosen = same[start : start + size]
            result[chosen] = _peaks(motion, rates[chosen], number).T
    return result


def _peaks(motion: GroundMotion, rates: ComplexArray, parts: int) -> FloatArray:
    at_samples = states(motion, rates)
    best = np.zeros((3, rates.size))
    swing = np.exp(rates[:, None] * (math.pi / rates.imag[:, None] * np.linspace(0.0, 1.0, FREE_POINTS)))
    for j, (value, _) in enumerate(_response(at_samples[:, -1:] * swing, np.zeros(swing.shape), rates[:, None])):
        best[j] = np.abs(value).max(axis=1)
    which, step = _close_steps(motion, rates, at_samples, best)
    h, a = motion.time_step, motion.acceleration
    rise, rate, start = a[step + 1] - a[step], rates[which], at_samples[which, step]
    left = _response(start, a[step], rate)
    for j in range(3):
        np.maximum.at(best[j], which, np.abs(left[j][0]))
    for k in range(1, parts + 1):
        t = k * h / parts
        first, second = phi(rates * t)
        inside = np.exp(rates * t)[which] * start
        inside -= t * first[which] * a[step] + (t * t / h * second)[which] * rise
        right = _response(inside, a[step] + k / parts * rise, rate)
        for j, pair in enumerate(zip(left, right, strict=True)):
            _raise(best[j], which, *pair, h / parts)
        left = right
    return best


def states(motion: GroundMotion, rates: ComplexArray) -> ComplexArray:
    """Return the states at the samples, one row an oscillator, at rest at the first."""
    h, a = motion.time_step, motion.acceleration
    first, second = phi(rates * h)
    before, after = _blocks(a[None, :-1]), _blocks(a[None, 1:])
    pushes = (-h * second)[:, None] * after + (-h * (first - second))[:, None] * before  # Eq. 151
    found = np.zeros((rates.size, 1 + pushes.shape[0] * pushes.shape[2]), dtype=np.complex128)
    found[:, 1:] = _recurrence(pushes, np.exp(rates * h)).transpose(1, 2, 0).reshape(rates.size, -1)
    return found[:, : a.size]


def _blocks(rows: NDArray[Any]) -> NDArray[Any]:
    """Return rows cut into blocks: what stands at one place of all blocks together."""
    padded = np.zeros((len(rows), -(-rows.shape[1] // _BLOCK) * _BLOCK), dtype=rows.dtype)
    padded[:, : rows.shape[1]] = rows
    return np.ascontiguousarray(padded.reshape(len(rows), -1, _BLOCK).transpose(2, 0, 1))


def _recurrence(pushes: ComplexArray, decay: ComplexArray) -> ComplexArray:
    """Return y[n] = decay y[n - 1] + push[n] of each row, in place of the pushes: blocks, then what they hand on."""
    for k in range(1, _BLOCK):
        pushes[k] += decay[:, None] * pushes[k - 1]
    last = pushes[-1, :, :-1]
    if last.shape[1]:
        handed = _recurrence(_blocks(last), decay**_BLOCK).transpose(1, 2, 0).reshape(len(decay), -1)
        carried = handed[:, : last.shape[1]]
        for k in range(_BLOCK):
            pushes[k, :, 1:] += (decay ** (k + 1))[:, None] * carried
    return pushes


def _close_steps(
    motion: GroundMotion, rates: ComplexArray, states: ComplexArray, best: FloatArray
) -> tuple[IntArray, IntArray]:
    """Return oscillators and steps that may hold a largest response, and raise the best known to those of samples."""
    size = np.sqrt(states.real**2 + states.imag**2)
    which, sample = np.nonzero(size >= HIGH * size.max(axis=1)[:, None])
    for j, (value, _) in enumerate(_response(states[which, sample], np.zeros(which.size), rates[which])):
        np.maximum.at(best[j], which, np.abs(value))
    needed = (best / _reach(rates)).min(axis=0) / (0.5 * MARGIN)
    h, a = motion.time_step, np.abs(motion.acceleration)
    decay = np.exp(-rates.real * h)[:, None]
    # within a step a state changes by no more than the push of the ground, seen from either of its ends
    bound = size[:, 1:] + h * np.maximum(a[:-1], a[1:])
    bound *= decay
    bound += size[:, :-1]
    found, step = np.nonzero(bound > needed[:, None])
    return np.asarray(found, dtype=np.int64), np.asarray(step, dtype=np.int64)


def _reach(s: ComplexArray) -> FloatArray:
    """Return the largest responses of states of magnitude one, whatever their phase: one row a response."""
    friction, omega2 = -2.0 * s.real, np.abs(s) ** 2
    velocity, absolute = np.hypot(1.0, s.real / s.imag), np.hypot(friction, (friction * s.real + omega2) / s.imag)
    return np.stack([1.0 / s.imag, velocity, absolute])


def _raise(best: FloatArray, which: IntArray, left: Any, right: Any, step: float) -> None:
    """Raise the largest magnitudes to those of cubics through values and slopes at both ends."""
    np.maximum.at(best, which, np.abs(right[0]))
    # no cubic leaves the range of its ends by more than 4/27 of its slopes: most need no closer look
    reach = np.maximum(np.abs(left[0]), np.abs(right[0])) + 4.0 / 27.0 * step * (np.abs(left[1]) + np.abs(right[1]))
    close = np.flatnonzero(reach > best[which])
    (y, d), (z, e) = ((side[0][close], step * side[1][close]) for side in (left, right))
    rise = z - y
    for root in quadratic_roots(3.0 * (d + e - 2.0 * rise), 2.0 * (3.0 * rise - 2.0 * d - e), d):
        t = np.where((root > 0.0) & (root < 1.0), root, 0.0)
        inside = y + t * (d + t * (3.0 * rise - 2.0 * d - e + t * (d + e - 2.0 * rise)))
        np.maximum.at(best, which[close], np.abs(inside))


def _response(states: ComplexArray, ground: FloatArray, rates: ComplexArray) -> Pairs:
    """Return displacement, velocity and absolute acceleration, each with its rate of change."""
    u = states.imag / rates.imag  # Eq. 150
    v = states.real + rates.real * u
    omega2, friction = np.abs(rates) ** 2, -2.0 * rates.real
    absolute = -friction * v - omega2 * u
    change = absolute - ground
    return [(u, v), (v, change), (absolute, -friction * change - omega2 * v)]
