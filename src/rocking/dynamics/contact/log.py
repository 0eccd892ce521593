"""What is written down while a history runs: samples, pieces, events, and the books of energy."""

import math
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.contact.base import LEFT, RIGHT
from rocking.dynamics.contact.ground import GroundSeries
from rocking.dynamics.contact.impact_resolution import Struck
from rocking.dynamics.contact.mode import Mode
from rocking.dynamics.contact.mode_series import ModeSeries
from rocking.dynamics.contact.power_series import derivative, integral, value
from rocking.dynamics.contact.state import ContactState
from rocking.dynamics.taylor import turning_points

SAMPLED = (
    "x", "rise", "rotation", "u", "w", "spin", "tangential", "normal_left", "normal_right", "work", "friction_loss",
    "impact_loss", "slid", "regime",
)  # fmt: skip


class SmoothPiece(NamedTuple):
    """A smooth piece of the history."""

    start: float  # start, duration: when it starts and how long it lasts [s]
    duration: float
    course: ModeSeries  # its series
    at: float  # where it ends within the series, in (0, 1]


class Blow(NamedTuple):
    """An impact."""

    time: float  # when [s]
    before: ContactState  # the state before it
    struck: Struck  # impulses and state after it
    after: ContactState  # the state from which the history goes on
    loss: float  # energy lost, per unit of mass [J/kg]


@dataclass
class Log:
    """The record of a history, per unit of mass."""

    count: int  # number of stretches of the motion; there is one sample more
    gravity: float  # acceleration of gravity [m/s2]
    work: float = 0.0
    friction_loss: float = 0.0
    impact_loss: float = 0.0
    slid: float = 0.0
    usage: float = 0.0
    peak: float = 0.0
    pieces: list[SmoothPiece] = field(default_factory=list)
    blows: list[Blow] = field(default_factory=list)
    changes: list[tuple[float, Mode]] = field(default_factory=list)
    samples: FloatArray = field(init=False)

    def __post_init__(self) -> None:
        """Make room for the samples."""
        self.samples = np.full((self.count + 1, len(SAMPLED)), math.nan)

    def pass_through(self, start: float, course: ModeSeries, ground: GroundSeries, at: float, friction: float) -> None:
        """Add a piece to the books.

        start: when it starts [s]; friction: Coulomb's coefficient [-].
        """
        self.pieces.append(SmoothPiece(start, at * course.unit, course, at))
        lift = np.array(ground.lift)
        lift[0] -= self.gravity
        along = integral(np.array(ground.push), derivative(course.x), at)
        up = integral(lift, derivative(course.rise), at)
        self.work -= along + up  # Eq. 46
        if course.sliding is not None and course.sliding.any():
            self.friction_loss -= course.unit * integral(course.tangential, course.sliding, at)
            self.slid += abs(course.unit * integral(np.ones(1), course.sliding, at))
        self._raise_peak(course.rotation, at)
        self._use(course, at, friction)

    def _raise_peak(self, rotation: FloatArray, at: float) -> None:
        turns = derivative(rotation)
        inside = turning_points(rotation.tolist(), at) if value(turns, 0.0) * value(turns, at) < 0.0 else []
        self.peak = max(self.peak, *(abs(value(rotation, instant)) for instant in (0.0, at, *inside)))

    def _use(self, course: ModeSeries, at: float, friction: float) -> None:
        for instant in (0.0, at):
            normal = sum(value(c, instant) for c in course.normals.values())
            tangential = abs(value(course.tangential, instant))
            if tangential > 0.0 and normal > 0.0:
                self.usage = max(self.usage, tangential / normal / friction if friction else 1.0)  # Eq. 78

    def sample(self, row: int, state: ContactState, mode: Mode, course: ModeSeries | None, at: float) -> None:
        """Write a sample."""
        if row > self.count:
            return
        forces = [0.0, 0.0, 0.0]
        if course is not None:
            normals = [value(course.normals[f], at) if f in course.normals else 0.0 for f in (LEFT, RIGHT)]
            forces = [value(course.tangential, at), *normals]
        books = (self.work, self.friction_loss, self.impact_loss, self.slid)
        self.samples[row] = (*state[:6], *forces, *books, mode.regime.code)

    def strike(self, blow: Blow) -> None:
        """Add an impact to the books."""
        self.blows.append(blow)
        self.impact_loss += blow.loss

    def change(self, time: float, mode: Mode) -> None:
        """Note that another mode starts.

        time: when [s].
        """
        if self.changes and self.changes[-1][0] == time:
            self.changes.pop()
        if not self.changes or self.changes[-1][1] != mode:
            self.changes.append((time, mode))
