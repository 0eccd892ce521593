"""What the engine in space hands back for one history: polynomials between events, and the events."""

from dataclasses import dataclass, field
from enum import Enum

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.space.contact_mode import ContactSet
from rocking.outcome import ContactMode, Outcome, Status
from rocking.portable import powers, times


class SpatialEventKind(Enum):
    """What happened."""

    UPLIFT = "lifted from rest"
    IMPACT = "impact"
    CHANGE = "change of contact without impact"
    REST = "came to rest"


@dataclass(frozen=True, eq=False, slots=True)
class SpatialEvent:
    """An uplift, an impact, a change of contact or a coming to rest."""

    time: float  # when [s]
    kind: SpatialEventKind  # what
    contact: ContactSet  # on what the body stands from then on
    before: float  # before, after: kinetic energy before and after [J]
    after: float
    # of an impact, vertical: at the vertex, at both ends of the edge, or as `supports` of a face [N s]
    impulses: FloatArray = field(default_factory=lambda: np.zeros(0))


@dataclass(frozen=True, eq=False, slots=True)
class StepPiece:
    """A step of the engine."""

    start: float  # start, length: when it starts, and the unit of time of its series [s]
    length: float
    until: float  # where it ends, in that unit [-]
    # quaternions, velocities: attitude [-] and angular velocity in body axes [rad/s], coefficients by power; shape
    # (order + 1, 4)
    quaternions: FloatArray
    velocities: FloatArray
    places: FloatArray  # place of the pivot or contact on the ground, coefficients by power [m]; shape (n, 2)
    contact: ContactSet  # on what the body stands

    @property
    def end(self) -> float:
        """When it ends [s]."""
        return self.start + self.until * self.length

    def at(self, share: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return attitude, angular velocity and place of the pivot.

        Returns at these times (shape (n, 4)).
        """
        by_power = powers(share, max(len(self.quaternions), len(self.places)))
        made = [times(by_power[:, : len(c)], c) for c in (self.quaternions, self.velocities, self.places)]
        made[0] /= np.linalg.norm(made[0], axis=1)[:, None]
        return made[0], made[1], made[2]


@dataclass(frozen=True, eq=False)
class SpatialTrajectory:
    """A history."""

    pieces: list[StepPiece] = field(repr=False)  # in order of time, without gaps
    events: list[SpatialEvent] = field(repr=False)  # in order of time
    outcome: Outcome  # how it ended
    status: Status  # whether it could be computed
    # peak_tilt, peak_time: largest angle between the axis of the body and the vertical [rad], and when [s]
    peak_tilt: float
    peak_time: float
    # when the centre of mass passed over the contact for the last time; NaN if the body did not overturn [s]
    overturning_time: float
    fell_over: ContactSet | None  # the edge or vertex over which it overturned
    # for how long an end of an edge was held down although the ground would have had to pull there, because its
    # friction kept it from opening: there it slips in truth; or a rim nearly flat, which hops [s]
    held: float
    engine: str  # which engine, and how

    @property
    def impacts(self) -> list[SpatialEvent]:
        """The impacts."""
        return [event for event in self.events if event.kind is SpatialEventKind.IMPACT]

    @property
    def contact(self) -> ContactMode:
        """On what the body stands at the end."""
        return self.pieces[-1].contact.mode
