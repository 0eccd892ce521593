"""The volume inside a closed surface of triangles."""

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from rocking import checks
from rocking.bodies.moments import SolidMoments, polyhedron_moments
from rocking.bodies.solid.self_intersection import check_self_intersection
from rocking.bodies.solid.surfaces import Footprint, Shape, Surface, TriangleSurface, placed_points
from rocking.bodies.solid.triangles import checked_triangles, open_edges
from rocking.bodies.solid.winding import inside
from rocking.conventions import BoolArray, FloatArray
from rocking.errors import GeometryError
from rocking.portable import times


class Polyhedron(Shape):
    """The volume inside a closed surface of triangles.

    Faces contain the vertex indices of each triangle, counter-clockwise seen from outside; cavities have inward faces.
    A `simple` surface has no self-intersections and is not checked. `patches` contains the triangles in former holes.

    >>> corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    >>> round(Polyhedron(corners, [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]).moments().mass, 12)
    0.166666666667
    """

    def __init__(
        self, vertices: ArrayLike, faces: ArrayLike, *, simple: bool = False, patches: Sequence[FloatArray] = ()
    ) -> None:
        self.vertices, self.faces = checked_triangles(vertices, faces)
        if count := len(open_edges(self.faces)):
            raise GeometryError(
                "The surface must be closed and oriented: {count} edges have no neighbour in the opposite direction",
                count=count, hint="check for holes, reversed faces, and vertices that are not merged",
            )  # fmt: skip
        self.patches: FloatArray = np.concatenate([np.empty((0, 3, 3)), *patches])
        if not simple:
            check_self_intersection(self.corners)
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
        return Polyhedron(vertices, self.faces, simple=True, patches=[self.patches * size])

    def mirrored(self) -> "Polyhedron":
        mirror = np.array([-1.0, 1.0, 1.0])
        return Polyhedron(self.vertices * mirror, self.faces[:, ::-1], simple=True, patches=[self.patches * mirror])

    def cells(self, divisions: int) -> tuple[FloatArray, FloatArray] | None:
        """Return volumes [m3] and centres [m] of pieces between faces and centre; None if a face is turned away."""
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
