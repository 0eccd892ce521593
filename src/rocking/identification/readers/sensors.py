"""The rotation of a body from a displacement or an acceleration at a height above its base."""

import numpy as np
from scipy.fft import irfft, next_fast_len, rfft, rfftfreq

from rocking.conventions import FloatArray, g
from rocking.errors import MeasurementError

_EVEN = 0.5
_STEEPEST = 0.95


def rotation_of_displacement(displacement: FloatArray, height: float) -> FloatArray:
    """Return the rotation of a point that moves to the right, from where it stands at rest.

    The point turns about the foot below, so its distance from the vertical through that foot changes by little:
    sin(theta) = u / height, to the second order in theta times the half width over the height.
    """
    most = float(np.abs(displacement).max())
    if most > _STEEPEST * height:
        raise MeasurementError(f"a displacement of {most:g} m at a height of {height:g} m is no rocking; wrong unit?")
    return np.asarray(np.arcsin(displacement / height))


def rotation_of_acceleration(
    time: FloatArray, acceleration: FloatArray, height: float
) -> tuple[FloatArray, tuple[str, ...]]:
    """Return the rotation of a sensor that turns with the body, and what there is to say against it.

    Such a sensor feels h theta'' - g theta to the right, for it tilts. That is solved for theta by frequency,
    theta = -f / (h omega^2 + g): no drift is integrated, since gravity shows which way is up.
    """
    steps = np.diff(time)
    step = float(np.median(steps))
    even = np.arange(time[0], time[-1] + 0.5 * step, step)
    felt = np.interp(even, time, acceleration)
    rest = felt.size
    # the ends are held for as long as a solution takes to forget them: sqrt(h / g) times ten
    held = int(np.ceil(10.0 * np.sqrt(height / g) / step))
    size = next_fast_len(rest + 2 * held, real=True)
    padded = np.concatenate((np.full(held, felt[0]), felt, np.full(size - rest - held, felt[-1])))
    omega = 2.0 * np.pi * rfftfreq(size, step)
    rotation = -irfft(rfft(padded) / (height * omega**2 + g), size)[held : held + rest]
    doubts = [
        "a rotation from an acceleration leaves out the centripetal part, of the half width times its speed squared"
    ]
    if np.abs(steps - step).max() > _EVEN * step:
        doubts.append("its time stamps are uneven: the acceleration was interpolated")
    return np.interp(time, even, rotation), tuple(doubts)
