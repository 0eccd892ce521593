"""Gamma modulation: how the intensity of a synthetic motion grows and fades."""

import math
from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray, g
from rocking.errors import InvalidValueError
from rocking.motions.portable import exponential, logarithm

MIDDLE = 0.45
"""Share of the Arias intensity at the middle of the strong shaking (Rezaeian & Der Kiureghian 2010)."""

WIDEST, NARROWEST = 1.0, 1e4
"""Allowed shapes of the gamma distribution of the energy: from one that starts at once to a narrow burst."""


@dataclass(frozen=True)
class GammaModulation:
    """Standard deviation of the acceleration, ``q(t) = a1 t^(a2 - 1) exp(-a3 t)``.

    Parameters
    ----------
    a1 : float
        Size [m/s2 over s^(a2 - 1)].
    a2 : float
        Shape, at least 1 [-].
    a3 : float
        Decay [1/s].

    Raises
    ------
    InvalidValueError
        If a parameter is outside its range.

    Examples
    --------
    >>> GammaModulation(a1=math.e, a2=2.0, a3=1.0)(np.array([0.0, 1.0])).round(12).tolist()
    [0.0, 1.0]
    """

    a1: float
    a2: float
    a3: float

    def __post_init__(self) -> None:
        """Check the parameters."""
        object.__setattr__(self, "a1", checks.positive("a1", self.a1, "m/s2"))
        object.__setattr__(self, "a2", checks.within("a2", self.a2, 1.0, 0.5 * (1.0 + NARROWEST)))
        object.__setattr__(self, "a3", checks.positive("a3", self.a3, "1/s"))

    def __call__(self, time: FloatArray) -> FloatArray:
        """Return the standard deviation at times of at least zero."""
        # in logarithms: the power alone can overflow
        grown = (self.a2 - 1.0) * logarithm(time) if self.a2 > 1.0 else np.zeros_like(time)
        return exponential(logarithm(np.array(self.a1)) + grown - self.a3 * time)  # Eq. 169

    def arias_intensity(self, gravity: float = g) -> float:
        """Return the expected Arias intensity of the whole motion.

        Parameters
        ----------
        gravity : float
            Acceleration of gravity [m/s2].

        Returns
        -------
        float
            The intensity [m/s].
        """
        gravity = checks.positive("gravity", gravity, "m/s2")
        shape, rate = 2.0 * self.a2 - 1.0, 2.0 * self.a3
        energy = 2.0 * math.log(self.a1) + math.lgamma(shape) - shape * math.log(rate)  # Eq. 170
        return 0.5 * math.pi / gravity * math.exp(energy)

    def time_of(self, share: float) -> float:
        """Return the time at which a share of the expected Arias intensity is reached.

        Parameters
        ----------
        share : float
            Between 0 and 1 [-].

        Returns
        -------
        float
            The time [s].
        """
        share = checks.within("share", share, 0.0, 1.0, open_high=True, hint="not a percentage")
        return _quantile(2.0 * self.a2 - 1.0, share) / (2.0 * self.a3)


def modulation_from_intensity(
    arias_intensity: float, significant_duration: float, middle: float, gravity: float = g
) -> GammaModulation:
    """Return the gamma modulation that has a given intensity, duration and middle.

    The squared modulation is a gamma distribution with the shape ``2 a2 - 1`` and the rate ``2 a3``; the ratio of
    the duration to the middle depends on the shape alone, which is solved for.

    Parameters
    ----------
    arias_intensity : float
        Expected Arias intensity [m/s].
    significant_duration : float
        Duration between 5 and 95 % of it [s].
    middle : float
        Time at which 45 % of it is reached [s].
    gravity : float
        Acceleration of gravity [m/s2].

    Returns
    -------
    GammaModulation
        The modulation.

    Raises
    ------
    InvalidValueError
        If no gamma modulation has this ratio of the duration to the middle.

    Examples
    --------
    >>> q = modulation_from_intensity(1.0, significant_duration=10.0, middle=8.0)
    >>> round(q.arias_intensity(), 9), round(q.time_of(0.95) - q.time_of(0.05), 9), round(q.time_of(0.45), 9)
    (1.0, 10.0, 8.0)
    """
    from scipy.optimize import brentq

    intensity = checks.positive("arias_intensity", arias_intensity, "m/s")
    duration = checks.positive("significant_duration", significant_duration, "s")
    middle = checks.positive("middle", middle, "s")
    gravity = checks.positive("gravity", gravity, "m/s2")
    wanted = duration / middle
    least, most = _ratio(NARROWEST), _ratio(WIDEST)
    if not least <= wanted <= most:
        raise InvalidValueError(
            f"significant_duration / middle must be in [{least:.4g}, {most:.4g}], got {wanted:.4g}; "
            "does the middle count from the start of the motion?"
        )
    # the ends themselves may miss by rounding
    log_shape = (
        0.0
        if wanted == most
        else float(brentq(lambda x: _ratio(math.exp(x)) - wanted, math.log(WIDEST), math.log(NARROWEST), xtol=1e-14))
    )
    # eleven and twelve digits: the last ones hang on the C library
    shape = float(f"{math.exp(log_shape):.11g}")
    rate = float(f"{_quantile(shape, MIDDLE) / middle:.11g}")
    energy = 2.0 * gravity * intensity / math.pi
    size = math.exp(0.5 * (math.log(energy) + shape * math.log(rate) - math.lgamma(shape)))  # Eq. 170
    return GammaModulation(float(f"{size:.12g}"), 0.5 * (shape + 1.0), 0.5 * rate)


def _quantile(shape: float, share: float) -> float:
    from scipy.special import gammaincinv

    return float(gammaincinv(shape, share))


def _ratio(shape: float) -> float:
    return (_quantile(shape, 0.95) - _quantile(shape, 0.05)) / _quantile(shape, MIDDLE)
