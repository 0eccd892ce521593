"""How a body comes to rest: let down from where it is held, it turns onto what lies under its centre until it stays."""

import numpy as np

from rocking.bodies.equilibria.poses import set_down
from rocking.bodies.solid.base import hull
from rocking.conventions import FloatArray
from rocking.errors import GeometryError

_DOWN = np.array([0.0, 0.0, -1.0])
_AHEAD = 1e-9


def stands(points: FloatArray, centre: FloatArray, tolerance: float) -> bool:
    """Return whether the centre lies above the hull of the points that are within a tolerance of the lowest [m]."""
    low = points[points[:, 2] <= points[:, 2].min() + tolerance, :2]
    try:
        return hull(low).margin(centre[:2]) > 1e-12 * float(np.ptp(points, axis=0).max())
    except GeometryError:
        return False


def settled(points: FloatArray, centre: FloatArray) -> FloatArray:
    """Return the rotation that lets a body down, from as it is onto a facet of its hull that holds its centre."""
    # The ray from the centre downward leaves the hull through a facet; the body is turned onto that, and again, until
    # the ray leaves through the facet that it lies on. The centre comes lower each time: from z / cos(angle) to z.
    from scipy.spatial import ConvexHull

    equations = ConvexHull(points - centre).equations
    normals, distances = equations[:, :3], -equations[:, 3]
    down, lowest = _DOWN, np.inf
    while True:
        ahead = normals @ down
        through = np.divide(distances, ahead, out=np.full(len(ahead), np.inf), where=ahead > _AHEAD)
        facet = int(np.argmin(through))
        if not distances[facet] < lowest * (1.0 - 1e-12):
            return set_down(down)
        down, lowest = normals[facet], float(distances[facet])
