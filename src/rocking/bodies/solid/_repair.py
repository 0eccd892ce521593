"""From the triangles of a file to a closed surface: weld, clean, orient, close, mend, and say what was done.

The order matters. A surface that is not welded has no neighbours, so that turning faces or closing holes on it does
harm; nothing is integrated before the surface is closed, and shells are told apart before they are united.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rocking import checks
from rocking.bodies.body import DEFAULT_DENSITY
from rocking.bodies.solid._changes import Changes, Repair, in_words
from rocking.bodies.solid._closing import closed
from rocking.bodies.solid._manifold import decimated, hollowed
from rocking.bodies.solid._mending import uncrossed, without_dust, without_fins
from rocking.bodies.solid._shells import connected, oriented_shells, turned_consistently
from rocking.bodies.solid._skin import Surface, skin
from rocking.bodies.solid.part import Part
from rocking.bodies.solid.polyhedron import Polyhedron, alone, numbered, open_edges
from rocking.conventions import FloatArray, IntArray
from rocking.errors import GeometryError

WELD = 1e-6  # vertices closer than this share of the size are merged if exact merging leaves the surface open [-]


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
    repair: Repair = "safe",
    surface: Surface = "faces",
    wall: float | None = None,
    place: Callable[[FloatArray], str] = in_words,
) -> Repaired:
    """Return the closed surface that triangles describe, or points alone, with a sentence for every change."""
    vertices, faces = _triangles(vertices, faces, surface != "faces")
    middle = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    points = vertices - middle
    size = checks.length("largest dimension of the mesh", float(np.ptp(points, axis=0).max()))
    changes = Changes(repair, lambda where: place(where + middle))
    if surface == "faces":
        points, faces = _closed_surface(points, faces, weld_tolerance, size, changes)
    else:
        points, faces = skin(points, surface, changes)
    points, faces = oriented_shells(points, faces, changes)
    points, faces = decimated(points, faces, changes)
    points, faces = uncrossed(points, faces, changes)
    if wall is not None:
        points, faces = hollowed(
            points, faces, checks.within("wall", wall, 0.0, 0.5 * size, unit="m", open_low=True), changes
        )
    shape = Polyhedron(*_used(points, faces), simple=True)
    _check_hull(shape)
    return Repaired(shape, middle, changes.sentences(shape.moments(), float(np.ptp(shape.vertices, axis=0).max())))


def _closed_surface(
    points: FloatArray, faces: IntArray, weld_tolerance: float | None, size: float, changes: Changes
) -> tuple[FloatArray, IntArray]:
    points, faces = _welded(points, faces, weld_tolerance, size, changes)
    faces = _cleaned(faces, changes)
    faces = without_fins(points, without_dust(points, faces, changes), changes)
    points, faces = _used(points, turned_consistently(faces, changes))
    count = len(faces)
    points, faces = closed(points, faces, changes)
    faces = turned_consistently(faces, changes) if len(faces) > count else faces
    if count := len(open_edges(faces)):
        raise GeometryError(
            f"no side of the surface is the outside: {count} edges cannot be matched however the faces are turned; "
            'do more than two faces meet along them, or is the surface one-sided? surface="wrap" stretches a skin over '
            "its points instead"
        )
    return points, faces


def _used(points: FloatArray, faces: IntArray) -> tuple[FloatArray, IntArray]:
    used, numbers = np.unique(faces, return_inverse=True)
    return points[used], numbers.reshape(faces.shape)


def _triangles(vertices: FloatArray, faces: IntArray, cloud: bool) -> tuple[FloatArray, IntArray]:
    points, numbers = checks.real_array("vertices", vertices, "m"), np.asarray(faces)
    if points.ndim != 2 or points.shape[1:] != (3,):
        raise GeometryError(f"vertices must be points (x, y, z) in m, got an array of shape {points.shape}")
    if numbers.ndim != 2 or numbers.shape[1:] != (3,) or numbers.dtype.kind not in "iu" or not (len(numbers) or cloud):
        raise GeometryError(
            f"faces must be triangles, each of three vertex numbers, got {numbers.dtype} of shape {numbers.shape}"
        )
    finite = np.isfinite(points).all(axis=1)
    if not finite.all():
        bad = int(np.argmin(finite))
        raise GeometryError(f"vertex {bad} must be finite, got {tuple(points[bad].tolist())}; is the file damaged?")
    if len(points) < 4:
        raise GeometryError(f"a closed surface has at least 4 vertices, got {len(points)}")
    if len(numbers) and (numbers.min() < 0 or numbers.max() >= len(points)):
        raise GeometryError(
            f"faces must name vertices 0 to {len(points) - 1}, got {numbers.min()} to {numbers.max()}; "
            "do the numbers start at 1, or belong to another list of vertices?"
        )
    return points, numbers.astype(np.int64)


def _welded(
    points: FloatArray, faces: IntArray, tolerance: float | None, size: float, changes: Changes
) -> tuple[FloatArray, IntArray]:
    from scipy.spatial import cKDTree

    same, inverse = _same(points)
    merged, joined = len(points) - len(same), inverse[faces]
    reach = checks.within("weld_tolerance", tolerance, 0.0, 0.01 * size, unit="m") if tolerance is not None else 0.0
    if tolerance is None and len(alone(joined)):
        reach = WELD * size
    if reach > 0.0:
        near = connected(len(same), *cKDTree(same).query_pairs(reach, output_type="ndarray").T)
        count = int(near.max()) + 1
        merged += len(same) - count
        first = np.unique(near, return_index=True)[1]
        same, joined = same[first], near[joined]
    if merged:
        how = f"within {reach:.3g} m of each other" if reach > 0.0 else "in the same place"
        changes.note(f"merged {merged} of {len(points)} vertices that lay {how}")
    return same, joined


def _same(points: FloatArray) -> tuple[FloatArray, IntArray]:
    """Return the different points, and which of them each is."""
    # a number for each: 64 bits mixed of three coordinates; the comparison finds the rare two that share one
    bits = np.ascontiguousarray(points + 0.0).view(np.uint64)
    mixed = bits[:, 0] * np.uint64(0x9E3779B97F4A7C15) + bits[:, 1] * np.uint64(0xC2B2AE3D27D4EB4F)
    mixed = (mixed ^ (mixed >> np.uint64(29))) + bits[:, 2] * np.uint64(0x165667B19E3779F9)
    _, first, inverse = np.unique(mixed, return_index=True, return_inverse=True)
    if not (points[first][inverse] == points).all():
        same, inverse = np.unique(points, axis=0, return_inverse=True)
        return same, inverse.ravel()
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return points[first[order]], rank[inverse]


def _cleaned(faces: IntArray, changes: Changes) -> IntArray:
    a, b, c = faces.T
    whole = (a != b) & (b != c) & (c != a)
    if not whole.all():
        changes.say(f"removed {int((~whole).sum())} faces that had shrunk to an edge or a point")
    faces = faces[whole]
    low, middle, high = np.sort(faces, axis=1).T
    edge = numbered(np.stack([low, middle], axis=1))
    _, first, inverse = np.unique(numbered(np.stack([edge, high], axis=1)), return_index=True, return_inverse=True)
    if len(first) == len(faces):
        return faces
    # the same corners twice: faces of one sense are one face, faces of opposite sense have nothing between them
    net = np.bincount(inverse, weights=_parity(faces), minlength=len(first))
    sense = _parity(faces[first])
    keep = net != 0.0
    result: IntArray = np.where((net * sense < 0.0)[:, None], faces[first][:, ::-1], faces[first])[keep]
    if len(result) < 4:
        raise GeometryError(
            "the faces lie on top of each other and nothing is left between them: the surface is a sheet"
        )
    changes.say(f"removed {len(faces) - len(result)} faces that lay on top of others")
    return result


def _parity(faces: IntArray) -> FloatArray:
    a, b, c = faces.T
    return np.where(((a < b) & (b < c)) | ((b < c) & (c < a)) | ((c < a) & (a < b)), 1.0, -1.0)


def _check_hull(shape: Polyhedron) -> None:
    whole = float(shape.hull.volume)
    volume = shape.moments().mass
    if volume > whole * (1.0 + 1e-9):
        raise GeometryError(
            f"the surface encloses {volume:.6g} m3, more than its hull ({whole:.6g} m3): it passes through itself"
        )
