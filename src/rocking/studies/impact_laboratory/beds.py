"""The bed that a study varies, and the coefficients that emerge from it."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies import Block
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.restitution.bed import BaseFriction, BedImpacts, ContactBed, KelvinVoigt, Sticking, bed_impacts, setup_of
from rocking.restitution.bed.tables import Setup


@dataclass(frozen=True)
class Laboratory:
    """A homogeneous block on a bed of Kelvin-Voigt points: the setting from which a study starts."""

    slenderness: float = 2.0  # h/b [-]
    width: float = 0.2  # width of the base [m]
    density: float = 2400.0  # density of the block [kg/m3]
    points: int = 41  # contact points
    # sqrt(k / m) / (2 pi) of the whole bed [Hz]; not used where `modulus_over_thickness` is given
    frequency: float = 400.0
    damping: float = 1.0  # damping ratio zeta of the whole bed [-]
    # elastic modulus of the layer over its thickness, per metre of depth of the block [Pa/m]
    modulus_over_thickness: float | None = None
    release: float = 0.5  # rotation from which the block falls, over its slenderness angle [-]
    friction: BaseFriction = field(default_factory=Sticking)  # by default the base cannot slide
    profile: tuple[float, ...] = ()  # heights of the points over the base line, none for a flat base [m]
    tolerance: float = 1e-9  # relative error of a step [-]

    def __post_init__(self) -> None:
        checks.within("release", self.release, 0.0, 1.0, open_low=True, open_high=True)
        checks.positive("frequency", self.frequency, "Hz")
        if self.modulus_over_thickness is not None:
            checks.positive("modulus over thickness", self.modulus_over_thickness, "Pa/m")
        if self.profile and len(self.profile) != self.points:
            raise InvalidValueError(f"profile must have {self.points} heights, one a point, got {len(self.profile)}")

    def but(self, **changes: Any) -> "Laboratory":
        """Return the same laboratory with something changed."""
        return replace(self, **changes)

    @property
    def block(self) -> Block:
        """The block."""
        return Block(width=self.width, height=self.slenderness * self.width, density=self.density)

    @property
    def stiffness(self) -> float:
        """Stiffness of the whole bed: E A / t where a layer is given, m (2 pi f)^2 otherwise [N/m]."""
        if self.modulus_over_thickness is not None:
            return self.modulus_over_thickness * self.width  # Eq. 115
        return self.block.mass * (2.0 * math.pi * self.frequency) ** 2

    @property
    def setup(self) -> Setup:
        """The impact, ready to be computed."""
        block = self.block
        law = KelvinVoigt(self.stiffness, damping_ratio=self.damping)
        bed = ContactBed.uniform(block, self.points, law, friction=self.friction)
        if self.profile:
            bed = bed.with_profile(np.array(self.profile))
        angle = self.release * math.atan(1.0 / self.slenderness)
        return setup_of(block, bed, rotation=angle, tolerance=self.tolerance)


def hardness_of(setup: Setup) -> float:
    """Return the dimensionless landing speed of the new foot, v sqrt(k / m) / g.

    Returns Hardness, as the model `contact-bed` takes it [-].
    """
    return setup.start.speed * math.sqrt(setup.law.stiffness / setup.rigid.mass) / setup.rigid.gravity  # Eq. 130


def measured(laboratories: Iterable[Laboratory], *, threads: int = 1) -> tuple[Sequence[Setup], BedImpacts]:
    """Resolve the impacts of laboratories."""
    setups = [each.setup for each in laboratories]
    return setups, bed_impacts(setups, threads=threads)


def coefficients(laboratories: Iterable[Laboratory], *, threads: int = 1) -> FloatArray:
    """Return the coefficients of restitution of laboratories.

    Returns theta_dot_after / theta_dot_before; NaN where an impact failed [-].
    """
    return measured(laboratories, threads=threads)[1].coefficient
