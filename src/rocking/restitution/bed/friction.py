"""Friction along the base line."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from enum import IntEnum

from rocking import checks


class FrictionKind(IntEnum):
    """The branches of the fast engine."""

    STICKING = 0
    COULOMB = 1
    REGULARISED = 2


class BaseFriction(ABC):
    """Friction between base and bed.

    All points of a flat base move along the base line at one speed u, so that the bed sticks or slides as a whole:
    the shear force is |T| <= mu N with N the sum of all normal forces. Which point takes which part of a sticking
    force is not determined; results show it in proportion to the normal forces.
    """

    @property
    @abstractmethod
    def numbers(self) -> tuple[FrictionKind, float, float]:
        """Kind, coefficient of friction [-] and creep speed [m/s]."""


@dataclass(frozen=True)
class Sticking(BaseFriction):
    """The base cannot slide (u = 0 always): the setting of docs/theory.md, Sections 5, 6 and 13."""

    @property
    def numbers(self) -> tuple[FrictionKind, float, float]:
        return FrictionKind.STICKING, 0.0, 0.0


@dataclass(frozen=True)
class Coulomb(BaseFriction):
    """Set-valued friction: u = 0 and |T| <= mu N, or T = -mu N sign(u); the switches are located.

    Parameters
    ----------
    coefficient : float
        mu [-].

    Raises
    ------
    InvalidValueError
        If it is negative.
    """

    coefficient: float

    def __post_init__(self) -> None:
        checks.within("coefficient of friction", self.coefficient, 0.0, 100.0)

    @property
    def numbers(self) -> tuple[FrictionKind, float, float]:
        return FrictionKind.COULOMB, float(self.coefficient), 0.0


@dataclass(frozen=True)
class RegularisedCoulomb(BaseFriction):
    """Smooth friction: T = -mu N u / sqrt(u^2 + v^2).

    Where Coulomb's law sticks, this one creeps at u = v / sqrt((mu N / T)^2 - 1), less than v while T is below
    0.7 mu N: that is its error.

    Parameters
    ----------
    coefficient : float
        mu [-].
    creep : float
        v, small against the landing speed [m/s].

    Raises
    ------
    InvalidValueError
        If a value is outside its range.
    """

    coefficient: float
    creep: float = 1e-4

    def __post_init__(self) -> None:
        checks.within("coefficient of friction", self.coefficient, 0.0, 100.0)
        checks.positive("creep", self.creep, "m/s")

    @property
    def numbers(self) -> tuple[FrictionKind, float, float]:
        return FrictionKind.REGULARISED, float(self.coefficient), float(self.creep)
