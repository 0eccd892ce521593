"""Response spectra of a record (exact for straight lines between samples), and Fourier spectra."""

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
"""Minimum number of points per period. Cubics between the points give the peaks."""

FREE_POINTS = 288
"""Points in the half period of free vibration. The error of a sine peak is at most (pi / 287)^2 / 8 = 0.0015 %."""

MARGIN = 1.001
"""Margin of the bound on the response within a step, for errors of the cubics below 0.01 % [-]."""

SHORTEST_PERIOD = 0.05  # shortest period / time step; a record does not resolve shorter periods
_TURN = np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=1)  # one direction per row, every degree from 0 to 179
_WITHIN = (0.25, 0.5, 0.75)  # positions within a step; 144 points per period give errors of at most 0.024 %
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
        Sa, absolute acceleration of the mass [m/s2].
    """

    periods: FloatArray
    damping: float
    displacement: FloatArray
    velocity: FloatArray
    absolute_acceleration: FloatArray

    @property
    def pseudo_velocity(self) -> FloatArray:
        """PSV, the product of Sd and the circular natural frequency [m/s]."""
        return 2.0 * np.pi / self.periods * self.displacement  # Eq. 149

    @property
    def pseudo_acceleration(self) -> FloatArray:
        """PSA, the product of Sd and the squared circular natural frequency [m/s2].

        It equals Sa only without damping.
        """
        return (2.0 * np.pi / self.periods) ** 2 * self.displacement  # Eq. 149


def response_spectrum(motion: GroundMotion, periods: ArrayLike, damping: float = 0.05) -> ResponseSpectrum:
    """Return the response spectrum of a motion.

    The recurrence is exact for straight lines between the samples (Nigam & Jennings 1969, DOI 10.1785/BSSA0590020909),
    and uses complex numbers. Only the peaks are approximate: they are the extremes of cubics through values and
    slopes at 36 or more points per period. The error of the peaks is below 0.01 %, even for periods below 2 time steps.
    Half a period of free vibration after the last sample is included.

    Parameters
    ----------
    motion : GroundMotion
        Motion. Only the horizontal part is used.
    periods : array_like
        Undamped natural periods, at least 1/20 of the time step [s].
    damping : float
        Damping ratio, from 0 to below 1 [-].

    Returns
    -------
    ResponseSpectrum
        Spectral values, one per period.

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
    validated, damping, rates = oscillators(motion, periods, damping)
    peaks = _peaks(motion, rates, np.ceil(POINTS_PER_PERIOD * motion.time_step / validated).astype(np.int64))
    return ResponseSpectrum(validated, damping, peaks[:, 0], peaks[:, 1], peaks[:, 2])


def oscillators(motion: GroundMotion, periods: ArrayLike, damping: float) -> tuple[FloatArray, float, ComplexArray]:
    """Return validated periods [s], damping ratio and complex rates of oscillators."""
    damping = checks.within("damping", damping, 0.0, 1.0, open_high=True, hint="a ratio, not a percentage")
    validated = np.atleast_1d(checks.positive_array("periods", periods, "s"))
    if validated.ndim != 1 or not validated.size:
        raise InvalidValueError(
            "{parameter} must be {allowed}, got shape {shape}", parameter="periods",
            allowed="a row of at least 1 number [s]", shape=validated.shape,
        )  # fmt: skip
    shortest = SHORTEST_PERIOD * motion.time_step
    if validated.min() < shortest:
        raise InvalidValueError(
            "periods must be at least {shortest:g} s for this time step, got {period:g}",
            shortest=shortest,
            period=validated.min(),
        )
    # with the complex rate s, the state z = u' - conj(s) u satisfies z' = s z - a, and u = Im z / Im s
    rates = 2.0 * math.pi / validated * complex(-damping, math.sqrt(1.0 - damping * damping))  # Eq. 150
    return validated.copy(), damping, np.asarray(rates, dtype=np.complex128)


