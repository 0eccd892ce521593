"""Integrals over the mass of a solid that are homogeneous about the place it lands on.

A product of features of degrees i and j about the landing point, divided by a squared length, is homogeneous; over the
volume it is a sum over the surface (`samples`). About an edge and upright the one integral of the plane, Eq. 17 of
Mao et al. 2024, is exact for extrusions along it.
"""

from collections.abc import Callable
from functools import lru_cache

import numpy as np

from rocking.bodies.solid import Edge, Part, Polyhedron, Prism, Solid
from rocking.bodies.solid.sampling import Distance, samples
from rocking.conventions import FloatArray
from rocking.portable import applied, gram, times
from rocking.restitution.ked_integrals import ring_integral

Features = Callable[[FloatArray], tuple[FloatArray, FloatArray]]

_NEGLIGIBLE = 1e-17
# a round surface hugs the tangent over a long way: 1e-10 of the integral needs no more
_NEGLIGIBLE_ROUND = 1e-13
_ALONG = 1e-12
_CACHED = 256


def line_moment(solid: Solid, edge: Edge) -> float:
    """Return ``Int z^4/(t^2 + z^2) dm`` about a line, the numerator of Eq. 17 (Mao et al. 2024) in space.

    For extrusions along the line it is the exact integral of the polygon times the length.

    edge: the line on the ground, in the body's frame [m]. Returns the integral [kg m2].
    """
    return _line_moment(solid, *edge.point.tolist(), *edge.direction.tolist())


@lru_cache(maxsize=_CACHED)
def _line_moment(solid: Solid, x: float, y: float, z: float, *direction: float) -> float:
    point, edge = np.array([x, y, z]), np.array(direction)
    total = 0.0
    for part in solid.local_parts:
        exact = extruded_moment(part, point, edge)
        total += _line_moment_part(part, point, edge) if exact is None else exact
    return total


def extruded_moment(part: Part, point: FloatArray, edge: FloatArray) -> float | None:
    """Return the exact integral of a part that is extruded along the line; None for any other.

    point, edge: A point of the line [m], and the unit vector along it [-]. Returns ``Int z^4/(t^2 + z^2) dm`` [kg m2].
    """
    prism = part.shape
    if not isinstance(prism, Prism) or not np.abs(np.cross(part.rotation[:, 2], edge)).max() <= _ALONG:
        return None
    across = np.array([-edge[1], edge[0], 0.0])
    frame = np.stack([across, np.array([0.0, 0.0, 1.0])])
    plane, shift = times(frame, part.rotation[:, :2]), applied(frame, part.translation - point)
    turned = float(np.sign(plane[0, 0] * plane[1, 1] - plane[0, 1] * plane[1, 0]))
    length = part.density * prism.length
    return length * turned * sum(ring_integral(times(ring, plane.T) + shift) for ring in prism.region.rings)


def _line_moment_part(part: Part, point: FloatArray, edge: FloatArray) -> float:
    def features(s: FloatArray) -> tuple[FloatArray, FloatArray]:
        inverse = 1.0 / np.maximum(distance(s), 1e-300)
        return (s[:, 2] ** 2 * inverse)[:, None], np.ones(1)

    distance = distance_to(edge)
    return float(of_part(part, point, features, (distance, _height_squared))[0, 0])


def distance_to(edge: FloatArray) -> Distance:
    """Return the function that measures distances to a line through the origin.

    edge: unit vector along it [-]. Returns takes points (n, 3) and returns their distances [m].
    """
    return lambda s: np.linalg.norm(np.cross(edge, s), axis=1)


def norm(s: FloatArray) -> FloatArray:
    """Return the distances of points from the origin.

    s: points [m]. Returns distances [m].
    """
    norms: FloatArray = np.linalg.norm(s, axis=1)
    return norms


def of_part(part: Part, point: FloatArray, features: Features, graded: tuple[Distance, Distance | None]) -> FloatArray:
    """Return ``Int f f^T dm`` over a part: the sum of ``f f^T (s . dA)/(k + 3)``, degree k entry by entry.

    point: the point about which the features are homogeneous [m].
    """
    distance, bound = graded
    shape, shift = part.shape, part.translation - point
    negligible = (_NEGLIGIBLE if isinstance(shape, Polyhedron) else _NEGLIGIBLE_ROUND) * shape.moments().mass
    if bound is not None:
        negligible = _NEGLIGIBLE * shape.moments().mass * float(np.ptp(shape.extent(part.rotation), axis=0).max()) ** 2
    total: FloatArray = np.zeros(())
    degrees: FloatArray = np.zeros(())
    for points, areas in samples(shape.surfaces(part.rotation, shift), distance, negligible, bound):
        cone = (points * areas).sum(axis=1)
        scaled, degrees = features(points)
        total = total + gram(scaled, cone)
    return part.density * total / (degrees[:, None] + degrees[None, :] + 3.0)  # Eq. 107


def _height_squared(s: FloatArray) -> FloatArray:
    squared: FloatArray = s[:, 2] ** 2
    return squared
