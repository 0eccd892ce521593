"""Energy of a motion and when it comes: Arias intensity and significant durations, solved exactly inside steps."""

import math

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray, g
from rocking.errors import InvalidValueError
from rocking.motions.motion import GroundMotion, checked_motion


def arias_intensity(motion: GroundMotion, gravity: float = g) -> float:
    """Return the Arias intensity, ``pi / (2 g)`` times the integral of the squared acceleration.

    Parameters
    ----------
    motion : GroundMotion
        The motion; its horizontal part counts.
    gravity : float
        Acceleration of gravity [m/s2].

    Returns
    -------
    float
        The intensity; the squared lines are integrated exactly [m/s].

    Examples
    --------
    >>> round(arias_intensity(GroundMotion([1.0, 1.0], 2.0), gravity=math.pi), 12)
    1.0
    """
    motion = checked_motion(motion)
    gravity = checks.positive("gravity", gravity, "m/s2")
    return 0.5 * math.pi / gravity * float(_energies(motion).sum())


def significant_times(motion: GroundMotion, start: float = 5.0, end: float = 95.0) -> tuple[float, float]:
    """Return the times at which two percentages of the Arias intensity are reached.

    Parameters
    ----------
    motion : GroundMotion
        The motion; its horizontal part counts.
    start, end : float
        Percentages, the second one larger [%].

    Returns
    -------
    tuple of float
        Exact times, also inside steps [s].

    Raises
    ------
    InvalidValueError
        If a percentage is outside 0 to 100, these are not in order, or the motion is zero throughout.
    """
    motion = checked_motion(motion)
    start = checks.within("start", start, 0.0, 100.0, unit="%")
    end = checks.within("end", end, start, 100.0, unit="%", open_low=True, hint="end must be above start")
    total = np.concatenate([[0.0], np.cumsum(_energies(motion))])
    if not total[-1] > 0.0:
        raise InvalidValueError(f"motion must have energy > 0 m2/s3, got {total[-1]:g}; zero throughout?")
    return _crossing(motion, total, 0.01 * start), _crossing(motion, total, 0.01 * end)


def significant_duration(motion: GroundMotion, start: float = 5.0, end: float = 95.0) -> float:
    """Return the significant duration, between two percentages of the Arias intensity.

    Parameters
    ----------
    motion : GroundMotion
        The motion; its horizontal part counts.
    start, end : float
        Percentages: 5 and 95, or 5 and 75, are common [%].

    Returns
    -------
    float
        The duration [s].

    Examples
    --------
    >>> round(significant_duration(GroundMotion([1.0, 1.0, 1.0], 5.0)), 12)
    9.0
    """
    first, last = significant_times(motion, start, end)
    return last - first


def _energies(motion: GroundMotion) -> FloatArray:
    """Return the integral of the squared acceleration over each step [m2/s3]."""
    a, b = motion.acceleration[:-1], motion.acceleration[1:]
    return motion.time_step / 3.0 * (a * a + a * b + b * b)


def _crossing(motion: GroundMotion, total: FloatArray, fraction: float) -> float:
    wanted = fraction * float(total[-1])
    i = min(max(int(np.searchsorted(total, wanted)) - 1, 0), len(motion) - 2)
    a, b = float(motion.acceleration[i]), float(motion.acceleration[i + 1])
    missing = 3.0 * (wanted - float(total[i])) / motion.time_step
    # the integral of the squared line is (c^3 - a^3) / (3 (b - a)); factored, it can be solved when b is near a too
    c = math.copysign(abs(cube := a**3 + (b - a) * missing) ** (1.0 / 3.0), cube)
    size = c * c + c * a + a * a
    return (i + (min(missing / size, 1.0) if size > 0.0 else 0.0)) * motion.time_step