def phi(x: Any) -> tuple[Any, Any]:
    """Return the phi functions ``(exp(x) - 1) / x`` and ``(exp(x) - 1 - x) / x^2``. They are accurate near zero."""
    argument = np.asarray(x, dtype=np.complex128)
    near = np.abs(argument) <= 1.0
    small, large = np.where(near, argument, 0.0), np.where(near, 1.0, argument)
    series = np.zeros_like(argument)
    for k in range(20, 1, -1):
        series = 1.0 / math.factorial(k) + small * series  # Eq. 152
    first = (np.exp(large) - 1.0) / large  # Eq. 152
    return np.where(near, 1.0 + small * series, first)[()], np.where(near, series, (first - 1.0) / large)[()]


def states(motion: GroundMotion, rates: ComplexArray) -> ComplexArray:
    """Return the states at the samples from rest, one row per oscillator."""
    h, a = motion.time_step, motion.acceleration
    result = np.zeros((rates.size, a.size), dtype=np.complex128)
    if (module := compiled()) is not None:
        module.states(a, h, rates, result)
        return result
    from scipy.signal import lfilter

    first, second = phi(rates * h)
    for row, decay, level, slope in zip(result, np.exp(rates * h), first, second, strict=True):
        row[1:] = lfilter([1.0], [1.0, -decay], -h * (slope * a[1:] + (level - slope) * a[:-1]))  # Eq. 151
    return result


def _peaks(motion: GroundMotion, rates: ComplexArray, parts: IntArray) -> FloatArray:
    """Return the largest displacement, velocity and absolute acceleration, one row per oscillator."""
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
            np.maximum(row, [_cubic_peak(*pair, h / number) for pair in zip(left, right, strict=True)], out=row)
            left = right
    return best


def _reach(s: ComplexArray) -> FloatArray:
    """Return the largest responses over all states of magnitude one, one row per response."""
    friction, omega2 = -2.0 * s.real, np.abs(s) ** 2
    velocity, absolute = np.hypot(1.0, s.real / s.imag), np.hypot(friction, (friction * s.real + omega2) / s.imag)
    return np.stack([1.0 / s.imag, velocity, absolute])


def _cubic_peak(left: Pair, right: Pair, step: float) -> float:
    """Return the largest magnitude of cubics through values and slopes at both ends."""
    (y, d), (z, e) = ((side[0], step * side[1]) for side in (left, right))
    rise, best = z - y, float(np.abs(z).max())
    for root in quadratic_roots(3.0 * (d + e - 2.0 * rise), 2.0 * (3.0 * rise - 2.0 * d - e), d):
        t = np.where((root > 0.0) & (root < 1.0), root, 0.0)
        inside = y + t * (d + t * (3.0 * rise - 2.0 * d - e + t * (d + e - 2.0 * rise)))
        best = max(best, float(np.abs(inside).max()))
    return best


def _response(states: ComplexArray, ground: Any, rates: Any) -> list[Pair]:
    """Return displacement, velocity and absolute acceleration, with their rates of change."""
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
    """Return percentiles of the pseudo-spectral acceleration over all directions.

    Boore (2010), DOI 10.1785/0120090400. The directions are every degree from 0 to 179 degrees. The response is exact
    for straight lines between samples, and the error of the peaks is below 0.03 %.

    Parameters
    ----------
    first, second : GroundMotion
        Perpendicular horizontal components, with equal time step and length.
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
        If the components do not match, or if a period, the damping or a percentile is outside its range.

    Examples
    --------
    >>> along, across = GroundMotion([3.0] * 101, 0.01), GroundMotion([4.0] * 101, 0.01)
    >>> rotd_spectrum(along, across, [0.1, 0.2], damping=0.0, percentiles=[100]).round(2).tolist()
    [[10.0, 10.0]]
    """
    requested = np.atleast_1d(checks.real_array("percentiles", percentiles, "%"))
    for percentile in requested.tolist():
        checks.within("percentiles", percentile, 0.0, 100.0, unit="%")
    peaks = directional_spectra(first, second, periods, damping)
    return np.asarray(np.percentile(peaks, requested, axis=1), dtype=np.float64)


