"""What an engine hands back for one history, whichever engine it was."""

from dataclasses import dataclass, field
from enum import IntEnum

from rocking.conventions import FloatArray
from rocking.dynamics.outcome import Outcome, Status


class EventKind(IntEnum):
    """What happened."""

    UPLIFT = 0
    IMPACT = 1
    REST = 2


@dataclass(frozen=True, slots=True)
class Event:
    """An uplift, an impact or a coming to rest.

    Parameters
    ----------
    time : float
        When [s].
    kind : EventKind
        What.
    side : int
        +1 or -1: the side on which the body stands from then on.
    before, after : float
        Angular velocities, of an impact [rad/s].
    coefficient : float
        Coefficient of restitution, of an impact [-].
    """

    time: float
    kind: EventKind
    side: int
    before: float = 0.0
    after: float = 0.0
    coefficient: float = 0.0


@dataclass(frozen=True)
class Trajectory:
    """A history at the ends of all stretches of the motion, with its events.

    Parameters
    ----------
    rotation, angular_velocity : ndarray, shape (stretches + 1,)
        theta [rad] and theta' [rad/s]; after overturning NaN.
    events : list of Event
        In order of time.
    outcome : Outcome
        How it ended.
    status : Status
        Whether it could be computed.
    side : int
        +1 or -1 to which it overturned, else 0.
    peak_rotation : float
        theta of largest size; a quarter turn if it overturned [rad].
    peak_time : float
        When [s].
    peak_angular_velocity : float
        Largest |theta'| [rad/s].
    overturning_time : float
        When the centre of mass passed over the foot for the last time, or the end of the motion if it does so
        later; NaN if it did not overturn [s].
    impacts, uplifts : int
        How many.
    truncation : float
        Sum of what the series of the steps leave out: no measure of accuracy, which takes a twin [rad].
    least_force : float
        Smallest normal force of the ground while rocking over the weight m g, up to where a body that overturns passes
        over its foot for good; at samples, uplifts and impacts; below zero the ground would have to pull; NaN if it
        never rocked [-].
    friction_demand : float
        Largest ratio of horizontal to normal force at the same instants; infinite where contact is lost [-].
    engine : str
        Which engine, and how.
    """

    rotation: FloatArray
    angular_velocity: FloatArray
    events: list[Event] = field(repr=False)
    outcome: Outcome
    status: Status
    side: int
    peak_rotation: float
    peak_time: float
    peak_angular_velocity: float
    overturning_time: float
    impacts: int
    uplifts: int
    truncation: float
    least_force: float
    friction_demand: float
    engine: str

    @property
    def still_rocking(self) -> bool:
        """Whether the body stands, but does not yet rest at the last sample."""
        return self.outcome is Outcome.ROCKED and bool(self.rotation[-1] != 0.0 or self.angular_velocity[-1] != 0.0)
