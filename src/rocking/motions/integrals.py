"""Integrals of a motion: ground velocity and displacement, their peaks, Arias intensity, significant duration.

Velocity and displacement are exact for straight lines between the samples, as in simulations. The squared samples are
summed by the trapezoidal rule, as is usual. For a band-limited record, this sum equals the integral of the square
(Parseval's theorem), except for half of the end samples. Integrating the squared straight lines would give up to one
third less.
"""

import math

import numpy as np

from rocking import checks, plausibility
from rocking.conventions import FloatArray, g
from rocking.errors import InvalidValueError
from rocking.messages import Message, Range
from rocking.motions.motion import GroundMotion, checked_motion


def ground_velocity(motion: GroundMotion) -> FloatArray:
    """Return the velocity of the ground at the samples, from rest.

    Parameters
    ----------
    motion : GroundMotion
        Motion. Only the horizontal part is used.

    Returns
    -------
    ndarray
        Exact integral of the straight lines, zero at the first sample [m/s].

    Examples
    --------
    >>> ground_velocity(GroundMotion([0.0, 2.0, 2.0], time_step=0.5)).tolist()
    [0.0, 0.5, 1.5]
    """
    return velocity_of(checked_motion(motion).acceleration, motion.time_step)


def ground_displacement(motion: GroundMotion) -> FloatArray:
    """Return the displacement of the ground at the samples, from rest.

    Parameters
    ----------
    motion : GroundMotion
        Motion. Only the horizontal part is used.

    Returns
    -------
    ndarray
        Exact second integral of the straight lines, zero at the first sample [m].

    Examples
    --------
    >>> ground_displacement(GroundMotion([1.0, 1.0, 1.0], time_step=2.0)).tolist()
    [0.0, 2.0, 8.0]
    """
    v = ground_velocity(motion)
    a, h = motion.acceleration, motion.time_step
    return _summed(h * v[:-1] + h * h / 6.0 * (2.0 * a[:-1] + a[1:]))  # Eq. 148


def peak_ground_velocity(motion: GroundMotion) -> float:
    """Return the peak ground velocity PGV, including extremes between the samples.

    Parameters
    ----------
    motion : GroundMotion
        Motion from rest. Correct the baseline of a drifting record first.

    Returns
    -------
    float
        PGV up to the last sample [m/s].

    Examples
    --------
    >>> peak_ground_velocity(GroundMotion([1.0, -1.0], time_step=1.0))
    0.25
    """
    v, a = ground_velocity(motion), motion.acceleration
    turns = np.flatnonzero((a[:-1] < 0.0) != (a[1:] < 0.0))
    before, after = a[turns], a[turns + 1]
    # dividing first keeps the fraction within [0, 1] for samples of any size
    inside = v[turns] + 0.5 * motion.time_step * before * (before / (before - after))
    return _largest(v, inside)


def peak_ground_displacement(motion: GroundMotion) -> float:
    """Return the peak ground displacement PGD, including extremes between the samples.

    Parameters
    ----------
    motion : GroundMotion
        Motion from rest. Correct the baseline of a drifting record first.

    Returns
    -------
    float
        PGD up to the last sample [m].

    Examples
    --------
    >>> round(peak_ground_displacement(GroundMotion([1.0, -2.0], time_step=1.0)), 9)
    0.074074074
    """
    v, u = ground_velocity(motion), ground_displacement(motion)
    a, h = motion.acceleration, motion.time_step
    start, rise = a[:-1], np.diff(a)
    inside = [u]
    for tau in quadratic_roots(0.5 * h * rise, h * start, v[:-1]):
        # outside (0, 1), the extremes are at the ends of the step, which u contains
        t = np.where((tau > 0.0) & (tau < 1.0), tau, 0.0)
        inside.append(u[:-1] + h * t * (v[:-1] + h * t * (0.5 * start + rise * t / 6.0)))
    return _largest(*inside)


