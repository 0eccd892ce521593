"""A linear oscillator between two samples, exactly: what filters of white noise are made of."""

import math
from itertools import pairwise

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray

LEAST_CYCLES = 1e-6
"""Smallest corner of the high pass in cycles a step [-]: below, its long memory drowns in rounding."""


def transition(omega: float, damping: float, step: float) -> FloatArray:
    """Return what free vibration does to displacement and velocity over one step.

    Parameters
    ----------
    omega : float
        Undamped natural frequency [rad/s].
    damping : float
        Damping ratio, from 0 to 1; 1 is critical [-].
    step : float
        Duration of the step [s].

    Returns
    -------
    ndarray, shape (2, 2)
        Matrix that takes displacement and velocity to the end of the step.

    Examples
    --------
    >>> transition(math.pi, 0.0, 1.0).round(12).tolist()
    [[-1.0, 0.0], [-0.0, -1.0]]
    """
    rate = omega * math.sqrt(1.0 - damping * damping)
    # sin(x)/rate has a limit at critical damping
    s = step * float(np.sinc(rate * step / math.pi))
    c = math.cos(rate * step)
    decay = math.exp(-damping * omega * step)
    own = damping * omega * s
    return decay * np.array([[c + own, s], [-omega * omega * s, c - own]])


def highpassed(acceleration: FloatArray, time_step: float, frequency: float) -> FloatArray:
    """Return the acceleration of a critically damped oscillator that a motion drives.

    The response of ``z'' + 2 w z' + w^2 z = a`` is a high pass of the motion: its velocity and displacement come back
    to zero (Rezaeian & Der Kiureghian 2008). It is exact at the samples for straight lines between them.

    Parameters
    ----------
    acceleration : ndarray
        Motion, from rest [m/s2].
    time_step : float
        Step between samples [s].
    frequency : float
        Natural frequency, the corner of the filter [Hz].

    Returns
    -------
    ndarray
        ``z''`` at the samples [m/s2].
    """
    low, high = LEAST_CYCLES / time_step, 0.5 / time_step
    w = 2.0 * math.pi * checks.within("corner frequency", frequency, low, high, unit="Hz", open_high=True)
    step = transition(w, 1.0, time_step).tolist()
    # against the moving equilibrium of a line a + b t, only free vibration is left
    w2, lag = 1.0 / (w * w), 2.0 / w**3
    z, v = 0.0, 0.0
    result = [float(acceleration[0])]
    samples = acceleration.tolist()
    for a, b in pairwise(samples):
        slope = (b - a) / time_step
        free, speed = z - (a * w2 - lag * slope), v - slope * w2
        z = step[0][0] * free + step[0][1] * speed + b * w2 - lag * slope
        v = step[1][0] * free + step[1][1] * speed + slope * w2
        result.append(b - 2.0 * w * v - w * w * z)
    return np.array(result)
