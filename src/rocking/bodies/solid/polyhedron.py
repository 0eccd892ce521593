"""The volume inside a closed surface of triangles."""

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from rocking import checks
from rocking.bodies.moments import SolidMoments, polyhedron_moments
from rocking.bodies.solid._self_crossing import check_crossings, inside
from rocking.bodies.solid.surfaces import Footprint, Shape, Surface, TriangleSurface, placed_points
from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.errors import GeometryError
from rocking.portable import times


class Polyhedron(Shape):
    """The volume inside a closed surface of triangles.

    Faces contain the vertex indices of each triangle, counter-clockwise seen from outside; cavities have inward faces.
    A `simple` surface has no self-intersections and is not checked. `mended` contains the triangles in former holes.

    >>> corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    >>> round(Polyhedron(corners, [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]).moments().mass, 12)
    0.166666666667
    """

    def __init__(
        self, vertices: ArrayLike, faces: ArrayLike, *, simple: bool = False, mended: Sequence[FloatArray] = ()
    ) -> None:
        self.vertices, self.faces = checked_triangles(vertices, faces)
        if count := len(open_edges(self.faces)):
            raise GeometryError(
                "The surface must be closed and oriented: {count} edges have no neighbour in the opposite direction",
                count=count, hint="check for holes, reversed faces, and vertices that are not merged",
            )  # fmt: skip
        self.mended: FloatArray = np.concatenate([np.empty((0, 3, 3)), *mended])
        if not simple:
            check_crossings(self.corners)
        self._check_volume()

    def __repr__(self) -> str:
        return (
            f"{type(self).__name__}({len(self.vertices)} vertices, {len(self.faces)} faces, {self._moments.mass:g} m3)"
        )

    @property
    def corners(self) -> FloatArray:
        """Corners of every triangle, shape (m, 3, 3) [m]."""
        corners: FloatArray = self.vertices[self.faces]
        return corners

    @cached_property
    def hull(self) -> Any:
        """Convex hull about the middle of the box, as a scipy ConvexHull."""
        from scipy.spatial import ConvexHull

        return ConvexHull(self.vertices - self._middle)

    @property
    def _middle(self) -> FloatArray:
        middle: FloatArray = 0.5 * (self.vertices.min(axis=0) + self.vertices.max(axis=0))
        return middle

    @cached_property
    def _moments(self) -> SolidMoments:
        return polyhedron_moments(self.corners)

    def moments(self) -> SolidMoments:
        return self._moments

    def surfaces(self, rotation: FloatArray | None = None, translation: FloatArray | None = None) -> list[Surface]:
        return [TriangleSurface(placed_points(self.corners, rotation, translation))]

    def extent(self, rotation: FloatArray) -> FloatArray:
        turned = times(self.vertices, rotation.T)
        return np.array([turned.min(axis=0), turned.max(axis=0)])

    def footprint(self) -> Footprint:
        return self.vertices, ()

    def hull_points(self) -> FloatArray:
        """Return the vertices."""
        return self.vertices

    def contains(self, points: FloatArray) -> BoolArray:
        return inside(points, self.corners)

    def scaled(self, size: float) -> "Polyhedron":
        vertices = self.vertices * checks.positive("size", size)
        return Polyhedron(vertices, self.faces, simple=True, mended=[self.mended * size])

    def mirrored(self) -> "Polyhedron":
        mirror = np.array([-1.0, 1.0, 1.0])
        return Polyhedron(self.vertices * mirror, self.faces[:, ::-1], simple=True, mended=[self.mended * mirror])

    def cells(self, divisions: int) -> tuple[FloatArray, FloatArray] | None:
        """Return volumes [m3] and centres [m] of tetrahedra to the centre, or None if faces are hidden from it."""
        apex = self._moments.centre
        corners = self.corners - apex
        cones = (corners[:, 0] * np.cross(corners[:, 1], corners[:, 2])).sum(axis=1) / 6.0
        if (cones <= 0.0).any():
            return None
        pieces = TriangleSurface(corners).triangles(divisions)
        cones = (pieces[:, 0] * np.cross(pieces[:, 1], pieces[:, 2])).sum(axis=1) / 6.0
        ends = np.linspace(0.0, 1.0, divisions + 1)
        layer_fractions, centre_fractions = np.diff(ends**3), 0.75 * np.diff(ends**4) / np.diff(ends**3)
        volumes = np.outer(cones, layer_fractions).ravel()
        centres = (pieces.mean(axis=1)[:, None] * centre_fractions[:, None]).reshape(-1, 3)
        return volumes, centres + apex

    def _check_volume(self) -> None:
        box, volume = np.ptp(self.vertices, axis=0), self._moments.mass
        checks.length("largest dimension of the polyhedron", float(box.max()))
        if abs(volume) <= 1e-9 * float(box.max()) * float(np.sort(box)[-2:].prod()):
            raise GeometryError(
                "The surface encloses no volume (box {width:g} x {depth:g} x {height:g} m)", width=float(box[0]),
                depth=float(box[1]), height=float(box[2]), hint="check for a sheet, and for reversed faces",
            )  # fmt: skip
        if volume < 0.0:
            raise GeometryError("The surface is inverted (negative volume). Reverse the faces.")


