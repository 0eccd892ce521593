"""Energy of a motion and when it comes: Arias intensity and significant durations.

The squared samples are summed by the trapezoidal rule, as the field does. A record is band-limited, for which this sum
is the integral of the square (Parseval) but for half of the end samples; straight lines between the samples, which
drive bodies and oscillators, would lose up to a third of it.
"""

import math

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray, g
from rocking.errors import InvalidValueError
from rocking.motions.motion import GroundMotion, checked_motion


def arias_intensity(motion: GroundMotion, gravity: float = g) -> float:
    """Return the Arias intensity, ``pi / (2 g)`` times the integral of the squared acceleration.

    Arias (1970), in Hansen (ed.), Seismic Design for Nuclear Power Plants, MIT Press, 438-483.

    Parameters
    ----------
    motion : GroundMotion
        The motion; its horizontal part counts.
    gravity : float
        Acceleration of gravity [m/s2].

    Returns
    -------
    float
        The intensity, by the trapezoidal rule [m/s].

    Examples
    --------
    >>> round(arias_intensity(GroundMotion([1.0, 1.0], 2.0), gravity=math.pi), 12)
    1.0
    """
    motion = checked_motion(motion)
    gravity = checks.positive("gravity", gravity, "m/s2")
    return 0.5 * math.pi / gravity * float(_husid(motion)[-1])  # Eq. 140


def significant_times(motion: GroundMotion, start: float = 5.0, end: float = 95.0) -> tuple[float, float]:
    """Return the times at which two percentages of the Arias intensity are reached.

    Husid (1969), Revista del IDIEM 8:21; straight lines between the samples of his plot.

    start, end: percentages, the second one larger [%]. Returns the times, also inside steps [s].
    """
    motion = checked_motion(motion)
    start = checks.within("start", start, 0.0, 100.0, unit="%")
    end = checks.within("end", end, start, 100.0, unit="%", open_low=True, hint="end must be above start")
    total = _husid(motion)
    if not total[-1] > 0.0:
        raise InvalidValueError(f"motion must have energy > 0 m2/s3, got {total[-1]:g}; zero throughout?")
    return _crossing(motion, total, 0.01 * start), _crossing(motion, total, 0.01 * end)


def significant_duration(motion: GroundMotion, start: float = 5.0, end: float = 95.0) -> float:
    """Return the significant duration, between two percentages of the Arias intensity.

    Trifunac & Brady (1975), Bulletin of the Seismological Society of America 65:581, for 5 to 95 %.

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
    return last - first  # Eq. 142


def _husid(motion: GroundMotion) -> FloatArray:
    """Return the integral of the squared acceleration up to each sample [m2/s3]."""
    squares = motion.acceleration**2
    return np.concatenate([[0.0], np.cumsum(0.5 * motion.time_step * (squares[:-1] + squares[1:]))])  # Eq. 141


def _crossing(motion: GroundMotion, total: FloatArray, fraction: float) -> float:
    wanted = fraction * float(total[-1])
    i = min(max(int(np.searchsorted(total, wanted)), 1), len(motion) - 1)
    rise = float(total[i] - total[i - 1])
    share = (wanted - float(total[i - 1])) / rise if rise > 0.0 else 0.0
    return (i - 1 + min(share, 1.0)) * motion.time_step
