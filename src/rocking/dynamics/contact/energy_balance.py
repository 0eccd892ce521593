"""Energy and forces of a planar response at its samples."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rocking.conventions import FloatArray

if TYPE_CHECKING:
    from rocking.dynamics.contact.response import ContactResponse


@dataclass(frozen=True)
class ContactEnergy:
    """Energy in the frame of the ground."""

    time: FloatArray  # times of the samples [s]
    kinetic: FloatArray  # kinetic, potential: of the body; the potential one above where it stands [J]
    potential: FloatArray
    work: FloatArray  # done by the ground since the start [J]
    lost_in_impacts: FloatArray  # lost_in_impacts, lost_in_friction: since the start [J]
    lost_in_friction: FloatArray

    @property
    def gap(self) -> FloatArray:
        """What does not add up: kinetic + potential + lost - work - initial [J]."""
        stored = self.kinetic + self.potential
        lost = self.lost_in_impacts + self.lost_in_friction
        return np.asarray(stored + lost - self.work - (stored[0] + lost[0]), dtype=np.float64)  # Eq. 45

    @property
    def closure(self) -> float:
        """Largest gap over the largest energy that was stored, lost, or worked [-]."""
        parts = (self.kinetic + self.potential, self.lost_in_impacts, self.lost_in_friction, self.work)
        scale = max(1e-300, *(float(np.abs(part).max()) for part in parts))
        return float(np.abs(self.gap).max()) / scale


@dataclass(frozen=True)
class ContactForces:
    """Forces of the ground on the body."""

    time: FloatArray  # times of the samples [s]
    horizontal: FloatArray  # on both feet together, to the right [N]
    left: FloatArray  # left, right: vertical force on each foot [N]
    right: FloatArray
    usage: FloatArray  # |horizontal| over mu times the vertical force; zero in flight [-]

    @property
    def vertical(self) -> FloatArray:
        """Vertical force on both feet together [N]."""
        return np.asarray(self.left + self.right)


def energy_of(response: "ContactResponse") -> ContactEnergy:
    """Return the energy of a response."""
    mass, j = response.base.mass, response.base.inertia
    u, w, spin = response.horizontal_velocity, response.vertical_velocity, response.angular_velocity
    return ContactEnergy(
        response.time,
        0.5 * mass * (u**2 + w**2 + j * spin**2),  # Eq. 62
        mass * response.settings.gravity * response.rise,
        mass * response.sampled("work"),
        mass * response.sampled("impact_loss"),
        mass * response.sampled("friction_loss"),
    )


def forces_of(response: "ContactResponse") -> ContactForces:
    """Return the forces of a response.

    Returns at its samples, as limits from before.
    """
    mass, friction = response.base.mass, response.law.friction
    tangential = response.sampled("tangential")
    left, right = response.sampled("normal_left"), response.sampled("normal_right")
    most = friction * (left + right)
    usage = np.zeros(most.size)
    np.divide(np.abs(tangential), most, out=usage, where=most > 0.0)  # Eq. 78
    return ContactForces(response.time, mass * tangential, mass * left, mass * right, usage)