def directed_edges(faces: IntArray) -> IntArray:
    """Return the directed edges of faces, shape (3 m, 2): all first edges, then all second, then all third."""
    edges: IntArray = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    return edges


def numbered(pairs: IntArray) -> IntArray:
    """Return the index of each pair among the different pairs of integers."""
    base = int(pairs.max(initial=0)) + 1
    keys = pairs[:, 0] * base + pairs[:, 1]
    numbers: IntArray = np.unique(keys, return_inverse=True)[1]
    return numbers


def edge_numbers(faces: IntArray) -> IntArray:
    """Return the index of the undirected edge of each of `directed_edges`."""
    return numbered(np.sort(directed_edges(faces), axis=1))


def alone(faces: IntArray) -> IntArray:
    """Return the directed edges with exactly one face."""
    numbers = edge_numbers(faces)
    single_edges: IntArray = directed_edges(faces)[np.bincount(numbers)[numbers] == 1]
    return single_edges


def open_edges(faces: IntArray) -> IntArray:
    """Return the directed edges without a face in the opposite direction."""
    edges = directed_edges(faces).astype(np.int64)
    base = int(edges.max(initial=0)) + 1
    forward, back = edges[:, 0] * base + edges[:, 1], edges[:, 1] * base + edges[:, 0]
    keys, inverse = np.unique(np.concatenate([forward, back]), return_inverse=True)
    forward_count = np.bincount(inverse[: len(edges)], minlength=len(keys))
    reverse = np.bincount(inverse[len(edges) :], minlength=len(keys))
    unmatched = np.repeat(keys, np.maximum(forward_count - reverse, 0))
    return np.stack([unmatched // base, unmatched % base], axis=1)


def checked_triangles(vertices: ArrayLike, faces: ArrayLike, fewest: int = 4) -> tuple[FloatArray, IntArray]:
    """Return checked points [m] and triangles; fewest: smallest number of triangles."""
    points, numbers = checks.real_array("vertices", vertices, "m"), np.asarray(faces)
    if points.ndim != 2 or points.shape[1:] != (3,) or len(points) < 4:
        raise GeometryError(
            "vertices must be at least 4 points (x, y, z) in m, got an array of shape {shape}", shape=points.shape
        )
    finite = np.isfinite(points).all(axis=1)
    if not finite.all():
        bad = int(np.argmin(finite))
        raise GeometryError(
            "vertex {vertex} must be finite, got {point}", vertex=bad, point=tuple(points[bad].tolist()),
            hint="check the file",
        )  # fmt: skip
    if np.abs(points).max() > checks.LARGEST:
        raise GeometryError(
            "coordinates must be within {limit:g} m of the origin", limit=checks.LARGEST, hint="check the unit"
        )
    if numbers.ndim != 2 or numbers.shape[1:] != (3,) or numbers.dtype.kind not in "iu" or len(numbers) < fewest:
        raise GeometryError(
            ("faces must be at least {fewest} triangles of three vertex indices, got {type} of shape {shape}"),
            fewest=fewest,
            type=numbers.dtype,
            shape=numbers.shape,
        )
    if len(numbers) and (numbers.min() < 0 or numbers.max() >= len(points)):
        raise GeometryError(
            "faces must contain vertex indices from 0 to {last}, got {low} to {high}", last=len(points) - 1,
            low=int(numbers.min()), high=int(numbers.max()), hint="check that the indices start at 0",
        )  # fmt: skip
    return points.copy(), numbers.astype(np.int64)
