"""Base of a solid: a polygon with corners and edges, or a circle."""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import GeometryError
from rocking.messages import Range
from rocking.portable import applied, dot, norm, times


@dataclass(frozen=True, slots=True, eq=False)
class Corner:
    """A pivot point of a body on the ground."""

    point: FloatArray  # position [m]; shape (3,)


@dataclass(frozen=True, slots=True, eq=False)
class Edge:
    """A rotation axis on the ground; the direction is that of the angular velocity of an outward rotation."""

    point: FloatArray  # a point on the edge [m]; shape (3,)
    direction: FloatArray  # unit vector, counter-clockwise around the base seen from above [-]; shape (3,)


class Base(ABC):
    """Base of a solid on the ground."""

    height: float  # height of the ground [m]

    @abstractmethod
    def margin(self, point: FloatArray) -> float:
        """Return the distance of a point (x, y) from the border of the base, negative outside [m]."""

    @property
    @abstractmethod
    def size(self) -> float:
        """Largest extent of the base [m]."""

    @abstractmethod
    def edge(self, which: float) -> Edge:
        """Return the edge with index `which` of a polygon, or the tangent of a circle at the azimuth `which` [rad]."""

    @abstractmethod
    def changed(self, matrix: FloatArray, shift: FloatArray) -> "Base":
        """Return the base after a similarity transformation: (2, 2) matrix [-], then (3,) shift [m]."""

    @abstractmethod
    def answer(self) -> dict[str, Any]:
        """Return type and geometry of the base as plain values."""


@dataclass(frozen=True, eq=False)
class RoundBase(Base):
    """A circular base."""

    centre: FloatArray  # centre (x, y) [m]
    radius: float  # radius of the circle [m]
    height: float = 0.0  # height of the ground [m]

    @property
    def size(self) -> float:
        return 2.0 * self.radius

    def edge(self, which: float) -> Edge:
        angle = checks.number("edge", which, "rad")
        outward = np.array([math.cos(angle), math.sin(angle)])
        point = np.array([*(self.centre + self.radius * outward), self.height])
        return Edge(point, np.array([-outward[1], outward[0], 0.0]))

    def margin(self, point: FloatArray) -> float:
        return self.radius - norm(point - self.centre)

    def changed(self, matrix: FloatArray, shift: FloatArray) -> "RoundBase":
        scale = math.sqrt(abs(_area_factor(matrix)))
        return RoundBase(applied(matrix, self.centre) + shift[:2], self.radius * scale, self.height * scale + shift[2])

    def answer(self) -> dict[str, Any]:
        return {"kind": "circle", "base_centre": self.centre, "base_radius": self.radius}


def _area_factor(matrix: FloatArray) -> float:
    return float(matrix[0, 0] * matrix[1, 1] - matrix[0, 1] * matrix[1, 0])


_INSIDE = 1e-12


@dataclass(frozen=True, eq=False)
class SupportPolygon(Base):
    """The convex hull of the contact points of a solid."""

    vertices: FloatArray  # corners of the hull, counter-clockwise seen from above [m]; shape (n, 2)
    height: float = 0.0  # height of the ground [m]

    @property
    def size(self) -> float:
        return float(np.ptp(self.vertices, axis=0).max())

    @property
    def corners(self) -> list[Corner]:
        """Corners in the order of `vertices`."""
        return [Corner(np.array([x, y, self.height])) for x, y in self.vertices.tolist()]

    @property
    def edges(self) -> list[Edge]:
        """Edges; edge i runs from corner i to the next corner."""
        return [self.edge(i) for i in range(len(self.vertices))]

    def edge(self, which: float) -> Edge:
        number = checks.number("edge", which)
        if number != int(number) or not 0 <= number < len(self.vertices):
            raise GeometryError(
                "{parameter} must be a whole number {allowed}, got {value}", parameter="edge",
                allowed=Range(0, len(self.vertices) - 1), value=which,
            )  # fmt: skip
        start, end = self.vertices[int(number)], self.vertices[(int(number) + 1) % len(self.vertices)]
        along = (end - start) / norm(end - start)
        return Edge(np.array([*start, self.height]), np.array([*along, 0.0]))

    def opposite(self, which: int) -> Edge:
        """Return the opposite edge parallel to a given edge; raise an error if the body lands on a corner."""
        along = self.edge(which).direction
        for edge in self.edges:
            if dot(edge.direction, along) < -1.0 + 1e-12:
                return edge
        raise GeometryError("No edge of the base is parallel to edge {edge}; the body lands on a corner.", edge=which)

    def margin(self, point: FloatArray) -> float:
        along = np.roll(self.vertices, -1, axis=0) - self.vertices
        arm = point - self.vertices
        return float(((along[:, 0] * arm[:, 1] - along[:, 1] * arm[:, 0]) / np.linalg.norm(along, axis=1)).min())

    def changed(self, matrix: FloatArray, shift: FloatArray) -> "SupportPolygon":
        moved, area = times(self.vertices, matrix.T) + shift[:2], _area_factor(matrix)
        scale = math.sqrt(abs(area))
        return SupportPolygon(moved if area > 0.0 else moved[::-1], self.height * scale + shift[2])

    def answer(self) -> dict[str, Any]:
        return {"kind": "polygon", "base_vertices": self.vertices}


def hull(points: ArrayLike) -> SupportPolygon:
    """Return the convex hull of points (x, y) on the ground z = 0 [m], without points on straight edges.

    >>> len(hull([(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0.0), (0.5, 0.5)]).vertices)
    4
    """
    array = checks.real_array("base points", points, "m")
    if array.ndim != 2 or array.shape[1:] != (2,) or not np.isfinite(array).all():
        raise GeometryError("base points must be a list of finite points (x, y) in m")
    ordered = np.unique(array, axis=0)
    size = float(np.ptp(ordered, axis=0).max(initial=0.0)) if len(ordered) else 0.0
    slack = _INSIDE * size * size
    chain = _chain(ordered, slack)[:-1] + _chain(ordered[::-1], slack)[:-1]
    if len(ordered) < 3 or len(chain) < 3:
        raise GeometryError(
            "The base has {count} point(s) on one line; a base with an area is needed. Use base= with contact points, "
            "or increase base_tolerance.", count=len(ordered),
        )  # fmt: skip
    return SupportPolygon(np.array(chain))


def _chain(points: FloatArray, slack: float) -> list[FloatArray]:
    chain: list[FloatArray] = []
    for c in points:
        while len(chain) > 1:
            a, b = chain[-2:]
            if float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) > slack:
                break
            chain.pop()
        chain.append(c)
    return chain
