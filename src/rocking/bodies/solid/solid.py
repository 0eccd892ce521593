"""A rigid 3D body: parts of any shape and density on a base."""

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
    "the base of the body is smaller than the facet of its hull: uplift and energy barriers here are those of the "
    "complete facet, and overestimate those of the base"
)
"""Message about a base smaller than its facet."""


class Solid:
    """A rigid 3D body on horizontal ground.

    Parameters
    ----------
    parts : Part, Shape, or sequence of them
        Parts of one rigid body; they may touch but not overlap. A shape without density has that of plain concrete,
        2400 kg/m3.
    base : array_like, shape (n, 2), or Base, optional
        Points (x, y) of the base [m]; the default is the corners or the round face on the ground.
    ground : float
        Height of the ground, equal to that of the lowest point [m].
    base_tolerance : float, optional
        Largest height of base corners above the ground [m]; the default is 1e-9 x body size.
    mass : float, optional
        Known mass, in place of densities [kg].
    centre : (float, float, float), optional
        Known centre of mass (x, y, z) [m]; the default is that of the parts.
    inertia : array_like, shape (3, 3) or (3,), optional
        Known inertia about the centre of mass, with axes along x, y and z [kg m2]: the tensor, or three moments for
        principal axes.

    Attributes
    ----------
    name : str
        Name in the file, or name of the file; empty without a file.
    repairs : tuple of str
        One sentence for each change of the mesh in the file, and for each doubt about the mesh.
    turn : ndarray, shape (3, 3)
        Rotation from the axes of the mesh in the file to those of the body [-]; the identity without a mesh.

    Raises
    ------
    GeometryError
        If parts overlap or have impossible moments, the body does not touch the ground, the base has no area, the
        centre of mass is not above the base, or the known centre of mass or inertia is impossible for the body.
    InvalidValueError
        If a number is not finite, or mass and densities are both given.

    Notes
    -----
    The default inertia for a known centre of mass is that of the parts, scaled along each axis like the largest
    possible second moment in the bounding box. `assumed` contains this assumption. The model ``ked-3d`` needs the mass
    distribution and does not accept a body with known moments only.

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
        self.settling_rotation: float = 0.0  # rotation of an unstable body of a file into a stable pose [rad]
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
                "The lowest point of the body, z = {lowest:.9g} m, is above the ground at {ground:.9g} m. Use "
                "ground={lowest:.9g} or move the parts."
                if lowest > self._ground
                else "The lowest point of the body, z = {lowest:.9g} m, is below the ground at {ground:.9g} m. Use "
                "ground={lowest:.9g} or move the parts.",
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
            known_centre = None if centre is None else checked_centre(centre, self.origin)
            part_moments = combined(part.moments() for part in self.local_parts)
            self.known = known_moments(self.local_parts, part_moments, known_centre, inertia)
            self._assumed = () if inertia is not None else (ASSUMED,)
        self.local_base = self._placed_base(base, tolerance)
        self._check_support()

    def __repr__(self) -> str:
        base = self.local_base
        kind = f"{len(base.vertices)} corners" if isinstance(base, SupportPolygon) else "a circle"
        return f"Solid({len(self.local_parts)} part(s), {self.mass:g} kg, on {kind})"

    @classmethod
    def from_section(cls, section: Section | Block) -> "Solid":
        """Return a 2D body as a 3D body: its polygons extruded over its depth, along y.

        Parameters
        ----------
        section : Section or Block
            2D body; its y becomes z, and its depth is symmetric about the plane y = 0.

        Returns
        -------
        Solid
            One prism per region, on the feet of the section. A known centre of mass or moment of inertia stays, with a
            uniform mass over the depth.

        Examples
        --------
        >>> import rocking as rk
        >>> Solid.from_section(rk.Section.from_rectangle(1.0, 4.0, density=1.0)).mass
        4.0
        """
        section = section.to_section() if isinstance(section, Block) else section
        rotation = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
        translation = (section.origin_x, 0.5 * section.depth, section.ground)
        parts = [
            Part(Prism(r, section.depth), r.density, rotation=rotation, translation=translation)
            for r in section.regions
        ]
        half = 0.5 * section.depth
        feet = [(x, y) for x in section.feet for y in (-half, half)]
        if section.known is None:
            return cls(parts, base=feet, ground=section.ground)
        moments, (x, z) = section.local_moments, section.centre
        along, across, up = moments.xx, moments.mass * section.depth**2 / 12.0, moments.yy
        inertia = (across + up, along + up, along + across)
        solid = cls(parts, base=feet, ground=section.ground, centre=(x, 0.0, z), inertia=inertia)
        solid._assumed = (*section.known.assumed[:-1], Message("mass uniform over the depth"))
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
        """Mass, centre of mass and central second moments relative to `origin`, known or of the parts."""
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
        """Base in the user's coordinates."""
        return self.local_base.changed(np.eye(2), self.origin)

    @property
    def parts(self) -> tuple[Part, ...]:
        """Parts in the user's coordinates."""
        return tuple(part.moved(*self.origin.tolist()) for part in self.local_parts)

    @property
    def assumed(self) -> tuple[str, ...]:
        """Assumed values, as texts."""
        return (
            *(Message("density {assumed}", {"assumed": text}) for text in assumed_density(self.densities)),
            *self._assumed,
        )

    @property
    def densities(self) -> tuple[float, ...]:
        """Density of each part [kg/m3]."""
        return tuple(part.density for part in self.local_parts)

    @property
    def doubts(self) -> tuple[str, ...]:
        """Warnings about implausible values, as texts."""
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
        """Return the results of the body.

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
        """Return the 2D body that rocks in one direction, between the ends of the base.

        If no edge of the base is normal to the direction, the ends are corners. The uplift of the solid about an edge
        then occurs at a smaller acceleration, see `equilibria`.

        Parameters
        ----------
        azimuth : float
            Azimuth of x of the 2D body, counter-clockwise from x of the solid, seen from above [rad].

        Returns
        -------
        Section
            Convex hull of the silhouette on the ends of the base, with mass, centre of mass and moment of inertia of
            the solid. x = 0 is the middle of the box of the solid, and y = 0 the ground. `assumed` of the section
            contains the mass distribution for the models that need it.

        Examples
        --------
        A box of 1 x 2 x 4 m, seen along x:

        >>> from rocking.bodies.solid import box
        >>> side = Solid(box(1.0, 2.0, 4.0)).in_plane(np.pi / 2)
        >>> round(side.slenderness_ratio, 12), round(side.depth, 12)
        (2.0, 1.0)
        """
        from rocking.bodies.solid.standing import plane_body

        turned_body = self.turned(-checks.number("azimuth", azimuth, "rad"))
        return plane_body(turned_body.local_parts, turned_body.local_base, turned_body.local_moments)

    def turned(self, angle: float) -> "Solid":
        """Return the body rotated about the vertical axis through its own origin.

        Parameters
        ----------
        angle : float
            Angle, counter-clockwise seen from above [rad].

        Returns
        -------
        Solid
            Rotated body.
        """
        turn = rotation_about((0.0, 0.0, 1.0), angle)
        return self._copy([part.turned((0.0, 0.0, 1.0), angle) for part in self.local_parts], turn)

    def mirrored(self) -> "Solid":
        """Return the body mirrored, x -> -x, about its own origin.

        Returns
        -------
        Solid
            Mirrored body.
        """
        return self._copy([part.mirrored() for part in self.local_parts], np.diag([-1.0, 1.0, 1.0]))

    def scaled(self, *, size: float = 1.0, density: float = 1.0) -> "Solid":
        """Return the body with scaled lengths and densities.

        Parameters
        ----------
        size, density : float
            Scale factors of all lengths and of all densities [-].

        Returns
        -------
        Solid
            Body scaled about its own origin.
        """
        factor = checks.positive("size", size)
        checks.length("size of the scaled body", self._size * factor)
        parts = [part.scaled(size=factor, density=density) for part in self.local_parts]
        return self._copy(parts, np.eye(3), factor, density)

    def equilibria(self, *, min_barrier: float | None = None) -> Equilibria:
        """Return all equilibria of the body on horizontal ground, exact on its convex hull.

        Parameters
        ----------
        min_barrier : float, optional
            Ignore stable poses with a smaller energy barrier: rise of the centre of mass on a path to a lower pose [m].
            The default is 0, and 1e-4 x size for round faces, which are polygons with 360 corners.

        Returns
        -------
        Equilibria
            Stable poses, saddles and summits in the user's coordinates, with passes and energy barriers.

        Raises
        ------
        InvalidValueError
            If `min_barrier` is negative, or larger than the largest dimension of the body.

        Examples
        --------
        >>> from rocking.bodies.solid import cylinder
        >>> equilibria = Solid(cylinder(1.0, 3.0)).equilibria()
        >>> len(equilibria.stable), [ring.kind for ring in equilibria.rings]
        (2, ['stable', 'summit', 'summit'])
        """
        if min_barrier is not None:
            min_barrier = checks.within("min_barrier", min_barrier, 0.0, self._size, unit="m", hint="check the unit")
        moments = self.local_moments
        placed = replace(moments, centre=self.centre)
        equilibria = equilibria_of(self.parts, placed, self._size, min_barrier)
        upright_pose = next((pose for pose in equilibria.stable if pose.down[2] < _UPRIGHT - 1.0), None)
        base = self.base
        if (
            upright_pose
            and isinstance(base, SupportPolygon)
            and _area(base.vertices) < _WHOLE * _area(upright_pose.support)
        ):
            return replace(equilibria, notes=(*equilibria.notes, _OWN_BASE))
        return equilibria

    def settled(self, pose: StablePose | None = None) -> "Solid":
        """Return the body in one of its stable poses.

        Parameters
        ----------
        pose : StablePose, optional
            A pose of its `equilibria`; the default is the pose that the body reaches from its present one.

        Returns
        -------
        Solid
            Body on this facet of its convex hull, with the ground z = 0 and the centre of mass above (0, 0).

        Examples
        --------
        >>> from rocking.bodies.solid import box
        >>> solid = Solid(box(1.0, 2.0, 3.0))
        >>> lying = solid.settled(solid.equilibria().stable[0])
        >>> round(float(lying.centre[2]), 12)
        0.5
        """
        candidate: object = pose
        if candidate is not None and not isinstance(candidate, StablePose):
            raise InvalidValueError("pose must be a stable pose of `equilibria`, got {pose}", pose=f"{candidate!r:.60}")
        chosen = self.equilibria().settling((0.0, 0.0, -1.0)) if pose is None else pose
        parts, base = set_down(self.parts, chosen, self._size)
        ground = min(float(part.box()[0, 2]) for part in parts)
        rotation, moments = chosen.rotation, dict[str, Any]()
        if self.known is not None:
            inertia = times(times(rotation, self.known.inertia), rotation.T)
            moments = {"centre": (0.0, 0.0, chosen.height), "inertia": inertia}
        result = Solid(parts, base=base, ground=ground, **moments)
        result.name, result.repairs, result._assumed = self.name, self.repairs, self._assumed
        result.turn = times(rotation, self.turn)
        return result

    def _copy(self, parts: list[Part], matrix: FloatArray, size: float = 1.0, density: float = 1.0) -> "Solid":
        # no checks, because a similarity transformation of a valid body is valid
        result = object.__new__(Solid)
        result.name, result.repairs, result.turn = self.name, self.repairs, times(matrix, self.turn)
        result.settling_rotation = self.settling_rotation
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
                hint="this body is not stable",
            )  # fmt: skip
        plausibility.warn(self.doubts)


def _weighing(parts: Sequence[Part], density: float) -> tuple[Part, ...]:
    return tuple(Part(p.shape, density, rotation=p.rotation, translation=p.translation) for p in parts)


def found_base(parts: Sequence[Part], tolerance: float) -> Base:
    """Return the base of parts: the hull of their corners on the ground, or their round face on the ground."""
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
        "The base consists of separate round faces and corners, and has no simple outline. Use base= with points."
    )


def _listed(parts: Any) -> list[Part]:
    items = [parts] if isinstance(parts, (Part, Shape)) else parts
    listed = list(items) if isinstance(items, Sequence) else []
    if not listed or not all(isinstance(part, (Part, Shape)) for part in listed):
        raise GeometryError("A Solid needs at least one Part(shape, density) or shape.")
    return [part if isinstance(part, Part) else Part(part) for part in listed]


def _area(polygon: FloatArray) -> float:
    x, y = polygon.T
    return 0.5 * abs(float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum()))
