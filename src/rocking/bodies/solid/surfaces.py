"""Base classes of 3D shapes and of their surfaces, with splitting and Gauss sampling of surface cells."""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from rocking import checks
from rocking.bodies.moments import SolidMoments
from rocking.conventions import BoolArray, FloatArray
from rocking.errors import GeometryError
from rocking.portable import applied, gauss_legendre, gauss_rule, times


class Surface(ABC):
    """A surface as an array of cells. Each cell can be split into four, and be sampled by a Gauss rule."""

    @abstractmethod
    def cells(self) -> FloatArray:
        """Return the coarse cells of the surface, without overlaps."""

    @abstractmethod
    def outline(self, cells: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the middle and border points of each cell [m], and outward area vectors at these points [m2]."""

    @abstractmethod
    def split(self, cells: FloatArray) -> FloatArray:
        """Return four cells per cell."""

    @abstractmethod
    def sample(self, cells: FloatArray, order: int) -> tuple[FloatArray, FloatArray]:
        """Return Gauss points of the cells [m] and their area vectors [m2]."""

    @abstractmethod
    def triangles(self, divisions: int) -> FloatArray:
        """Return triangles for figures of the surface [m]."""


@cache
def gauss(order: int) -> tuple[FloatArray, FloatArray]:
    """Return nodes and weights of the Gauss-Legendre rule on [0, 1]."""
    nodes, weights = gauss_legendre(order)
    return 0.5 * (1.0 + nodes), 0.5 * weights


@cache
def gauss_triangle(order: int) -> tuple[FloatArray, FloatArray]:
    """Return barycentric coordinates (n^2, 3) and weights of a rule of degree 2 n - 1 in a triangle; their sum is 1."""
    # The triangle is a collapsed square. Gauss-Jacobi nodes with the weight u towards the collapsed corner preserve
    # the order.
    k = np.arange(1.0, order)
    side = np.sqrt(k * (k + 1.0)) / (2.0 * k + 1.0)
    i = np.arange(order)
    roots, root_weights = gauss_rule(1.0 / ((2.0 * i + 1.0) * (2.0 * i + 3.0)), side)
    nodes, weights = gauss(order)
    u, v = (grid.ravel() for grid in np.meshgrid(0.5 * (1.0 + roots), nodes, indexing="ij"))
    corner_weights = np.stack([1.0 - u, u * (1.0 - v), u * v], axis=1)
    return corner_weights, np.outer(root_weights, weights).ravel()


@cache
def gauss_square(order: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return nodes u, v and weights of the product rule on the unit square."""
    nodes, weights = gauss(order)
    u, v = np.meshgrid(nodes, nodes, indexing="ij")
    return u.ravel(), v.ravel(), np.outer(weights, weights).ravel()


def area_vectors(triangles: FloatArray) -> FloatArray:
    """Return the area vectors of triangles (normal times area) [m2]."""
    a, b, c = np.moveaxis(triangles, 1, 0)
    vectors: FloatArray = 0.5 * np.cross(b - a, c - a)
    return vectors


def boxes(triangles: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return lowest and highest coordinates of each triangle [m]."""
    # a loop over the three corners is several times faster than min and max along the axis
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    return np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)


@dataclass(frozen=True, eq=False)
class TriangleSurface(Surface):
    """Flat triangles."""

    corners: FloatArray  # corners, counter-clockwise seen from outside [m]; shape (n, 3, 3)

    def cells(self) -> FloatArray:
        return self.corners

    def outline(self, cells: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return centroid and corners of each triangle [m], with its area vector [m2] (shape (n, 4, 3))."""
        points = np.concatenate([cells.mean(axis=1, keepdims=True), cells], axis=1)
        return points, np.repeat(area_vectors(cells)[:, None], 4, axis=1)

    def split(self, cells: FloatArray) -> FloatArray:
        """Return the four triangles between corners and midpoints."""
        a, b, c = np.moveaxis(cells, 1, 0)
        ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
        quarters = ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))
        return np.concatenate([np.stack(quarter, axis=1) for quarter in quarters])

    def sample(self, cells: FloatArray, order: int) -> tuple[FloatArray, FloatArray]:
        """Return Gauss points of the collapsed square in each triangle [m], and their area vectors [m2]."""
        corner_weights, weights = gauss_triangle(order)
        points = times(corner_weights, cells)
        areas = weights[:, None] * area_vectors(cells)[:, None]
        return points.reshape(-1, 3), areas.reshape(-1, 3)

    def triangles(self, divisions: int) -> FloatArray:
        """Return the triangles, split down to the largest edge length / `divisions` [m]."""
        cells, done = self.corners, []
        limit = 1.001 * float(_longest(cells).max()) / divisions
        while len(cells):
            large = _longest(cells) > limit
            done.append(cells[~large])
            cells = self.split(cells[large])
        return np.concatenate(done)


