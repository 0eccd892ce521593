"""Dimensionless impacts on a Kelvin-Voigt bed, in the form of the table of the contact bed."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from rocking import checks, conventions
from rocking.bodies import MassPoints
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.restitution.bed.contact_bed import BaseFriction, ContactBed, Coulomb, Sticking
from rocking.restitution.bed.impact import BedStatus, bed_impacts
from rocking.restitution.bed.laws import KelvinVoigt
from rocking.restitution.bed.setup import Setup, setup_of

RELEASE = 0.05  # initial rotation / smallest slenderness angle [-], for rocking of small amplitude
_TOLERANCES = (1e-8, 3e-8, 1e-7, 1e-6)


@dataclass(frozen=True, slots=True)
class ScaledImpact:
    """A body on a Kelvin-Voigt bed, in dimensionless numbers.

    >>> impact = ScaledImpact(flatness=0.15, offset=0.0, points=2, damping=1.0, hardness=300.0)
    >>> round(float(resolved_coefficients([impact])[0]), 2)
    0.7
    """

    flatness: float  # 1 / (1 + rho) [-], with rho = (I_C + m h^2) / (m w^2), w: half of the distance between the feet
    offset: float  # distance from the plumb line back to the middle of the base, over w [-]
    points: int  # number of contact points from foot to foot
    damping: float  # damping ratio of the whole bed [-]
    hardness: float  # landing speed of the new foot times sqrt(k / m) / gravity [-]
    friction: float = math.inf  # coefficient of friction [-]; infinite for a base that cannot slide
    # m h^2 / (I_C + m h^2) [-], which gives the height of the centre for a base that slides
    height_share: float = 0.7

    def __post_init__(self) -> None:
        checks.within("flatness", self.flatness, 1e-6, 1.0, open_high=True)
        checks.within("offset", self.offset, -1.0, 1.0, open_low=True, open_high=True)
        checks.within("height share", self.height_share, 0.0, 1.0, open_low=True)

    @property
    def setup(self) -> Setup:
        """Setup of the impact for the engines."""
        body, feet, release, speed = _body(self.flatness, self.offset, self.height_share)
        stiffness = (self.hardness * conventions.g / speed) ** 2
        friction = Sticking() if math.isinf(self.friction) else Coulomb(self.friction)
        bed = _bed(feet, self.points, stiffness, self.damping, friction)
        return setup_of(body, bed, rotation=release, tolerance=_TOLERANCES[0])


def resolved_coefficients(impacts: Sequence[ScaledImpact], *, threads: int = 1) -> FloatArray:
    """Return coefficients of restitution resolved in time [-]."""
    setups = [impact.setup for impact in impacts]
    r = np.full(len(setups), np.nan)
    # chattering points can exceed the allowed number of steps; retry with another tolerance
    for tolerance in _TOLERANCES:
        failed = np.flatnonzero(np.isnan(r))
        if failed.size == 0:
            return r
        batch = bed_impacts([replace(setups[i], tolerance=tolerance) for i in failed.tolist()], threads=threads)
        ended = [status in {BedStatus.PEAK, BedStatus.TOPPLED} for status in batch.status]
        r[failed] = np.where(ended, batch.coefficient, np.nan)
    if np.isnan(r).any():
        raise InvalidValueError(
            "{count} impacts did not end, the first is {impact}", count=int(np.isnan(r).sum()),
            impact=str(impacts[int(np.argmax(np.isnan(r)))]),
        )  # fmt: skip
    return r


@lru_cache(maxsize=256)
def _body(flatness: float, offset: float, share: float) -> tuple[MassPoints, tuple[float, float], float, float]:
    """Return body, feet [m], initial rotation [rad] and landing speed of the new foot [m/s]."""
    gyration = 1.0 / flatness - 1.0
    height, arm = math.sqrt(share * gyration), math.sqrt((1.0 - share) * gyration)
    feet = (-1.0 - offset, 1.0 - offset)
    masses = ([(-arm, height), (arm, height)], [0.5, 0.5]) if arm > 0.0 else ([(0.0, height)], [1.0])
    body = MassPoints(*masses, feet=feet)
    release = RELEASE * math.atan(min(-feet[0], feet[1]) / height)
    speed = 2.0 * setup_of(body, _bed(feet, 2, 1.0, 1.0, Sticking()), rotation=release).landing_velocity
    return body, feet, release, speed


def _bed(
    feet: tuple[float, float], points: int, stiffness: float, damping: float, friction: BaseFriction
) -> ContactBed:
    shares = np.ones(points)
    shares[[0, -1]] = 0.5
    law = KelvinVoigt(stiffness, damping_ratio=damping)
    # sliding needs the exact kinematics; for sticking, the table uses small rotations
    slides = not isinstance(friction, Sticking)
    return ContactBed(
        np.linspace(*feet, points), law, shares / shares.sum(), friction=friction,
        kinematics="exact" if slides else "small",
    )  # fmt: skip
