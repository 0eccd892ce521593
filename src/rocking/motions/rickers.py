"""Ricker wavelets: derivatives of a Gaussian, cut where nothing of them is left."""

import math
from dataclasses import dataclass, replace
from typing import Literal

from rocking import checks
from rocking.conventions import FloatArray
from rocking.motions.portable import exponential
from rocking.motions.pulse import Pulse

_SQRT3 = math.sqrt(3.0)

# maximum of (3 - z^2) z exp(-z^2 / 2), at z^2 = 3 - sqrt(6)
_PEAK = math.sqrt(6.0) * math.sqrt(3.0 - math.sqrt(6.0)) * math.exp(-0.5 * (3.0 - math.sqrt(6.0)))  # Eq. 161


@dataclass(frozen=True)
class Ricker(Pulse):
    """A Ricker wavelet, symmetric or antisymmetric about its middle.

    With t from the middle, the symmetric one is ``a_p (1 - 2 x^2) exp(-x^2)``, x = pi t / T_p, and the antisymmetric
    one ``(a_p / beta) (z^2 - 3) z exp(-z^2 / 2)``, z = 2 pi t / (sqrt(3) T_p), beta = 1.3801... Beyond 2 (2.5) periods
    from the middle nothing above 1e-15 of the peak is left, and it is cut there.
    """

    amplitude: float  # peak acceleration a_p; a negative one turns it round [m/s2]
    period: float  # period T_p [s]
    shape: Literal["symmetric", "antisymmetric"] = "symmetric"  # which of the two

    def __post_init__(self) -> None:
        """Check the peak."""
        self._check_peak()

    @property
    def name(self) -> str:
        """What to call it in titles and tables."""
        return f"{self.shape} Ricker wavelet, {abs(self.amplitude):.3g} m/s2, {self.period:.3g} s"

    @property
    def duration(self) -> float:
        """Time at which it is cut [s]."""
        return (4.0 if self.shape == "symmetric" else 5.0) * self.period

    @property
    def peak(self) -> float:
        """Peak ground acceleration [m/s2]."""
        return abs(self.amplitude)

    @property
    def fastest(self) -> float:
        """Circular frequency that its sharpest bend corresponds to [rad/s]."""
        return 3.0 * math.pi / self.period

    def scaled(self, factor: float) -> "Ricker":
        """Return the pulse with its acceleration multiplied by a factor.

        factor: may be negative [-].
        """
        return replace(self, amplitude=checks.number("factor", factor) * self.amplitude)

    def _inside(self, time: FloatArray, derivative: int) -> FloatArray:
        t = time - 0.5 * self.duration
        if self.shape == "symmetric":
            x2 = (math.pi / self.period * t) ** 2
            part = (-0.5 * (self.period / math.pi) ** 2, t, 1.0 - 2.0 * x2)[derivative]  # Eq. 160
            return self.amplitude * part * exponential(-x2)
        unit = _SQRT3 * self.period / (2.0 * math.pi)
        z = t / unit
        part = (unit**2 * z, -unit * (z * z - 1.0), (z * z - 3.0) * z)[derivative]  # Eq. 161
        return self.amplitude / _PEAK * part * exponential(-0.5 * z * z)
