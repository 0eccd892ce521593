"""Pulses: ground accelerations as formulas, which are sums of sinusoids or Ricker wavelets."""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from rocking import checks, plausibility
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.messages import Message
from rocking.motions.filters import cosine_sine, exponential
from rocking.motions.motion import LARGEST_ACCELERATION, LONGEST_STEP, SHORTEST_STEP, GroundMotion
from rocking.motions.segments import Segments

MOST_SAMPLES = 2_000_000  # larger numbers result from a wrong unit
_PER_RADIAN = 8.0
Wave = tuple[float, float, float]
"""Amplitude [m/s2], circular frequency [rad/s] and phase [rad] of ``amplitude * sin(frequency * t + phase)``."""

_SQRT3 = math.sqrt(3.0)
# maximum of (3 - z^2) z exp(-z^2 / 2), at z^2 = 3 - sqrt(6)
_PEAK = math.sqrt(6.0) * math.sqrt(3.0 - math.sqrt(6.0)) * math.exp(-0.5 * (3.0 - math.sqrt(6.0)))  # Eq. 161


class Pulse(ABC):
    """A horizontal ground motion with formulas for acceleration, velocity and displacement.

    The motion starts at time zero from rest. After `duration`, the acceleration is zero and the velocity is constant.
    """

    @property
    @abstractmethod
    def name(self) -> str:
        """Shape, strength and period of the pulse, for titles and tables."""

    def named(self, *, strength: bool = True, period: bool = True) -> str:
        """Return the shape of the pulse, optionally with strength and period.

        Parameters
        ----------
        strength, period : bool
            True to include the value.

        Returns
        -------
        str
            Text with units. Pulses without shorter names return the full name.
        """
        return self.name

    @property
    @abstractmethod
    def duration(self) -> float:
        """Time at which the acceleration ends [s]."""

    @property
    @abstractmethod
    def peak(self) -> float:
        """Peak ground acceleration [m/s2]."""

    @property
    @abstractmethod
    def fastest(self) -> float:
        """Highest circular frequency of the pulse [rad/s]. It determines the length of segments."""

    @property
    def doubts(self) -> tuple[str, ...]:
        """Warnings about implausible accelerations."""
        return plausibility.of_acceleration(self.peak)

    @abstractmethod
    def scaled(self, factor: float) -> "Pulse":
        """Return the pulse with its acceleration multiplied by a factor.

        Parameters
        ----------
        factor : float
            Scale factor [-]. A negative factor reverses the polarity.
        """

    @abstractmethod
    def _inside(self, time: FloatArray, derivative: int) -> FloatArray:
        """Return displacement (0), velocity (1) or acceleration (2) within the pulse, without integration constants."""

    def acceleration(self, time: Any) -> FloatArray:
        """Return the acceleration at given times.

        Parameters
        ----------
        time : array_like
            Times [s].

        Returns
        -------
        ndarray
            Acceleration [m/s2], zero outside the pulse.
        """
        t = _times(time)
        inside = (t >= 0.0) & (t <= self.duration)
        return np.where(inside, self._inside(np.clip(t, 0.0, self.duration), 2), 0.0)

    def velocity(self, time: Any) -> FloatArray:
        """Return the ground velocity at given times, zero before the pulse.

        Parameters
        ----------
        time : array_like
            Times [s].

        Returns
        -------
        ndarray
            Velocity [m/s].
        """
        t = np.clip(_times(time), 0.0, self.duration)
        return np.asarray(self._inside(t, 1) - self._inside(np.zeros(()), 1))

    def displacement(self, time: Any) -> FloatArray:
        """Return the ground displacement at given times, zero before the pulse.

        Parameters
        ----------
        time : array_like
            Times [s].

        Returns
        -------
        ndarray
            Displacement [m].
        """
        times = _times(time)
        t = np.clip(times, 0.0, self.duration)
        start = self._inside(np.zeros(()), 0) + self._inside(np.zeros(()), 1) * t
        coasting = np.maximum(times - self.duration, 0.0) * self.velocity(self.duration)
        return np.asarray(self._inside(t, 0) - start + coasting)

    def _check_peak(self) -> None:
        if not self.peak <= LARGEST_ACCELERATION:
            raise InvalidValueError(
                "the peak of a pulse must be in [0, {most:g}] m/s2, got {peak:g}; check the unit",
                most=LARGEST_ACCELERATION,
                peak=self.peak,
            )

    def segments(self) -> Segments:
        """Return the pulse as polynomials, equal to the pulse within rounding.

        Returns
        -------
        Segments
            Segments of degree 7.
        """
        count = max(1, int(np.ceil(_PER_RADIAN * self.fastest * self.duration)))
        return Segments.of_function(self.acceleration_inside, self.duration, count)

    def acceleration_inside(self, time: FloatArray) -> FloatArray:
        """Return the acceleration by the formula within the pulse.

        Parameters
        ----------
        time : ndarray
            Times from 0 to `duration` [s].

        Returns
        -------
        ndarray
            Acceleration [m/s2].
        """
        return self._inside(time, 2)

    def sampled(self, time_step: float) -> GroundMotion:
        """Return the pulse as samples, with zeros after its end.

        Parameters
        ----------
        time_step : float
            Time step between samples [s].

        Returns
        -------
        GroundMotion
            Samples with straight lines between them. The error is of second order in the step.

        Raises
        ------
        InvalidValueError
            If the step is outside the limits of a `GroundMotion`, is longer than the pulse, or gives more than
            2,000,000 samples.
        """
        step = checks.within("time_step", time_step, SHORTEST_STEP, LONGEST_STEP, unit="s", hint="in seconds")
        if step > self.duration:
            raise InvalidValueError(
                "{parameter} must be at most the pulse's duration {duration:g} s, got {value}", parameter="time_step",
                value=step, duration=self.duration,
            )  # fmt: skip
        count = int(np.ceil(self.duration / step - 1e-9)) + 2
        if count > MOST_SAMPLES:
            raise InvalidValueError(
                "{parameter} must give at most {limit:g} samples, got {value} s with {count:g} samples",
                parameter="time_step", value=step, limit=MOST_SAMPLES, count=count, hint="check the unit",
            )  # fmt: skip
        times = np.arange(count) * step
        return GroundMotion(
            self.acceleration(times),
            step,
            name=self.name,
            provenance=(f"{self!r} sampled every {step!r} s",),
        )


