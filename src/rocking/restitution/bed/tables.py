"""Impacts as both engines take them: rows of numbers, and rows of results."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.restitution.bed.law import LawNumbers
from rocking.restitution.bed.rigid import RigidRocking
from rocking.restitution.bed.start import ImpactStart

END_AT_PEAK, END_AT_PARTING = 0, 1

RESULTS: Final = (
    "y", "rotation", "u", "w", "angular_velocity", "time", "travel", "bed_loss", "friction_loss", "energy_start",
    "energy_end", "stored", "residual", "peak_force", "deepest", "touch", "parting", "impulse", "impulse_moment",
    "shear_impulse", "slid",
)  # fmt: skip
"""Columns of the results of an impact."""

COUNTS: Final = ("status", "steps", "rejected", "switches", "contacts", "forced")
"""Columns of its whole numbers."""

SAMPLES: Final = (
    "time", "travel", "normal", "shear", "moment", "bed_loss", "friction_loss", "y", "rotation", "u", "w",
    "angular_velocity",
)  # fmt: skip
"""Columns of its history."""


@dataclass(frozen=True)
class Setup:
    """One impact, ready to be computed."""

    rigid: RigidRocking  # body and bed
    law: LawNumbers  # contact law under this body
    start: ImpactStart  # initial state and scales
    push: float  # horizontal ground acceleration [m/s2]
    tolerance: float  # relative error of a step [-]
    longest: float  # time after which the computation ends [s]

    @property
    def gravity(self) -> float:
        """Vertical acceleration that acts during the impact [m/s2]."""
        return 0.0 if self.start.impulsive else self.rigid.gravity

    @property
    def end(self) -> int:
        """Where the impact ends."""
        return END_AT_PARTING if self.start.impulsive else END_AT_PEAK

    @property
    def farthest(self) -> float:
        """Rotation that ends the computation: the body topples [rad]."""
        return max(self.rigid.furthest(1.0), self.rigid.furthest(-1.0)) * (1.0 + 1e-9)


def numbers_of(setup: Setup) -> FloatArray:
    """Return the row of numbers of an impact."""
    r, law, start = setup.rigid, setup.law, setup.start
    _, coefficient, creep = r.bed.friction.numbers
    return np.array([
        r.mass, r.inertia, r.height, setup.gravity, setup.push,
        law.stiffness, law.damping, law.exponent, law.viscosity, law.rebound, coefficient, creep,
        *start.state, setup.tolerance, start.depth, start.speed, start.half_base, setup.longest, setup.farthest,
    ])  # fmt: skip


def choices_of(setup: Setup, first: int, most_steps: int) -> IntArray:
    """Return the row of whole numbers of an impact."""
    bed, start = setup.rigid.bed, setup.start
    kind = int(bed.friction.numbers[0])
    exact = int(bed.kinematics == "exact")
    return np.array(
        [
            int(setup.law.kind),
            kind,
            exact,
            setup.end,
            start.new_foot,
            start.old_foot,
            first,
            len(bed.positions),
            most_steps,
        ],
        dtype=np.int64,
    )
