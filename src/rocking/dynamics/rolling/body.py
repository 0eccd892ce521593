"""Rigid 3D body: mass, centre of mass, inertia and base, and the solid from which they were computed."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies.solid import Base, Part, RoundBase, Solid, SolidMoments, SupportPolygon, box, cylinder
from rocking.conventions import FloatArray
from rocking.errors import GeometryError, InvalidValueError
from rocking.portable import applied, dot, norm


@dataclass(frozen=True, eq=False)
class Matter:
    """Solid in the axes of a body. The solid is created at first access, because few impact models need it."""

    make: Callable[[], Solid]  # returns the solid
    shift: FloatArray  # origin of the body axes in the coordinates of the solid [m]; shape (3,)

    @cached_property
    def placed(self) -> tuple[Solid, FloatArray]:
        """The solid, and the origin of the frame of the solid in axes of the body [m]."""
        solid = self.make()
        return solid, solid.origin - self.shift

    def __call__(self) -> tuple[Solid, FloatArray]:
        """Return `placed`, in the form that impacts need."""
        return self.placed


# only functions at module level can be pickled
def _box(width: float, depth: float, height: float, density: float) -> Solid:
    return Solid(Part(box(width, depth, height), density))


def _cylinder(diameter: float, height: float, density: float) -> Solid:
    return Solid(Part(cylinder(diameter, height), density))


def _same(solid: Solid) -> Solid:
    return solid


_ROUNDING = 1e-9
_NAMES = {
    "inertia": ("inertia", "inertia_tensor"),
    "base": ("base", "support_polygon", "base_radius"),
}


@dataclass(frozen=True, eq=False)
class SpatialBody:
    """Rigid body with its base on the plane z = 0 of its axes.

    Parameters
    ----------
    mass : float
        Mass [kg].
    centre : array_like, shape (3,)
        Centre of mass [m]; z is the height over the base.
    inertia : array_like, shape (3, 3)
        Inertia tensor about the centre of mass, in body axes [kg m2].
    base : array_like, shape (k, 2), or float
        Vertices of the convex support polygon [m], counter-clockwise as seen from above; or radius of a round base
        about the origin [m].

    Attributes
    ----------
    matter : Matter or None
        Distribution of mass; available for a `Solid`, a `box` and a `cylinder`.

    Raises
    ------
    InvalidValueError
        If a value is not finite, or the inertia is not physical.
    GeometryError
        If the polygon is not convex and counter-clockwise, or if the centre of mass is not above the base.

    Examples
    --------
    >>> body = SpatialBody.box(width=1.0, depth=1.0, height=4.0, density=2400.0)
    >>> body.mass, body.vertices.shape
    (9600.0, (4, 3))
    """

    mass: float
    centre: FloatArray
    inertia: FloatArray
    base: FloatArray | float
    matter: Matter | None = field(default=None, init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "mass", checks.positive("mass", self.mass, "kg"))
        object.__setattr__(self, "centre", checks.finite("centre", self.centre, "m", (3,)))
        object.__setattr__(self, "inertia", checked_inertia(self.inertia))
        if np.ndim(self.base) == 0:
            object.__setattr__(self, "base", checks.length("radius of the base", self.base))
        else:
            object.__setattr__(self, "base", _polygon(self.base))
        checks.length("height of the centre of mass", float(self.centre[2]))
        if not self.reach > 0.0:
            raise GeometryError(
                "the centre of mass must be above the base, got {outside:g} m outside, at ({x:g}, {y:g})",
                outside=-self.reach, x=float(self.centre[0]), y=float(self.centre[1]),
                hint="the body would overturn under its weight",
            )  # fmt: skip

    @classmethod
    def box(cls, width: float, depth: float, height: float, density: float = 1000.0) -> "SpatialBody":
        """Return a homogeneous box whose base is centred over the origin.

        Parameters
        ----------
        width, depth, height : float
            Full sizes along x, y and z [m].
        density : float
            Density [kg/m3].

        Returns
        -------
        SpatialBody
            The box.
        """
        x, y, z = (checks.length(n, v) for n, v in (("width", width), ("depth", depth), ("height", height)))
        mass = checks.density("density", density) * x * y * z
        inertia = mass / 12.0 * np.diag([y * y + z * z, x * x + z * z, x * x + y * y])
        corners = 0.5 * np.array([[-x, -y], [x, -y], [x, y], [-x, y]])
        body = cls(mass, np.array([0.0, 0.0, 0.5 * z]), inertia, corners)
        return body._with_matter(Matter(partial(_box, x, y, z, density), np.zeros(3)))

    @classmethod
    def cylinder(cls, diameter: float, height: float, density: float = 1000.0) -> "SpatialBody":
        """Return a homogeneous upright cylinder whose base is centred over the origin.

        Parameters
        ----------
        diameter, height : float
            Full sizes [m].
        density : float
            Density [kg/m3].

        Returns
        -------
        SpatialBody
            The cylinder.
        """
        b, z = 0.5 * checks.length("diameter", diameter), checks.length("height", height)
        mass = checks.density("density", density) * math.pi * b * b * z
        across = mass * (b * b / 4.0 + z * z / 12.0)
        body = cls(mass, np.array([0.0, 0.0, 0.5 * z]), np.diag([across, across, 0.5 * mass * b * b]), b)
        return body._with_matter(Matter(partial(_cylinder, 2.0 * b, z, density), np.zeros(3)))

    @classmethod
    def of(cls, body: Any) -> "SpatialBody":
        """Return a body with mass, centre of mass, inertia and base as a `SpatialBody`.

        Parameters
        ----------
        body : Any
            Object with `mass` [kg], `centre` [m], `inertia` (or `inertia_tensor`) [kg m2] and `base`: vertices
            (k, 2) [m], a radius [m], or an object with `vertices` or `radius` and optionally `centre` and `height`. The
            origin is moved to the height of the base, and to the centre of a round base.

        Returns
        -------
        SpatialBody
            The body; the argument itself if it is a `SpatialBody`.

        Raises
        ------
        InvalidValueError
            If an attribute is missing.
        """
        if isinstance(body, cls):
            return body
        values = {name: _attribute(body, _NAMES.get(name, (name,))) for name in ("mass", "centre", "inertia", "base")}
        base = values["base"]
        origin = np.array([0.0, 0.0, getattr(base, "height", 0.0)])
        if getattr(base, "radius", None) is not None:
            origin[:2] = getattr(base, "centre", (0.0, 0.0))
        shape = next((getattr(base, n) for n in ("radius", "vertices") if getattr(base, n, None) is not None), base)
        spatial = cls(values["mass"], np.asarray(values["centre"]) - origin, values["inertia"], shape)
        spread = isinstance(body, Solid) and body.known is None  # known moments define no mass distribution
        return spatial._with_matter(Matter(partial(_same, body), origin)) if spread else spatial

    def _with_matter(self, matter: Matter) -> "SpatialBody":
        # not an argument of the constructor, because a solid with another mass or inertia would give wrong energies
        object.__setattr__(self, "matter", matter)
        return self

    @property
    def facts(self) -> dict[str, Any]:
        """Mass, centre of mass, inertia and base as plain values."""
        return {
            "mass": self.mass,
            "centre": self.centre.tolist(),
            "inertia": np.ravel(self.inertia).tolist(),
            "base_radius" if self.round else "base_vertices": np.ravel(self.base).tolist(),
        }

    @property
    def round(self) -> bool:
        """True if the base is a circle."""
        return np.ndim(self.base) == 0

    @cached_property
    def moments(self) -> SolidMoments:
        """Mass, centre of mass and central second moments [kg, m, kg m2]."""
        return SolidMoments(self.mass, self.centre, 0.5 * np.trace(self.inertia) * np.eye(3) - self.inertia)

    @cached_property
    def footprint(self) -> Base:
        """Base in the axes of the body."""
        return RoundBase(np.zeros(2), float(self.base)) if self.round else SupportPolygon(np.asarray(self.base))

    @cached_property
    def radius(self) -> float:
        """Radius of a round base, or largest distance of a vertex of a polygon from the origin [m]."""
        return float(np.hypot(*np.atleast_2d(self.base).T).max()) if not self.round else float(self.base)

    @cached_property
    def vertices(self) -> FloatArray:
        """Vertices of the base with z = 0, shape (k, 3); empty for a round base [m]."""
        if self.round:
            return np.zeros((0, 3))
        return np.column_stack([np.asarray(self.base), np.zeros(len(np.asarray(self.base)))])

    @cached_property
    def edges(self) -> FloatArray:
        """Unit vectors along the edges, from every vertex to the next vertex, shape (k, 3) [-]."""
        along = np.roll(self.vertices, -1, axis=0) - self.vertices
        return np.asarray(along / np.linalg.norm(along, axis=1)[:, None])

    @cached_property
    def inward(self) -> FloatArray:
        """Unit normals of the edges, towards the inside of the base, shape (k, 2) [-]."""
        return np.column_stack([-self.edges[:, 1], self.edges[:, 0]])

    @cached_property
    def reach(self) -> float:
        """Smallest horizontal distance of the centre of mass from the border of the base [m]."""
        if self.round:
            return self.radius - math.hypot(*self.centre[:2])
        return float(((self.centre[:2] - self.vertices[:, :2]) * self.inward).sum(axis=1).min())

    @cached_property
    def size(self) -> float:
        """Largest distance of the centre of mass from a point of contact [m]."""
        if self.round:
            return math.hypot(self.radius + math.hypot(*self.centre[:2]), self.centre[2])
        return float(np.linalg.norm(self.centre - self.vertices, axis=1).max())

    @cached_property
    def lift(self) -> float:
        """Smallest rise of the centre of mass on the way to overturning [m]."""
        height = float(self.centre[2])
        return self.reach**2 / (math.hypot(self.reach, height) + height)  # Eq. 85

    def inertia_about(self, point: FloatArray) -> FloatArray:
        """Return the inertia tensor about a point of the body (Steiner).

        Parameters
        ----------
        point : ndarray, shape (3,)
            In body axes [m].

        Returns
        -------
        ndarray, shape (3, 3)
            In body axes [kg m2].
        """
        arm = self.centre - point
        return np.asarray(self.inertia + self.mass * (dot(arm, arm) * np.eye(3) - np.outer(arm, arm)))  # Eq. 83

    def kinetic(self, point: FloatArray, velocity: FloatArray) -> float:
        """Return the kinetic energy of the body when it turns about a point at rest.

        Parameters
        ----------
        point : ndarray, shape (3,)
            In body axes [m].
        velocity : ndarray, shape (3,)
            Angular velocity in body axes [rad/s].

        Returns
        -------
        float
            Energy [J].
        """
        return 0.5 * dot(velocity, applied(self.inertia_about(point), velocity))  # Eq. 84

    def frequency(self, gravity: float) -> float:
        """Return the frequency parameter of the body, p = sqrt(m g R / I) about an edge.

        Parameters
        ----------
        gravity : float
            Acceleration of gravity [m/s2].

        Returns
        -------
        float
            p, the smallest value over all edges [rad/s].
        """
        if self.round:
            points, axes = np.array([[-self.radius, 0.0, 0.0]]), np.array([[0.0, 1.0, 0.0]])
        else:
            points, axes = self.vertices, self.edges
        frequencies = []
        for point, axis in zip(points, axes, strict=True):
            arm = norm(np.cross(self.centre - point, axis))
            frequencies.append(math.sqrt(self.mass * gravity * arm / (2.0 * self.kinetic(point, axis))))  # Eq. 26
        return min(frequencies)


def _attribute(body: Any, names: tuple[str, ...]) -> Any:
    for name in names:
        if getattr(body, name, None) is not None:
            return getattr(body, name)
    raise InvalidValueError(
        "{parameter} must be {allowed}; a 3D body needs {attributes}, got {type} without this attribute",
        parameter="body",
        allowed="a Block, a Section, MassPoints or a 3D body", attributes=" or ".join(names),
        type=type(body).__name__,
    )  # fmt: skip


def checked_inertia(values: Any) -> FloatArray:
    """Return an inertia tensor. Raise an error if it is not physical."""
    tensor = checks.finite("inertia", values, "kg m2", (3, 3))
    scale = float(np.abs(tensor).max())
    moments = np.linalg.eigvalsh(tensor)
    symmetric = np.abs(tensor - tensor.T).max() <= _ROUNDING * scale
    if not (symmetric and moments[0] > 0.0 and moments[0] + moments[1] >= moments[2] * (1.0 - _ROUNDING)):
        raise InvalidValueError(
            "{parameter} must be {allowed}, got {moments}", parameter="inertia",
            allowed="symmetric with principal moments > 0, none above the sum of the others", moments=str(moments),
        )  # fmt: skip
    return tensor


def _polygon(values: Any) -> FloatArray:
    points = checks.real_array("base", values, "m")
    if points.ndim != 2 or points.shape[0] < 3 or points.shape[1] != 2:
        raise GeometryError(
            "{parameter} must be {allowed}, got shape {shape}", parameter="base",
            allowed="vertices (k, 2) with k >= 3, or a radius [m]", shape=points.shape,
        )  # fmt: skip
    points = checks.finite("base", points, "m", points.shape)
    along = np.roll(points, -1, axis=0) - points
    turns = along[:, 0] * np.roll(along[:, 1], -1) - along[:, 1] * np.roll(along[:, 0], -1)
    around = float(np.arctan2(turns, (along * np.roll(along, -1, axis=0)).sum(axis=1)).sum())
    if not (turns > 0.0).all() or abs(around - 2.0 * math.pi) > 1e-6:
        raise GeometryError("base must be convex, counter-clockwise as seen from above, without repeated vertices")
    return points
