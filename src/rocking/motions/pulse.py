"""A pulse: an acceleration known at every instant, not only at samples."""

from abc import ABC, abstractmethod
from typing import Any

import numpy as np

from rocking import checks, plausibility
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.motions.motion import LARGEST_ACCELERATION, LONGEST_STEP, SHORTEST_STEP, GroundMotion
from rocking.motions.segments import Segments

MOST_SAMPLES = 2_000_000
"""No pulse is sampled to more than this: asking for more is a wrong unit."""

_PER_RADIAN = 8.0


class Pulse(ABC):
    """A horizontal ground motion given by formulas for acceleration, velocity and displacement.

    It starts at time zero from rest and is zero before; after `duration` the acceleration is zero and the velocity
    stays what it was.
    """

    @property
    @abstractmethod
    def name(self) -> str:
        """What to call it in titles and tables."""

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
        """Highest circular frequency in it, which says how fine it must be cut [rad/s]."""

    @property
    def doubts(self) -> tuple[str, ...]:
        """What can be computed with but was hardly meant, in words."""
        return plausibility.of_acceleration(self.peak)

    @abstractmethod
    def scaled(self, factor: float) -> "Pulse":
        """Return the pulse with its acceleration multiplied by a factor.

        Parameters
        ----------
        factor : float
            May be negative [-].
        """

    @abstractmethod
    def _inside(self, time: FloatArray, derivative: int) -> FloatArray:
        """Return displacement (0), velocity (1) or acceleration (2) at times within the pulse, up to constants."""

    def acceleration(self, time: Any) -> FloatArray:
        """Return the acceleration at any times.

        Parameters
        ----------
        time : array_like
            Times [s].

        Returns
        -------
        ndarray
            Acceleration, zero outside the pulse [m/s2].
        """
        t = _times(time)
        inside = (t >= 0.0) & (t <= self.duration)
        return np.where(inside, self._inside(np.clip(t, 0.0, self.duration), 2), 0.0)

    def velocity(self, time: Any) -> FloatArray:
        """Return the ground velocity at any times, zero before the pulse.

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
        """Return the ground displacement at any times, zero before the pulse.

        Parameters
        ----------
        time : array_like
            Times [s].

        Returns
        -------
        ndarray
            Displacement [m].
        """
        given = _times(time)
        t = np.clip(given, 0.0, self.duration)
        start = self._inside(np.zeros(()), 0) + self._inside(np.zeros(()), 1) * t
        coasting = np.maximum(given - self.duration, 0.0) * self.velocity(self.duration)
        return np.asarray(self._inside(t, 0) - start + coasting)

    def _check_peak(self) -> None:
        if not self.peak <= LARGEST_ACCELERATION:
            raise InvalidValueError(
                f"the peak of a pulse must be in [0, {LARGEST_ACCELERATION:g}] m/s2, got {self.peak:g}; wrong unit?"
            )

    def segments(self) -> Segments:
        """Return the pulse as polynomials that agree with it to rounding.

        Returns
        -------
        Segments
            Of degree 7.
        """
        count = max(1, int(np.ceil(_PER_RADIAN * self.fastest * self.duration)))
        return Segments.of_function(self.acceleration_inside, self.duration, count)

    def acceleration_inside(self, time: FloatArray) -> FloatArray:
        """Return the acceleration by the formula that holds within the pulse.

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
            Step between samples [s].

        Returns
        -------
        GroundMotion
            Straight lines between the samples: an approximation, of second order in the step.

        Raises
        ------
        InvalidValueError
            If the step is not within the limits of a `GroundMotion`, longer than the pulse, or so short that there
            would be more than 2,000,000 samples.
        """
        step = checks.within("time_step", time_step, SHORTEST_STEP, LONGEST_STEP, unit="s", hint="in seconds")
        if step > self.duration:
            raise InvalidValueError(f"time_step must be at most the pulse's duration {self.duration:g} s, got {step:g}")
        count = int(np.ceil(self.duration / step - 1e-9)) + 2
        if count > MOST_SAMPLES:
            raise InvalidValueError(
                f"time_step must leave at most {MOST_SAMPLES:g} samples, got {step:g} s, "
                f"which leaves {count:g}; wrong unit?"
            )
        times = np.arange(count) * step
        return GroundMotion(
            self.acceleration(times), step, name=self.name, provenance=(f"{self!r} sampled every {step!r} s",)
        )


def _times(time: Any) -> FloatArray:
    given = checks.real_array("time", time, "s")
    if not np.isfinite(given).all():
        raise InvalidValueError(f"time must be finite [s], got {given[~np.isfinite(given)][0]:g}")
    return given
