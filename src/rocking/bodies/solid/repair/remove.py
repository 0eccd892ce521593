"""Removal of loose pieces and fins of scans."""

import numpy as np

from rocking.bodies.solid.repair.log import RepairLog
from rocking.bodies.solid.surfaces import area_vectors
from rocking.bodies.solid.triangles import connected, edge_numbers, neighbours
from rocking.conventions import FloatArray, IntArray
from rocking.messages import Message

THIN = 0.05  # largest thickness / width of a sheet [-]
LOOSE_OPEN = 1e-3  # bounding box of the largest removed open piece / largest bounding box [-]
LOOSE_CLOSED = 1e-6  # bounding box of the largest removed closed piece / largest bounding box [-]
FIN = 0.05  # largest area of fins / area of the surface [-]


def remove_loose_pieces(points: FloatArray, faces: IntArray, log: RepairLog) -> IntArray:
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
    loose = room < np.where(is_open, LOOSE_OPEN, LOOSE_CLOSED) * room.max()
    sheets = [
        k for k in np.flatnonzero(is_open & ~loose & (room < room.max())) if _is_sheet(points[faces[labels == k]])
    ]
    if sheets:
        log.add_repair(
            Message(
                "removed {sheets} separate open sheet(s), such as the support of a scan, {faces} faces",
                {"sheets": len(sheets), "faces": int(np.isin(labels, sheets).sum())},
            )
        )
    if loose.any():
        total_room = float(room[loose].sum())
        location = (0.5 * (low + high) * room[:, None])[loose].sum(axis=0) / total_room if total_room else None
        facts = {"pieces": int(loose.sum()), "faces": int(loose[labels].sum())}
        sentence = Message("removed {pieces} small loose piece(s), {faces} faces", facts)
        log.add_repair(sentence, total_room, location)
    loose[sheets] = True
    kept: IntArray = faces[~loose[labels]]
    return kept


def _is_sheet(triangles: FloatArray) -> bool:
    """Return True if the corners lie near one plane."""
    corners = triangles.reshape(-1, 3)
    arms = corners - corners.mean(axis=0)
    along = np.ptp(arms @ np.linalg.eigh(arms.T @ arms)[1], axis=0)
    return bool(along[0] < THIN * along[2])


def remove_fins(points: FloatArray, faces: IntArray, log: RepairLog) -> IntArray:
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
        log.add_repair(Message("removed {faces} faces of fins", facts))
    kept: IntArray = faces[~fin[labels]]
    return kept
