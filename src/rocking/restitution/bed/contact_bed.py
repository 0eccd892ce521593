"""The bed: where the base touches, what stands under each point, and friction along the base line."""

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any, Literal, Self, get_args

import numpy as np

from rocking import checks
from rocking.bodies import Body
from rocking.conventions import FloatArray, Foot
from rocking.errors import InvalidValueError
from rocking.restitution.bed.laws import ContactLaw
from rocking.restitution.impact import contact_of


class FrictionKind(IntEnum):
    """The branches of the fast engine."""

    STICKING = 0
    COULOMB = 1
    REGULARISED = 2


class BaseFriction(ABC):
    """Friction between base and bed.

    All points of a flat base move along the base line at one speed u, so that the bed sticks or slides as a whole:
    the shear force is ``|T| <= mu N`` with N the sum of all normal forces. Which point takes which part of a sticking
    force is not determined; results show it in proportion to the normal forces.
    """

    @property
    @abstractmethod
    def numbers(self) -> tuple[FrictionKind, float, float]:
        """Kind, coefficient of friction [-] and creep speed [m/s]."""


@dataclass(frozen=True)
class Sticking(BaseFriction):
    """The base cannot slide (u = 0 always), as in docs/theory/restitution.md and docs/theory/contact_bed.md."""

    @property
    def numbers(self) -> tuple[FrictionKind, float, float]:
        return FrictionKind.STICKING, 0.0, 0.0


@dataclass(frozen=True)
class SlidingFriction(BaseFriction):
    """What the laws share by which the base can slide."""

    coefficient: float  # mu [-]

    def __post_init__(self) -> None:
        checks.within("coefficient of friction", self.coefficient, 0.0, 100.0)


@dataclass(frozen=True)
class Coulomb(SlidingFriction):
    """Set-valued friction: ``u = 0`` and ``|T| <= mu N``, or ``T = -mu N sign(u)``; the switches are located.

    Parameters
    ----------
    coefficient : float
        mu [-].

    Raises
    ------
    InvalidValueError
        If it is negative.
    """

    @property
    def numbers(self) -> tuple[FrictionKind, float, float]:
        return FrictionKind.COULOMB, float(self.coefficient), 0.0


@dataclass(frozen=True)
class RegularisedCoulomb(SlidingFriction):
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

    creep: float = 1e-4

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.positive("creep", self.creep, "m/s")

    @property
    def numbers(self) -> tuple[FrictionKind, float, float]:
        return FrictionKind.REGULARISED, float(self.coefficient), float(self.creep)


Kinematics = Literal["exact", "small"]
Rule = Literal["ends", "trapezoid"]


