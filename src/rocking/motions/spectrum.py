"""Spectra of a record: of linear oscillators, exact for straight lines between the samples, and of Fourier."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rocking import checks
from rocking.conventions import FloatArray, IntArray
from rocking.errors import InvalidValueError
from rocking.motions.components import ANGLES, matching
from rocking.motions.filters import compiled
from rocking.motions.integrals import quadratic_roots
from rocking.motions.motion import GroundMotion, checked_motion

POINTS_PER_PERIOD = 36
"""Steps are divided until there are so many points a period; between these, peaks are those of cubics."""

FREE_POINTS = 288
"""Points in the half period of free vibration: between, a sine hides at most (pi / 287)^2 / 8 = 0.0015 %."""

MARGIN = 1.001
"""Room for cubics, which leave the true response by less than 0.01 %, in the bound of what a step can hold [-]."""

SHORTEST_PERIOD = 0.05  # shortest period in time steps: below, the record says nothing about what the oscillator feels
_TURN = np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=1)  # one direction a row: every degree of half a turn
_WITHIN = (0.25, 0.5, 0.75)  # places in a step where a cubic is looked at: 144 points a period miss at most 0.024 %
ComplexArray = NDArray[np.complex128]
Pair = tuple[FloatArray, FloatArray]
"""A response and its rate of change."""


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
    found = _peaks(motion, rates, np.ceil(POINTS_PER_PERIOD * motion.time_step / given).astype(np.int64))
    return ResponseSpectrum(given, damping, found[:, 0], found[:, 1], found[:, 2])


def oscillators(motion: GroundMotion, periods: ArrayLike, damping: float) -> tuple[FloatArray, float, ComplexArray]:
    """Return periods [s] and damping of oscillators, checked, and their complex rates."""
    damping = checks.within("damping", damping, 0.0, 1.0, open_high=True, hint="a ratio, not a percentage")
    given = np.atleast_1d(checks.positive_array("periods", periods, "s"))
    if given.ndim != 1 or not given.size:
        raise InvalidValueError(
            "{parameter} must be {allowed}, got shape {shape}", parameter="periods",
            allowed="a row of at least 1 number [s]", shape=given.shape,
        )  # fmt: skip
    shortest = SHORTEST_PERIOD * motion.time_step
    if given.min() < shortest:
        raise InvalidValueError(
            "periods must be at least {shortest:g} s for this time step, got {period:g}",
            shortest=shortest,
            period=given.min(),
        )
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


def states(motion: GroundMotion, rates: ComplexArray) -> ComplexArray:
    """Return the states at the samples, one row an oscillator, at rest at the first."""
    h, a = motion.time_step, motion.acceleration
    found = np.zeros((rates.size, a.size), dtype=np.complex128)
    if (module := compiled()) is not None:
        module.states(a, h, rates, found)
        return found
    from scipy.signal import lfilter

    first, second = phi(rates * h)
    for row, decay, one, two in zip(found, np.exp(rates * h), first, second, strict=True):
        row[1:] = lfilter([1.0], [1.0, -decay], -h * (two * a[1:] + (one - two) * a[:-1]))  # Eq. 151
    return found


def _peaks(motion: GroundMotion, rates: ComplexArray, parts: IntArray) -> FloatArray:
    """Return the largest displacement, velocity and absolute acceleration, one row an oscillator."""
    best = np.zeros((rates.size, 3))
    if (module := compiled()) is not None:
        reach = np.ascontiguousarray(_reach(rates).T)
        module.peaks(motion.acceleration, motion.time_step, rates, reach, parts, MARGIN, FREE_POINTS, best)
        return best
    h, a = motion.time_step, motion.acceleration
    rise = np.diff(a)
    for row, rate, number in zip(best, rates, parts.tolist(), strict=True):
        start = states(motion, np.array([rate]))[0]
        swing = np.exp(rate * math.pi / rate.imag * np.linspace(0.0, 1.0, FREE_POINTS))
        np.maximum(row, [np.abs(value).max() for value, _ in _response(start[-1] * swing, 0.0, rate)], out=row)
        left = _response(start[:-1], a[:-1], rate)
        for k in range(1, number + 1):
            t = k * h / number
            first, second = phi(rate * t)
            inside = np.exp(rate * t) * start[:-1] - t * first * a[:-1] - t * t / h * second * rise  # Eq. 151
            right = _response(inside, a[:-1] + k / number * rise, rate)
            np.maximum(row, [_highest(*pair, h / number) for pair in zip(left, right, strict=True)], out=row)
            left = right
    return best


def _reach(s: ComplexArray) -> FloatArray:
    """Return the largest responses of states of magnitude one, whatever their phase: one row a response."""
    friction, omega2 = -2.0 * s.real, np.abs(s) ** 2
    velocity, absolute = np.hypot(1.0, s.real / s.imag), np.hypot(friction, (friction * s.real + omega2) / s.imag)
    return np.stack([1.0 / s.imag, velocity, absolute])


def _highest(left: Pair, right: Pair, step: float) -> float:
    """Return the largest magnitude of cubics through values and slopes at both ends."""
    (y, d), (z, e) = ((side[0], step * side[1]) for side in (left, right))
    rise, best = z - y, float(np.abs(z).max())
    for root in quadratic_roots(3.0 * (d + e - 2.0 * rise), 2.0 * (3.0 * rise - 2.0 * d - e), d):
        t = np.where((root > 0.0) & (root < 1.0), root, 0.0)
        inside = y + t * (d + t * (3.0 * rise - 2.0 * d - e + t * (d + e - 2.0 * rise)))
        best = max(best, float(np.abs(inside).max()))
    return best


def _response(states: ComplexArray, ground: Any, rates: Any) -> list[Pair]:
    """Return displacement, velocity and absolute acceleration, each with its rate of change."""
    u = states.imag / rates.imag  # Eq. 150
    v = states.real + rates.real * u
    omega2, friction = np.abs(rates) ** 2, -2.0 * rates.real
    absolute = -friction * v - omega2 * u
    change = absolute - ground
    return [(u, v), (v, change), (absolute, -friction * change - omega2 * v)]


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
    # turned into another direction the displacement along each component is a sum of both
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


def fourier_amplitudes(
    motion: GroundMotion, frequencies: ArrayLike | None = None, bandwidth: float = 40.0
) -> tuple[FloatArray, FloatArray]:
    """Return the Fourier amplitudes of the acceleration.

    Parameters
    ----------
    motion : GroundMotion
        The motion; its horizontal part counts.
    frequencies : array_like, optional
        Where the amplitudes are wanted, smoothed over their neighbours by the window of Konno & Ohmachi (1998); those
        of the transform as they are if not given [Hz].
    bandwidth : float
        b of the window: the larger, the narrower [-].

    Returns
    -------
    tuple of ndarray
        Frequencies [Hz] and amplitudes of one side [m/s].

    Examples
    --------
    >>> _, amplitudes = fourier_amplitudes(GroundMotion([0.0, 2.0, 2.0, 0.0], 0.5))
    >>> float(amplitudes[0])
    2.0
    """
    motion = checked_motion(motion)
    every = np.fft.rfftfreq(len(motion), motion.time_step)
    amplitudes = motion.time_step * np.abs(np.fft.rfft(motion.acceleration))  # Eq. 304
    if frequencies is None:
        return np.asarray(every, dtype=np.float64), np.asarray(amplitudes, dtype=np.float64)
    wanted = np.atleast_1d(checks.positive_array("frequencies", frequencies, "Hz"))
    checks.all_within("frequencies", wanted, every[1], every[-1], wanted)
    b = checks.positive("bandwidth", bandwidth)
    smooth = np.empty(wanted.size)
    for k, centre in enumerate(wanted.tolist()):
        x = b * np.log10(every[1:] / centre)
        window = np.sinc(x / np.pi) ** 4  # Eq. 305
        smooth[k] = float((window * amplitudes[1:]).sum() / window.sum())
    return wanted.copy(), smooth
