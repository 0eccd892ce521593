"""Flat triangles as a surface."""

from dataclasses import dataclass

import numpy as np

from rocking.bodies.solid.surfaces import Surface, area_vectors, gauss_triangle
from rocking.conventions import FloatArray
from rocking.portable import times


@dataclass(frozen=True, eq=False)
class TriangleSurface(Surface):
    """Flat triangles."""

    corners: FloatArray  # corners, counter-clockwise seen from outside [m]; shape (n, 3, 3)

    def cells(self) -> FloatArray:
        return self.corners

    def outline(self, cells: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return centroid and corners of each triangle, with its area vector.

        cells: triangles [m]. Returns points [m] and area vectors [m2] (shape (n, 4, 3)).
        """
        points = np.concatenate([cells.mean(axis=1, keepdims=True), cells], axis=1)
        return points, np.repeat(area_vectors(cells)[:, None], 4, axis=1)

    def split(self, cells: FloatArray) -> FloatArray:
        """Return the four triangles between corners and midpoints.

        cells: triangles [m].
        """
        a, b, c = np.moveaxis(cells, 1, 0)
        ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
        quarters = ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))
        return np.concatenate([np.stack(quarter, axis=1) for quarter in quarters])

    def sample(self, cells: FloatArray, order: int) -> tuple[FloatArray, FloatArray]:
        """Return Gauss points of a square collapsed onto each triangle.

        cells: triangles [m]. Returns points [m] and weighted area vectors [m2] (shape (n order^2, 3)).
        """
        shares, weights = gauss_triangle(order)
        points = times(shares, cells)
        areas = weights[:, None] * area_vectors(cells)[:, None]
        return points.reshape(-1, 3), areas.reshape(-1, 3)

    def triangles(self, divisions: int) -> FloatArray:
        """Return the triangles, split until none is longer than the largest over `divisions`.

        Returns corners [m].
        """
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
