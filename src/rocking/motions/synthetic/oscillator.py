"""A linear oscillator between two samples, exactly: what filters of white noise are made of."""

import math

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.motions.portable import cosine_sine, exponential, recurrence

LEAST_CYCLES = 1e-6
"""Smallest corner of the high pass in cycles a step [-]: below, its long memory drowns in rounding."""


def transition(omega: float, damping: float, step: float) -> FloatArray:
    """Return what free vibration does to displacement and velocity over one step.

    omega: undamped natural frequency [rad/s]; damping: damping ratio, from 0 to 1; 1 is critical [-]; step: duration of
    the step [s]. Returns matrix that takes displacement and velocity to the end of the step.

    >>> transition(math.pi, 0.0, 1.0).round(12).tolist()
    [[-1.0, 0.0], [-0.0, -1.0]]
    """
    rate = omega * math.sqrt(1.0 - damping * damping)
    cosine, sine = cosine_sine(np.array([rate * step]))
    # sin(x)/rate has a limit at critical damping
    c, s = float(cosine[0]), float(sine[0]) / rate if rate > 0.0 else step
    decay = float(exponential(np.array([-damping * omega * step]))[0])
    own = damping * omega * s
    return decay * np.array([[c + own, s], [-omega * omega * s, c - own]])  # Eq. 167


def highpassed(acceleration: FloatArray, time_step: float, frequency: float) -> FloatArray:
    """Return the acceleration of a critically damped oscillator that a motion drives.

    The response of ``z'' + 2 w z' + w^2 z = a`` is a high pass of the motion: its velocity and displacement come back
    to zero (Rezaeian & Der Kiureghian 2008). It is exact at the samples for straight lines between them.

    acceleration: motion, from rest [m/s2]; time_step: step between samples [s]; frequency: natural frequency, the
    corner of the filter [Hz]. Returns ``z''`` at the samples [m/s2].
    """
    low, high = LEAST_CYCLES / time_step, 0.5 / time_step
    w = 2.0 * math.pi * checks.within("corner frequency", frequency, low, high, unit="Hz", open_high=True)
    move = transition(w, 1.0, time_step)
    # against the moving equilibrium of a line a + b t, only free vibration is left
    w2, lag = 1.0 / (w * w), 2.0 / w**3
    a, slope = acceleration[:-1], np.diff(acceleration) / time_step
    rest, end, speed = w2 * a - lag * slope, w2 * acceleration[1:] - lag * slope, w2 * slope
    (m00, m01), (m10, m11) = move.tolist()
    z, v = recurrence(move, (0.0, 0.0), end - (m00 * rest + m01 * speed), speed - (m10 * rest + m11 * speed))
    return acceleration - 2.0 * w * v - w * w * z  # Eq. 168