def _longest(triangles: FloatArray) -> FloatArray:
    longest: FloatArray = np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2).max(axis=1)
    return longest


@dataclass(frozen=True, eq=False)
class TurnedSurface(Surface):
    """A meridian rotated about the z axis, scaled to half axes, with rotation and translation."""

    # straight: (radius, height) at both ends [m]. Arc of radius 1: first row, the two polar angles from the top [rad];
    # second row, height of the centre and vertical half axis [m]; shape (2, 2)
    meridian: FloatArray
    half_axes: tuple[float, float]  # scale factors along x and y [-], or half axes of the ellipse for an arc [m]
    arc: bool  # True for an arc of an ellipse
    rotation: FloatArray  # rotation matrix [-]; shape (3, 3)
    translation: FloatArray  # displacement [m]; shape (3,)

    def cells(self) -> FloatArray:
        """Return cells in eight sectors of the revolution, and in meridian pieces of at most 45 degrees."""
        u = np.linspace(0.0, 1.0, 1 + max(1, math.ceil(self._sweep / (0.25 * math.pi) - 1e-9)))
        phi = np.linspace(0.0, 2.0 * math.pi, 9)
        return np.array([(*u[i : i + 2], *phi[j : j + 2]) for i in range(len(u) - 1) for j in range(8)])

    def outline(self, cells: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the middle and eight border points of each cell [m], with area vectors [m2] (shape (n, 9, 3))."""
        ends = np.array([0.5, 0.0, 1.0])
        s, t = (grid.ravel() for grid in np.meshgrid(ends, ends, indexing="ij"))
        return self._at(cells, s, t)

    def split(self, cells: FloatArray) -> FloatArray:
        u0, u1, p0, p1 = cells.T
        um, pm = 0.5 * (u0 + u1), 0.5 * (p0 + p1)
        quarters = ((u0, um, p0, pm), (um, u1, p0, pm), (u0, um, pm, p1), (um, u1, pm, p1))
        return np.concatenate([np.stack(quarter, axis=1) for quarter in quarters])

    def sample(self, cells: FloatArray, order: int) -> tuple[FloatArray, FloatArray]:
        """Return Gauss points of each cell [m] and area vectors [m2], with order >= 8 because of the curvature."""
        u, v, weights = gauss_square(max(order, 8))
        points, areas = self._at(cells, u, v)
        return points.reshape(-1, 3), (areas * weights[:, None]).reshape(-1, 3)

    def triangles(self, divisions: int) -> FloatArray:
        """Return two triangles per patch of a regular net [m]."""
        pieces = divisions * (math.ceil(self._sweep / (0.5 * math.pi) - 1e-9) if self.arc else 1)
        u, v = np.linspace(0.0, 1.0, pieces + 1), np.linspace(0.0, 1.0, 4 * divisions + 1)
        s, t = (grid.ravel() for grid in np.meshgrid(u, v, indexing="ij"))
        net = self._at(np.array([[0.0, 1.0, 0.0, 2.0 * math.pi]]), s, t)[0].reshape(len(u), len(v), 3)
        a, b, c, d = net[:-1, :-1], net[1:, :-1], net[1:, 1:], net[:-1, 1:]
        both = np.concatenate([np.stack(corners, axis=2).reshape(-1, 3, 3) for corners in ((a, c, b), (a, d, c))])
        kept: FloatArray = both[
            np.linalg.norm(area_vectors(both), axis=1) > 1e-14 * np.ptp(net, axis=(0, 1)).max() ** 2
        ]
        return kept

    @property
    def _sweep(self) -> float:
        return abs(float(self.meridian[0, 1] - self.meridian[0, 0])) if self.arc else 0.0

    def _at(self, cells: FloatArray, s: FloatArray, t: FloatArray) -> tuple[FloatArray, FloatArray]:
        u0, u1, p0, p1 = (column[:, None] for column in cells.T)
        r, z, dr, dz = self._meridian(u0 + (u1 - u0) * s)
        phi = p0 + (p1 - p0) * t
        (a, b), cos, sin = self.half_axes, np.cos(phi), np.sin(phi)
        local = np.stack([a * r * cos, b * r * sin, z], axis=-1)
        along = np.stack([a * dr * cos, b * dr * sin, dz], axis=-1)
        around = np.stack([-a * r * sin, b * r * cos, np.zeros_like(r)], axis=-1)
        areas = np.cross(around, along) * ((u1 - u0) * (p1 - p0))[..., None]
        return times(local, self.rotation.T) + self.translation, times(areas, self.rotation.T)

    def _meridian(self, u: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        first, second = self.meridian
        if not self.arc:
            (r0, z0), (r1, z1) = first, second
            ones = np.ones_like(u)
            return r0 + (r1 - r0) * u, z0 + (z1 - z0) * u, (r1 - r0) * ones, (z1 - z0) * ones
        (q0, q1), (centre, half) = first, second
        sweep = q1 - q0
        polar = q0 + sweep * u
        return np.sin(polar), centre + half * np.cos(polar), np.cos(polar) * sweep, -half * np.sin(polar) * sweep


Footprint = tuple[FloatArray, tuple[tuple[FloatArray, float], ...]]
"""Possible contact corners, shape (n, 3) [m], and centre and radius of possible round contact faces [m]."""


class Shape(ABC):
    """A closed volume in its own frame, with z along the axis of the shape. All methods use this frame."""

    @abstractmethod
    def moments(self) -> SolidMoments:
        """Return volume, centre and second moments at unit density, exact up to rounding."""

    @abstractmethod
    def surfaces(self, rotation: FloatArray | None = None, translation: FloatArray | None = None) -> list[Surface]:
        """Return the pieces of the surface, normals outward, rotated [-], then translated [m]."""

    @abstractmethod
    def extent(self, rotation: FloatArray) -> FloatArray:
        """Return lowest and highest coordinates of the rotated shape [m]; shape (2, 3)."""

    @abstractmethod
    def footprint(self) -> Footprint:
        """Return the possible contact corners and round contact faces."""

    @abstractmethod
    def hull_points(self) -> FloatArray:
        """Return points with the convex hull of the shape, shape (n, 3) [m]; round faces have 360 corners."""

    @abstractmethod
    def contains(self, points: FloatArray) -> BoolArray:
        """Return True for points (n, 3) inside [m]; the result on the surface is undefined."""

    @abstractmethod
    def scaled(self, size: float) -> "Shape":
        """Return the shape with all lengths times `size` [-]."""

    @abstractmethod
    def mirrored(self) -> "Shape":
        """Return the shape mirrored, x -> -x."""

    def cells(self, divisions: int) -> tuple[FloatArray, FloatArray] | None:
        """Return volumes [m3] and centres [m] of the volume elements of the shape, about `divisions` per direction.

        The result is None for shapes that need voxels.
        """
        return None


def vector(name: str, value: Any, unit: str = "m") -> FloatArray:
    """Return `value` as an array of three finite numbers."""
    array = checks.real_array(name, value, unit)
    if array.shape != (3,) or not np.isfinite(array).all():
        raise GeometryError(parameter=name, allowed=f"three finite numbers (x, y, z) [{unit}]", value=value)
    return array.copy()


def placed_points(points: FloatArray, rotation: FloatArray | None, translation: FloatArray | None) -> FloatArray:
    """Return points after a rotation and then a translation [m]."""
    turned = points if rotation is None else applied(rotation, points)
    return turned if translation is None else turned + translation


def coordinates_text(point: FloatArray, unit: str = "m") -> str:
    """Return the coordinates of a point, as a text."""
    return f"({', '.join(f'{round(x, 9) + 0.0:.4g}' for x in point.tolist())}) {unit}"


def grid_points(low: FloatArray, high: FloatArray, count: int) -> FloatArray:
    """Return the middles of count x count x count equal cells of a box [m]; shape (count^3, 3)."""
    positions = (np.arange(count) + 0.5) / count
    grid = np.stack(np.meshgrid(positions, positions, positions, indexing="ij"), axis=-1).reshape(-1, 3)
    points: FloatArray = low + (high - low) * grid
    return points
