"""Pulses made of sinusoids within a window: sine, cosine, A, B, C_n, Mavroeidis-Papageorgiou, harmonic, rectangle."""

import math
from dataclasses import dataclass, replace

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.motions.portable import cosine_sine
from rocking.motions.pulse import Pulse

Wave = tuple[float, float, float]
"""Amplitude [m/s2], circular frequency [rad/s] and phase [rad] of ``amplitude * sin(frequency * t + phase)``."""


@dataclass(frozen=True)
class Sinusoids(Pulse):
    """A sum of sinusoids from time zero to `duration`."""

    title: str  # what to call it
    waves: tuple[Wave, ...]  # amplitude [m/s2], circular frequency [rad/s] and phase [rad] of each sine
    length: float  # duration [s]
    largest: float  # peak acceleration [m/s2]

    def __post_init__(self) -> None:
        """Check the peak."""
        self._check_peak()

    @property
    def name(self) -> str:
        """What to call it in titles and tables."""
        return self.title

    @property
    def duration(self) -> float:
        """Time at which the acceleration ends [s]."""
        return self.length

    @property
    def peak(self) -> float:
        """Peak ground acceleration [m/s2]."""
        return self.largest

    @property
    def fastest(self) -> float:
        """Highest circular frequency in it [rad/s]."""
        return max(abs(frequency) for _, frequency, _ in self.waves)

    def scaled(self, factor: float) -> "Sinusoids":
        """Return the pulse with its acceleration multiplied by a factor.

        factor: may be negative [-].
        """
        factor = checks.number("factor", factor)
        waves = tuple((factor * amplitude, frequency, phase) for amplitude, frequency, phase in self.waves)
        return replace(self, waves=waves, largest=abs(factor) * self.largest)

    def _inside(self, time: FloatArray, derivative: int) -> FloatArray:
        total = np.zeros_like(time)
        for amplitude, frequency, phase in self.waves:
            if frequency == 0.0:
                power = 2 - derivative
                total += amplitude * math.sin(phase) * time**power / (1.0, 1.0, 2.0)[power]
            elif derivative == 2:
                total += amplitude * cosine_sine(frequency * time + phase)[1]  # Eq. 157
            elif derivative == 1:
                total -= amplitude / frequency * cosine_sine(frequency * time + phase)[0]
            else:
                total -= amplitude / frequency**2 * cosine_sine(frequency * time + phase)[1]
        return total
