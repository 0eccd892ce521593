"""The rectangular block: the body of Housner (1963) and of Mao et al. (2024), homogeneous if nothing else is known."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.bodies._known import Known, density_of
from rocking.bodies.body import DEFAULT_DENSITY, Body, Interval
from rocking.bodies.moments import PlaneMoments
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError

if TYPE_CHECKING:
    from rocking.bodies.section import Section


@dataclass(frozen=True, slots=True, init=False)
class Block(Body):
    """A rectangular block standing on its whole base, homogeneous if nothing else is known.

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
    mass : float, optional
        Mass, if known, in place of the density [kg].
    centre : (float, float), optional
        Centre of mass, from the lower left corner, if known; the middle if not given [m].
    moment_of_inertia : float, optional
        Polar moment about the centre of mass, if known [kg m2].

    Raises
    ------
    InvalidValueError
        If a value is not a finite number above zero, or mass and density are both given.
    GeometryError
        If the centre of mass lies outside the block, or no mass within it has such a moment of inertia.

    Notes
    -----
    A moment of inertia that is not given is that of four quarters about the centre of mass, each homogeneous:
    ``m (x (B - x) + y (H - y)) / 3``, and of the homogeneous block if the centre is the middle. `assumed` says so, and
    what the models take that ask how mass is spread.

    Examples
    --------
    >>> import rocking as rk
    >>> block = rk.Block(width=1.0, height=4.0, depth=1.0, density=2400.0)
    >>> block.slenderness_ratio, block.mass
    (4.0, 9600.0)
    >>> round(block.slenderness_angle, 10)
    0.2449786631

    A cabinet of 300 kg whose centre of mass was found by tilting it, low and right of the middle:

    >>> cabinet = rk.Block(width=0.8, height=2.0, depth=0.6, mass=300.0, centre=(0.42, 0.7))
    >>> round(cabinet.side("left").slenderness_ratio, 12), round(cabinet.side("right").slenderness_ratio, 12)
    (1.666666666667, 1.842105263158)
    >>> round(cabinet.moment_of_inertia, 6), cabinet.mass
    (106.96, 300.0)
    """

    width: float
    height: float
    depth: float
    density: float
    known: Known | None

    def __init__(
        self,
        *,
        width: float,
        height: float,
        depth: float = 1.0,
        density: float = DEFAULT_DENSITY,
        mass: float | None = None,
        centre: tuple[float, float] | None = None,
        moment_of_inertia: float | None = None,
    ) -> None:
        for name, value in (("width", width), ("height", height), ("depth", depth)):
            object.__setattr__(self, name, checks.length(name, value))
        if mass is not None:
            density = density_of(mass, self.width * self.height * self.depth, (density,))
        object.__setattr__(self, "density", checks.density("density", density))
        object.__setattr__(self, "known", Known.of(centre, moment_of_inertia))
        self._check_support()

    def __repr__(self) -> str:
        named = {name: getattr(self, name) for name in ("width", "height", "depth", "density")}
        named |= {} if self.known is None else self.known.given()
        return f"Block({', '.join(f'{name}={value!r}' for name, value in named.items())})"

    @classmethod
    def from_angle(cls, slenderness_angle: float, semi_diagonal: float, **options: Any) -> "Block":
        """Return the block with a slenderness angle and a semi-diagonal, as papers on rocking give it.

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
            The block, its centre of mass in its middle.

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
        if options.get("centre") is not None:
            raise InvalidValueError("angle and semi-diagonal say where the centre of mass is: leave centre out")
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
    def local_feet(self) -> Interval:
        """The two lower corners, x = 0 and x = width [m]."""
        return 0.0, self.width

    @property
    def local_moments(self) -> PlaneMoments:
        """Mass, centre and central second moments, closed form."""
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
        """Return the block seen in a vertical mirror through its middle; a homogeneous one is the same."""
        return self if self.known is None else self._changed(1.0, 1.0, self.known.mirrored(self.width))

    def scaled(self, *, size: float = 1.0, density: float = 1.0) -> "Block":
        size, density = checks.positive("size", size), checks.positive("density", density)
        return self._changed(size, density, self.known and self.known.scaled(size, density))

    def _changed(self, size: float, density: float, known: Known | None) -> "Block":
        return Block(
            width=self.width * size,
            height=self.height * size,
            depth=self.depth * size,
            density=type(self.density)(self.density * density),
            **({} if known is None else known.given()),
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

        known = {} if self.known is None else self.known.given()
        return Section.from_rectangle(self.width, self.height, density=self.density, depth=self.depth, **known)