def arias_intensity(motion: GroundMotion, gravity: float = g) -> float:
    """Return the Arias intensity, ``pi / (2 g)`` times the integral of the squared acceleration.

    Arias (1970), in Hansen (ed.), Seismic Design for Nuclear Power Plants, MIT Press, 438-483.

    Parameters
    ----------
    motion : GroundMotion
        Motion. Only the horizontal part is used.
    gravity : float
        Acceleration of gravity [m/s2].

    Returns
    -------
    float
        Arias intensity, by the trapezoidal rule [m/s].

    Examples
    --------
    >>> round(arias_intensity(GroundMotion([1.0, 1.0], 2.0), gravity=math.pi), 12)
    1.0
    """
    motion, gravity = checked_motion(motion), checks.positive("gravity", gravity, "m/s2")
    return 0.5 * math.pi / gravity * float(_husid(motion)[-1])  # Eq. 140


def significant_duration(motion: GroundMotion, start: float = 5.0, end: float = 95.0) -> float:
    """Return the significant duration between two percentages of the Arias intensity.

    Trifunac & Brady (1975), Bulletin of the Seismological Society of America 65:581, for 5 to 95 %.

    Parameters
    ----------
    motion : GroundMotion
        Motion. Only the horizontal part is used.
    start, end : float
        Percentages, usually 5 and 95 or 5 and 75 [%].

    Returns
    -------
    float
        Significant duration [s].

    Examples
    --------
    >>> round(significant_duration(GroundMotion([1.0, 1.0, 1.0], 5.0)), 12)
    9.0
    """
    first, last = significant_times(motion, start, end)
    return last - first  # Eq. 142


def significant_times(motion: GroundMotion, start: float = 5.0, end: float = 95.0) -> tuple[float, float]:
    """Return the times of two percentages of the Arias intensity, interpolated between samples.

    Linear interpolation of the Husid plot. Husid (1969), Revista del IDIEM 8:21.

    Parameters
    ----------
    motion : GroundMotion
        Motion. Only the horizontal part is used.
    start, end : float
        Percentages [%]; `end` is larger than `start`.

    Returns
    -------
    tuple of float
        Both times [s].
    """
    motion = checked_motion(motion)
    start = checks.within("start", start, 0.0, 100.0, unit="%")
    end = checks.within("end", end, start, 100.0, unit="%", open_low=True, hint="end must be above start")
    husid = _husid(motion)
    if not husid[-1] > 0.0:
        raise InvalidValueError(
            "the motion must have energy {allowed}, got {value}", parameter="energy", value=float(husid[-1]),
            allowed=Range(0.0, math.inf, "m2/s3", low_open=True), hint=Message("check for a record of zeros"),
        )  # fmt: skip
    return _crossing(motion, husid, 0.01 * start), _crossing(motion, husid, 0.01 * end)


def integral_doubts(motion: GroundMotion) -> tuple[str, ...]:
    """Return the warnings about the integrated velocity and displacement of a motion."""
    velocity, displacement = ground_velocity(motion), ground_displacement(motion)
    ends = float(velocity[-1]), float(np.abs(velocity).max()), float(np.abs(displacement).max())
    return plausibility.of_integrals(*ends)


def velocity_of(samples: FloatArray, time_step: float) -> FloatArray:
    """Return the integral of the straight lines between samples [m/s2, s, m/s]."""
    return _summed(0.5 * time_step * (samples[:-1] + samples[1:]))  # Eq. 147


def quadratic_roots(second: FloatArray, first: FloatArray, zeroth: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return both real roots of many quadratic equations, without cancellation. Missing roots are not finite."""
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        q = -0.5 * (first + np.copysign(np.sqrt(first * first - 4.0 * second * zeroth), first))
        return q / second, zeroth / q


def _husid(motion: GroundMotion) -> FloatArray:
    """Return the integral of the squared acceleration up to every sample [m2/s3]."""
    squares = motion.acceleration**2
    return _summed(0.5 * motion.time_step * (squares[:-1] + squares[1:]))  # Eq. 141


def _crossing(motion: GroundMotion, husid: FloatArray, fraction: float) -> float:
    target = fraction * float(husid[-1])
    i = min(max(int(np.searchsorted(husid, target)), 1), len(motion) - 1)
    rise = float(husid[i] - husid[i - 1])
    position = (target - float(husid[i - 1])) / rise if rise > 0.0 else 0.0
    return (i - 1 + min(position, 1.0)) * motion.time_step


def _summed(increments: FloatArray) -> FloatArray:
    return np.concatenate([[0.0], np.cumsum(increments)])


def _largest(*values: FloatArray) -> float:
    return max(float(np.abs(array).max(initial=0.0)) for array in values)
