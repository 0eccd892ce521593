"""Velocity and displacement of the ground, integrated exactly: quadratic and cubic pieces between the samples."""

import numpy as np

from rocking.conventions import FloatArray
from rocking.motions.motion import GroundMotion, checked_motion


def ground_velocity(motion: GroundMotion) -> FloatArray:
    """Return the velocity of the ground at the samples, from rest.

    Parameters
    ----------
    motion : GroundMotion
        The motion; its horizontal part counts.

    Returns
    -------
    ndarray
        Exact integral of the straight lines, zero at the first sample [m/s].

    Examples
    --------
    >>> ground_velocity(GroundMotion([0.0, 2.0, 2.0], time_step=0.5)).tolist()
    [0.0, 0.5, 1.5]
    """
    motion = checked_motion(motion)
    a = motion.acceleration
    return _summed(0.5 * motion.time_step * (a[:-1] + a[1:]))  # Eq. 147


def ground_displacement(motion: GroundMotion) -> FloatArray:
    """Return the displacement of the ground at the samples, from rest.

    Parameters
    ----------
    motion : GroundMotion
        The motion; its horizontal part counts.

    Returns
    -------
    ndarray
        Exact second integral of the straight lines, zero at the first sample [m].

    Examples
    --------
    >>> ground_displacement(GroundMotion([1.0, 1.0, 1.0], time_step=2.0)).tolist()
    [0.0, 2.0, 8.0]
    """
    motion = checked_motion(motion)
    a, h = motion.acceleration, motion.time_step
    v = ground_velocity(motion)
    return _summed(h * v[:-1] + h * h / 6.0 * (2.0 * a[:-1] + a[1:]))  # Eq. 148


def largest_velocity(motion: GroundMotion) -> float:
    """Return the largest velocity of the ground in either direction, also inside steps.

    Returns largest magnitude up to the last sample [m/s].

    >>> largest_velocity(GroundMotion([1.0, -1.0], time_step=1.0))
    0.25
    """
    motion = checked_motion(motion)
    a, v = motion.acceleration, ground_velocity(motion)
    turns = np.flatnonzero((a[:-1] < 0.0) != (a[1:] < 0.0))
    before, after = a[turns], a[turns + 1]
    # dividing first keeps the fraction within [0, 1] whatever the size of the samples
    inside = v[turns] + 0.5 * motion.time_step * before * (before / (before - after))
    return _largest(v, inside)


def largest_displacement(motion: GroundMotion) -> float:
    """Return the largest displacement of the ground in either direction, also inside steps.

    Returns largest magnitude up to the last sample [m].

    >>> round(largest_displacement(GroundMotion([1.0, -2.0], time_step=1.0)), 9)
    0.074074074
    """
    motion = checked_motion(motion)
    a, h = motion.acceleration, motion.time_step
    v, u = ground_velocity(motion), ground_displacement(motion)
    start, rise = a[:-1], np.diff(a)
    inside = [u]
    for tau in quadratic_roots(0.5 * h * rise, h * start, v[:-1]):
        # outside (0, 1) the ends of the step are the extremes, and these are in u already
        t = np.where((tau > 0.0) & (tau < 1.0), tau, 0.0)
        inside.append(u[:-1] + h * t * (v[:-1] + h * t * (0.5 * start + rise * t / 6.0)))
    return _largest(*inside)


def quadratic_roots(second: FloatArray, first: FloatArray, zeroth: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the real roots of many quadratic equations, without cancellation.

    Returns both roots of each; not finite where there is none.

    >>> one, other = quadratic_roots(np.array([1.0]), np.array([-3.0]), np.array([2.0]))
    >>> float(one[0]), float(other[0])
    (2.0, 1.0)
    """
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        q = -0.5 * (first + np.copysign(np.sqrt(first * first - 4.0 * second * zeroth), first))
        return q / second, zeroth / q


def _summed(increments: FloatArray) -> FloatArray:
    return np.concatenate([[0.0], np.cumsum(increments)])


def _largest(*values: FloatArray) -> float:
    return max(float(np.abs(part).max(initial=0.0)) for part in values)
