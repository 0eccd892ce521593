"""What a history of a body on its hull keeps, and how it is integrated."""

import math
from dataclasses import dataclass, field
from enum import Enum
from typing import NamedTuple

from rocking.dynamics.hull.contact_problem import HullContact
from rocking.dynamics.hull.motion import State
from rocking.outcome import Outcome, Status


class HullEventKind(Enum):
    """What happens at an event."""

    IMPACT = "vertices strike the ground"
    CHANGE = "vertices leave, stick or start to slide"
    REST = "comes to rest"
    UPLIFT = "leaves its rest"


class HullEvent(NamedTuple):
    """Something that happened."""

    time: float
    kind: HullEventKind
    contact: HullContact  # after it
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
    lost: float = 0.0  # energy lost in impacts and by coming to rest; friction's work is not in it [J]
    replaced: int = 0  # impacts whose impulse had to act at the vertices that land
    held: int = 0  # impacts and changes without a solution, where the largest face was made to stick
    flew: bool = False
    slid: bool = False
    rocked: bool = False
    fell: bool = False  # off the shelf
    stood: int = 0  # facet on which the body stood before it was tilted
    pose: int = -1  # the stable pose in which it ends, or to which it is on its way
    overturning_time: float = math.nan  # when its centre left the first pose for the last time [s]
    direction: float = math.nan  # in which it leant then, from x towards y [rad]
    least_cosine: float = 1.0  # of the angle from the pose at the beginning
    peak_time: float = 0.0  # of that [s]
    peak_spin: float = 0.0  # largest angular velocity [rad/s]
    sliding_distance: float = 0.0  # path of the vertex that slides most [m]
    first_uplift: float = math.nan  # [s]
    uplifts: int = 0
    steps: int = 0

    @property
    def peak_tilt(self) -> float:
        """Largest angle from the pose at the beginning [rad]."""
        least = self.least_cosine
        return math.atan2(math.sqrt(max((1.0 - least) * (1.0 + least), 0.0)), least)
