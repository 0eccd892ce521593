"""From the triangles of a file to a closed surface: weld, clean, orient, close, and say what was done.

The order matters. A surface that is not welded has no neighbours, so that turning faces or filling holes on it does
harm; nothing is integrated before the surface is closed.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.bodies.body import DEFAULT_DENSITY
from rocking.bodies.solid._self_crossing import check_crossings, in_words
from rocking.bodies.solid._shells import connected, oriented_shells, turned_consistently
from rocking.bodies.solid.part import Part
from rocking.bodies.solid.polyhedron import Polyhedron, directed_edges, open_edges
from rocking.bodies.solid.surfaces import area_vectors
from rocking.conventions import FloatArray, IntArray, percent
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
    place: Callable[[FloatArray], str] = in_words,
) -> Repaired:
    """Return the closed surface that triangles describe, with a sentence for every change."""
    vertices, faces = _triangles(vertices, faces)
    middle = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    points = vertices - middle
    size = checks.length("largest dimension of the mesh", float(np.ptp(points, axis=0).max()))
    repairs: list[str] = []
    points, faces = _welded(points, faces, weld_tolerance, size, repairs)
    faces = _cleaned(faces, repairs)
    faces = turned_consistently(faces, repairs)
    loops = boundary_loops(faces, points)
    if loops and not fill_holes:
        raise GeometryError(holes_sentence(loops, points + middle))
    points, faces = filled(points, faces, loops, repairs)
    faces = turned_consistently(faces, repairs) if loops else faces
    if count := len(open_edges(faces)):
        raise GeometryError(
            f"no side of the surface is the outside: {count} edges cannot be matched however the faces are turned; "
            "do more than two faces meet along them, or is the surface one-sided?"
        )
    faces = oriented_shells(points, faces, repairs)
    used, numbers = np.unique(faces, return_inverse=True)
    points, faces = points[used], numbers.reshape(faces.shape)
    if not check_crossings(points[faces], lambda where: place(where + middle)):
        repairs.append("too many faces lie side by side to try whether all of them keep clear of each other")
    shape = Polyhedron(points, faces, simple=True)
    _check_hull(shape)
    return Repaired(shape, middle, tuple(repairs))


def _triangles(vertices: FloatArray, faces: IntArray) -> tuple[FloatArray, IntArray]:
    points, numbers = checks.real_array("vertices", vertices, "m"), np.asarray(faces)
    if points.ndim != 2 or points.shape[1:] != (3,):
        raise GeometryError(f"vertices must be points (x, y, z) in m, got an array of shape {points.shape}")
    if numbers.ndim != 2 or numbers.shape[1:] != (3,) or numbers.dtype.kind not in "iu" or not len(numbers):
        raise GeometryError(
            f"faces must be triangles, each of three vertex numbers, got {numbers.dtype} of shape {numbers.shape}"
        )
    finite = np.isfinite(points).all(axis=1)
    if not finite.all():
        bad = int(np.argmin(finite))
        raise GeometryError(f"vertex {bad} must be finite, got {tuple(points[bad].tolist())}; is the file damaged?")
    if len(points) < 4:
        raise GeometryError(f"a closed surface has at least 4 vertices, got {len(points)}")
    if numbers.min() < 0 or numbers.max() >= len(points):
        raise GeometryError(
            f"faces must name vertices 0 to {len(points) - 1}, got {numbers.min()} to {numbers.max()}; "
            "do the numbers start at 1, or belong to another list of vertices?"
        )
    return points, numbers.astype(np.int64)


def _welded(
    points: FloatArray, faces: IntArray, tolerance: float | None, size: float, repairs: list[str]
) -> tuple[FloatArray, IntArray]:
    from scipy.spatial import cKDTree

    same, inverse = np.unique(points, axis=0, return_inverse=True)
    merged, joined = len(points) - len(same), inverse.ravel()[faces]
    reach = checks.within("weld_tolerance", tolerance, 0.0, 0.01 * size, unit="m") if tolerance is not None else 0.0
    if tolerance is None and len(_boundary(joined)):
        reach = WELD * size
    if reach > 0.0:
        near = connected(len(same), *cKDTree(same).query_pairs(reach, output_type="ndarray").T)
        count = int(near.max()) + 1
        merged += len(same) - count
        first = np.unique(near, return_index=True)[1]
        same, joined = same[first], near[joined]
    if merged:
        how = f"within {reach:.3g} m of each other" if reach > 0.0 else "in the same place"
        repairs.append(f"merged {merged} of {len(points)} vertices that lay {how}")
    return same, joined


def _boundary(faces: IntArray) -> IntArray:
    """Return the directed edges that one face has for itself."""
    edges = directed_edges(faces)
    _, inverse, counts = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True, return_counts=True)
    alone: IntArray = edges[counts[inverse.ravel()] == 1]
    return alone


def _cleaned(faces: IntArray, repairs: list[str]) -> IntArray:
    a, b, c = faces.T
    whole = (a != b) & (b != c) & (c != a)
    if not whole.all():
        repairs.append(f"removed {int((~whole).sum())} faces that had shrunk to an edge or a point")
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
    repairs.append(f"removed {len(faces) - len(result)} faces that lay on top of others")
    return result


def _parity(faces: IntArray) -> FloatArray:
    a, b, c = faces.T
    return np.where(((a < b) & (b < c)) | ((b < c) & (c < a)) | ((c < a) & (a < b)), 1.0, -1.0)


def _check_hull(shape: Polyhedron) -> None:
    from scipy.spatial import ConvexHull

    whole = float(ConvexHull(shape.vertices).volume)
    volume = shape.moments().mass
    if volume > whole * (1.0 + 1e-9):
        raise GeometryError(
            f"the surface encloses {volume:.6g} m3, more than its hull ({whole:.6g} m3): it passes through itself"
        )


SMALL = 0.01
"""Holes are filled up to this share of the surface, all together [-]."""

_LISTED = 3


def boundary_loops(faces: IntArray, points: FloatArray) -> list[IntArray]:
    """Return the rings of edges that have a face on one side only."""
    open_ = _boundary(faces)[:, ::-1]
    following = dict(open_.tolist())
    if len(following) < len(open_):
        where = points[open_[:, 0]].mean(axis=0)
        raise GeometryError(
            f"the surface has {len(open_)} open edges that meet in more than pairs, around "
            f"({where[0]:.3g}, {where[1]:.3g}, {where[2]:.3g}) m from the middle of the mesh; "
            "repair it in the program that made it"
        )
    loops = []
    while following:
        start, vertex = next(iter(following.items()))
        ring = [start]
        del following[start]
        while vertex != start:
            if vertex not in following:
                raise GeometryError("the open edges of the surface form no rings; are faces turned against each other?")
            ring.append(vertex)
            vertex = following.pop(vertex)
        loops.append(np.array(ring))
    return loops


def holes_sentence(loops: list[IntArray], points: FloatArray) -> str:
    """Return what a user must know about the holes of a surface."""
    order = sorted(loops, key=lambda ring: -_width(points[ring]))
    listed = "; ".join(
        f"{_width(points[ring]):.3g} m wide ({len(ring)} edges) at "
        f"({', '.join(f'{x:.3g}' for x in points[ring].mean(axis=0))}) m"
        for ring in order[:_LISTED]
    )
    more = f" and {len(loops) - _LISTED} smaller" if len(loops) > _LISTED else ""
    return (
        f"the surface is not closed, it has {len(loops)} hole(s): {listed}{more}; close them in the program that made "
        "it, or pass fill_holes=True if together they are below 1 % of the surface"
    )


def filled(
    points: FloatArray, faces: IntArray, loops: list[IntArray], repairs: list[str]
) -> tuple[FloatArray, IntArray]:
    """Return the surface with a fan of triangles over each hole."""
    if not loops:
        return points, faces
    whole = _area(points[faces])
    extra_points, extra_faces = [], []
    for number, ring in enumerate(loops):
        extra_points.append(points[ring].mean(axis=0))
        middle = np.full(len(ring), len(points) + number)
        extra_faces.append(np.stack([ring, np.roll(ring, -1), middle], axis=1))
    points, fans = np.concatenate([points, extra_points]), np.concatenate(extra_faces)
    share = _area(points[fans]) / whole
    if share > SMALL:
        raise GeometryError(
            f"{len(loops)} hole(s) are {percent(share)} of the surface; only up to 1 % is filled, as a larger "
            "patch would invent part of the body: close them in the program that made the mesh"
        )
    repairs.append(f"filled {len(loops)} hole(s), together {percent(share)} of the surface, each with a fan")
    return points, np.concatenate([faces, fans])


def _area(triangles: FloatArray) -> float:
    return float(np.linalg.norm(area_vectors(triangles), axis=1).sum())


def _width(ring: FloatArray) -> float:
    return float(np.linalg.norm(np.ptp(ring, axis=0)))
