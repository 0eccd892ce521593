"""Rigid body on the vertices of its convex hull: vertices, mass, centre of mass and inertia."""

from copy import copy
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies.equilibria.polytope import Polytope, polytope
from rocking.bodies.solid import Base, Solid
from rocking.conventions import FloatArray
from rocking.dynamics.frictional.ground import Frame, Vector, length
from rocking.dynamics.rolling.body import SpatialBody, checked_inertia
from rocking.errors import GeometryError, InvalidValueError
from rocking.portable import inverse


@dataclass(frozen=True, eq=False)
class HullBody:
    """Rigid body with contact at the vertices of its convex hull.

    >>> from rocking.bodies.solid import box
    >>> cube = HullBody.of(Solid(box(1.0, 1.0, 1.0)))
    >>> len(cube.points), len(cube.hull.normals), cube.size == 0.75**0.5
    (8, 6, True)
    """

    vertices: FloatArray  # points of the body [m]; shape (k, 3); points inside the hull or inside a facet are ignored
    mass: float  # [kg]
    centre: FloatArray  # centre of mass, in the axes of the vertices [m]; shape (3,)
    inertia: FloatArray  # inertia tensor about the centre of mass [kg m2]; shape (3, 3)
    solid: Solid | None = None  # distribution of mass in the axes of the vertices, for laws that need a distribution
    footprint: Base | None = None  # base of the upright body, in the axes of the vertices
    hull: Polytope = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "vertices", checks.finite("vertices", self.vertices, "m", (None, 3)))
        object.__setattr__(self, "mass", checks.positive("mass", self.mass, "kg"))
        object.__setattr__(self, "centre", checks.finite("centre", self.centre, "m", (3,)))
        object.__setattr__(self, "inertia", checked_inertia(self.inertia))
        object.__setattr__(self, "hull", polytope(self.vertices, self.centre))
        _check_inside(self.centre, self.hull)

    @classmethod
    def of(cls, solid: Any) -> "HullBody":
        """Return a solid, or a body with a distribution of mass, as a `HullBody`."""
        # round faces have 360 corners, as in `Solid.equilibria`
        if isinstance(solid, cls):
            return solid
        if isinstance(solid, SpatialBody) and solid.matter is not None:
            solid = solid.matter()[0]
        if not isinstance(solid, Solid):
            raise InvalidValueError(
                "with friction a body must be {allowed}, got {type}, which has a base but no hull",
                parameter="body", allowed="a Solid, a box or a cylinder", type=type(solid).__name__,
            )  # fmt: skip
        moments = solid.local_moments
        points = solid.equilibria().hull_vertices - solid.origin
        mass_distribution = solid if solid.known is None else None  # known moments define no mass distribution
        return cls(points, moments.mass, moments.centre, moments.inertia, mass_distribution, solid.local_base)

    def moved(self, shift: FloatArray) -> "HullBody":
        """Return the body with its centre of mass moved [m].

        Vertices and inertia about the centre of mass do not change.
        """
        hull = self.hull.moved(shift)
        _check_inside(self.centre + shift, hull)
        body: HullBody = object.__new__(HullBody)
        for name in ("vertices", "mass", "inertia", "solid", "footprint"):
            object.__setattr__(body, name, getattr(self, name))
        object.__setattr__(body, "centre", self.centre + shift)
        object.__setattr__(body, "hull", hull)
        return body

    def with_poses_near(self, facet: int, cosine: float) -> "HullBody":
        """Return the body with two poses: 0 for facets with normals near that of `facet`, 1 for other facets."""
        body = copy(self)
        near = (self.hull.normals * self.hull.normals[facet]).sum(axis=1) >= cosine
        body.__dict__["poses"] = np.where(near, 0, 1).tolist()
        return body

    @cached_property
    def points(self) -> list[Vector]:
        """Vertices relative to the centre of mass [m]."""
        return list(map(tuple, self.hull.vertices.tolist()))

    @cached_property
    def compliance(self) -> Frame:
        """Inverse of the inertia tensor [1/(kg m2)]."""
        return _rows(inverse(self.inertia))

    @cached_property
    def tensor(self) -> Frame:
        """Inertia tensor about the centre of mass [kg m2]."""
        return _rows(0.5 * (self.inertia + self.inertia.T))

    @cached_property
    def size(self) -> float:
        """Largest distance of a vertex from the centre of mass [m]."""
        return max(length(p) for p in self.points)

    @cached_property
    def facets(self) -> list[Vector]:
        """Facets as points of the dual hull: outward unit normals / distances from the centre of mass [1/m]."""
        return list(map(tuple, (self.hull.normals / self.hull.heights[:, None]).tolist()))

    @cached_property
    def poses(self) -> list[int]:
        """Index of the stable pose to which the body rolls from each facet; pose 0 has the lowest centre of mass."""
        hull = self.hull
        order = np.lexsort((np.arange(len(hull.heights)), hull.heights))
        number = {int(facet): k for k, facet in enumerate(order[hull.stable[order]])}
        return [number[facet] for facet in hull.rolls.tolist()]

    @cached_property
    def base(self) -> int:
        """Index of the facet on which the body stands in the axes of its vertices, before the tilt."""
        return self.under((0.0, 0.0, 1.0))

    def under(self, up: Vector) -> int:
        """Return the index of the facet under the centre of mass."""
        # up: vertical in body axes [-]
        x, y, z = (self.hull.normals / self.hull.heights[:, None]).T
        return int(np.argmin(x * up[0] + y * up[1] + z * up[2]))  # Eq. 258


def _check_inside(centre: FloatArray, hull: Polytope) -> None:
    if not hull.heights.min() > 0.0:
        raise GeometryError(
            "the centre of mass {centre} m must be inside the hull of the vertices, got {outside:.3g} m outside",
            parameter="centre", centre=centre.tolist(), outside=float(-hull.heights.min()),
            hint="check axes and units",
        )  # fmt: skip


def _rows(matrix: FloatArray) -> Frame:
    a, b, c = (tuple(float(v) for v in row) for row in matrix)
    return a, b, c  # type: ignore[return-value]
