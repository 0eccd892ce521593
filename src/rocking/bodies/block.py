"""The rectangular block of Housner (1963) and of Mao et al. (2024), homogeneous by default."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.bodies._known import Known, density_of
from rocking.bodies.body import DEFAULT_DENSITY, DEFAULT_DEPTH, GROUND_TOLERANCE, Body, Interval, feet_of
from rocking.bodies.moments import PlaneMoments
from rocking.conventions import FloatArray
from rocking.errors import GeometryError, InvalidValueError
from rocking.messages import Amount, Range

if TYPE_CHECKING:
    from rocking.bodies.section import Section


@dataclass(frozen=True, slots=True, init=False)
class Block(Body):
    """A rectangular block, homogeneous by default.

    The contact with the ground is the complete base, or two feet within the base.

    Parameters
    ----------
    width : float
        Full width B = 2b, in the direction of the motion [m].
    height : float
        Full height H = 2h [m].
    depth : float
        Depth out of the plane [m]. The motion does not act along the depth; `assumed` contains a note if a stated depth
        is smaller than the width.
    density : float
        Density [kg/m3]; the default is that of plain concrete. The coefficient of restitution does not depend on the
        density.
    mass : float, optional
        Known mass, in place of the density [kg].
    centre : (float, float), optional
        Known centre of mass (x, y) from the lower left corner [m]; the default is the centre of the rectangle.
    moment_of_inertia : float, optional
        Known polar moment about the centre of mass [kg m2].
    feet : (float, float), optional
        Positions of the left and the right foot from the lower left corner [m]; the default is the corners of the base.
        The base between the feet is flat.

    Raises
    ------
    InvalidValueError
        If a value is not a finite number above zero, or mass and density are both given.
    GeometryError
        If a foot lies outside the base, the centre of mass lies outside the block or not between the feet, or the
        moment of inertia is impossible for masses within the block.

    Notes
    -----
    The default moment of inertia is that of four homogeneous quarters about the centre of mass:
    ``m (x (B - x) + y (H - y)) / 3``. For a centre of mass in the middle, this is the moment of the homogeneous block.
    `assumed` contains this assumption, and the mass distribution for the models that need a distribution.

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(width=1.0, height=4.0, depth=1.0, density=2400.0)
    >>> block.slenderness_ratio, block.mass
    (4.0, 9600.0)
    >>> round(block.slenderness_angle, 10)
    0.2449786631

    A cabinet of 300 kg with the centre of mass from a tilt test, low and right of the middle:

    >>> cabinet = rk.Block(width=0.8, height=2.0, depth=0.6, mass=300.0, centre=(0.42, 0.7))
    >>> round(cabinet.side("left").slenderness_ratio, 12), round(cabinet.side("right").slenderness_ratio, 12)
    (1.666666666667, 1.842105263158)
    >>> round(cabinet.moment_of_inertia, 6), cabinet.mass
    (106.96, 300.0)

    A cabinet on two feet, 5 cm and 10 cm inside its corners, is more slender to the right:

    >>> cabinet = rk.Block(width=0.8, height=2.0, feet=(0.05, 0.70))
    >>> round(cabinet.side("left").half_width, 12), round(cabinet.side("right").half_width, 12)
    (0.35, 0.3)
    """

    width: float
    height: float
    depth: float
    density: float
    known: Known | None
    feet: Interval

    def __init__(
        self,
        *,
        width: float,
        height: float,
        depth: float = DEFAULT_DEPTH,
        density: float = DEFAULT_DENSITY,
        mass: float | None = None,
        centre: tuple[float, float] | None = None,
        moment_of_inertia: float | None = None,
        feet: tuple[float, float] | None = None,
    ) -> None:
        for name, value in (("width", width), ("height", height), ("depth", depth)):
            object.__setattr__(self, name, checks.length(name, value))
        if mass is not None:
            density = density_of(mass, self.width * self.height * self.depth, (density,))
        object.__setattr__(self, "density", checks.density("density", density))
        object.__setattr__(self, "known", Known.of(centre, moment_of_inertia))
        object.__setattr__(self, "feet", (0.0, self.width) if feet is None else self._on_base(feet_of(feet)))
        self._check_support()

    def _on_base(self, feet: Interval) -> Interval:
        left, right = feet
        slack = GROUND_TOLERANCE * max(self.width, self.height)
        if not -slack <= left < right <= self.width + slack:
            raise GeometryError(
                "{parameter} must be a left and a right foot on the base, x {allowed} from the lower left corner, got "
                "{left} and {right}",
                parameter="feet", value=feet, allowed=Range(0.0, self.width, "m"),
                left=Amount(left, "", ".9g"), right=Amount(right, "m", ".9g"),
            )  # fmt: skip
        return max(left, 0.0), min(right, self.width)

    def __repr__(self) -> str:
        named = {name: getattr(self, name) for name in ("width", "height", "depth", "density")}
        named |= self._stated
        return f"Block({', '.join(f'{name}={value!r}' for name, value in named.items())})"

    @classmethod
    def from_angle(cls, slenderness_angle: float, semi_diagonal: float, **options: Any) -> "Block":
        """Return the block with a given slenderness angle and semi-diagonal, as in papers on rocking.

        Parameters
        ----------
        slenderness_angle : float
            alpha = atan(b/h), between 0 and pi/2 [rad].
        semi_diagonal : float
            R, from a foot to the centre of mass [m].
        **options
            ``depth`` [m], ``density`` [kg/m3], ``mass`` [kg] and ``moment_of_inertia`` [kg m2].

        Returns
        -------
        Block
            Block with its centre of mass in the middle.

        Raises
        ------
        InvalidValueError
            If a value is outside its range.

        Examples
        --------
        >>> import math
        >>> round(Block.from_angle(math.atan(0.25), 2.0).slenderness_ratio, 12)
        4.0
        """
        alpha = checks.within(
            "slenderness_angle",
            slenderness_angle,
            0.0,
            0.5 * math.pi,
            unit="rad",
            open_low=True,
            open_high=True,
            hint="check that the angle is in radians",
        )
        size = checks.positive("semi_diagonal", semi_diagonal, "m")
        for name in ("centre", "feet"):
            if options.get(name) is not None:
                raise InvalidValueError(
                    "Angle and semi-diagonal define centre of mass and feet. Remove {parameter}.", parameter=name
                )
        return cls(width=2.0 * size * math.sin(alpha), height=2.0 * size * math.cos(alpha), **options)

    @property
    def stands_on_corners(self) -> bool:
        """True if the feet are the corners of the base."""
        return self.feet == (0.0, self.width)

    @property
    def _stated(self) -> dict[str, Any]:
        """Arguments stated by the user, by name, without sizes and density."""
        feet = {} if self.stands_on_corners else {"feet": self.feet}
        return ({} if self.known is None else self.known.arguments()) | feet

    @property
    def densities(self) -> tuple[float, ...]:
        return (self.density,)

    @property
    def half_width(self) -> float:
        """Half width b [m]."""
        return 0.5 * self.width

    @property
    def half_height(self) -> float:
        """Half height h [m]."""
        return 0.5 * self.height

    @property
    def local_feet(self) -> Interval:
        """Positions of the left and right foot, by default the lower corners x = 0 and x = width [m]."""
        return self.feet

    @property
    def local_moments(self) -> PlaneMoments:
        """Mass, centre of mass and central second moments, in closed form."""
        mass = self.density * self.width * self.height * self.depth
        homogeneous = PlaneMoments(
            mass, self.half_width, self.half_height, mass * self.width**2 / 12.0, mass * self.height**2 / 12.0
        )
        if self.known is None:
            return homogeneous
        corners = [(0.0, 0.0), (self.width, 0.0), (self.width, self.height), (0.0, self.height)]
        return self.known.moments(homogeneous, np.array(corners))

    @property
    def local_contact(self) -> tuple[Interval, ...]:
        """The base between the feet [m]."""
        return (self.local_feet,)

    @property
    def local_box(self) -> tuple[float, float, float, float]:
        """The rectangle itself [m]."""
        return 0.0, 0.0, self.width, self.height

    def density_at(self, x: FloatArray, y: FloatArray) -> FloatArray:
        inside = (x >= 0.0) & (x <= self.width) & (y >= 0.0) & (y <= self.height)
        return np.where(inside, self.density, 0.0)

    def mirrored(self) -> "Block":
        """Return the block mirrored about its vertical centre line."""
        if self.known is None and self.stands_on_corners:
            return self
        left, right = self.feet
        known_moments = self.known and self.known.mirrored(self.width)
        return self._changed(1.0, 1.0, known_moments, (self.width - right, self.width - left))

    def scaled(self, *, size: float = 1.0, density: float = 1.0) -> "Block":
        size, density = checks.positive("size", size), checks.positive("density", density)
        known_moments, (left, right) = self.known and self.known.scaled(size, density), self.feet
        return self._changed(size, density, known_moments, (left * size, right * size))

    def _changed(self, size: float, density: float, known_moments: Known | None, feet: Interval) -> "Block":
        return Block(
            width=self.width * size,
            height=self.height * size,
            depth=type(self.depth)(self.depth * size),
            density=type(self.density)(self.density * density),
            feet=feet,
            **({} if known_moments is None else known_moments.arguments()),
        )

    def with_feet(self, left: float, right: float) -> "Block":
        return self._changed(1.0, 1.0, self.known, (left, right))

    def to_section(self) -> "Section":
        """Return the block as a `Section` of one region.

        Returns
        -------
        Section
            The rectangle with its four vertices.
        """
        from rocking.bodies.section import Section

        return Section.from_rectangle(self.width, self.height, density=self.density, depth=self.depth, **self._stated)
