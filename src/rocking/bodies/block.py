"""The homogeneous rectangular block: the body of Housner (1963) and of Mao et al. (2024)."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rocking import checks
from rocking.bodies.body import DEFAULT_DENSITY, Body, Interval
from rocking.bodies.moments import PlaneMoments
from rocking.conventions import FloatArray

if TYPE_CHECKING:
    from rocking.bodies.section import Section


@dataclass(frozen=True, slots=True, kw_only=True)
class Block(Body):
    """A homogeneous rectangular block standing on its whole base.

    Parameters
    ----------
    width : float
        Full width B = 2b [m].
    height : float
        Full height H = 2h [m].
    depth : float
        Depth out of the plane [m].
    density : float
        Density [kg/m3]; plain concrete if not given. No coefficient of restitution depends on it.

    Raises
    ------
    InvalidValueError
        If a value is not a finite number above zero.

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(width=1.0, height=4.0, depth=1.0, density=2400.0)
    >>> block.slenderness_ratio, block.mass
    (4.0, 9600.0)
    >>> round(block.slenderness_angle, 10)
    0.2449786631
    """

    width: float
    height: float
    depth: float = 1.0
    density: float = DEFAULT_DENSITY

    def __post_init__(self) -> None:
        """Refuse what is not a block."""
        for name in ("width", "height", "depth"):
            object.__setattr__(self, name, checks.length(name, getattr(self, name)))
        object.__setattr__(self, "density", checks.density("density", self.density))
        self._check_support()

    @classmethod
    def from_angle(cls, slenderness_angle: float, semi_diagonal: float, **options: float) -> "Block":
        """Return the block with a slenderness angle and a semi-diagonal, as papers on rocking give it.

        Parameters
        ----------
        slenderness_angle : float
            alpha = atan(b/h), between 0 and pi/2 [rad].
        semi_diagonal : float
            R, from a foot to the centre of mass [m].
        **options : float
            ``depth`` [m] and ``density`` [kg/m3].

        Returns
        -------
        Block
            The block.

        Raises
        ------
        InvalidValueError
            If a value is outside its range; an angle above pi/2 is most likely in degrees.

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
            hint="degrees?",
        )
        size = checks.positive("semi_diagonal", semi_diagonal, "m")
        return cls(width=2.0 * size * math.sin(alpha), height=2.0 * size * math.cos(alpha), **options)

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
    def origin_x(self) -> float:
        """The local frame is the user's: the block stands on 0 <= x <= width."""
        return 0.0

    @property
    def ground(self) -> float:
        """Height of the ground [m]: zero."""
        return 0.0

    @property
    def local_feet(self) -> Interval:
        """The two lower corners [m]."""
        return 0.0, self.width

    @property
    def local_moments(self) -> PlaneMoments:
        """Mass, centre and central second moments, closed form."""
        mass = self.density * self.width * self.height * self.depth
        return PlaneMoments(
            mass, self.half_width, self.half_height, mass * self.width**2 / 12.0, mass * self.height**2 / 12.0
        )

    @property
    def local_contact(self) -> tuple[Interval, ...]:
        """The whole base [m]."""
        return (self.local_feet,)

    @property
    def local_box(self) -> tuple[float, float, float, float]:
        """The rectangle itself [m]."""
        return 0.0, 0.0, self.width, self.height

    def density_at(self, x: FloatArray, y: FloatArray) -> FloatArray:
        inside = (x >= 0.0) & (x <= self.width) & (y >= 0.0) & (y <= self.height)
        return np.where(inside, self.density, 0.0)

    def mirrored(self) -> "Block":
        """Return the block itself: it is its own mirror image."""
        return self

    def scaled(self, *, size: float = 1.0, density: float = 1.0) -> "Block":
        size, density = checks.positive("size", size), checks.positive("density", density)
        return Block(
            width=self.width * size,
            height=self.height * size,
            depth=self.depth * size,
            density=type(self.density)(self.density * density),
        )

    def with_feet(self, left: float, right: float) -> "Section":
        """Return the block standing on feet inside its base, which makes it a `Section`."""
        return self.to_section().with_feet(left, right)

    def to_section(self) -> "Section":
        """Return the same body as a `Section` of one region.

        Returns
        -------
        Section
            The rectangle with its four vertices.
        """
        from rocking.bodies.section import Section

        return Section.from_rectangle(self.width, self.height, density=self.density, depth=self.depth)
