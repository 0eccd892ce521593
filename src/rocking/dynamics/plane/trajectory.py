"""What an engine hands back for one history, whichever engine it was."""

import math
from dataclasses import dataclass, field
from enum import IntEnum

from rocking.conventions import FloatArray
from rocking.outcome import Outcome, Status


class EventKind(IntEnum):
    """What happened."""

    UPLIFT = 0
    IMPACT = 1
    REST = 2


@dataclass(frozen=True, slots=True)
class Event:
    """An uplift, an impact or a coming to rest."""

    time: float  # when [s]
    kind: EventKind  # what
    side: int  # +1 or -1: the side on which the body stands from then on
    before: float = 0.0  # before, after: angular velocities, of an impact [rad/s]
    after: float = 0.0
    coefficient: float = 0.0  # coefficient of restitution, of an impact [-]


@dataclass(frozen=True)
class Trajectory:
    """A history at the ends of all stretches of the motion, with its events."""

    # rotation, angular_velocity: theta [rad] and theta' [rad/s]; after overturning NaN; shape (stretches + 1,)
    rotation: FloatArray
    angular_velocity: FloatArray
    events: list[Event] = field(repr=False)  # in order of time
    outcome: Outcome  # how it ended
    status: Status  # whether it could be computed
    side: int  # +1 or -1 to which it overturned, else 0
    peak_rotation: float  # theta of largest size; a quarter turn if it overturned [rad]
    peak_time: float  # when [s]
    peak_velocity: float  # largest |theta'| [rad/s]
    # when the centre of mass passed over the foot for the last time, or the end of the motion if it does so later; NaN
    # if it did not overturn [s]
    overturning_time: float
    impacts: int  # impacts, uplifts: how many
    uplifts: int
    truncation: float  # sum of what the series of the steps leave out: no measure of accuracy, which takes a twin [rad]
    # smallest normal force of the ground while rocking over the weight m g, up to where a body that overturns passes
    # over its foot for good; at samples, uplifts and impacts; below zero the ground would have to pull; NaN if it never
    # rocked [-]
    least_force: float
    # largest ratio of horizontal to normal force at the same instants; infinite where contact is lost [-]
    friction_demand: float
    engine: str  # which engine, and how

    @property
    def first_uplift(self) -> float:
        """When the body was first lifted from rest; NaN if never [s]."""
        return next((event.time for event in self.events if event.kind is EventKind.UPLIFT), math.nan)

    @property
    def still_rocking(self) -> bool:
        """Whether the body stands, but does not yet rest at the last sample."""
        return self.outcome is Outcome.ROCKED and bool(self.rotation[-1] != 0.0 or self.angular_velocity[-1] != 0.0)
