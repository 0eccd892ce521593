"""A body as its convex hull meets the ground: vertices, mass, centre of mass and inertia."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.spatial import ConvexHull

from rocking import checks
from rocking.conventions import FloatArray
from rocking.dynamics.hull.vectors import Frame, Vector, length
from rocking.errors import GeometryError, InvalidValueError
from rocking.portable import inverse

_MERGED = 1e-9


@dataclass(frozen=True, eq=False)
class HullBody:
    """A rigid body that touches the ground with the vertices of its convex hull.

    Parameters
    ----------
    vertices : array_like, shape (k, 3)
        Points of the body; those inside the convex hull are left out [m].
    mass : float
        Mass [kg].
    centre : array_like, shape (3,)
        Centre of mass, in the axes of the vertices [m].
    inertia : array_like, shape (3, 3)
        Inertia tensor about the centre of mass [kg m2].
    solid : Solid, optional
        The body as a distribution of mass, for laws of restitution that need it; its own frame is that of the vertices.

    Raises
    ------
    InvalidValueError
        If a value is outside its range.
    GeometryError
        If the points span no volume.

    Examples
    --------
    >>> cube = HullBody.box(1.0, 1.0, 1.0, mass=1.0)
    >>> len(cube.points), cube.size == 0.75**0.5
    (8, True)
    """

    vertices: Any
    mass: float
    centre: Any
    inertia: Any
    solid: Any = None

    def __post_init__(self) -> None:
        """Check the values and keep the vertices of the hull."""
        object.__setattr__(self, "mass", checks.within("mass", self.mass, 0.0, math.inf, unit="kg", open_low=True))
        for name, shape in (("vertices", (-1, 3)), ("centre", (3,)), ("inertia", (3, 3))):
            values = np.array(getattr(self, name), dtype=np.float64)
            fits = values.ndim == len(shape) and all(n in (-1, m) for n, m in zip(shape, values.shape, strict=True))
            if not (fits and np.isfinite(values).all()):
                raise InvalidValueError(f"{name} must be {shape} finite numbers (-1: any count), got {values!r:.60}")
            object.__setattr__(self, name, values)
        moments = np.linalg.eigvalsh(self.inertia)
        if not moments[0] > 0.0 or np.abs(self.inertia - self.inertia.T).max() > 1e-9 * moments[2]:
            raise InvalidValueError(f"inertia must be symmetric with principal moments > 0, got {moments}")
        try:
            hull = ConvexHull(self.vertices)
        except Exception as error:
            raise GeometryError(
                f"vertices must span a volume, at least four of them, got {self.vertices!r:.80}"
            ) from error
        object.__setattr__(self, "vertices", self.vertices[np.sort(hull.vertices)])

    @classmethod
    def box(cls, x: float, y: float, z: float, mass: float) -> "HullBody":
        """Return a homogeneous box with the middle of its base at the origin.

        Parameters
        ----------
        x, y, z : float
            Full sizes [m].
        mass : float
            Mass [kg].

        Returns
        -------
        HullBody
            The box.
        """
        corners = [(sx * x, sy * y, sz * z) for sx in (-0.5, 0.5) for sy in (-0.5, 0.5) for sz in (0.0, 1.0)]
        inertia = mass / 12.0 * np.diag([y * y + z * z, x * x + z * z, x * x + y * y])
        return cls(corners, mass, (0.0, 0.0, 0.5 * z), inertia)

    @cached_property
    def points(self) -> list[Vector]:
        """Vertices, from the centre of mass [m]."""
        return [(float(p[0]), float(p[1]), float(p[2])) for p in self.vertices - self.centre]

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
    def facets(self) -> list[tuple[Vector, float]]:
        """Outward normals of the facets, and distances from the centre of mass; coplanar ones are merged [-], [m]."""
        found: list[tuple[Vector, float]] = []
        for a, b, c, d in ConvexHull(self.vertices - self.centre).equations:
            normal = (float(a), float(b), float(c))
            if not any(sum(x * y for x, y in zip(normal, n, strict=True)) > 1.0 - _MERGED for n, _ in found):
                found.append((normal, -float(d)))
        return found


def _rows(matrix: FloatArray) -> Frame:
    a, b, c = (tuple(float(v) for v in row) for row in matrix)
    return a, b, c  # type: ignore[return-value]
