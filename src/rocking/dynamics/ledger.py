"""Where the energy goes: work of the ground in, losses at impacts out, the rest kinetic and potential."""

from dataclasses import dataclass

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics import equations
from rocking.dynamics.intervals import Intervals
from rocking.dynamics.settings import Settings


@dataclass(frozen=True)
class ResponseEnergy:
    """Energy of a response at its samples.

    Parameters
    ----------
    time : ndarray
        Times of the samples, and of the fall if it comes after the last of them [s].
    kinetic, potential : ndarray
        Of the body, above rest [J].
    work : ndarray
        Done by the ground since the start [J].
    lost : ndarray
        At impacts since the start [J].
    """

    time: FloatArray
    kinetic: FloatArray
    potential: FloatArray
    work: FloatArray
    lost: FloatArray

    @property
    def gap(self) -> FloatArray:
        """What does not add up: kinetic + potential + lost - work - initial [J]."""
        stored = self.kinetic + self.potential
        return np.asarray(stored + self.lost - self.work - stored[0], dtype=np.float64)

    @property
    def closure(self) -> float:
        """Largest gap over the largest energy that was ever stored or lost [-]."""
        scale = max(float(np.max(self.kinetic + self.potential)), float(np.max(np.abs(self.lost))), 1e-300)
        return float(np.max(np.abs(self.gap))) / scale


def energy_of(intervals: Intervals, time: FloatArray, mass: float, settings: Settings) -> ResponseEnergy:
    """Return the energy of a response.

    Parameters
    ----------
    intervals : Intervals
        The response between its samples and events.
    time : ndarray
        Times of the samples, the first one zero, and of a fall after the last of them [s].
    mass : float
        Mass of the body [kg].
    settings : Settings
        How it was integrated.

    Returns
    -------
    ResponseEnergy
        At these times.
    """
    unit = (mass * settings.gravity * intervals.semi_diagonal)[:, None]
    alpha, p = intervals.alpha[:, None], intervals.p[:, None]
    stored = unit * equations.energy(intervals.rotation, intervals.velocity, alpha, p, linear=settings.linear)
    kinetic = unit * 0.5 * np.square(intervals.velocity / p)
    # what one interval ends with and the next one starts without was lost in between
    lost = np.concatenate([[0.0], np.cumsum(stored[:-1, 1] - stored[1:, 0])])
    work = np.cumsum(mass * intervals.work(settings))
    place = intervals.places(time[1:])

    def at_samples(first: float, values: FloatArray) -> FloatArray:
        return np.concatenate([[first], values[place]])

    return ResponseEnergy(
        time=time,
        kinetic=at_samples(kinetic[0, 0], kinetic[:, 1]),
        potential=at_samples(stored[0, 0] - kinetic[0, 0], stored[:, 1] - kinetic[:, 1]),
        work=at_samples(0.0, work),
        lost=at_samples(0.0, lost),
    )
