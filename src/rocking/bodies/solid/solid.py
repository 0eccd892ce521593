"""A rigid body in space: parts of any shape and density on a base."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from rocking import checks, plausibility
from rocking.answers import Answer
from rocking.bodies._known import density_of
from rocking.bodies.block import Block
from rocking.bodies.body import assumed_density
from rocking.bodies.equilibria import Equilibria, StablePose
from rocking.bodies.moments import SolidMoments, combined
from rocking.bodies.section import Section
from rocking.bodies.solid._known import ASSUMED, check_disjoint, check_possible, checked_centre, known_moments, similar
from rocking.bodies.solid.base import Base, RoundBase, SupportPolygon, hull
from rocking.bodies.solid.part import Part, footprint, rotation_about
from rocking.bodies.solid.prism import Prism
from rocking.bodies.solid.standing import equilibria_of, set_down
from rocking.bodies.solid.surfaces import Shape
from rocking.conventions import FloatArray
from rocking.errors import GeometryError, InvalidValueError
from rocking.messages import Message
from rocking.portable import times

BASE_TOLERANCE = 1e-9
_UPRIGHT, _WHOLE = 1e-12, 0.999
_OWN_BASE = Message(
    "the body stands on a base of its own, smaller than the facet of its hull: what lifts it and how far its centre "
    "must rise are those of the whole facet here, more than its own base asks"
)
"""Corners this close to the ground, relative to the body's size, stand on it by default."""


