"""Records corrected: baselines, tapers and band-pass filters, each with a line of provenance."""

import math
from typing import Any, Literal

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.motions.kinematics import ground_velocity
from rocking.motions.motion import GroundMotion, checked_motion
from rocking.motions.portable import cosine_sine


def demeaned(motion: GroundMotion) -> GroundMotion:
    """Return the motion without its mean acceleration.

    Parameters
    ----------
    motion : GroundMotion
        The motion; each component loses its own mean.

    Returns
    -------
    GroundMotion
        The corrected motion.

    Examples
    --------
    >>> demeaned(GroundMotion([1.0, 3.0], 0.1)).acceleration.tolist()
    [-1.0, 1.0]
    """
    motion = checked_motion(motion)
    return _each(motion, lambda part: part.acceleration - part.acceleration.mean(), "mean acceleration removed")


def detrended(
    motion: GroundMotion, order: int = 1, fit: Literal["velocity", "acceleration"] = "velocity"
) -> GroundMotion:
    """Return the motion without a polynomial trend, found by least squares.

    Parameters
    ----------
    motion : GroundMotion
        The motion; each component loses its own trend.
    order : int
        Order of the polynomial, from 1 to 3 [-].
    fit : {"velocity", "acceleration"}
        What the polynomial is fitted to. A trend of the velocity starts from rest, and its derivative is taken off
        the acceleration; a trend of the acceleration has a constant term.

    Returns
    -------
    GroundMotion
        The corrected motion.

    Raises
    ------
    InvalidValueError
        If the order or the word is unknown, or there are too few samples for the order.

    Examples
    --------
    >>> detrended(GroundMotion([2.0, 2.0, 2.0], 0.1)).peak < 1e-12
    True
    """
    motion = checked_motion(motion)
    if isinstance(order, bool) or order not in {1, 2, 3}:
        raise InvalidValueError(f"order must be 1, 2 or 3, got {order!r}")
    if fit not in {"velocity", "acceleration"}:
        raise InvalidValueError(f'fit must be "velocity" or "acceleration", got {fit!r}')
    if len(motion) < order + 2:
        raise InvalidValueError(f"a trend of order {order} needs at least {order + 2} samples, got {len(motion)}")
    what = f"polynomial of order {order} fitted to the {fit} removed"
    return _each(motion, lambda part: part.acceleration - _trend(part, int(order), fit), what)


def tapered(motion: GroundMotion, fraction: float = 0.05) -> GroundMotion:
    """Return the motion with both ends brought to zero by half a cosine.

    Parameters
    ----------
    motion : GroundMotion
        The motion; both components are tapered.
    fraction : float
        Share of the duration that each taper takes, up to 0.5 [-].

    Returns
    -------
    GroundMotion
        The tapered motion; first and last sample are zero.

    Examples
    --------
    >>> tapered(GroundMotion([1.0] * 5, 1.0), 0.5).acceleration.round(12).tolist()
    [0.0, 0.5, 1.0, 0.5, 0.0]
    """
    motion = checked_motion(motion)
    fraction = checks.within("fraction", fraction, 0.0, 0.5, open_low=True, hint="share of the duration at each end")
    place = np.linspace(0.0, 1.0, len(motion))
    edge = np.minimum(np.minimum(place, 1.0 - place) / fraction, 1.0)
    window = 0.5 * (1.0 - cosine_sine(np.pi * edge)[0])  # Eq. 154
    return _each(motion, lambda part: part.acceleration * window, f"cosine taper over {fraction:g} of each end")


def bandpassed(motion: GroundMotion, low: float, high: float, order: int = 4) -> GroundMotion:
    """Return the motion filtered by a Butterworth band pass, forwards and backwards.

    Two passes leave no phase shift, and square the response: at both corners it is 1/2. The motion is zero outside
    the record and is filtered as such, with 1.5 `order` / `low` of zeros at both ends (Converse & Brady 1992); what
    the filter puts there is cut off again. Use `padded` before to keep it.

    Parameters
    ----------
    motion : GroundMotion
        The motion; both components are filtered.
    low, high : float
        Corner frequencies, the second one below half the sampling rate [Hz].
    order : int
        Order of one pass, from 1 to 10 [-].

    Returns
    -------
    GroundMotion
        The filtered motion, of the same length.

    Raises
    ------
    InvalidValueError
        If the corners are not in order or the order is outside its range.
    """
    motion = checked_motion(motion)
    from scipy.signal import butter, sosfiltfilt

    nyquist = 0.5 / motion.time_step
    low = checks.within("low", low, 0.0, nyquist, unit="Hz", open_low=True, open_high=True)
    high = checks.within(
        "high", high, low, nyquist, unit="Hz", open_low=True, open_high=True, hint="low < high < Nyquist"
    )
    if isinstance(order, bool) or order not in range(1, 11):
        raise InvalidValueError(f"order must be a whole number from 1 to 10, got {order!r}")
    sections: Any = butter(int(order), [low, high], btype="bandpass", fs=1.0 / motion.time_step, output="sos")
    pad = math.ceil(1.5 * order / low / motion.time_step)  # Eq. 155

    def filtered(part: GroundMotion) -> FloatArray:
        result: Any = sosfiltfilt(sections, np.pad(part.acceleration, pad), padtype=None)
        return np.asarray(result[pad:-pad], dtype=np.float64)

    what = f"band-pass {low:g} to {high:g} Hz, Butterworth order {order}, forwards and backwards"
    return _each(motion, filtered, what)


def _each(motion: GroundMotion, correct: Any, what: str) -> GroundMotion:
    vertical = motion.vertical
    if vertical is not None:
        vertical = correct(GroundMotion(vertical, motion.time_step))
    return motion.changed(what, acceleration=correct(motion), vertical=vertical)


def _trend(part: GroundMotion, order: int, fit: str) -> FloatArray:
    """Fit by polynomials that are orthogonal over the samples, from Stieltjes' recurrence: no matrix is solved."""
    x = np.linspace(0.0, 1.0, len(part))
    velocity = fit == "velocity"
    weight, values = (x, ground_velocity(part)) if velocity else (np.ones_like(x), part.acceleration)
    trend, before, p, slope_before, slope = 0.0 * x, 0.0 * x, np.ones_like(x), 0.0 * x, 0.0 * x
    last = 1.0
    for _ in range(order if velocity else order + 1):
        q = weight * p
        size = (q * q).sum()
        term = (p + x * slope) / part.duration if velocity else p
        trend += (q * values).sum() / size * term
        middle, ratio = (x * q * q).sum() / size, size / last
        before, p, slope_before, slope = (
            p,
            (x - middle) * p - ratio * before,  # Eq. 153
            slope,
            p + (x - middle) * slope - ratio * slope_before,
        )
        last = size
    return trend
