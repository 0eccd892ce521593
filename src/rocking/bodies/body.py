"""What every rocking body answers, whatever it is made of."""

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Self

from rocking import checks, conventions, plausibility
from rocking.answers import Answer
from rocking.bodies._known import Known
from rocking.bodies.moments import PlaneMoments
from rocking.conventions import FEET, Assumed, FloatArray, Foot
from rocking.errors import AsymmetricBodyError, GeometryError, InvalidValueError
from rocking.messages import Amount, Message


@dataclass(frozen=True, slots=True)
class Side:
    """A body seen from one of its feet.

    Parameters
    ----------
    foot : {"left", "right"}
        The foot it turns about.
    half_width : float
        Horizontal distance b from the foot to the centre of mass [m].
    centre_height : float
        Height h of the centre of mass above the ground [m].
    mass : float
        Mass m [kg].
    moment_of_inertia : float
        Polar moment I_O about the foot [kg m2].
    gravity : float
        Acceleration of gravity [m/s2].

    Examples
    --------
    >>> from rocking import Block
    >>> round(Block(width=1.0, height=4.0).side("left").slenderness_ratio, 12)
    4.0
    """

    foot: Foot
    half_width: float
    centre_height: float
    mass: float
    moment_of_inertia: float
    gravity: float = conventions.g

    @property
    def slenderness_ratio(self) -> float:
        """Slenderness h/b [-]."""
        return self.centre_height / self.half_width

    @property
    def slenderness_angle(self) -> float:
        """Angle alpha = atan(b/h) between the vertical and the line from foot to centre [rad]."""
        return math.atan2(self.half_width, self.centre_height)

    @property
    def semi_diagonal(self) -> float:
        """Distance R from the foot to the centre of mass [m]."""
        return math.hypot(self.half_width, self.centre_height)

    @property
    def frequency_parameter(self) -> float:
        """Frequency parameter p = sqrt(m g R / I_O) [rad/s]."""
        return math.sqrt(self.mass * self.gravity * self.semi_diagonal / self.moment_of_inertia)  # Eq. 26

    @property
    def uplift_acceleration(self) -> float:
        """Horizontal ground acceleration g b/h that starts rocking about this foot [m/s2]."""
        return self.gravity * self.half_width / self.centre_height


Interval = tuple[float, float]

DEFAULT_DENSITY = Assumed(2400.0)  # plain concrete [kg/m3]; no coefficient of a homogeneous body depends on it

GROUND_TOLERANCE = 1e-9
"""Vertices this close to the ground, and feet this close to the base, relative to the body's size, are on it."""

# Feet closer to the plumb line of the centre than this, relative to their distance, are no support.
_SUPPORT_TOLERANCE = 1e-12