def directional_spectra(
    first: GroundMotion, second: GroundMotion, periods: ArrayLike, damping: float = 0.05
) -> FloatArray:
    """Return the pseudo-spectral acceleration in every direction, one row per period [m/s2]."""
    # the displacement in any direction is a linear combination of both components
    matching(first, second)
    validated, _, rates = oscillators(first, periods, damping)
    parts = np.ceil(POINTS_PER_PERIOD * first.time_step / validated).astype(np.int64)
    peaks = np.zeros((validated.size, len(ANGLES)))
    if (module := compiled()) is not None:
        both, step = (first.acceleration, second.acceleration), first.time_step
        module.directions(*both, step, rates, np.cos(ANGLES), np.sin(ANGLES), parts, FREE_POINTS, peaks)
    else:
        for row, rate, number in zip(peaks, rates, parts.tolist(), strict=True):
            for points in _path(first, second, rate, number):
                np.maximum(row, np.abs(_TURN @ points).max(axis=1), out=row)  # Eq. 156
    return np.asarray(peaks * (2.0 * np.pi / validated[:, None]) ** 2, dtype=np.float64)  # Eq. 149


def _path(first: GroundMotion, second: GroundMotion, rate: complex, parts: int) -> Iterator[FloatArray]:
    """Yield points on the path of one oscillator under two components [m], one array per part of the steps."""
    h, rates = first.time_step, np.array([rate])
    state = np.concatenate([states(first, rates), states(second, rates)])
    ground = np.stack([first.acceleration, second.acceleration])
    swing = np.exp(rate * math.pi / rate.imag * np.linspace(0.0, 1.0, FREE_POINTS))
    yield (state[:, -1:] * swing).imag / rate.imag
    start, rise, left = state[:, :-1], np.diff(ground), state[:, :-1]
    for k in range(1, parts + 1):
        t = k * h / parts
        level, slope = phi(rate * t)
        right = np.exp(rate * t) * start - t * level * ground[:, :-1] - t * t / h * slope * rise  # Eq. 151
        y, z = left.imag / rate.imag, right.imag / rate.imag  # Eq. 150
        d, e = (h / parts * (side.real + rate.real * position) for side, position in ((left, y), (right, z)))
        for position in (*_WITHIN, 1.0):
            yield y + position * (d + position * (3.0 * (z - y) - 2.0 * d - e + position * (d + e - 2.0 * (z - y))))
        left = right


def fourier_amplitudes(
    motion: GroundMotion, frequencies: ArrayLike | None = None, bandwidth: float = 40.0
) -> tuple[FloatArray, FloatArray]:
    """Return the Fourier amplitudes of the acceleration.

    Parameters
    ----------
    motion : GroundMotion
        Motion. Only the horizontal part is used.
    frequencies : array_like, optional
        Frequencies [Hz] of amplitudes that are smoothed by the window of Konno & Ohmachi (1998). The default is the
        unsmoothed transform.
    bandwidth : float
        Parameter b of the window [-]. A larger b gives a narrower window.

    Returns
    -------
    tuple of ndarray
        Frequencies [Hz] and one-sided amplitudes [m/s].

    Examples
    --------
    >>> _, amplitudes = fourier_amplitudes(GroundMotion([0.0, 2.0, 2.0, 0.0], 0.5))
    >>> float(amplitudes[0])
    2.0
    """
    motion = checked_motion(motion)
    all_frequencies = np.fft.rfftfreq(len(motion), motion.time_step)
    amplitudes = motion.time_step * np.abs(np.fft.rfft(motion.acceleration))  # Eq. 304
    if frequencies is None:
        return np.asarray(all_frequencies, dtype=np.float64), np.asarray(amplitudes, dtype=np.float64)
    requested = np.atleast_1d(checks.positive_array("frequencies", frequencies, "Hz"))
    checks.all_within("frequencies", requested, all_frequencies[1], all_frequencies[-1], requested)
    b = checks.positive("bandwidth", bandwidth)
    smooth = np.empty(requested.size)
    for k, centre in enumerate(requested.tolist()):
        x = b * np.log10(all_frequencies[1:] / centre)
        window = np.sinc(x / np.pi) ** 4  # Eq. 305
        smooth[k] = float((window * amplitudes[1:]).sum() / window.sum())
    return requested.copy(), smooth
