"""Where the energy goes: work of the ground in, losses at impacts out, the rest kinetic and potential."""

from dataclasses import dataclass

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.plane import equations
from rocking.dynamics.plane.dense_output import DenseOutput
from rocking.dynamics.settings import Settings


@dataclass(frozen=True)
class ResponseEnergy:
    """Energy of a response at its samples."""

    time: FloatArray  # times of the samples, and of the fall if it comes after the last of them [s]
    kinetic: FloatArray  # kinetic, potential: of the body, above rest [J]
    potential: FloatArray
    work: FloatArray  # done by the ground since the start [J]
    lost: FloatArray  # at impacts since the start [J]

    @property
    def gap(self) -> FloatArray:
        """What does not add up: kinetic + potential + lost - work - initial [J]."""
        stored = self.kinetic + self.potential
        return np.asarray(stored + self.lost - self.work - stored[0], dtype=np.float64)  # Eq. 45

    @property
    def closure(self) -> float:
        """Largest gap over the largest energy that was ever stored or lost [-]."""
        scale = max(float(np.max(self.kinetic + self.potential)), float(np.max(np.abs(self.lost))))
        fallen = float(np.max(np.abs(self.potential)))  # a body let go far beyond balance has no other energy
        return float(np.max(np.abs(self.gap))) / max(scale if scale > 1e-9 * fallen else fallen, 1e-300)


def energy_of(dense_output: DenseOutput, time: FloatArray, mass: float, settings: Settings) -> ResponseEnergy:
    """Return the energy of a response.

    time: times of the samples, the first one zero, and of a fall after the last of them [s]; mass: mass of the body
    [kg].
    """
    kinetic, potential, work, lost = energies(dense_output, mass, settings)
    place = dense_output.places(time[1:])

    def at_samples(values: FloatArray) -> FloatArray:
        return np.append(values[0, 0], values[place, 1])

    return ResponseEnergy(
        time=time,
        kinetic=at_samples(kinetic),
        potential=at_samples(potential),
        work=at_samples(work),
        lost=at_samples(lost),
    )


def energies(
    dense_output: DenseOutput, mass: float, settings: Settings
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return the energy of a response at both ends of its dense_output.

    mass: mass of the body [kg]. Returns as `ResponseEnergy` has them [J] (shape (n, 2)).
    """
    unit = (mass * settings.gravity * dense_output.semi_diagonal)[:, None]
    alpha, p = dense_output.alpha[:, None], dense_output.p[:, None]
    stored = unit * equations.energy(dense_output.rotation, dense_output.velocity, alpha, p, linear=settings.linear)
    kinetic = unit * 0.5 * np.square(dense_output.velocity / p)
    # what one interval ends with and the next one starts without was lost in between
    lost = np.concatenate([[0.0], np.cumsum(stored[:-1, 1] - stored[1:, 0])])
    work = np.concatenate([[0.0], np.cumsum(mass * dense_output.work(settings))])
    return kinetic, stored - kinetic, np.stack([work[:-1], work[1:]], axis=1), np.stack([lost, lost], axis=1)
