"""Result of the engines of a stack."""

import math
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from rocking.conventions import FloatArray
from rocking.outcome import Outcome, Status

OPENS, IMPACT, CLOSES, PEAK = "opens", "impact", "closes", "peak"


class StackEvent(NamedTuple):
    """Event of a joint. Sides are 1 (right corner), -1 (left corner), 0 (closed)."""

    time: float  # [s]
    joint: int  # index, 0 for the ground
    kind: str
    sides_before: tuple[int, ...]
    sides_after: tuple[int, ...]
    rotation: tuple[float, ...]  # theta of every body [rad]
    before: tuple[float, ...]  # theta' of every body before the event [rad/s]
    after: tuple[float, ...]  # theta' of every body after the event [rad/s]


@dataclass(slots=True)
class StackTrajectory:
    """A history: states at samples, events, and extremes of the joints."""

    time: FloatArray  # [s]; shape (samples,)
    rotation: FloatArray  # theta of every body [rad]; shape (samples, bodies)
    angular_velocity: FloatArray  # theta' of every body [rad/s]; shape (samples, bodies)
    centre: FloatArray  # centres of mass [m]; shape (samples, bodies, 2)
    slip: FloatArray  # displacement of the upper body along every joint [m]; shape (samples, bodies)
    work: FloatArray  # work of the ground since the start [J]; shape (samples,)
    kinetic: FloatArray  # [J]; shape (samples,)
    potential: FloatArray  # above the initial position [J]; shape (samples,)
    lost: FloatArray  # energy lost in impacts and by friction since the start [J]; shape (samples,)
    peak_opening: FloatArray  # largest relative rotation of every joint [rad]; shape (bodies,)
    peak_slip: FloatArray  # largest displacement along every joint [m]; shape (bodies,)
    least_normal: FloatArray  # smallest normal force of every joint over the weight above [-]; shape (bodies,)
    largest_ratio: FloatArray  # largest |T| / N of every joint [-]; shape (bodies,)
    slip_time: FloatArray  # first time with a ratio above the friction, or with sliding [s], NaN without; (bodies,)
    events: list[StackEvent] = field(default_factory=list)
    outcome: Outcome = Outcome.NO_UPLIFT
    status: Status = Status.GOOD
    fallen: int = -1  # index of the joint whose bodies overturned, -1 without overturning
    overturning_time: float = math.nan  # [s]
    still_rocking: bool = False
    slid_off: bool = field(init=False)  # True if the fallen bodies left the face below by sliding
    largest_gap: FloatArray = field(init=False)  # largest distance of the faces [m]; (bodies,)
    flight_time: FloatArray = field(init=False)  # first time without contact [s], NaN; (bodies,)
    assumes_sticking: bool = True  # True if the engine has no sliding
    engine: str = "reference (Dormand-Prince, order 8)"

    unsolved_steps: int = 0  # steps whose complementarity conditions exceed the tolerance
    interpenetration: float = 0.0  # largest, over the semi-diagonal of the smallest body [-]
    energy_created: float = 0.0  # sum of positive works of contact impulses [J]

    def __post_init__(self) -> None:
        self.largest_gap, self.flight_time = np.zeros(self.peak_slip.size), np.full(self.peak_slip.size, np.nan)
        self.slid_off = self.fallen >= 0 and float(np.max(np.abs(self.rotation[-1]))) < 0.49 * math.pi

    def take_fall(self, longer: "StackTrajectory") -> None:
        """Take over the overturning of a longer history. Samples, events and extremes stay those of this history."""
        if longer.outcome is Outcome.OVERTURNED:
            for name in ("outcome", "fallen", "overturning_time", "slid_off", "still_rocking"):
                setattr(self, name, getattr(longer, name))

    @property
    def impacts(self) -> int:
        """Number of impacts."""
        return sum(event.kind == IMPACT for event in self.events)

    @property
    def opening(self) -> FloatArray:
        """Relative rotation of every joint [rad]; shape (samples, bodies)."""
        return np.diff(self.rotation, axis=1, prepend=0.0)
