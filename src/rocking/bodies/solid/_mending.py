"""Repairs of scanned surfaces: loose pieces, fins, and self-intersections from noise."""

import numpy as np

from rocking.bodies.moments import polyhedron_moments
from rocking.bodies.solid._changes import MOST_VOLUME, SKINS, Changes
from rocking.bodies.solid._self_crossing import check_crossings, pierced
from rocking.bodies.solid._shells import connected, neighbours
from rocking.bodies.solid.polyhedron import directed_edges, edge_numbers
from rocking.bodies.solid.surfaces import area_vectors
from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.errors import GeometryError
from rocking.messages import Message

THIN = 0.05  # largest thickness / width of a sheet [-]
DUST, SPECK = 1e-3, 1e-6  # largest box of an ignored open piece, closed piece / largest box [-]
FIN = 0.05  # largest area of fins / area of the surface [-]

_ROUNDS, _RELAX, _MOST_SWEPT = 12, 0.5, 0.5


def without_dust(points: FloatArray, faces: IntArray, changes: Changes) -> IntArray:
    """Return the faces without small loose pieces."""
    labels = connected(len(points), faces[:, [0, 1]].ravel(), faces[:, [1, 2]].ravel())[faces[:, 0]]
    _, labels = np.unique(labels, return_inverse=True)
    count = int(labels.max()) + 1
    if count == 1:
        return faces
    starts = np.flatnonzero(np.diff(np.append(-1, np.sort(labels))))
    corners = points[faces[np.argsort(labels, kind="stable")]]
    low = np.minimum.reduceat(corners.min(axis=1), starts)
    high = np.maximum.reduceat(corners.max(axis=1), starts)
    room = (high - low).prod(axis=1)
    numbers = edge_numbers(faces)
    is_open = np.zeros(count, dtype=bool)
    is_open[np.tile(labels, 3)[np.bincount(numbers)[numbers] == 1]] = True
    dust = room < np.where(is_open, DUST, SPECK) * room.max()
    sheets = [k for k in np.flatnonzero(is_open & ~dust & (room < room.max())) if _is_sheet(points[faces[labels == k]])]
    if sheets:
        changes.add_repair(
            Message(
                "removed {sheets} separate open sheet(s), such as the support of a scan, {faces} faces",
                {"sheets": len(sheets), "faces": int(np.isin(labels, sheets).sum())},
            )
        )
    if dust.any():
        total_room = float(room[dust].sum())
        location = (0.5 * (low + high) * room[:, None])[dust].sum(axis=0) / total_room if total_room else None
        facts = {"pieces": int(dust.sum()), "faces": int(dust[labels].sum())}
        loose = Message("removed {pieces} small loose piece(s), {faces} faces", facts)
        changes.add_repair(loose, total_room, location)
    dust[sheets] = True
    kept: IntArray = faces[~dust[labels]]
    return kept


def _is_sheet(triangles: FloatArray) -> bool:
    """Return True if the corners lie near one plane."""
    corners = triangles.reshape(-1, 3)
    arms = corners - corners.mean(axis=0)
    along = np.ptp(arms @ np.linalg.eigh(arms.T @ arms)[1], axis=0)
    return bool(along[0] < THIN * along[2])


def without_fins(points: FloatArray, faces: IntArray, changes: Changes) -> IntArray:
    """Return the faces without fins: sheets from an edge of the surface with a free end."""
    numbers = edge_numbers(faces)
    counts = np.bincount(numbers)[numbers]
    if (counts <= 2).all():
        return faces
    labels = connected(len(faces), *neighbours(faces)[:2])
    areas = np.bincount(labels, weights=np.linalg.norm(area_vectors(points[faces]), axis=1))
    owners = np.tile(labels, 3)
    fin = np.zeros(len(areas), dtype=bool)
    fin[np.intersect1d(owners[counts == 1], owners[counts > 2])] = True
    fin &= areas < FIN * areas.sum()
    if fin.any():
        facts = {"faces": int(fin[labels].sum())}
        changes.add_repair(Message("removed {faces} faces of fins", facts))
    kept: IntArray = faces[~fin[labels]]
    return kept


def uncrossed(points: FloatArray, faces: IntArray, changes: Changes) -> tuple[FloatArray, IntArray]:
    """Return the surface without self-intersections, after repeated local smoothing."""
    piercing = pierced(points[faces])
    first, before, smoothed = piercing, points, np.zeros(len(points), dtype=bool)
    for _ in range(_ROUNDS if changes.allowed != "none" else 0):
        if not piercing.pairs:
            break
        core = np.zeros(len(points), dtype=bool)
        core[faces[piercing.faces]] = True
        smoothed[faces[core[faces].any(axis=1)]] = True
        points = _smoothed(points, faces, smoothed)
        piercing = pierced(points[faces])
    moved = np.linalg.norm(points - before, axis=1)
    swept = np.linalg.norm(area_vectors(before[faces]), axis=1) * moved[faces].mean(axis=1)
    limit = MOST_VOLUME if changes.allowed == "safe" else _MOST_SWEPT
    if piercing.pairs or swept.sum() > limit * abs(polyhedron_moments(before[faces]).mass):
        raise GeometryError(
            "The surface intersects itself, mainly near {point}. {pairs} pair(s) of faces cross, and smoothing does "
            "not separate them", point=changes.describe(first.location), pairs=first.pairs,
            hint=Message(
                "repair the mesh in its own program, for instance by a boolean union, or use {wrap} or {hull} for a "
                "skin around its points", SKINS,
            ),
        )  # fmt: skip
    if first.pairs:
        changes.add_repair(
            Message(
                "smoothed {vertices} vertices at {pairs} pair(s) of crossing faces, by up to {distance:.2g} mm",
                {"vertices": int(smoothed.sum()), "pairs": int(first.pairs), "distance": float(1000.0 * moved.max())},
            ),
            float(swept.sum()),
            (before[faces].mean(axis=1) * swept[:, None]).sum(axis=0) / swept.sum(),
        )
    if not check_crossings(points[faces], changes.describe, piercing):
        changes.add_note(Message("too many adjacent faces for a complete check of self-intersections"))
    return points, faces


def _smoothed(points: FloatArray, faces: IntArray, is_moved: BoolArray) -> FloatArray:
    """Return the points; the selected ones are moved half way to the mean of their neighbours."""
    edges = directed_edges(faces[is_moved[faces].any(axis=1)])
    count = np.bincount(edges[:, 0], minlength=len(points))
    sums = [np.bincount(edges[:, 0], weights=points[edges[:, 1], i], minlength=len(points)) for i in range(3)]
    mean = np.stack(sums, axis=1) / np.maximum(count, 1)[:, None]
    return np.where(is_moved[:, None], points + _RELAX * (mean - points), points)
