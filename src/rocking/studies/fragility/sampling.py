"""Pulses as records, for what is only defined for records."""

import numpy as np

from rocking.dynamics.response import Motion
from rocking.motions.motion import GroundMotion
from rocking.motions.pulse import Pulse

SAMPLES_PER_PERIOD = 4000
"""Samples of the shortest period of a pulse: its measures are off by less than 1e-6, its PGA by nothing."""


def sampled(motion: Motion) -> GroundMotion:
    """Return a motion as a record: a pulse is sampled so finely that its measures are right to 1e-6.

    Returns the motion itself, or the samples of the pulse [m/s2], the largest raised to its peak.
    """
    if not isinstance(motion, Pulse):
        return motion
    count = max(200, int(np.ceil(SAMPLES_PER_PERIOD * motion.fastest * motion.duration / (2.0 * np.pi))))
    made = motion.sampled(motion.duration / count)
    samples = np.array(made.acceleration)
    top = int(np.argmax(np.abs(samples)))
    samples[top] = np.copysign(motion.peak, samples[top])
    return made.changed("the largest sample raised to the peak of the pulse", acceleration=samples)
