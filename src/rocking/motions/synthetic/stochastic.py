"""Fully nonstationary motions after Rezaeian and Der Kiureghian: filtered, modulated white noise.

Rezaeian & Der Kiureghian (2008), Earthquake Engineering & Structural Dynamics 37(13):1565-1584, DOI
10.1002/eqe.831; the parametrisation by the middle of the strong shaking is theirs of 2010, ibid. 39:1155, DOI
10.1002/eqe.997. Their regressions on magnitude, distance and site are not part of this module: the parameters are
the user's.
"""

import math
from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.motions.motion import GroundMotion
from rocking.motions.synthetic.modulation import GammaModulation
from rocking.motions.synthetic.oscillator import highpassed
from rocking.motions.synthetic.sampling import described, generator, times

FORGOTTEN = 40.0
"""Decays of an impulse response after which it is below rounding: exp(-40) = 4e-18."""

_BLOCK = 24


@dataclass(frozen=True)
class NonstationaryFilter:
    """Oscillator whose frequency drifts while it shapes the noise.

    The defaults are round numbers of the size of records on firm ground, for trying things out; they are no
    prediction for any site.

    Parameters
    ----------
    frequency : float
        Frequency at the middle time [Hz].
    slope : float
        Change of the frequency with time [Hz/s].
    middle : float
        Time at which the frequency is `frequency` [s].
    damping : float
        Damping ratio, between 0 and 1: small is narrow-banded [-].
    lowest : float
        The drift ends where the frequency falls to this [Hz].

    Raises
    ------
    InvalidValueError
        If a parameter is outside its range.
    """

    frequency: float = 6.0
    slope: float = -0.1
    middle: float = 8.0
    damping: float = 0.3
    lowest: float = 0.3

    def __post_init__(self) -> None:
        """Check the parameters."""
        object.__setattr__(self, "frequency", checks.positive("frequency", self.frequency, "Hz"))
        object.__setattr__(self, "slope", checks.number("slope", self.slope, "Hz/s"))
        object.__setattr__(self, "middle", checks.within("middle", self.middle, 0.0, math.inf, unit="s"))
        damping = checks.within("damping", self.damping, 0.0, 1.0, open_low=True, open_high=True)
        object.__setattr__(self, "damping", damping)
        object.__setattr__(self, "lowest", checks.within("lowest", self.lowest, 0.0, self.frequency, open_low=True))

    def omega(self, time: FloatArray) -> FloatArray:
        """Return the frequency at given times.

        Parameters
        ----------
        time : ndarray
            Times [s].

        Returns
        -------
        ndarray
            Circular frequency [rad/s].
        """
        return 2.0 * np.pi * np.maximum(self.frequency + self.slope * (time - self.middle), self.lowest)


def nonstationary_motion(
    modulation: GammaModulation,
    shaper: NonstationaryFilter,
    *,
    seed: int,
    time_step: float = 0.01,
    duration: float = 40.0,
    corner: float | None = 0.1,
) -> GroundMotion:
    """Return one synthetic motion.

    Before the high pass its standard deviation is that of `modulation` at every sample but the first, which is zero.

    Parameters
    ----------
    modulation : GammaModulation
        Standard deviation over time; `modulation_from_intensity` finds it.
    shaper : NonstationaryFilter
        Frequency and bandwidth over time.
    seed : int
        The same seed gives the same bits [-].
    time_step : float
        Step between samples [s].
    duration : float
        Duration [s].
    corner : float or None
        Frequency of the critically damped high pass that brings velocity and displacement back to zero; None for
        none [Hz].

    Returns
    -------
    GroundMotion
        The motion, with its parameters as metadata.

    Raises
    ------
    InvalidValueError
        If a parameter is outside its range, or the filter is faster than the steps can follow.

    Examples
    --------
    >>> modulation = GammaModulation(a1=0.5, a2=2.0, a3=0.3)
    >>> one = nonstationary_motion(modulation, NonstationaryFilter(), seed=1, duration=20.0)
    >>> two = nonstationary_motion(modulation, NonstationaryFilter(), seed=1, duration=20.0)
    >>> bool((one.acceleration == two.acceleration).all())
    True
    """
    time = times(time_step, duration)
    step = float(time[1])
    omega = shaper.omega(time)
    if omega.max() * step >= math.pi:
        raise InvalidValueError(
            f"filter frequency must be below {0.5 / step:g} Hz for steps of {step:g} s, "
            f"got {omega.max() / (2.0 * math.pi):g} Hz; sign of the slope?"
        )
    noise = generator(seed).standard_normal(time.size)
    acceleration = modulation(time) * _unit_process(noise, omega, shaper.damping, step)
    if corner is not None:
        acceleration = highpassed(acceleration, step, checks.positive("corner", corner, "Hz"))
    parameters = described(
        modulation=modulation, filter=shaper, seed=int(seed), time_step=step, duration=duration, corner=corner
    )
    line = f"simulated: modulated filtered white noise (Rezaeian & Der Kiureghian 2008), seed {seed}"
    return GroundMotion(
        acceleration, step, name=f"synthetic, nonstationary, seed {seed}", metadata=parameters, provenance=(line,)
    )


def _unit_process(noise: FloatArray, omega: FloatArray, damping: float, step: float) -> FloatArray:
    """Return noise through a filter that changes, over its own standard deviation: variance 1 after the start."""
    total, variance = np.zeros(noise.size), np.zeros(noise.size)
    for first in range(0, noise.size - 1, _BLOCK):
        turn = omega[first : min(first + _BLOCK, noise.size - 1)] * step
        left = noise.size - 1 - first
        reach = min(left, math.ceil(FORGOTTEN / (damping * turn.min())))
        response = _responses(turn, damping, reach) * (turn / step)[:, np.newaxis]
        for out, weights in (
            (total, response * noise[first : first + turn.size, np.newaxis]),
            (variance, response * response),
        ):
            arrived = _staggered(weights)[:left]
            out[first + 1 : first + 1 + arrived.size] += arrived
    # at the first sample nothing has come through yet
    variance[0] = 1.0
    return total / np.sqrt(variance)


def _responses(turn: FloatArray, damping: float, reach: int) -> FloatArray:
    """Return exp(-zeta k turn) sin(k root turn) / root for k = 1 ... reach, a row for each turn."""
    root = math.sqrt(1.0 - damping * damping)
    rate = complex(-damping, root) * turn[:, np.newaxis]
    # powers of a number are those of its own power, times the first few: few exponentials are left
    far = np.exp(rate * (_BLOCK * np.arange(-(-reach // _BLOCK))))[:, :, np.newaxis]
    near = np.exp(rate * np.arange(1, _BLOCK + 1))[:, np.newaxis, :] / root
    powers: FloatArray = far.real * near.imag + far.imag * near.real
    return powers.reshape(turn.size, -1)[:, :reach]


def _staggered(rows: FloatArray) -> FloatArray:
    """Return the sum of rows each of which starts one place after the one above it."""
    count, width = rows.shape
    padded = np.zeros((count, width + count))
    padded[:, :width] = rows
    # read with rows one shorter, every row comes to stand one place further right
    together: FloatArray = padded.ravel()[: count * (width + count - 1)].reshape(count, -1).sum(axis=0)
    return together