class Solid:
    """A rigid body in space, standing on level ground.

    Parameters
    ----------
    parts : Part, Shape, or sequence of them
        What it is made of; parts may touch but not overlap, and move as one even where they do not touch. A bare
        shape has the density of plain concrete, 2400 kg/m3.
    base : array_like, shape (n, 2), or Base, optional
        Points (x, y) that it stands on [m]; by default its corners on the ground, or its round face there.
    ground : float
        Height of the ground [m]: the lowest point must lie on it.
    base_tolerance : float, optional
        Corners this close to the ground stand on it [m]; by default 1e-9 of the body's size.
    mass : float, optional
        Mass, if known, in place of densities [kg].
    centre : (float, float, float), optional
        Centre of mass (x, y, z), if known; by default that of the parts [m].
    inertia : array_like, shape (3, 3) or (3,), optional
        Inertia about the centre of mass, axes along x, y and z, if known: the tensor, or three moments where these are
        principal axes [kg m2].

    Attributes
    ----------
    name : str
        What its file calls it, or the name of the file; empty without one.
    repairs : tuple of str
        One sentence for each change of a mesh that it was read from, and each doubt about it.
    turn : ndarray, shape (3, 3)
        Rotation from the axes of the mesh that it was read from to its own; none if it was not [-].

    Raises
    ------
    GeometryError
        If parts overlap or have moments that no body has, the body does not stand on the ground, has no base with
        an area, its centre is not above the base, or no mass within it has the centre or the inertia that were given.
    InvalidValueError
        If a number is not finite, or mass and densities are both given.

    Notes
    -----
    An inertia that is not given is that of the parts, scaled along each axis as the greatest second moment that masses
    within the box can have about the known centre; `assumed` says so. The model ``ked-3d`` needs the distribution of
    mass, refuses a body of which only moments are known, and names those that do not.

    Examples
    --------
    >>> from rocking.bodies.solid import box, cylinder, Part
    >>> column = Part(cylinder(0.8, 2.0), 2700.0).moved(0.0, 0.0, 0.3)
    >>> solid = Solid([Part(box(1.0, 1.0, 0.3), 2400.0), column])
    >>> round(solid.mass, 6), len(solid.base.vertices)
    (3434.336053, 4)
    """

    def __init__(
        self,
        parts: Part | Shape | Sequence[Part | Shape],
        *,
        base: Base | ArrayLike | None = None,
        ground: float = 0.0,
        base_tolerance: float | None = None,
        mass: float | None = None,
        centre: ArrayLike | None = None,
        inertia: ArrayLike | None = None,
    ) -> None:
        self.name: str = ""
        self.repairs: tuple[str, ...] = ()
        self.turn: FloatArray = np.eye(3)
        listed = _listed(parts)
        self._ground = checks.number("ground", ground, "m")
        boxes = np.array([part.box() for part in listed])
        low, high = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
        self._size = checks.length("largest dimension of the body", float((high - low).max()))
        tolerance = BASE_TOLERANCE * self._size
        if base_tolerance is not None:
            tolerance = checks.positive("base_tolerance", base_tolerance, "m")
        if abs(low[2] - self._ground) > max(tolerance, 8.0 * np.spacing(abs(self._ground))):
            lowest = float(low[2])
            raise GeometryError(
                "the body floats above the ground: its lowest point is z = {lowest:.9g} m, the ground {ground:.9g} m; "
                "pass ground={lowest:.9g} or move the parts"
                if lowest > self._ground
                else "the body reaches below the ground: its lowest point is z = {lowest:.9g} m, the ground "
                "{ground:.9g} m; pass ground={lowest:.9g} or move the parts",
                lowest=lowest,
                ground=self._ground,
            )
        middle = 0.5 * (low + high)
        self.origin: FloatArray = np.array([middle[0], middle[1], self._ground])
        self.local_parts = tuple(part.moved(*(-self.origin).tolist()) for part in listed)
        check_possible(self.local_parts)
        check_disjoint(self.local_parts)
        if mass is not None:
            self.local_parts = _weighing(self.local_parts, density_of(mass, self.volume, self.densities))
        self.known: SolidMoments | None = None
        self._assumed: tuple[str, ...] = ()
        if centre is not None or inertia is not None:
            place = None if centre is None else checked_centre(centre, self.origin)
            own = combined(part.moments() for part in self.local_parts)
            self.known = known_moments(self.local_parts, own, place, inertia)
            self._assumed = () if inertia is not None else (ASSUMED,)
        self.local_base = self._placed_base(base, tolerance)
        self._check_support()

    def __repr__(self) -> str:
        base = self.local_base
        kind = f"{len(base.vertices)} corners" if isinstance(base, SupportPolygon) else "a circle"
        return f"Solid({len(self.local_parts)} part(s), {self.mass:g} kg, on {kind})"

    @classmethod
    def from_section(cls, section: Section | Block) -> "Solid":
        """Return the plane body as a body in space: its polygons extruded over its depth, along y.

        Parameters
        ----------
        section : Section or Block
            The plane body; its y becomes z, its depth lies half before and half behind the plane y = 0.

        Returns
        -------
        Solid
            A prism for each region, standing on the section's feet. Of a plane body whose centre of mass or moment of
            inertia is known, it has these, and its mass is spread evenly over the depth.

        Examples
        --------
        >>> import rocking as rk
        >>> Solid.from_section(rk.Section.from_rectangle(1.0, 4.0, density=1.0)).mass
        4.0
        """
        section = section.to_section() if isinstance(section, Block) else section
        stand = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
        place = (section.origin_x, 0.5 * section.depth, section.ground)
        parts = [Part(Prism(r, section.depth), r.density, rotation=stand, translation=place) for r in section.regions]
        half = 0.5 * section.depth
        feet = [(x, y) for x in section.feet for y in (-half, half)]
        if section.known is None:
            return cls(parts, base=feet, ground=section.ground)
        moments, (x, z) = section.local_moments, section.centre
        along, across, up = moments.xx, moments.mass * section.depth**2 / 12.0, moments.yy
        inertia = (across + up, along + up, along + across)
        solid = cls(parts, base=feet, ground=section.ground, centre=(x, 0.0, z), inertia=inertia)
        solid._assumed = (*section.known.assumed[:-1], Message("mass spread evenly over the depth"))
        return solid

    @property
    def ground(self) -> float:
        """Height of the ground in the user's coordinates [m]."""
        return self._ground

    @property
    def size(self) -> float:
        """Largest side of the bounding box [m]."""
        return self._size

    @cached_property
    def local_moments(self) -> SolidMoments:
        """Mass, centre and central second moments about `origin`: known, or of the parts."""
        return self.known or combined(part.moments() for part in self.local_parts)

    @property
    def mass(self) -> float:
        """Mass [kg]."""
        return self.local_moments.mass

    @property
    def volume(self) -> float:
        """Volume [m3]."""
        return sum(part.shape.moments().mass for part in self.local_parts)

    @property
    def centre(self) -> FloatArray:
        """Centre of mass (x, y, z) in the user's coordinates [m]."""
        return self.origin + self.local_moments.centre

    @property
    def inertia(self) -> FloatArray:
        """Inertia tensor about the centre of mass, axes along x, y and z [kg m2]."""
        return self.local_moments.inertia

    @property
    def base(self) -> Base:
        """The base in the user's coordinates."""
        return self.local_base.changed(np.eye(2), self.origin)

    @property
    def parts(self) -> tuple[Part, ...]:
        """The parts in the user's coordinates."""
        return tuple(part.moved(*self.origin.tolist()) for part in self.local_parts)

    @property
    def assumed(self) -> tuple[str, ...]:
        """What nobody gave and was assumed, in words."""
        return (
            *(Message("density {assumed}", {"assumed": each}) for each in assumed_density(self.densities)),
            *self._assumed,
        )

    @property
    def densities(self) -> tuple[float, ...]:
        """Density of each part [kg/m3]."""
        return tuple(part.density for part in self.local_parts)

    @property
    def doubts(self) -> tuple[str, ...]:
        """What can be computed with but was hardly meant, in words."""
        centre = self.local_moments.centre
        slenderness = float(centre[2]) / self.local_base.margin(centre[:2])
        return plausibility.of_body(float(centre[2]), slenderness, self.densities)

    @property
    def box(self) -> FloatArray:
        """Lowest and highest corner of the bounding box in the user's coordinates, shape (2, 3) [m]."""
        boxes = np.array([part.box() for part in self.local_parts])
        box: FloatArray = np.array([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)]) + self.origin
        return box

    def answer(self) -> Answer:
        """Return what is shown of the body.

        Returns
        -------
        Answer
            Mass, volume, size, centre, inertia, base, assumptions, doubts and repairs.
        """
        low, high = self.box
        return Answer({
            "kind": "Solid", "name": self.name, "parts": len(self.local_parts), "mass": self.mass,
            "volume": self.volume, "size": high - low, "centre": self.centre,
            "centre_height": self.centre[2] - self.ground, "inertia": self.inertia, "base": self.base.answer(),
            "assumed": self.assumed, "warnings": self.doubts, "repairs": self.repairs,
        })  # fmt: skip

    def in_plane(self, azimuth: float = 0.0) -> Section:
        """Return the plane body that rocks in one direction, from one end of the base to the other.

        Of a base that is not square to the direction these ends are its corners: the solid itself lifts earlier,
        over an edge, as `equilibria` says.

        Parameters
        ----------
        azimuth : float
            Direction of the plane's x, from the solid's x counter-clockwise seen from above [rad].

        Returns
        -------
        Section
            The convex hull of the silhouette on the ends of the base in that direction, with mass, centre of mass and
            moment of inertia of the solid; its x = 0 is the middle of the solid's box, its ground y = 0. What needs the
            distribution of mass takes what `assumed` of the plane body says.

        Examples
        --------
        A box of 1 x 2 x 4 m from its long side:

        >>> from rocking.bodies.solid import box
        >>> side = Solid(box(1.0, 2.0, 4.0)).in_plane(np.pi / 2)
        >>> round(side.slenderness_ratio, 12), round(side.depth, 12)
        (2.0, 1.0)
        """
        from rocking.bodies.solid.standing import plane_body

        seen = self.turned(-checks.number("azimuth", azimuth, "rad"))
        return plane_body(seen.local_parts, seen.local_base, seen.local_moments)

    def turned(self, angle: float) -> "Solid":
        """Return the body turned about the vertical through its own origin.

        Parameters
        ----------
        angle : float
            Angle, counter-clockwise seen from above [rad].

        Returns
        -------
        Solid
            The same body, another way round.
        """
        turn = rotation_about((0.0, 0.0, 1.0), angle)
        return self._copy([part.turned((0.0, 0.0, 1.0), angle) for part in self.local_parts], turn)

    def mirrored(self) -> "Solid":
        """Return the body seen in the mirror x -> -x through its own origin.

        Returns
        -------
        Solid
            The mirror image.
        """
        return self._copy([part.mirrored() for part in self.local_parts], np.diag([-1.0, 1.0, 1.0]))

    def scaled(self, *, size: float = 1.0, density: float = 1.0) -> "Solid":
        """Return the body with all lengths times `size` and all densities times `density`.

        Parameters
        ----------
        size, density : float
            Factors [-].

        Returns
        -------
        Solid
            The scaled body, about its own origin.
        """
        factor = checks.positive("size", size)
        checks.length("size of the scaled body", self._size * factor)
        parts = [part.scaled(size=factor, density=density) for part in self.local_parts]
        return self._copy(parts, np.eye(3), factor, density)

    def equilibria(self, *, min_barrier: float | None = None) -> Equilibria:
        """Return in how many ways the body can stand or be balanced on level ground, exact on its convex hull.

        Parameters
        ----------
        min_barrier : float, optional
            Stable poses from which a smaller rise of the centre leads into a lower one are not poses of their own [m];
            by default 0, and 1e-4 of the size with round faces, which are taken as those of 360 corners.

        Returns
        -------
        Equilibria
            Stable poses, saddles and summits, in the user's coordinates, with the passes and barriers between them.

        Examples
        --------
        >>> from rocking.bodies.solid import cylinder
        >>> found = Solid(cylinder(1.0, 3.0)).equilibria()
        >>> len(found.stable), [ring.kind for ring in found.rings]
        (2, ['stable', 'summit', 'summit'])
        """
        moments = self.local_moments
        placed = replace(moments, centre=self.centre)
        found = equilibria_of(self.parts, placed, self._size, min_barrier)
        stands = next((pose for pose in found.stable if pose.down[2] < _UPRIGHT - 1.0), None)
        base = self.base
        if stands and isinstance(base, SupportPolygon) and _area(base.vertices) < _WHOLE * _area(stands.support):
            return replace(found, notes=(*found.notes, _OWN_BASE))
        return found

    def settled(self, pose: StablePose | None = None) -> "Solid":
        """Return the body set down in one of its stable poses.

        Parameters
        ----------
        pose : StablePose, optional
            Of its `equilibria`; by default the one into which it settles from the way up that it has.

        Returns
        -------
        Solid
            The body on that facet of its convex hull, on the ground z = 0, its centre of mass above (0, 0).

        Examples
        --------
        >>> from rocking.bodies.solid import box
        >>> solid = Solid(box(1.0, 2.0, 3.0))
        >>> lying = solid.settled(solid.equilibria().stable[0])
        >>> round(float(lying.centre[2]), 12)
        0.5
        """
        given: object = pose
        if given is not None and not isinstance(given, StablePose):
            raise InvalidValueError(
                "pose must be one of the stable poses of `equilibria`, got {pose}", pose=f"{given!r:.60}"
            )
        chosen = self.equilibria().settling((0.0, 0.0, -1.0)) if pose is None else pose
        parts, base = set_down(self.parts, chosen, self._size)
        ground = min(float(part.box()[0, 2]) for part in parts)
        turn, known = chosen.rotation, dict[str, Any]()
        if self.known is not None:
            inertia = times(times(turn, self.known.inertia), turn.T)
            known = {"centre": (0.0, 0.0, chosen.height), "inertia": inertia}
        result = Solid(parts, base=base, ground=ground, **known)
        result.name, result.repairs, result._assumed = self.name, self.repairs, self._assumed
        result.turn = times(turn, self.turn)
        return result

    def _copy(self, parts: list[Part], matrix: FloatArray, size: float = 1.0, density: float = 1.0) -> "Solid":
        # not checked again: a similarity keeps a valid body valid
        result = object.__new__(Solid)
        result.name, result.repairs, result.turn = self.name, self.repairs, times(matrix, self.turn)
        result._ground, result._size, result.origin = self._ground, self._size * size, self.origin
        result.local_parts = tuple(parts)
        result.local_base = self.local_base.changed(size * matrix[:2, :2], np.zeros(3))
        result.known = self.known and similar(self.known, matrix, size, density)
        result._assumed = self._assumed
        return result

    def _placed_base(self, base: Base | ArrayLike | None, tolerance: float) -> Base:
        if isinstance(base, Base):
            return base.changed(np.eye(2), -self.origin)
        if base is not None:
            points = checks.real_array("base", base, "m")
            return hull(points - self.origin[:2] if points.ndim == 2 and points.shape[1:] == (2,) else points)
        return found_base(self.local_parts, tolerance)

    def _check_support(self) -> None:
        centre = self.local_moments.centre
        if self.local_base.margin(centre[:2]) <= 1e-12 * self._size:
            x, y = (self.origin + centre)[:2].tolist()
            raise GeometryError(
                "the centre of mass (x = {x:.6g}, y = {y:.6g} m) must lie above the base", x=x, y=y,
                hint="a body like this falls over by itself",
            )  # fmt: skip
        plausibility.warn(self.doubts)


