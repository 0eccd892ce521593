"""Two horizontal components turned into other directions."""

import math

import numpy as np

from rocking import checks
from rocking.errors import InvalidValueError
from rocking.motions.motion import GroundMotion, checked_motion

ANGLES = np.radians(np.arange(180.0))
"""Directions for RotD: every degree over half a turn."""


def rotated(first: GroundMotion, second: GroundMotion, angle: float) -> tuple[GroundMotion, GroundMotion]:
    """Return two perpendicular components along turned axes.

    Parameters
    ----------
    first, second : GroundMotion
        Horizontal components along x and y, of one step and length.
    angle : float
        Angle of the turn, from x towards y [rad].

    Returns
    -------
    tuple of GroundMotion
        Components along the turned x and y; each keeps the vertical part of the motion that it replaces.

    Examples
    --------
    >>> x, y = rotated(GroundMotion([0.0, 1.0], 0.1), GroundMotion([0.0, 0.0], 0.1), math.pi / 2)
    >>> x.peak < 1e-15, y.acceleration.tolist()
    (True, [0.0, -1.0])
    """
    _matching(first, second)
    angle = checks.number("angle", angle, "rad")
    c, s = math.cos(angle), math.sin(angle)
    a, b = first.acceleration, second.acceleration
    what = f"turned by {angle:g} rad together with "
    return (
        first.changed(what + repr(second.name), acceleration=c * a + s * b),  # Eq. 156
        second.changed(what + repr(first.name), acceleration=c * b - s * a),
    )


def rotd_pga(first: GroundMotion, second: GroundMotion, percentile: float) -> float:
    """Return a percentile over all directions of the peak ground acceleration.

    Boore (2010), DOI 10.1785/0120090400. The directions are every degree over half a turn; RotD100 is exact, over
    all directions.

    Parameters
    ----------
    first, second : GroundMotion
        Perpendicular horizontal components, of one step and length.
    percentile : float
        50 for RotD50, 100 for RotD100, 0 for RotD00 [%].

    Returns
    -------
    float
        The percentile of the peaks [m/s2].

    Examples
    --------
    >>> rotd_pga(GroundMotion([0.0, 3.0], 0.1), GroundMotion([0.0, 4.0], 0.1), 100)
    5.0
    """
    _matching(first, second)
    percentile = checks.within("percentile", percentile, 0.0, 100.0, unit="%")
    a, b = first.acceleration, second.acceleration
    if percentile == 100.0:
        # between samples the point moves on a straight line, so that it is farthest at a sample
        return float(np.hypot(a, b).max())
    peaks = np.array([np.abs(math.cos(t) * a + math.sin(t) * b).max() for t in ANGLES])  # Eq. 156
    return float(np.percentile(peaks, percentile))


def _matching(first: GroundMotion, second: GroundMotion) -> None:
    checked_motion(first, "first")
    checked_motion(second, "second")
    if len(first) != len(second) or not math.isclose(first.time_step, second.time_step, rel_tol=1e-9):
        raise InvalidValueError(
            "second must have the step and the length of first, "
            f"{first.time_step:g} s and {len(first)} samples, got {second.time_step:g} s and {len(second)}"
        )
