"""A 2D body of any shape: polygons with holes, each with its density."""

import math
from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies import shapes
from rocking.bodies._known import Known, density_of
from rocking.bodies.body import DEFAULT_DENSITY, DEFAULT_DEPTH, GROUND_TOLERANCE, Body, Interval, feet_of
from rocking.bodies.moments import PlaneMoments, combined_plane, ring_moments
from rocking.bodies.region import Region, check_disjoint
from rocking.conventions import FloatArray
from rocking.errors import GeometryError
from rocking.messages import Amount, Message, Option, Range


class Section(Body):
    """A rigid body with any set of polygons as cross-section.

    Parameters
    ----------
    regions : sequence of Region
        Polygons of one rigid body [m]; they may touch but not overlap.
    feet : (float, float), optional
        Positions of the left and right foot on the ground [m]; the default is the ends of the base.
    depth : float
        Depth out of the plane [m]. The motion does not act along the depth; `assumed` contains a note if a stated depth
        is smaller than the base.
    ground : float
        Height of the ground, equal to that of the lowest vertices [m].
    mass : float, optional
        Known mass, in place of densities [kg].
    centre : (float, float), optional
        Known centre of mass (x, y) [m]; the default follows from the densities.
    moment_of_inertia : float, optional
        Known polar moment about the centre of mass [kg m2].

    Raises
    ------
    GeometryError
        If regions overlap, the body does not touch the ground, a foot lies outside the base, the centre of
        mass is not between the feet or outside the outline, or the moment of inertia is impossible in this outline.
    InvalidValueError
        If a number is not finite or outside its range, or mass and densities are both given.

    Notes
    -----
    The default moment of inertia for a known centre of mass is a fraction of the largest possible value in the outline.
    This fraction is the same as for the homogeneous body. `assumed` contains this assumption, and the mass distribution
    for the models that need it.

    Examples
    --------
    A trapezoidal pedestal, 1 m wide at the base and 0.4 m at the top:

    >>> import rocking as rk
    >>> outline = [(0.0, 0.0), (1.0, 0.0), (0.7, 2.5), (0.3, 2.5)]
    >>> section = rk.Section([rk.Region(outline, density=2400.0)])
    >>> round(rk.coefficient_of_restitution(section, "housner"), 10)
    0.7416338583

    A cabinet of 300 kg with the centre of mass from a tilt test:

    >>> cabinet = rk.Section.from_rectangle(0.8, 2.0, mass=300.0, centre=(0.42, 0.7), moment_of_inertia=95.0)
    >>> round(cabinet.side("left").slenderness_ratio, 12), round(cabinet.side("right").slenderness_ratio, 12)
    (1.666666666667, 1.842105263158)
    """

    def __init__(
        self,
        regions: Sequence[Region],
        feet: tuple[float, float] | None = None,
        *,
        depth: float = DEFAULT_DEPTH,
        ground: float = 0.0,
        mass: float | None = None,
        centre: tuple[float, float] | None = None,
        moment_of_inertia: float | None = None,
    ) -> None:
        stated: object = regions
        regions = tuple(regions) if isinstance(stated, Sequence) else ()
        if not regions or not all(isinstance(region, Region) for region in regions):
            raise GeometryError("A Section needs a list of at least one Region(outline, density, holes).")
        self._depth = checks.length("depth", depth)
        self._ground = checks.number("ground", ground, "m")
        low = np.min([region.outline.min(axis=0) for region in regions], axis=0)
        high = np.max([region.outline.max(axis=0) for region in regions], axis=0)
        self._origin_x = 0.5 * float(low[0] + high[0])
        self._size = float((high - low).max())
        if abs(float(low[1]) - self._ground) > GROUND_TOLERANCE * self._size:
            lowest = float(low[1])
            raise GeometryError(
                "the lowest point of the body, y = {y}, is above the ground at {ground}"
                if lowest > self._ground
                else "the lowest point of the body, y = {y}, is below the ground at {ground}",
                y=Amount(lowest, "m", ".9g"), ground=Amount(self._ground, "m", ".9g"),
                hint=Message("use {option} or move the outline", {"option": Option("body.section.ground", lowest)}),
            )  # fmt: skip
        self.regions = tuple(region.moved(-self._origin_x, -self._ground) for region in regions)
        check_disjoint([(region.outline, region.holes) for region in self.regions])
        self._local_feet = self._placed(feet)
        if mass is not None:
            area = sum(ring_moments(ring).mass for region in self.regions for ring in region.rings)
            density = density_of(mass, area * self._depth, self.densities)
            self.regions = tuple(Region(region.outline, density, region.holes) for region in self.regions)
        self._known = Known.of(centre, moment_of_inertia, (self._origin_x, self._ground))
        self._check_support()

    def __repr__(self) -> str:
        left, right = self.feet
        vertices = sum(len(ring) for region in self.regions for ring in region.rings)
        return f"Section({len(self.regions)} region(s), {vertices} vertices, feet=({left:g}, {right:g}) m)"

    @classmethod
    def from_points(
        cls,
        outline: Any,
        density: float = DEFAULT_DENSITY,
        *,
        holes: Sequence[Any] = (),
        feet: tuple[float, float] | None = None,
        **options: Any,
    ) -> "Section":
        """Return the body of one polygon.

        Parameters
        ----------
        outline : array_like, shape (n, 2)
            Vertices (x, y) [m].
        density : float
            Density [kg/m3].
        holes : sequence of array_like
            Rings of the holes [m].
        feet : (float, float), optional
            Positions of the feet [m]; the default is the ends of the base.
        **options
            ``depth``, ``ground``, ``mass``, ``centre``, ``moment_of_inertia``, as for the class.

        Returns
        -------
        Section
            The body.

        Examples
        --------
        >>> from rocking import Section
        >>> Section.from_points([(0, 0), (2, 0), (1, 3)]).centre
        (1.0, 1.0)
        """
        return cls([Region(outline, density, holes)], feet, **options)

    @classmethod
    def from_rectangle(cls, width: float, height: float, **options: Any) -> "Section":
        """Return a rectangle with the base 0 <= x <= width.

        Parameters
        ----------
        width, height : float
            Full width and height [m].
        **options
            As for `from_points`.

        Returns
        -------
        Section
            The body.
        """
        return cls.from_points(shapes.rectangle(width, height), **options)

    @classmethod
    def from_trapezoid(cls, base: float, top: float, height: float, lean: float = 0.0, **options: Any) -> "Section":
        """Return a trapezoid with the base 0 <= x <= base.

        Parameters
        ----------
        base, top, height : float
            Width at the ground, width at the top, height [m].
        lean : float
            Horizontal offset of the middle of the top from the middle of the base, positive to the right [m].
        **options
            As for `from_points`.

        Returns
        -------
        Section
            The body.
        """
        return cls.from_points(shapes.trapezoid(base, top, height, lean), **options)

    @classmethod
    def from_regular_polygon(cls, sides: int, radius: float, **options: Any) -> "Section":
        """Return a regular polygon with one side as base.

        Parameters
        ----------
        sides : int
            Number of sides, at least 3 [-].
        radius : float
            Radius of the circle through the vertices [m].
        **options
            As for `from_points`.

        Returns
        -------
        Section
            The body.
        """
        return cls.from_points(shapes.regular_polygon(sides, radius), **options)

    @classmethod
    def from_ellipse(cls, width: float, height: float, sides: int = 64, **options: Any) -> "Section":
        """Return an ellipse as an inscribed polygon with one side as base.

        Parameters
        ----------
        width, height : float
            Full axes of the ellipse [m].
        sides : int
            Number of sides; the lowest side is the base [-].
        **options
            As for `from_points`.

        Returns
        -------
        Section
            The body.
        """
        return cls.from_points(shapes.ellipse(width, height, sides), **options)

    @property
    def depth(self) -> float:
        """Depth out of the plane [m]."""
        return self._depth

    @property
    def origin_x(self) -> float:
        """Middle of the bounding box in the user's coordinates [m]."""
        return self._origin_x

    @property
    def ground(self) -> float:
        return self._ground

    @property
    def local_feet(self) -> Interval:
        return self._local_feet

    @property
    def densities(self) -> tuple[float, ...]:
        return tuple(region.density for region in self.regions)

    @cached_property
    def local_moments(self) -> PlaneMoments:
        """Mass, centre of mass and central second moments in the local frame, known or from the polygons."""
        moments = combined_plane(
            ring_moments(ring).times(region.density * self._depth) for region in self.regions for ring in region.rings
        )
        if self._known is None:
            return moments
        vertices = np.concatenate([region.outline for region in self.regions])
        return self._known.moments(moments, vertices, (self._origin_x, self._ground))

    @property
    def known(self) -> Known | None:
        return self._known

    @cached_property
    def local_contact(self) -> tuple[Interval, ...]:
        """Contact intervals of the base between the feet, in the local frame [m]; empty for contact points."""
        (left, right), slack = self._local_feet, GROUND_TOLERANCE * self._size
        ends = np.sort(np.concatenate([_level_edges(region.outline, slack) for region in self.regions]), axis=1)
        a, b = ends[np.lexsort(ends.T[::-1])].T.clip(left, right)
        a, b = a[b > a], b[b > a]
        if not a.size:
            return ()
        reach = np.maximum.accumulate(b)
        apart = np.flatnonzero(a[1:] > reach[:-1] + slack)
        starts, stops = a[np.append(0, apart + 1)], reach[np.append(apart, -1)]
        return tuple(zip(starts.tolist(), stops.tolist(), strict=True))

    @property
    def local_box(self) -> tuple[float, float, float, float]:
        """Bounding box in the local frame [m]."""
        low = np.min([region.outline.min(axis=0) for region in self.regions], axis=0)
        high = np.max([region.outline.max(axis=0) for region in self.regions], axis=0)
        return float(low[0]), float(low[1]), float(high[0]), float(high[1])

    def density_at(self, x: FloatArray, y: FloatArray) -> FloatArray:
        import shapely

        local_x, local_y = np.asarray(x) - self.origin_x, np.asarray(y) - self.ground
        density = np.zeros(np.broadcast_shapes(local_x.shape, local_y.shape))
        for region in self.regions:
            polygon = shapely.Polygon(region.outline, region.holes)
            shapely.prepare(polygon)
            density[shapely.intersects_xy(polygon, local_x, local_y)] = region.density
        return density

    def mirrored(self) -> "Section":
        """Return the section with left and right exchanged."""
        left, right = self._local_feet
        section = self._copy(lambda ring: ring * np.array([-1.0, 1.0]), (-right, -left))
        section._known = self._known and self._known.mirrored()
        return section

    def scaled(self, *, size: float = 1.0, density: float = 1.0) -> "Section":
        size, density = checks.positive("size", size), checks.positive("density", density)
        checks.length("size of the scaled body", self._size * size)
        left, right = self._local_feet
        section = self._copy(lambda ring: ring * size, (left * size, right * size), density, size)
        section._known = self._known and self._known.scaled(size, density)
        return section

    def with_feet(self, left: float, right: float) -> "Section":
        section = self._copy(lambda ring: ring, self._placed((left, right)))
        section._check_support()
        return section

    def _copy(
        self, change: Callable[[FloatArray], FloatArray], feet: Interval, density: float = 1.0, size: float = 1.0
    ) -> "Section":
        section = object.__new__(Section)
        section.regions = tuple(region.mapped(change, density) for region in self.regions)
        section._depth, section._size = type(self._depth)(self._depth * size), self._size * size
        section._known = self._known
        section._origin_x, section._ground, section._local_feet = self._origin_x, self._ground, feet
        return section

    def _placed(self, feet: tuple[float, float] | None) -> Interval:
        """Return the feet in the local frame, by default the ends of the base."""
        slack, origin = GROUND_TOLERANCE * self._size, self._origin_x
        touching = np.concatenate([r.outline[np.abs(r.outline[:, 1]) <= slack, 0] for r in self.regions])
        base = float(touching.min()), float(touching.max())
        if feet is None:
            if base[1] - base[0] <= slack:
                raise GeometryError("The body touches the ground at one point; two feet are needed.")
            return base
        left, right = feet_of(feet)
        left, right = left - origin, right - origin
        if not left < right:
            raise GeometryError(
                "the left foot must be left of the right foot, got {left} and {right}", parameter="feet", value=feet,
                left=Amount(feet[0]), right=Amount(feet[1], "m"),
            )  # fmt: skip
        slack += 4.0 * math.ulp(abs(origin))
        for name, x in (("left", left), ("right", right)):
            if not base[0] - slack <= x <= base[1] + slack:
                a, b = base[0] + origin, base[1] + origin
                raise GeometryError(
                    "the {foot} foot must lie on the base, x {allowed}, got {x}", parameter="feet", value=x + origin,
                    allowed=Range(a, b, "m"), foot=name, x=Amount(x + origin, "", ".9g"),
                    y=Amount(self._ground, "m", ".9g"),
                )  # fmt: skip
        return max(left, base[0]), min(right, base[1])


def _level_edges(outline: FloatArray, tolerance: float) -> FloatArray:
    """Return the x coordinates of both ends of every edge on the ground, shape (n, 2) [m]."""
    x, y = outline.T
    low = np.abs(y) <= tolerance
    both = low & np.roll(low, -1)
    return np.stack([x[both], np.roll(x, -1)[both]], axis=1)
