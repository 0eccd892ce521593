"""What axes need to know of a motion, pulse or record: the period of a pulse, the largest velocity of the ground."""

import math

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.response import Motion
from rocking.errors import InvalidValueError
from rocking.motions.kinematics import largest_velocity
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse
from rocking.motions.rickers import Ricker
from rocking.motions.sinusoids import Sinusoids

_SAMPLES = 4096


def main_period(motion: Motion) -> float:
    """Return the period T_p of a pulse.

    Returns T_p; of a sum of sinusoids that of the first [s].

    >>> from rocking.motions.pulses import sine
    >>> round(main_period(sine(2.0, 0.5)), 12)
    0.5
    """
    if isinstance(motion, Ricker):
        return motion.period
    frequency = abs(motion.waves[0][1]) if isinstance(motion, Sinusoids) else 0.0
    if frequency == 0.0:
        raise InvalidValueError(
            f"the period of a pulse cannot vary for {motion.name!r}, which has none; "
            "the axes scale, pga, pgv and duration take any motion"
        )
    return 2.0 * math.pi / frequency


def peak_velocity(motion: Motion) -> float:
    """Return the largest velocity of the ground in either direction.

    Returns largest magnitude during the motion [m/s].

    >>> import math
    >>> from rocking.motions.pulses import sine
    >>> round(peak_velocity(sine(math.pi, 1.0)), 12)
    1.0
    """
    if isinstance(motion, GroundMotion):
        return largest_velocity(motion)
    times = np.linspace(0.0, motion.duration, _SAMPLES + 1)
    turns = _zeros_of_acceleration(motion, times)
    return float(np.abs(motion.velocity(np.concatenate([times, turns]))).max())


def _zeros_of_acceleration(motion: Pulse, times: FloatArray) -> FloatArray:
    signs = np.sign(motion.acceleration_inside(times))
    places = np.flatnonzero(signs[:-1] * signs[1:] < 0.0)
    low, high = times[places], times[places + 1]
    for _ in range(60):
        middle = 0.5 * (low + high)
        left = np.sign(motion.acceleration_inside(middle)) == signs[places]
        low, high = np.where(left, middle, low), np.where(left, high, middle)
    return low