@dataclass(frozen=True, eq=False)
class ContactBed:
    """Contact points of a base, seen from the plumb line of the centre of mass, towards the new foot.

    Parameters
    ----------
    positions : array_like
        Where the points are, in growing order [m].
    law : ContactLaw
        One copy of the contact law.
    shares : array_like, optional
        Copies of the law under each point; by default the law is the whole bed's, shared equally [-].
    heights : array_like, optional
        Profile of the base: heights of the points over the base line [m].
    friction : BaseFriction, optional
        By default the base cannot slide.
    kinematics : {"exact", "small"}
        Points of a rigid body at any rotation, or the small-base kinematics of Psycharis and Jennings (1983), which
        lets the base line tilt without moving sideways and is meant for a base that sticks.

    Raises
    ------
    InvalidValueError
        If positions do not grow, or an array has another length or holds what is not a number.

    Examples
    --------
    >>> from rocking import Block
    >>> from rocking.restitution.bed import KelvinVoigt
    >>> bed = ContactBed.uniform(Block(width=0.2, height=0.4), 5, KelvinVoigt(1e8, damping_ratio=0.3))
    >>> bed.positions.round(3).tolist()
    [-0.1, -0.05, 0.0, 0.05, 0.1]
    """

    positions: Any
    law: ContactLaw
    shares: Any = None
    heights: Any = None
    friction: BaseFriction = field(default_factory=Sticking)
    kinematics: Kinematics = "exact"

    def __post_init__(self) -> None:
        positions = checks.finite("positions", self.positions, "m")
        count = len(positions)
        if count > 1 and not bool((np.diff(positions) > 0.0).all()):
            raise InvalidValueError("positions of contact points must grow; two points on one place?")
        shares = np.full(count, 1.0 / count) if self.shares is None else self.shares
        heights = np.zeros(count) if self.heights is None else self.heights
        made: dict[str, Any] = {
            "positions": positions,
            "shares": checks.finite("shares", shares, shape=(count,)),
            "heights": checks.finite("heights", heights, "m", (count,)),
            "kinematics": checks.one_of("kinematics", self.kinematics, get_args(Kinematics)),
        }
        checks.all_positive("shares", made["shares"])
        checks.of_kind("law", self.law, ContactLaw, "a contact law")
        checks.of_kind("friction", self.friction, BaseFriction, "a friction of the base")
        for name, value in made.items():
            object.__setattr__(self, name, value)

    @classmethod
    def uniform(
        cls,
        body: Body,
        count: int,
        law: ContactLaw,
        *,
        onto: Foot = "right",
        rule: Rule = "trapezoid",
        friction: BaseFriction | None = None,
        kinematics: Kinematics = "exact",
    ) -> Self:
        """Return equal points along the base of a body, its feet included; the law is the whole bed's.

        Parameters
        ----------
        body : Body
            The body; where its base is hollow there are no points between the stretches.
        count : int
            Number of points, two or more; a body that stands on points has its two feet only.
        law : ContactLaw
            The law of the whole bed.
        onto : {"left", "right"}
            The new foot.
        rule : {"trapezoid", "ends"}
            Half a share for the ends of a stretch, as the trapezoidal rule gives, or equal shares for all points;
            the first converges with the square of the spacing to the continuous bed, the second linearly.
        friction : BaseFriction, optional
            By default the base cannot slide.
        kinematics : {"exact", "small"}
            See `ContactBed`.

        Returns
        -------
        ContactBed
            The bed.

        Raises
        ------
        InvalidValueError
            If there are fewer than two points or the rule is unknown.
        """
        count = checks.whole("count", count, 2, 100_000)
        alike = checks.one_of("rule", rule, get_args(Rule)) == "ends"
        positions, lengths = _along(contact_of(body, onto), body, count, onto)
        shares = np.ones(len(positions)) if alike else lengths
        return cls(positions, law, shares / shares.sum(), friction=friction or Sticking(), kinematics=kinematics)

    def with_profile(self, heights: Any) -> Self:
        """Return the same bed under a base that is not flat.

        Parameters
        ----------
        heights : array_like
            Heights of the points over the base line, below zero for a bulge [m].

        Returns
        -------
        ContactBed
            The bed.
        """
        return type(self)(self.positions, self.law, self.shares, heights, self.friction, self.kinematics)

    @property
    def ends(self) -> tuple[float, float]:
        """First and last point [m]."""
        return float(self.positions[0]), float(self.positions[-1])


def _along(patches: FloatArray, body: Body, count: int, onto: Foot) -> tuple[FloatArray, FloatArray]:
    """Points and the lengths of base they stand for."""
    left, right = body.local_feet[0] - body.local_moments.x, body.local_feet[1] - body.local_moments.x
    ends = (left, right) if onto == "right" else (-right, -left)
    if count == 2 or len(patches) == 0:
        return np.array(ends), np.ones(2)
    sizes = patches[:, 1] - patches[:, 0]
    counts = np.maximum(2, np.rint(count * sizes / sizes.sum())).astype(int)
    positions, lengths = [], []
    for (start, stop), number in zip(patches, counts.tolist(), strict=True):
        weights = np.full(number, (stop - start) / (number - 1))
        weights[[0, -1]] *= 0.5
        positions.append(np.linspace(start, stop, number))
        lengths.append(weights)
    return np.concatenate(positions), np.concatenate(lengths)
