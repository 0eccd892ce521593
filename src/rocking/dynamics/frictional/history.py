"""Time history of a body that touches the ground at the vertices of its hull."""

import math
from dataclasses import dataclass, field
from enum import Enum
from typing import NamedTuple

from rocking.dynamics.frictional.contact_problem import HullContact
from rocking.dynamics.frictional.motion import State
from rocking.outcome import Outcome, Status


class HullEventKind(Enum):
    """Kind of an event of a body on its hull."""

    IMPACT = "impact of vertices"
    CHANGE = "vertices leave, stick or start to slide"
    REST = "came to rest"
    UPLIFT = "uplift from rest"


class HullEvent(NamedTuple):
    """An impact, a change of contact, a start or an end of rest."""

    time: float
    kind: HullEventKind
    contact: HullContact  # contact after the event
    before: float  # kinetic energy before [J]
    after: float  # kinetic energy after [J]


@dataclass
class HullHistory:
    """A history at the ends of its steps."""

    time: list[float] = field(default_factory=list)
    states: list[State] = field(default_factory=list)
    contacts: list[HullContact] = field(default_factory=list)
    events: list[HullEvent] = field(default_factory=list)
    status: Status = Status.GOOD
    outcome: Outcome = Outcome.NO_UPLIFT
    still_rocking: bool = False
    lost: float = 0.0  # energy lost in impacts and at the start of rest, without the work of friction [J]
    replaced: int = 0  # number of impacts with the impulse at the landing vertices instead of the position of the law
    held: int = 0  # number of impacts and changes of contact without a solution; the largest face then sticks
    flew: bool = False
    slid: bool = False
    rocked: bool = False
    fell_off: bool = False  # True after a fall from the shelf
    initial_facet: int = 0  # facet on which the body stood before the tilt
    pose: int = -1  # stable pose at the end, or to which the body moves
    overturning_time: float = math.nan  # last time at which the centre of mass left the initial pose [s]
    direction: float = math.nan  # direction of tilt at that time, from x towards y [rad]
    min_cosine: float = 1.0  # smallest cosine of the angle from the initial pose [-]
    peak_time: float = 0.0  # time of the smallest cosine [s]
    peak_spin: float = 0.0  # largest angular velocity [rad/s]
    sliding_distance: float = 0.0  # path of the vertex with the largest slip [m]
    first_uplift: float = math.nan  # time of the first uplift [s]
    uplifts: int = 0
    steps: int = 0

    @property
    def peak_tilt(self) -> float:
        """Largest angle from the initial pose [rad]."""
        cosine = self.min_cosine
        return math.atan2(math.sqrt(max((1.0 - cosine) * (1.0 + cosine), 0.0)), cosine)