class Body(ABC):
    """A rigid body of plane shape standing on two feet.

    A subclass fixes the mass distribution in a local frame whose origin lies on the ground, near the body
    (`origin_x`, `ground`), so that nothing is lost far from the user's origin.
    """

    @property
    def origin_x(self) -> float:
        """Horizontal position of the local frame in the user's coordinates: zero, if they are the same [m]."""
        return 0.0

    @property
    def ground(self) -> float:
        """Height of the ground in the user's coordinates: zero, if nothing else is said [m]."""
        return 0.0

    @property
    @abstractmethod
    def local_feet(self) -> Interval:
        """Positions of the left and right foot in the local frame [m]."""

    @property
    @abstractmethod
    def local_moments(self) -> PlaneMoments:
        """Mass, centre and central second moments in the local frame."""

    @property
    @abstractmethod
    def local_contact(self) -> tuple[Interval, ...]:
        """Stretches of the ground that the base touches between the feet, left to right, local frame [m]."""

    @property
    @abstractmethod
    def local_box(self) -> tuple[float, float, float, float]:
        """Bounding box (x_min, y_min, x_max, y_max) in the local frame [m]."""

    @abstractmethod
    def mirrored(self) -> Self:
        """Return the body seen in a vertical mirror: left and right change places."""

    @abstractmethod
    def scaled(self, *, size: float = 1.0, density: float = 1.0) -> Self:
        """Return the body with all lengths times `size` and all densities times `density`.

        Parameters
        ----------
        size : float
            Factor on all lengths, depth included [-].
        density : float
            Factor on all densities [-].
        """

    @abstractmethod
    def with_feet(self, left: float, right: float) -> "Body":
        """Return the same body standing on other feet.

        Parameters
        ----------
        left, right : float
            New positions of the feet in the user's coordinates [m].
        """

    @property
    def mass(self) -> float:
        """Mass m [kg]."""
        return self.local_moments.mass

    @property
    def centre(self) -> tuple[float, float]:
        """Centre of mass (x, y) in the user's coordinates [m]."""
        moments = self.local_moments
        return self.origin_x + moments.x, self.ground + moments.y

    @property
    def feet(self) -> Interval:
        """Positions of the left and right foot in the user's coordinates [m]."""
        left, right = self.local_feet
        return self.origin_x + left, self.origin_x + right

    @property
    def moment_of_inertia(self) -> float:
        """Polar moment I_C about the centre of mass [kg m2]."""
        return self.local_moments.polar

    def side(self, foot: Foot, gravity: float = conventions.g) -> Side:
        """Return the body seen from one of its feet.

        Parameters
        ----------
        foot : {"left", "right"}
            The foot it turns about.
        gravity : float
            Acceleration of gravity [m/s2].

        Returns
        -------
        Side
            Slenderness, semi-diagonal, frequency parameter and uplift acceleration about that foot.

        Raises
        ------
        InvalidValueError
            If the foot is neither, or gravity is not above zero.

        Examples
        --------
        >>> from rocking import Block
        >>> round(Block(width=1.0, height=4.0).side("right", gravity=9.81).frequency_parameter, 10)
        1.889156352
        """
        foot = checks.foot("foot", foot)
        moments, (left, right) = self.local_moments, self.local_feet
        half_width = moments.x - left if foot == "left" else right - moments.x
        inertia = moments.polar + moments.mass * (half_width**2 + moments.y**2)
        gravity = checks.positive("gravity", gravity, "m/s2")
        return Side(foot, half_width, moments.y, moments.mass, inertia, gravity)

    def density_at(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Return the density at points, zero outside the body: what fields and pictures sample.

        Of a body whose centre of mass or moment of inertia was given it is that of its outline all the same.

        Parameters
        ----------
        x, y : ndarray
            Points in the user's coordinates, of one shape [m].

        Returns
        -------
        ndarray
            Density [kg/m3].

        Raises
        ------
        InvalidValueError
            If this kind of body has no density field, as mass points.
        """
        raise InvalidValueError("a {type} body has no density field", type=type(self).__name__)

    @property
    def densities(self) -> tuple[float, ...]:
        """Densities of the parts; none of mass points [kg/m3]."""
        return ()

    @property
    def known(self) -> Known | None:
        """Centre of mass and moment of inertia that were given in place of those of the outline; None without them."""
        return None

    @property
    def assumed(self) -> tuple[str, ...]:
        """What nobody gave and was assumed, in words."""
        density = (Message("density {assumed}", {"assumed": each}) for each in assumed_density(self.densities))
        return (*density, *(() if self.known is None else self.known.assumed))

    @property
    def doubts(self) -> tuple[str, ...]:
        """What can be computed with but was hardly meant, in words."""
        (left, right), height = self.local_feet, self.local_moments.y
        return plausibility.of_body(height, 2.0 * height / (right - left), self.densities)

    def answer(self, gravity: float = conventions.g) -> Answer:
        """Return what is shown of the body.

        Parameters
        ----------
        gravity : float
            Acceleration of gravity [m/s2].

        Returns
        -------
        Answer
            Mass, centre, feet, moment of inertia, assumptions, doubts, and the geometry of each side.
        """
        names = (
            "slenderness_ratio", "slenderness_angle", "semi_diagonal", "frequency_parameter", "uplift_acceleration",
        )  # fmt: skip
        sides = {foot: self.side(foot, gravity) for foot in FEET}
        return Answer({
            "kind": type(self).__name__, "mass": self.mass, "centre": self.centre, "foot_positions": self.feet,
            "moment_of_inertia": self.moment_of_inertia, "gravity": gravity, "assumed": self.assumed,
            "warnings": self.doubts,
            "sides": {foot: {name: getattr(side, name) for name in names} for foot, side in sides.items()},
        })  # fmt: skip

    @property
    def is_symmetric(self) -> bool:
        """Whether both feet are equally far from the centre of mass (to 1e-12 of the base)."""
        left, right = self.local_feet
        return abs(self.local_moments.x - 0.5 * (left + right)) <= 1e-12 * (right - left)

    @property
    def slenderness_ratio(self) -> float:
        """Slenderness h/b [-] of a body with equal sides."""
        return self._either_side("slenderness_ratio").slenderness_ratio

    @property
    def slenderness_angle(self) -> float:
        """Slenderness angle alpha = atan(b/h) [rad] of a body with equal sides."""
        return self._either_side("slenderness_angle").slenderness_angle

    @property
    def semi_diagonal(self) -> float:
        """Distance R from a foot to the centre of mass [m] of a body with equal sides."""
        return self._either_side("semi_diagonal").semi_diagonal

    @property
    def frequency_parameter(self) -> float:
        """Frequency parameter p [rad/s] of a body with equal sides, at standard gravity."""
        return self._either_side("frequency_parameter").frequency_parameter

    @property
    def uplift_acceleration(self) -> float:
        """Ground acceleration at which rocking starts [m/s2] of a body with equal sides, at standard gravity."""
        return self._either_side("uplift_acceleration").uplift_acceleration

    def _either_side(self, name: str) -> Side:
        if not self.is_symmetric:
            raise AsymmetricBodyError(
                '{quantity} depends on the side of this body; ask body.side("left").{quantity} or "right"',
                quantity=name,
            )
        return self.side("right")

    def _check_support(self) -> None:
        moments, (left, right) = self.local_moments, self.local_feet
        if not (moments.mass > 0.0 and math.isfinite(moments.polar)):
            raise GeometryError("the body must have a finite mass > 0 kg, got {mass:g}", mass=moments.mass)
        slack = _SUPPORT_TOLERANCE * (right - left)
        if not left + slack < moments.x < right - slack:
            x = self.origin_x + moments.x
            a, b = self.feet
            raise GeometryError(
                "the centre of mass (x = {x}) must lie between the feet ({left} and {right})",
                parameter="centre", value=x, hint="a body like this falls over by itself",
                x=Amount(x, "m", ".6g"), left=Amount(a, "", ".6g"), right=Amount(b, "m", ".6g"),
            )  # fmt: skip
        plausibility.warn(self.doubts)


def feet_of(feet: Any) -> Interval:
    """Return two positions of feet [m] as numbers."""
    try:
        left, right = feet
    except (TypeError, ValueError) as error:
        raise GeometryError("feet must be a pair (x_left, x_right) in m") from error
    return checks.number("left foot", left, "m"), checks.number("right foot", right, "m")


def assumed_rows(body: Any) -> list[tuple[str, str]]:
    """Return what was assumed of a body, plane or in space, as label and text of lines of a table."""
    density = assumed_density(body.densities)
    return [*(("density", each) for each in density), *(("assumed", each) for each in body.assumed[len(density) :])]


_ASSUMED_DENSITY = {  # by whether all densities are assumed, and whether they are scaled
    (True, False): (
        "{density:g} kg/m3 assumed, that of plain concrete; mass and forces depend on it, rotations do not"
    ),
    (True, True): (
        "{density:g} kg/m3 assumed, that of plain concrete, scaled to {scaled:.6g}; mass and forces depend on "
        "it, rotations do not"
    ),
    (False, False): (
        "{density:g} kg/m3 assumed for {parts} of {total} parts, that of plain concrete; the centre of mass "
        "and rotations depend on it"
    ),
    (False, True): (
        "{density:g} kg/m3 assumed for {parts} of {total} parts, that of plain concrete, scaled to "
        "{scaled:.6g}; the centre of mass and rotations depend on it"
    ),
}


def assumed_density(densities: Sequence[float]) -> tuple[str, ...]:
    """Return what was assumed about densities."""
    assumed = [value for value in densities if isinstance(value, Assumed)]
    if not assumed:
        return ()
    facts = {"density": DEFAULT_DENSITY, "parts": len(assumed), "total": len(densities), "scaled": assumed[0]}
    of_all, is_scaled = len(assumed) == len(densities), assumed[0] != DEFAULT_DENSITY
    return (Message(_ASSUMED_DENSITY[of_all, is_scaled], facts),)
