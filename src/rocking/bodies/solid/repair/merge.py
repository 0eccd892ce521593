"""Merging of equal vertices, and removal of degenerate and duplicate faces."""

import numpy as np

from rocking import checks
from rocking.bodies.solid.repair.log import RepairLog
from rocking.bodies.solid.triangles import connected, numbered, single_edges
from rocking.conventions import FloatArray, IntArray
from rocking.errors import GeometryError
from rocking.messages import Message

WELD = 1e-6  # distance of merged vertices / size, if merging of equal vertices leaves the surface open [-]


def merge_vertices(
    points: FloatArray, faces: IntArray, tolerance: float | None, size: float, log: RepairLog
) -> tuple[FloatArray, IntArray]:
    """Return the surface with one vertex for all vertices within a distance [m]; `size` is the largest side [m]."""
    from scipy.spatial import cKDTree

    same, inverse = _distinct(points)
    merged, welded_faces = len(points) - len(same), inverse[faces]
    distance = checks.within("weld_tolerance", tolerance, 0.0, 0.01 * size, unit="m") if tolerance is not None else 0.0
    if tolerance is None and len(single_edges(welded_faces)):
        distance = WELD * size
    if distance > 0.0:
        labels = connected(len(same), *cKDTree(same).query_pairs(distance, output_type="ndarray").T)
        count = int(labels.max()) + 1
        merged += len(same) - count
        first = np.unique(labels, return_index=True)[1]
        same, welded_faces = same[first], labels[welded_faces]
    if merged:
        facts = {"merged": merged, "total": len(points), "distance": distance}
        near_each_other = Message("merged {merged} of {total} vertices at distances up to {distance:.3g} m", facts)
        in_one_place = Message("merged {merged} of {total} vertices with equal coordinates", facts)
        log.add_note(near_each_other if distance > 0.0 else in_one_place)
    return same, welded_faces


def _distinct(points: FloatArray) -> tuple[FloatArray, IntArray]:
    """Return the different points, and the index of every point among them."""
    # a 64-bit hash of the three coordinates per point; the comparison detects the rare collisions
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


def remove_duplicates(faces: IntArray, log: RepairLog) -> IntArray:
    """Return the faces without degenerate and duplicate faces."""
    a, b, c = faces.T
    is_triangle = (a != b) & (b != c) & (c != a)
    if not is_triangle.all():
        facts = {"number": int((~is_triangle).sum())}
        log.add_repair(Message("removed {number} degenerate faces", facts))
    faces = faces[is_triangle]
    low, middle, high = np.sort(faces, axis=1).T
    edge = numbered(np.stack([low, middle], axis=1))
    _, first, inverse = np.unique(numbered(np.stack([edge, high], axis=1)), return_index=True, return_inverse=True)
    if len(first) == len(faces):
        return faces
    # of faces with equal corners, faces of equal orientation are one face, and faces of opposite orientation cancel
    net = np.bincount(inverse, weights=_parity(faces), minlength=len(first))
    sense = _parity(faces[first])
    keep = net != 0.0
    result: IntArray = np.where((net * sense < 0.0)[:, None], faces[first][:, ::-1], faces[first])[keep]
    if len(result) < 4:
        raise GeometryError("The faces coincide and enclose no volume: the surface is a sheet")
    log.add_repair(Message("removed {number} duplicate faces", {"number": len(faces) - len(result)}))
    return result


def _parity(faces: IntArray) -> FloatArray:
    a, b, c = faces.T
    return np.where(((a < b) & (b < c)) | ((b < c) & (c < a)) | ((c < a) & (a < b)), 1.0, -1.0)
