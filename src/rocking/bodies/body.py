"""Base class of 2D bodies: feet, moments, slenderness and frequency parameter."""

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
    """Parameters of a body for rotation about one foot.

    Parameters
    ----------
    foot : {"left", "right"}
        The foot of the rotation.
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

DEFAULT_DENSITY = Assumed(2400.0)  # plain concrete [kg/m3]; without effect on restitution of a homogeneous body

DEFAULT_DEPTH = Assumed(1.0)  # out of the plane [m]; no rotation depends on it

GROUND_TOLERANCE = 1e-9
"""Tolerance of vertices on the ground and of feet on the base: distance / body size."""

# smallest ratio: distance of a foot from the vertical through the centre of mass / distance of the feet
_SUPPORT_TOLERANCE = 1e-12


class Body(ABC):
    """A rigid 2D body on two feet.

    A subclass defines the mass distribution in a local frame. The origin of this frame lies on the ground near the body
    (`origin_x`, `ground`), which avoids rounding errors far from the user's origin.
    """

    @property
    def origin_x(self) -> float:
        """Horizontal position of the local frame in the user's coordinates, by default 0 [m]."""
        return 0.0

    @property
    def ground(self) -> float:
        """Height of the ground in the user's coordinates, by default 0 [m]."""
        return 0.0

    @property
    @abstractmethod
    def local_feet(self) -> Interval:
        """Positions of the left and right foot in the local frame [m]."""

    @property
    @abstractmethod
    def local_moments(self) -> PlaneMoments:
        """Mass, centre of mass and central second moments in the local frame."""

    @property
    @abstractmethod
    def local_contact(self) -> tuple[Interval, ...]:
        """Contact intervals of the base between the feet, left to right, in the local frame [m]."""

    @property
    @abstractmethod
    def local_box(self) -> tuple[float, float, float, float]:
        """Bounding box (x_min, y_min, x_max, y_max) in the local frame [m]."""

    @abstractmethod
    def mirrored(self) -> Self:
        """Return the body with left and right exchanged."""

    @abstractmethod
    def scaled(self, *, size: float = 1.0, density: float = 1.0) -> Self:
        """Return the body with scaled lengths and densities.

        Parameters
        ----------
        size : float
            Scale factor of all lengths, including the depth [-].
        density : float
            Scale factor of all densities [-].
        """

    @abstractmethod
    def with_feet(self, left: float, right: float) -> "Body":
        """Return the body with other feet.

        Parameters
        ----------
        left, right : float
            New positions of the feet in the user's coordinates [m].
        """

    @property
    def depth(self) -> float:
        """Depth out of the plane, by default assumed [m]."""
        return DEFAULT_DEPTH

    @property
    def is_weaker_along_depth(self) -> bool:
        """True if uplift begins earlier along the stated depth than along the width."""
        (left, right), x = self.local_feet, self.local_moments.x
        is_stated = not isinstance(self.depth, Assumed)
        return is_stated and 0.5 * self.depth < (1.0 - GROUND_TOLERANCE) * min(x - left, right - x)

    @property
    def depth_note(self) -> str:
        """Note that the smaller resistance along the depth is not computed; empty if the width is the weaker side."""
        if not self.is_weaker_along_depth:
            return ""
        (left, right), moments = self.local_feet, self.local_moments
        facts = {
            "width": right - left, "depth": self.depth, "limit": 0.5 * self.depth / moments.y,
            "own": min(moments.x - left, right - moments.x) / moments.y,
        }  # fmt: skip
        return Message(
            "only motion along the width of {width:.3g} m is computed. The depth of {depth:.3g} m is smaller: along "
            "the depth uplift begins at {limit:.3g} times gravity, along the width at {own:.3g} times gravity. "
            "Exchange width and depth to compute the motion along the depth",
            facts,
        )

    @property
    def caution(self) -> str:
        """The note of a weaker depth as a sentence for a verdict; empty without one."""
        return Message("Caution: {note}.", {"note": self.depth_note}) if self.depth_note else ""

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
        """Return the parameters of the body for rotation about one foot.

        Parameters
        ----------
        foot : {"left", "right"}
            The foot of the rotation.
        gravity : float
            Acceleration of gravity [m/s2].

        Returns
        -------
        Side
            Slenderness, semi-diagonal, frequency parameter and uplift acceleration about that foot.

        Raises
        ------
        InvalidValueError
            If the foot is neither "left" nor "right", or gravity is not above zero.

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
        """Return the density at points, zero outside the body.

        A known centre of mass or moment of inertia does not change the density of the outline.

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
            If this type of body has no density field, such as mass points.
        """
        raise InvalidValueError("A {type} body has no density field.", type=type(self).__name__)

    @property
    def densities(self) -> tuple[float, ...]:
        """Densities of the parts; empty for mass points [kg/m3]."""
        return ()

    @property
    def known(self) -> Known | None:
        """Known centre of mass and moment of inertia, which replace the values of the outline, or None."""
        return None

    @property
    def assumed(self) -> tuple[str, ...]:
        """Assumed values, as texts."""
        density = (Message("density {assumed}", {"assumed": text}) for text in assumed_density(self.densities))
        return (*density, *(() if self.known is None else self.known.assumed), *filter(None, [self.depth_note]))

    @property
    def doubts(self) -> tuple[str, ...]:
        """Warnings about implausible values, as texts."""
        (left, right), height = self.local_feet, self.local_moments.y
        return plausibility.of_body(height, 2.0 * height / (right - left), self.densities)

    def answer(self, gravity: float = conventions.g) -> Answer:
        """Return the results of the body.

        Parameters
        ----------
        gravity : float
            Acceleration of gravity [m/s2].

        Returns
        -------
        Answer
            Mass, centre of mass, feet, moment of inertia, assumptions, doubts, and the geometry of each side.
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
        """True if both feet have the same distance from the centre of mass (to 1e-12 of the base)."""
        left, right = self.local_feet
        return abs(self.local_moments.x - 0.5 * (left + right)) <= 1e-12 * (right - left)

    @property
    def slenderness_ratio(self) -> float:
        """Slenderness h/b of a body with equal sides [-]."""
        return self._common_side("slenderness_ratio").slenderness_ratio

    @property
    def slenderness_angle(self) -> float:
        """Slenderness angle alpha = atan(b/h) of a body with equal sides [rad]."""
        return self._common_side("slenderness_angle").slenderness_angle

    @property
    def semi_diagonal(self) -> float:
        """Distance R from a foot to the centre of mass of a body with equal sides [m]."""
        return self._common_side("semi_diagonal").semi_diagonal

    @property
    def frequency_parameter(self) -> float:
        """Frequency parameter p of a body with equal sides, at standard gravity [rad/s]."""
        return self._common_side("frequency_parameter").frequency_parameter

    @property
    def uplift_acceleration(self) -> float:
        """Uplift acceleration of a body with equal sides, at standard gravity [m/s2]."""
        return self._common_side("uplift_acceleration").uplift_acceleration

    def _common_side(self, name: str) -> Side:
        if not self.is_symmetric:
            raise AsymmetricBodyError(
                '{quantity} depends on the side of this body. Use body.side("left").{quantity} or body.side("right").',
                quantity=name,
            )
        return self.side("right")

    def _check_support(self) -> None:
        moments, (left, right) = self.local_moments, self.local_feet
        if not (moments.mass > 0.0 and math.isfinite(moments.polar)):
            raise GeometryError("The mass of the body must be finite and > 0 kg, got {mass:g}.", mass=moments.mass)
        slack = _SUPPORT_TOLERANCE * (right - left)
        if not left + slack < moments.x < right - slack:
            x = self.origin_x + moments.x
            a, b = self.feet
            raise GeometryError(
                "the centre of mass (x = {x}) must lie between the feet ({left} and {right})",
                parameter="centre", value=x, hint="this body is not stable",
                x=Amount(x, "m", ".6g"), left=Amount(a, "", ".6g"), right=Amount(b, "m", ".6g"),
            )  # fmt: skip
        plausibility.warn(self.doubts)