def _weighing(parts: Sequence[Part], density: float) -> tuple[Part, ...]:
    return tuple(Part(p.shape, density, rotation=p.rotation, translation=p.translation) for p in parts)


def found_base(parts: Sequence[Part], tolerance: float) -> Base:
    """Return what parts stand on: the hull of their corners on the ground, or the round face there."""
    prints = [footprint(part, 0.0, tolerance) for part in parts]
    points = np.concatenate([print_[0] for print_ in prints])
    discs = [disc for print_ in prints for disc in print_[1]]
    if not discs:
        return hull(points)
    centre, radius = max(discs, key=lambda disc: disc[1])
    circle = RoundBase(centre, radius)
    slack = -1e-9 * radius
    inside_points = all(circle.margin(point) >= slack for point in points)
    if inside_points and all(circle.margin(c) >= r + slack for c, r in discs):
        return circle
    polygon = hull(points) if len(points) > 2 else None
    if polygon is not None and all(polygon.margin(c) >= r + slack for c, r in discs):
        return polygon
    raise GeometryError(
        "the body stands on round faces and corners that reach beyond each other; pass base= with points"
    )


def _listed(parts: Any) -> list[Part]:
    given = [parts] if isinstance(parts, (Part, Shape)) else parts
    listed = list(given) if isinstance(given, Sequence) else []
    if not listed or not all(isinstance(part, (Part, Shape)) for part in listed):
        raise GeometryError("a Solid needs at least one Part(shape, density) or shape")
    return [part if isinstance(part, Part) else Part(part) for part in listed]


def _area(polygon: FloatArray) -> float:
    x, y = polygon.T
    return 0.5 * abs(float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum()))
