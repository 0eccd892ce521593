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
from rocking.motions.portable import NEIGHBOURS, cosine_sine, exponential, resonances
from rocking.motions.synthetic.modulation import GammaModulation
from rocking.motions.synthetic.oscillator import highpassed
from rocking.motions.synthetic.sampling import described, normals, times

FORGOTTEN = 27.0
"""Decays of an impulse response after which it is left out: exp(-27) = 2e-12."""

SPACING = 0.05
"""Distance of the frequencies of oscillators that share impulses, over the slowest rate of decay [-]."""


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
        return 2.0 * np.pi * np.maximum(self.frequency + self.slope * (time - self.middle), self.lowest)  # Eq. 171


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
    noise = normals(seed, time.size)
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
    # Every impulse goes through the oscillator of its own instant. As the frequency drifts one way, few oscillators a
    # short way apart serve: polynomials of degree 9 between their responses err below 1e-10. Where a drift crosses
    # more of them than there are impulses, each impulse has its own.
    used, count = omega[:-1], noise.size - 1
    spacing = SPACING * damping * float(used.min())
    place, own = np.abs(used - used[0]) / spacing, used
    nodes = int(place.max()) + NEIGHBOURS
    if shared := nodes < count:
        steps = np.arange(nodes, dtype=np.float64) - (NEIGHBOURS - 1) // 2
        own = used[0] + math.copysign(spacing, float(used[-1] - used[0])) * steps
    else:
        place = np.arange(count, dtype=np.float64)
    decay = exponential(-damping * step * own)
    cosine, sine = cosine_sine(math.sqrt(1.0 - damping * damping) * step * own)
    lasting = np.ceil(FORGOTTEN / (damping * step * own))
    total, squares = resonances(noise, omega, place, shared, (decay * cosine, decay * sine), lasting)
    # at the first sample nothing has come through yet
    squares[0] = 2.0
    return total / np.sqrt(0.5 * squares)  # Eq. 172