@dataclass(frozen=True)
class Sinusoids(Pulse):
    """A sum of sinusoids from time zero to `duration`."""

    shape: str  # name of the shape
    waves: tuple[Wave, ...]  # amplitude [m/s2], circular frequency [rad/s] and phase [rad] of each sine
    length: float  # duration [s]
    largest: float  # peak acceleration [m/s2]
    strength: float  # strength in the name, in `unit`
    period: float  # period in the name [s]
    unit: str = "m/s2"

    def __post_init__(self) -> None:
        self._check_peak()

    @property
    def name(self) -> str:
        """Shape, strength and period of the pulse."""
        return self.named()

    def named(self, *, strength: bool = True, period: bool = True) -> str:
        """Return the shape of the pulse, optionally with strength and period."""
        return _named(self.shape, self.strength, self.unit, self.period, strength=strength, period=period)

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
        """Highest circular frequency of the pulse [rad/s]."""
        return max(abs(frequency) for _, frequency, _ in self.waves)

    def scaled(self, factor: float) -> "Sinusoids":
        """Return the pulse with its acceleration multiplied by a factor."""
        factor = checks.number("factor", factor)
        waves = tuple((factor * amplitude, frequency, phase) for amplitude, frequency, phase in self.waves)
        strength = abs(factor) * self.strength
        return replace(self, waves=waves, largest=abs(factor) * self.largest, strength=strength)

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


@dataclass(frozen=True)
class Ricker(Pulse):
    """A Ricker wavelet, symmetric or antisymmetric about its middle.

    With the time t from the middle, the symmetric wavelet is ``a_p (1 - 2 x^2) exp(-x^2)``, x = pi t / T_p. The
    antisymmetric wavelet is ``(a_p / beta) (z^2 - 3) z exp(-z^2 / 2)``, z = 2 pi t / (sqrt(3) T_p), beta = 1.3801...
    The wavelet ends 2 periods (antisymmetric: 2.5 periods) from the middle, where it is below 1e-15 of the peak.
    """

    amplitude: float  # peak acceleration a_p [m/s2]; negative for reversed polarity
    period: float  # period T_p [s]
    shape: Literal["symmetric", "antisymmetric"] = "symmetric"

    def __post_init__(self) -> None:
        self._check_peak()

    @property
    def name(self) -> str:
        """Shape, strength and period of the pulse."""
        return self.named()

    def named(self, *, strength: bool = True, period: bool = True) -> str:
        """Return the shape of the wavelet, optionally with amplitude and period."""
        shape = f"{self.shape} Ricker wavelet"
        return _named(shape, self.amplitude, "m/s2", self.period, strength=strength, period=period)

    @property
    def duration(self) -> float:
        """End of the wavelet [s]."""
        return (4.0 if self.shape == "symmetric" else 5.0) * self.period

    @property
    def peak(self) -> float:
        """Peak ground acceleration [m/s2]."""
        return abs(self.amplitude)

    @property
    def fastest(self) -> float:
        """Circular frequency that corresponds to the largest curvature [rad/s]."""
        return 3.0 * math.pi / self.period

    def scaled(self, factor: float) -> "Ricker":
        """Return the pulse with its acceleration multiplied by a factor."""
        return replace(self, amplitude=checks.number("factor", factor) * self.amplitude)

    def _inside(self, time: FloatArray, derivative: int) -> FloatArray:
        t = time - 0.5 * self.duration
        if self.shape == "symmetric":
            x2 = (math.pi / self.period * t) ** 2
            shape = (-0.5 * (self.period / math.pi) ** 2, t, 1.0 - 2.0 * x2)[derivative]  # Eq. 160
            return self.amplitude * shape * exponential(-x2)
        unit = _SQRT3 * self.period / (2.0 * math.pi)
        z = t / unit
        shape = (unit**2 * z, -unit * (z * z - 1.0), (z * z - 3.0) * z)[derivative]  # Eq. 161
        return self.amplitude / _PEAK * shape * exponential(-0.5 * z * z)


def _named(shape: str, value: float, unit: str, time: float, *, strength: bool, period: bool) -> str:
    facts = {"shape": Message(shape), "strength": f"{abs(value):.3g} {unit}", "period": f"{time:.3g} s"}
    text = {(True, True): "{shape}, {strength}, {period}", (True, False): "{shape}, {strength}"}
    return Message(text.get((strength, period), "{shape}, {period}" if period else "{shape}"), facts)


def _times(time: Any) -> FloatArray:
    times = checks.real_array("time", time, "s")
    if not np.isfinite(times).all():
        raise InvalidValueError("time must be finite [s], got {time:g}", time=times[~np.isfinite(times)][0])
    return times


Motion = GroundMotion | Pulse
