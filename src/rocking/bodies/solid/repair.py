"""From the triangles of a file to a closed surface: weld, clean, orient, close, and say what was done.

The order matters. A surface that is not welded has no neighbours, so that turning faces or filling holes on it does
harm; nothing is integrated before the surface is closed.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.bodies.body import DEFAULT_DENSITY
from rocking.bodies.solid.holes import boundary_loops, filled, holes_sentence
from rocking.bodies.solid.part import Part
from rocking.bodies.solid.polyhedron import Polyhedron, open_edges
from rocking.bodies.solid.self_crossing import check_crossings, in_metres
from rocking.bodies.solid.shells import oriented_shells, turned_consistently
from rocking.conventions import FloatArray, IntArray
from rocking.errors import GeometryError

WELD = 1e-6
"""Vertices closer than this share of the size are merged if exact merging leaves the surface open [-]."""


@dataclass(frozen=True, eq=False)
class Repaired:
    """A closed surface and what was done to get it."""

    shape: Polyhedron  # the volume, the middle of its box at the origin
    middle: FloatArray  # where that middle lies in the given coordinates [m]; shape (3,)
    repairs: tuple[str, ...]  # one sentence for each change; empty if the surface was fine

    def part(self, density: float = DEFAULT_DENSITY) -> Part:
        """Return the volume in its place, in one material [kg/m3]."""
        return Part(self.shape, density, translation=self.middle)


def repaired(
    vertices: FloatArray,
    faces: IntArray,
    *,
    weld_tolerance: float | None = None,
    fill_holes: bool = False,
    place: Callable[[FloatArray], str] = in_metres,
) -> Repaired:
    """Return the closed surface that triangles describe, with a sentence for every change.

    vertices: vertices [m]; weld_tolerance: vertices this close are merged [m]; by default equal ones, and if that
    leaves the surface open, those within 1e-6 of its size; place: turns a place in the given coordinates [m] into the
    words that the user reads.

    >>> from rocking.bodies.solid import box
    >>> cube = box(1.0, 1.0, 1.0)
    >>> faces = cube.faces.copy()
    >>> faces[3] = faces[3, ::-1]
    >>> repaired(cube.vertices, faces).repairs
    ('turned round 1 of 12 faces that looked the other way than their neighbours',)
    """
    vertices, faces = _triangles(vertices, faces)
    middle = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    points = vertices - middle
    size = checks.length("largest dimension of the mesh", float(np.ptp(points, axis=0).max()))
    said: list[str] = []
    points, faces = _welded(points, faces, weld_tolerance, size, said)
    faces = _cleaned(faces, said)
    faces = turned_consistently(faces, said)
    loops = boundary_loops(faces, points)
    if loops and not fill_holes:
        raise GeometryError(holes_sentence(loops, points + middle))
    points, faces = filled(points, faces, loops, said)
    faces = turned_consistently(faces, said) if loops else faces
    _check_orientable(faces)
    faces = oriented_shells(points, faces, said)
    points, faces = _used(points, faces)
    if not check_crossings(points[faces], lambda where: place(where + middle)):
        said.append("too many faces lie side by side to try whether all of them keep clear of each other")
    shape = Polyhedron(points, faces, simple=True)
    _check_hull(shape)
    return Repaired(shape, middle, tuple(said))


def _triangles(vertices: FloatArray, faces: IntArray) -> tuple[FloatArray, IntArray]:
    points, numbers = checks.real_array("vertices", vertices, "m"), np.asarray(faces)
    if points.ndim != 2 or points.shape[1:] != (3,):
        raise GeometryError(f"vertices must be points (x, y, z) in m, got an array of shape {points.shape}")
    if numbers.ndim != 2 or numbers.shape[1:] != (3,) or numbers.dtype.kind not in "iu" or not len(numbers):
        raise GeometryError(
            f"faces must be triangles, each of three vertex numbers, got {numbers.dtype} of shape {numbers.shape}"
        )
    _check_finite(points)
    if numbers.min() < 0 or numbers.max() >= len(points):
        raise GeometryError(
            f"faces must name vertices 0 to {len(points) - 1}, got {numbers.min()} to {numbers.max()}; "
            "do the numbers start at 1, or belong to another list of vertices?"
        )
    return points, numbers.astype(np.int64)


def _check_finite(vertices: FloatArray) -> None:
    finite = np.isfinite(vertices).all(axis=1)
    if not finite.all():
        bad = int(np.argmin(finite))
        raise GeometryError(f"vertex {bad} must be finite, got {tuple(vertices[bad].tolist())}; is the file damaged?")
    if len(vertices) < 4:
        raise GeometryError(f"a closed surface has at least 4 vertices, got {len(vertices)}")


def _welded(
    points: FloatArray, faces: IntArray, tolerance: float | None, size: float, said: list[str]
) -> tuple[FloatArray, IntArray]:
    same, inverse = np.unique(points, axis=0, return_inverse=True)
    merged, joined = len(points) - len(same), inverse.ravel()[faces]
    reach = checks.within("weld_tolerance", tolerance, 0.0, 0.01 * size, unit="m") if tolerance is not None else 0.0
    if tolerance is None and _boundary_count(joined):
        reach = WELD * size
    if reach > 0.0:
        near = _clusters(same, reach)
        count = int(near.max()) + 1
        merged += len(same) - count
        first = np.unique(near, return_index=True)[1]
        same, joined = same[first], near[joined]
    if merged:
        how = f"within {reach:.3g} m of each other" if reach > 0.0 else "in the same place"
        said.append(f"merged {merged} of {len(points)} vertices that lay {how}")
    return same, joined


def _boundary_count(faces: IntArray) -> int:
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    return int((np.unique(edges, axis=0, return_counts=True)[1] == 1).sum())


def _clusters(points: FloatArray, reach: float) -> IntArray:
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    pairs = cKDTree(points).query_pairs(reach, output_type="ndarray")
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(points), len(points)))
    labels: IntArray = connected_components(graph, directed=False)[1].astype(np.int64)
    return labels


def _cleaned(faces: IntArray, said: list[str]) -> IntArray:
    a, b, c = faces.T
    whole = (a != b) & (b != c) & (c != a)
    if not whole.all():
        said.append(f"removed {int((~whole).sum())} faces that had shrunk to an edge or a point")
    faces = faces[whole]
    _, first, inverse = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_inverse=True)
    if len(first) == len(faces):
        return faces
    # the same corners twice: faces of one sense are one face, faces of opposite sense have nothing between them
    net = np.bincount(inverse.ravel(), weights=_parity(faces), minlength=len(first))
    sense = _parity(faces[first])
    keep = net != 0.0
    result: IntArray = np.where((net * sense < 0.0)[:, None], faces[first][:, ::-1], faces[first])[keep]
    if len(result) < 4:
        raise GeometryError(
            "the faces lie on top of each other and nothing is left between them: the surface is a sheet"
        )
    said.append(f"removed {len(faces) - len(result)} faces that lay on top of others")
    return result


def _parity(faces: IntArray) -> FloatArray:
    a, b, c = faces.T
    return np.where(((a < b) & (b < c)) | ((b < c) & (c < a)) | ((c < a) & (a < b)), 1.0, -1.0)


def _check_orientable(faces: IntArray) -> None:
    count = len(open_edges(faces))
    if count:
        raise GeometryError(
            f"no side of the surface is the outside: {count} edges cannot be matched however the faces are turned; "
            "do more than two faces meet along them, or is the surface one-sided?"
        )


def _used(points: FloatArray, faces: IntArray) -> tuple[FloatArray, IntArray]:
    numbers, inverse = np.unique(faces, return_inverse=True)
    return points[numbers], inverse.reshape(faces.shape)


def _check_hull(shape: Polyhedron) -> None:
    from scipy.spatial import ConvexHull

    whole = float(ConvexHull(shape.vertices).volume)
    volume = shape.moments().mass
    if volume > whole * (1.0 + 1e-9):
        raise GeometryError(
            f"the surface encloses {volume:.6g} m3, more than its hull ({whole:.6g} m3): it passes through itself"
        )
