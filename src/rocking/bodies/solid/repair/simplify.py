"""Simplification of surfaces with many faces."""

import numpy as np

from rocking.bodies.moments import polyhedron_moments
from rocking.bodies.solid.repair.log import RepairLog
from rocking.bodies.solid.repair.manifolds import manifold, triangles_of
from rocking.bodies.solid.triangles import largest_extent
from rocking.conventions import FloatArray, IntArray
from rocking.errors import GeometryError
from rocking.messages import Message

MOST_FACES = 200_000  # largest number of faces without simplification [-]
FINEST = 1e-4  # largest shift of the hull by the simplification / size [-]
WORTH = 0.7  # largest fraction of faces after a useful simplification [-]
_MOST_DISTANCES = 20_000_000  # largest number of distances of points and planes that are computed together [-]


def simplify(points: FloatArray, faces: IntArray, log: RepairLog) -> tuple[FloatArray, IntArray]:
    """Return a simplified surface with a shift of the convex hull of at most 1e-4 of the size."""
    if len(faces) <= MOST_FACES or log.allowed == "none":
        return points, faces
    bound = FINEST * largest_extent(points)
    try:
        body = manifold(points, faces)
    except GeometryError:  # the surface has touching faces; without simplification only the speed is lower
        return points, faces
    for fraction in (1.0, 0.5, 0.25, 0.1):
        fewer_points, fewer = triangles_of(body.simplify(fraction * bound))
        if len(fewer) > WORTH * len(faces):
            return points, faces
        moved = _hull_distance(points, fewer_points, bound)
        if moved <= bound:
            break
    else:
        return points, faces
    before, after = polyhedron_moments(points[faces]), polyhedron_moments(fewer_points[fewer])
    shift = float(np.linalg.norm(after.centre - before.centre))
    log.add_repair(
        Message(
            "simplified from {before} to {after} faces; shift of the hull at most {hull:.2g} mm, of the centre of mass "
            "{centre:.2g} mm",
            {"before": len(faces), "after": len(fewer), "hull": 1000.0 * moved, "centre": 1000.0 * shift},
        ),
        abs(after.mass - before.mass),
    )
    return fewer_points, fewer


def _hull_distance(points: FloatArray, fewer: FloatArray, bound: float) -> float:
    """Return the largest distance of points outside the hull of fewer points [m]; approximate up to `bound`."""
    from scipy.spatial import ConvexHull, cKDTree

    corners = points[ConvexHull(points).vertices]
    near = np.asarray(cKDTree(fewer).query(corners)[0])
    far = corners[near > bound]
    largest = float(near[near <= bound].max(initial=0.0))
    if len(far):
        planes = np.unique(ConvexHull(fewer).equations.round(12), axis=0)
        for chunk in np.array_split(far, 1 + len(far) * len(planes) // _MOST_DISTANCES):
            largest = max(largest, float((chunk @ planes[:, :3].T + planes[:, 3]).max()))
    return largest
