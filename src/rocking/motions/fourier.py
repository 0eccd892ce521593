"""Fourier amplitudes of a record, smoothed where wanted."""

import numpy as np
from numpy.typing import ArrayLike

from rocking import checks
from rocking.conventions import FloatArray
from rocking.motions.motion import GroundMotion, checked_motion


def fourier_amplitudes(
    motion: GroundMotion, frequencies: ArrayLike | None = None, bandwidth: float = 40.0
) -> tuple[FloatArray, FloatArray]:
    """Return the Fourier amplitudes of the acceleration.

    Parameters
    ----------
    motion : GroundMotion
        The motion; its horizontal part counts.
    frequencies : array_like, optional
        Where the amplitudes are wanted, smoothed over their neighbours by the window of Konno & Ohmachi (1998); those
        of the transform as they are if not given [Hz].
    bandwidth : float
        b of the window: the larger, the narrower [-].

    Returns
    -------
    tuple of ndarray
        Frequencies [Hz] and amplitudes of one side [m/s].

    Examples
    --------
    >>> _, amplitudes = fourier_amplitudes(GroundMotion([0.0, 2.0, 2.0, 0.0], 0.5))
    >>> float(amplitudes[0])
    2.0
    """
    motion = checked_motion(motion)
    every = np.fft.rfftfreq(len(motion), motion.time_step)
    amplitudes = motion.time_step * np.abs(np.fft.rfft(motion.acceleration))  # Eq. 304
    if frequencies is None:
        return np.asarray(every, dtype=np.float64), np.asarray(amplitudes, dtype=np.float64)
    wanted = np.atleast_1d(checks.positive_array("frequencies", frequencies, "Hz"))
    checks.all_within("frequencies", wanted, every[1], every[-1], wanted)
    b = checks.positive("bandwidth", bandwidth)
    smooth = np.empty(wanted.size)
    for k, centre in enumerate(wanted.tolist()):
        x = b * np.log10(every[1:] / centre)
        window = np.sinc(x / np.pi) ** 4  # Eq. 305
        smooth[k] = float((window * amplitudes[1:]).sum() / window.sum())
    return wanted.copy(), smooth
