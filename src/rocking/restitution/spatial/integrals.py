"""The integrals of KED in space, about a point and about a line.

After stage 1 the velocity of a mass point is horizontal, ``v = P_h (omega x s + c)``, with s from the landing point
and c its velocity. Stage 2 about a point removes ``(s . v)^2/|s|^2``, and ``s . v = g . (omega_x, omega_y, c_x, c_y)``
with ``g = (-y z, x z, x, y)``. About a line along e it keeps ``((e x s) . v)^2/|e x s|^2``, and
``(e x s) . v = h . (omega_e, omega_z, c_m)`` with ``h = (z^2, -z sigma, z)``, sigma along the line and m = e x n.
So one symmetric matrix serves every angular velocity.
"""

from collections.abc import Callable
from functools import lru_cache

import numpy as np

from rocking.bodies.solid import Edge, Part, Polyhedron, Prism, Solid
from rocking.bodies.solid.sampling import Distance, samples
from rocking.conventions import FloatArray
from rocking.restitution.ked_integrals import ring_integral

Features = Callable[[FloatArray], tuple[FloatArray, FloatArray]]

_NEGLIGIBLE = 1e-17
# a round surface hugs the tangent over a long way: 1e-10 of the integral needs no more
_NEGLIGIBLE_ROUND = 1e-13
_ALONG = 1e-12
_CACHED = 256


def point_matrix(solid: Solid, point: FloatArray) -> FloatArray:
    """Return the matrix of what stage 2 removes about a point, ``Int g g^T/|s|^2 dm``.

    Parameters
    ----------
    solid : Solid
        The body.
    point : ndarray, shape (3,)
        The point on the ground, in the body's frame [m].

    Returns
    -------
    ndarray, shape (4, 4)
        Twice the energy removed is ``q^T K q`` with ``q = (omega_x, omega_y, c_x, c_y)``.
    """
    return _point_matrix(solid, *point.tolist())


def line_matrix(solid: Solid, edge: Edge) -> FloatArray:
    """Return the matrix of what stage 2 keeps about a line, ``Int h h^T/|e x s|^2 dm``.

    Parameters
    ----------
    solid : Solid
        The body.
    edge : Edge
        The line on the ground, in the body's frame [m].

    Returns
    -------
    ndarray, shape (3, 3)
        Twice the energy kept is ``q^T K q`` with ``q = (omega_e, omega_z, c_m)``.
    """
    return _line_matrix(solid, *edge.point.tolist(), *edge.direction.tolist())


def line_moment(solid: Solid, edge: Edge) -> float:
    """Return ``Int z^4/(t^2 + z^2) dm`` about a line, the numerator of Eq. 17 (Mao et al. 2024) in space.

    For extrusions along the line it is the exact integral of the polygon times the length.

    Parameters
    ----------
    solid : Solid
        The body.
    edge : Edge
        The line on the ground, in the body's frame [m].

    Returns
    -------
    float
        The integral [kg m2].
    """
    return _line_moment(solid, *edge.point.tolist(), *edge.direction.tolist())


@lru_cache(maxsize=_CACHED)
def _point_matrix(solid: Solid, x: float, y: float, z: float) -> FloatArray:
    return sum(
        (_of_part(part, np.array([x, y, z]), _about_point, (_norm, None)) for part in solid.local_parts), np.zeros(())
    )


@lru_cache(maxsize=_CACHED)
def _line_matrix(solid: Solid, x: float, y: float, z: float, *direction: float) -> FloatArray:
    point, edge = np.array([x, y, z]), np.array(direction)
    return sum((_line_part(part, point, edge) for part in solid.local_parts), np.zeros(()))


@lru_cache(maxsize=_CACHED)
def _line_moment(solid: Solid, x: float, y: float, z: float, *direction: float) -> float:
    point, edge = np.array([x, y, z]), np.array(direction)
    total = 0.0
    for part in solid.local_parts:
        axis = part.rotation[:, 2]
        if isinstance(part.shape, Prism) and np.abs(np.cross(axis, edge)).max() <= _ALONG:
            total += part.density * _extruded(part, part.shape, point, edge)
        else:
            total += _line_moment_part(part, point, edge)
    return total


def _extruded(part: Part, prism: Prism, point: FloatArray, edge: FloatArray) -> float:
    across = np.array([-edge[1], edge[0], 0.0])
    frame = np.stack([across, np.array([0.0, 0.0, 1.0])])
    plane, shift = frame @ part.rotation[:, :2], frame @ (part.translation - point)
    turned = float(np.sign(np.linalg.det(plane)))
    return prism.length * turned * sum(ring_integral(ring @ plane.T + shift) for ring in prism.region.rings)


def _line_part(part: Part, point: FloatArray, edge: FloatArray) -> FloatArray:
    def features(s: FloatArray) -> tuple[FloatArray, FloatArray]:
        return _about_line(s, edge)

    return _of_part(part, point, features, (_distance_to(edge), None))


def _line_moment_part(part: Part, point: FloatArray, edge: FloatArray) -> float:
    def features(s: FloatArray) -> tuple[FloatArray, FloatArray]:
        return _about_line(s, edge)[0][:, :1], np.ones(1)

    return float(_of_part(part, point, features, (_distance_to(edge), _height_squared))[0, 0])


def _distance_to(edge: FloatArray) -> Distance:
    return lambda s: np.linalg.norm(np.cross(edge, s), axis=1)


def _of_part(part: Part, point: FloatArray, features: Features, graded: tuple[Distance, Distance | None]) -> FloatArray:
    """Sum ``f (s . dA)/(k + 3)``, degree k entry by entry."""
    distance, bound = graded
    shape, shift = part.shape, part.translation - point
    negligible = (_NEGLIGIBLE if isinstance(shape, Polyhedron) else _NEGLIGIBLE_ROUND) * shape.moments().mass
    if bound is not None:
        negligible = _NEGLIGIBLE * shape.moments().mass * float(np.ptp(shape.extent(part.rotation), axis=0).max()) ** 2
    total: FloatArray = np.zeros(())
    degrees: FloatArray = np.zeros(())
    for points, areas in samples(shape.surfaces(part.rotation, shift), distance, negligible, bound):
        cone = np.einsum("nd,nd->n", points, areas)
        scaled, degrees = features(points)
        total = total + (scaled * cone[:, None]).T @ scaled
    return part.density * total / (degrees[:, None] + degrees[None, :] + 3.0)


def _height_squared(s: FloatArray) -> FloatArray:
    squared: FloatArray = s[:, 2] ** 2
    return squared


def _norm(s: FloatArray) -> FloatArray:
    norms: FloatArray = np.linalg.norm(s, axis=1)
    return norms


def _about_point(s: FloatArray) -> tuple[FloatArray, FloatArray]:
    x, y, z = s.T
    inverse = 1.0 / np.maximum(_norm(s), 1e-300)
    # degrees of g/|s|: one less than those of g
    return np.stack([-y * z, x * z, x, y], axis=1) * inverse[:, None], np.array([1.0, 1.0, 0.0, 0.0])


def _about_line(s: FloatArray, edge: FloatArray) -> tuple[FloatArray, FloatArray]:
    z = s[:, 2]
    inverse = 1.0 / np.maximum(np.linalg.norm(np.cross(edge, s), axis=1), 1e-300)
    return np.stack([z * z, -z * (s @ edge), z], axis=1) * inverse[:, None], np.array([1.0, 1.0, 0.0])
