"""Smoothing of self-intersections from noise."""

import numpy as np

from rocking.bodies.moments import polyhedron_moments
from rocking.bodies.solid.repair.log import MOST_VOLUME, SKINS, RepairLog
from rocking.bodies.solid.self_intersection import check_self_intersection, find_crossings
from rocking.bodies.solid.surfaces import area_vectors
from rocking.bodies.solid.triangles import directed_edges
from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.errors import GeometryError
from rocking.messages import Message

_ROUNDS = 12  # largest number of rounds of smoothing [-]
_RELAX = 0.5  # displacement / distance to the mean of the neighbours, per round [-]
_MOST_SWEPT = 0.5  # largest swept volume / volume if all repairs are allowed [-]


def smooth_crossings(points: FloatArray, faces: IntArray, log: RepairLog) -> tuple[FloatArray, IntArray]:
    """Return the surface without self-intersections, after repeated local smoothing."""
    crossings = find_crossings(points[faces])
    first, before, smoothed = crossings, points, np.zeros(len(points), dtype=bool)
    for _ in range(_ROUNDS if log.allowed != "none" else 0):
        if not crossings.pairs:
            break
        core = np.zeros(len(points), dtype=bool)
        core[faces[crossings.faces]] = True
        smoothed[faces[core[faces].any(axis=1)]] = True
        points = _smoothed(points, faces, smoothed)
        crossings = find_crossings(points[faces])
    moved = np.linalg.norm(points - before, axis=1)
    swept = np.linalg.norm(area_vectors(before[faces]), axis=1) * moved[faces].mean(axis=1)
    limit = MOST_VOLUME if log.allowed == "safe" else _MOST_SWEPT
    if crossings.pairs or swept.sum() > limit * abs(polyhedron_moments(before[faces]).mass):
        raise GeometryError(
            "The surface intersects itself, mainly near {point}. {pairs} pair(s) of faces cross, and smoothing does "
            "not separate them", point=log.describe(first.location), pairs=first.pairs,
            hint=Message(
                "repair the mesh in the program that wrote it, for instance by a boolean union, or use {wrap} or "
                "{hull} for a "
                "skin around its points", SKINS,
            ),
        )  # fmt: skip
    if first.pairs:
        log.add_repair(
            Message(
                "smoothed {vertices} vertices at {pairs} pair(s) of crossing faces, by up to {distance:.2g} mm",
                {"vertices": int(smoothed.sum()), "pairs": int(first.pairs), "distance": float(1000.0 * moved.max())},
            ),
            float(swept.sum()),
            (before[faces].mean(axis=1) * swept[:, None]).sum(axis=0) / swept.sum(),
        )
    if not check_self_intersection(points[faces], log.describe, crossings):
        log.add_note(Message("too many adjacent faces for a complete check of self-intersections"))
    return points, faces


def _smoothed(points: FloatArray, faces: IntArray, is_moved: BoolArray) -> FloatArray:
    """Return the points; selected points are moved half way to the mean of their neighbours."""
    edges = directed_edges(faces[is_moved[faces].any(axis=1)])
    count = np.bincount(edges[:, 0], minlength=len(points))
    sums = [np.bincount(edges[:, 0], weights=points[edges[:, 1], i], minlength=len(points)) for i in range(3)]
    mean = np.stack(sums, axis=1) / np.maximum(count, 1)[:, None]
    return np.where(is_moved[:, None], points + _RELAX * (mean - points), points)