def feet_of(feet: Any) -> Interval:
    """Return the positions of the two feet as numbers [m]."""
    try:
        left, right = feet
    except (TypeError, ValueError) as error:
        raise GeometryError("feet must be a pair (x_left, x_right) in m") from error
    return checks.number("left foot", left, "m"), checks.number("right foot", right, "m")


def assumed_rows(body: Any) -> list[tuple[str, str]]:
    """Return the assumptions about a body as rows (label, text) of a table."""
    affects_rotations = hasattr(body, "restraints") or hasattr(body, "base_mass")
    density = assumed_density(body.densities, affects_rotations=affects_rotations)
    return [*(("density", text) for text in density), *(("assumed", text) for text in body.assumed[len(density) :])]


_ASSUMED_DENSITY = {  # keys: (all densities are assumed, the densities are scaled)
    (True, False): ("{density:g} kg/m3 assumed (plain concrete); it affects mass and forces, not rotations"),
    (True, True): (
        "{density:g} kg/m3 assumed (plain concrete), scaled to {scaled:.6g}; it affects mass and forces, not rotations"
    ),
    (False, False): (
        "{density:g} kg/m3 assumed for {parts} of {total} parts (plain concrete); it affects the centre of mass "
        "and rotations"
    ),
    (False, True): (
        "{density:g} kg/m3 assumed for {parts} of {total} parts (plain concrete), scaled to {scaled:.6g}; it affects "
        "the centre of mass and rotations"
    ),
}


_ASSUMED_WITH_RESTRAINTS = {
    (True, False): "{density:g} kg/m3 assumed (plain concrete); with restraints or a base it affects rotations",
    (True, True): (
        "{density:g} kg/m3 assumed (plain concrete), scaled to {scaled:.6g}; with restraints or a base it affects "
        "rotations"
    ),
}  # fmt: skip


def assumed_together(bodies: Sequence[Body], *, affects_rotations: bool = False) -> tuple[str, ...]:
    """Return the assumed values of bodies that move together, as texts. A body without densities has a stated mass."""
    densities = [density for body in bodies for density in body.densities or (math.nan,)]
    density = assumed_density(densities, affects_rotations=affects_rotations)
    texts = [Message("density {assumed}", {"assumed": text}) for text in density]
    others = [text for body in bodies for text in body.assumed[len(assumed_density(body.densities)) :]]
    return tuple(dict.fromkeys([*texts, *others]))


def assumed_density(densities: Sequence[float], *, affects_rotations: bool = False) -> tuple[str, ...]:
    """Return the assumptions about densities, as texts. With restraints the mass affects the rotations."""
    assumed = [value for value in densities if isinstance(value, Assumed)]
    if not assumed:
        return ()
    facts = {"density": DEFAULT_DENSITY, "parts": len(assumed), "total": len(densities), "scaled": assumed[0]}
    of_all, is_scaled = len(assumed) == len(densities), assumed[0] != DEFAULT_DENSITY
    texts = _ASSUMED_WITH_RESTRAINTS if affects_rotations and of_all else _ASSUMED_DENSITY
    return (Message(texts[of_all, is_scaled], facts),)
