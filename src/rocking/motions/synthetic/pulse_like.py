"""Pulse-like motions: the long pulse of a near-fault record on top of the rest of it.

The pulse is that of Mavroeidis & Papageorgiou (2003), Bulletin of the Seismological Society of America 93:1099, DOI
10.1785/0120020100. They too add a simple pulse to a synthetic motion of high frequency.
"""

import math

import numpy as np

from rocking import checks
from rocking.errors import InvalidValueError
from rocking.motions.motion import GroundMotion, checked_motion
from rocking.motions.pulse import Pulse

MOST_SAMPLES = 10_000_000
"""No motion made here has more samples: a later arrival is a wrong unit."""


def with_pulse(residual: GroundMotion, pulse: Pulse, arrival: float) -> GroundMotion:
    """Return a motion with a pulse added to it.

    Parameters
    ----------
    residual : GroundMotion
        What is left of a record without its pulse; its vertical part stays as it is.
    pulse : Pulse
        The pulse, sampled at the step of the residual.
    arrival : float
        Time at which the middle of the pulse passes, rounded to a whole step; the pulse must not begin before the
        motion [s].

    Returns
    -------
    GroundMotion
        The sum; longer than the residual if the pulse ends after it.

    Raises
    ------
    InvalidValueError
        If it is no pulse, or the arrival is outside its range.

    Examples
    --------
    >>> from rocking.motions.pulses import mavroeidis_papageorgiou
    >>> still = GroundMotion([0.0, 0.0], time_step=0.01)
    >>> motion = with_pulse(still, mavroeidis_papageorgiou(velocity=0.5, period=1.0), arrival=1.0)
    >>> from rocking.motions.intensity import peak_ground_velocity
    >>> round(peak_ground_velocity(motion), 3)
    0.5
    """
    residual, given = checked_motion(residual, "residual"), pulse
    if not isinstance(given, Pulse):
        raise InvalidValueError(f"pulse must be a pulse such as pulses.mavroeidis_papageorgiou(..), got {pulse!r:.60}")
    step, half = residual.time_step, 0.5 * pulse.duration
    arrival = checks.within(
        "arrival", arrival, half, MOST_SAMPLES * step - half, unit="s", hint="the pulse would begin before the motion"
    )
    first = max(round((arrival - half) / step), 0)
    count = max(len(residual), first + math.ceil(pulse.duration / step) + 2)
    horizontal = np.zeros(count)
    horizontal[: len(residual)] = residual.acceleration
    horizontal += pulse.acceleration((np.arange(count) - first) * step)
    vertical = None
    if residual.vertical is not None:
        vertical = np.concatenate([residual.vertical, np.zeros(count - len(residual))])
    what = f"{pulse.name} added, its middle at {first * step + half:g} s"
    return residual.changed(what, acceleration=horizontal, vertical=vertical)
