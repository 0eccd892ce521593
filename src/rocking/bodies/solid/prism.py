"""Boxes and extrusions: polyhedra with exact moments."""

import numpy as np
from numpy.typing import ArrayLike

from rocking import checks
from rocking.bodies.moments import SolidMoments, combined_plane, ring_moments
from rocking.bodies.region import Region, triangulated
from rocking.bodies.solid.polyhedron import Polyhedron
from rocking.bodies.solid.surfaces import TriangleSurface, area_vectors
from rocking.conventions import FloatArray, IntArray
from rocking.errors import GeometryError


class Prism(Polyhedron):
    """A region extruded along z from 0 to its length [m]; the density of the region is ignored.

    >>> round(Prism(Region([(0, 0), (1, 0), (0, 1)]), 2.0).moments().mass, 12)
    1.0
    """

    def __init__(self, region: Region, length: float) -> None:
        if not isinstance(region, Region):
            raise GeometryError("A Prism needs a Region(outline, density, holes).")
        self.region = region
        self.length = checks.length("length", length)
        flat, self._caps, sides = _net(region)
        count = len(flat)
        bottom, top = (np.column_stack([flat, np.full(count, height)]) for height in (0.0, self.length))
        a, b = sides.T
        around = np.concatenate([np.stack([a, b, b + count], axis=1), np.stack([a, b + count, a + count], axis=1)])
        super().__init__(
            np.concatenate([bottom, top]),
            np.concatenate([self._caps[:, ::-1], self._caps + count, around]),
            simple=True,
        )

    def moments(self) -> SolidMoments:
        """Return volume, centre and second moments; the contribution of the height is exact, ``L^2/12``."""
        plane = combined_plane(ring_moments(ring) for ring in self.region.rings)
        second = super().moments().second * np.array([[1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 0.0]])
        second[[0, 1, 2], [0, 1, 2]] = np.array([plane.xx, plane.yy, plane.mass * self.length**2 / 12.0])
        second[[0, 1], [0, 1]] *= self.length
        second[2, 2] *= self.length
        return SolidMoments(plane.mass * self.length, np.array([plane.x, plane.y, 0.5 * self.length]), second)

    def scaled(self, size: float) -> "Prism":
        factor = checks.positive("size", size)
        return Prism(self.region.mapped(lambda ring: ring * factor), self.length * factor)

    def mirrored(self) -> "Prism":
        return Prism(self.region.mapped(lambda ring: ring * np.array([-1.0, 1.0])), self.length)

    def cells(self, divisions: int) -> tuple[FloatArray, FloatArray]:
        """Return volumes [m3] and centres [m] of wedges: triangles of the polygon times layers of the length."""
        pieces = TriangleSurface(self.vertices[self._caps]).triangles(divisions)
        areas, step = area_vectors(pieces)[:, 2], self.length / divisions
        heights = step * (np.arange(divisions) + 0.5)
        centres = np.repeat(pieces.mean(axis=1), divisions, axis=0)
        centres[:, 2] = np.tile(heights, len(pieces))
        return np.repeat(areas * step, divisions), centres


class Box(Polyhedron):
    """A box on z = 0, centred on the z axis, with full sizes along x, y and z [m]."""

    def __init__(self, width: float, depth: float, height: float) -> None:
        names = ("width", "depth", "height")
        self.size = np.array([checks.length(n, v) for n, v in zip(names, (width, depth, height), strict=True)])
        unit = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)], dtype=np.float64)
        super().__init__((unit - np.array([0.5, 0.5, 0.0])) * self.size, _BOX_FACES, simple=True)

    def moments(self) -> SolidMoments:
        """Return volume, centre and second moments in closed form, ``V a^2/12`` along each axis."""
        volume = float(self.size.prod())
        return SolidMoments(volume, np.array([0.0, 0.0, 0.5 * self.size[2]]), np.diag(volume * self.size**2 / 12.0))

    def scaled(self, size: float) -> "Box":
        return Box(*(self.size * checks.positive("size", size)).tolist())

    def mirrored(self) -> "Box":
        """Return an equal box."""
        return Box(*self.size.tolist())

    def cells(self, divisions: int) -> tuple[FloatArray, FloatArray]:
        """Return volumes [m3] and centres [m] of a regular grid of small boxes."""
        middles = (np.arange(divisions) + 0.5) / divisions
        grid = np.stack(np.meshgrid(middles - 0.5, middles - 0.5, middles, indexing="ij"), axis=-1).reshape(-1, 3)
        return np.full(divisions**3, float(self.size.prod()) / divisions**3), grid * self.size


def box(width: float, depth: float, height: float) -> Box:
    """Return a box on z = 0, centred on the z axis.

    Parameters
    ----------
    width, depth, height : float
        Full sizes along x, y and z [m].

    Returns
    -------
    Box
        The shape.

    Examples
    --------
    >>> box(1.0, 2.0, 3.0).moments().mass
    6.0
    """
    return Box(width, depth, height)


def extrusion(outline: ArrayLike, length: float, holes: tuple[ArrayLike, ...] = ()) -> Prism:
    """Return a vertical extrusion of a plan outline from z = 0.

    Parameters
    ----------
    outline : array_like, shape (n, 2)
        Vertices (x, y) of the plan [m].
    length : float
        Height [m].
    holes : tuple of array_like
        Outlines of holes [m].

    Returns
    -------
    Prism
        The shape.

    Examples
    --------
    >>> extrusion([(0, 0), (1, 0), (0, 1)], 4.0).moments().mass
    2.0
    """
    return Prism(Region(outline, 1.0, holes), length)


_BOX_FACES = np.array(
    [
        *((0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4)),
        *((2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)),
    ]
)


def _net(region: Region) -> tuple[FloatArray, IntArray, IntArray]:
    """Return vertices, counter-clockwise triangles and directed boundary edges of a region."""
    flat, index = np.unique(np.concatenate(region.rings), axis=0, return_inverse=True)
    number = {tuple(point): i for i, point in enumerate(flat.tolist())}
    triangles = triangulated(region.outline, region.holes).tolist()
    caps = np.array([[number[tuple(point)] for point in triangle] for triangle in triangles], dtype=np.int64)
    sides, start = [], 0
    for ring in region.rings:
        members = index.ravel()[start : start + len(ring)]
        sides.append(np.stack([members, np.roll(members, -1)], axis=1))
        start += len(ring)
    return flat, caps, np.concatenate(sides)
