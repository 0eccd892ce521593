"""The bed: contact points of the base, laws of the contact points, and friction along the base line."""

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
    """Branches of the fast engine."""

    STICKING = 0
    COULOMB = 1
    REGULARISED = 2


class BaseFriction(ABC):
    """Friction between base and bed.

    All points of a flat base have the same velocity u along the base line, so that all points stick or all points
    slide. The shear force is ``|T| <= mu N``, where N is the sum of all normal forces. The distribution of a sticking
    force over the points is not determined. Results divide it in proportion to the normal forces.
    """

    @property
    @abstractmethod
    def numbers(self) -> tuple[FrictionKind, float, float]:
        """Kind of friction, coefficient of friction [-] and creep speed [m/s]."""


@dataclass(frozen=True)
class Sticking(BaseFriction):
    """The base cannot slide (u = 0 at all times), as in docs/theory/restitution.md and docs/theory/contact_bed.md."""

    @property
    def numbers(self) -> tuple[FrictionKind, float, float]:
        return FrictionKind.STICKING, 0.0, 0.0


@dataclass(frozen=True)
class SlidingFriction(BaseFriction):
    """Base class of friction laws with sliding."""

    coefficient: float  # mu [-]

    def __post_init__(self) -> None:
        checks.within("coefficient of friction", self.coefficient, 0.0, 100.0)


@dataclass(frozen=True)
class Coulomb(SlidingFriction):
    """Set-valued friction: ``u = 0`` and ``|T| <= mu N``, or ``T = -mu N sign(u)``. Switching times are located.

    Parameters
    ----------
    coefficient : float
        mu [-].

    Raises
    ------
    InvalidValueError
        If the coefficient is negative.
    """

    @property
    def numbers(self) -> tuple[FrictionKind, float, float]:
        return FrictionKind.COULOMB, float(self.coefficient), 0.0


@dataclass(frozen=True)
class RegularisedCoulomb(SlidingFriction):
    """Smooth friction: T = -mu N u / sqrt(u^2 + v^2).

    Instead of sticking, the base creeps at u = v / sqrt((mu N / T)^2 - 1). This creep is the error of the law. It is
    below v for T < 0.7 mu N.

    Parameters
    ----------
    coefficient : float
        mu [-].
    creep : float
        Creep speed v [m/s], small compared with the landing speed.

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
    """Contact points of a base, relative to the plumb line of the centre of mass, positive towards the new foot.

    Parameters
    ----------
    positions : array_like
        Positions of the points, increasing [m].
    law : ContactLaw
        One copy of the contact law.
    shares : array_like, optional
        Number of copies of the law under every point [-]. By default, equal fractions with sum 1.
    heights : array_like, optional
        Profile of the base: heights of the points above the base line [m].
    friction : BaseFriction, optional
        By default the base cannot slide.
    kinematics : {"exact", "small"}
        Exact rotation of a rigid body; or, for a base that sticks, the small-base kinematics of Psycharis and Jennings
        (1983) without sideways displacement.

    Raises
    ------
    InvalidValueError
        If positions do not increase, or if an array has another length or contains values that are not finite.

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
            raise InvalidValueError("positions of contact points must increase; remove repeated points")
        shares = np.full(count, 1.0 / count) if self.shares is None else self.shares
        heights = np.zeros(count) if self.heights is None else self.heights
        values: dict[str, Any] = {
            "positions": positions,
            "shares": checks.finite("shares", shares, shape=(count,)),
            "heights": checks.finite("heights", heights, "m", (count,)),
            "kinematics": checks.one_of("kinematics", self.kinematics, get_args(Kinematics)),
        }
        checks.all_positive("shares", values["shares"])
        checks.of_kind("law", self.law, ContactLaw, "a contact law")
        checks.of_kind("friction", self.friction, BaseFriction, "a friction of the base")
        for name, value in values.items():
            object.__setattr__(self, name, value)

    @classmethod
    def uniform(
        cls,
        body: Body,
        count: int,
        law: ContactLaw,
        *,
        foot: Foot = "right",
        rule: Rule = "trapezoid",
        friction: BaseFriction | None = None,
        kinematics: Kinematics = "exact",
    ) -> Self:
        """Return a bed with equal points along the base of a body, including its feet.

        The law is that of the entire bed.

        Parameters
        ----------
        body : Body
            The body. There are no points between separate contact segments of its base.
        count : int
            Number of points, two or more. A body with point contacts has only its two feet.
        law : ContactLaw
            The law of the bed.
        foot : {"left", "right"}
            The new foot.
        rule : {"trapezoid", "ends"}
            Trapezoidal rule with half weights at the ends of a segment, or equal weights for all points. With
            decreasing spacing, the trapezoidal rule converges quadratically to the continuous bed, and equal weights
            converge linearly.
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
        is_equal = checks.one_of("rule", rule, get_args(Rule)) == "ends"
        positions, lengths = _along(contact_of(body, foot), body, count, foot)
        shares = np.ones(len(positions)) if is_equal else lengths
        return cls(positions, law, shares / shares.sum(), friction=friction or Sticking(), kinematics=kinematics)

    def with_profile(self, heights: Any) -> Self:
        """Return the bed under a base that is not flat.

        Parameters
        ----------
        heights : array_like
            Heights of the points above the base line [m]; negative for a bulge.

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


def _along(patches: FloatArray, body: Body, count: int, foot: Foot) -> tuple[FloatArray, FloatArray]:
    """Return points [m], and the lengths of the base that belong to the points [m]."""
    left, right = body.local_feet[0] - body.local_moments.x, body.local_feet[1] - body.local_moments.x
    ends = (left, right) if foot == "right" else (-right, -left)
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
