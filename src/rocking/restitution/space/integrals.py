"""Integrals over the mass of a solid as sums over its surface. Integrands are homogeneous about landing point or edge.

Stage 2 of KED depends on the attitude only through the projection, so that the moments are computed once per landing.
The moments are not the tensors K of Eq. 106, but their components in one symmetric matrix. The component of v along the
direction that stage 2 removes, or allows, is ``(linear . A u + quadratic . B W)/length``, with the components of s
(linear) and their products (quadratic).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from rocking.bodies.solid import Corner, Edge, Part, Polyhedron, Prism, Solid
from rocking.bodies.solid.sampling import Distance, samples
from rocking.bodies.solid.surfaces import TriangleSurface, area_vectors, placed_points
from rocking.bodies.solid.triangles import directed_edges, edge_numbers
from rocking.conventions import FloatArray, IntArray
from rocking.portable import applied, dot, gram, times
from rocking.restitution.ked import edge_integrals, ring_integral

Features = Callable[[FloatArray], tuple[FloatArray, FloatArray]]

_NEGLIGIBLE = 1e-17
# a round surface is close to its tangent over a long distance; this value is sufficient for 1e-10 of the integral
_NEGLIGIBLE_ROUND = 1e-13
_ALONG = 1e-12
_STEEP = 1e-3
_CACHED = 256


def line_moment(solid: Solid, edge: Edge) -> float:
    """Return ``Int z^4/(t^2 + z^2) dm`` about a line, the numerator of Eq. 17 (Mao et al. 2024) in 3D."""
    return _line_moment(solid, *edge.point.tolist(), *edge.direction.tolist())


@lru_cache(maxsize=_CACHED)
def _line_moment(solid: Solid, x: float, y: float, z: float, *direction: float) -> float:
    point, edge = np.array([x, y, z]), np.array(direction)
    distance, total = distance_to(edge), 0.0

    def features(s: FloatArray) -> tuple[FloatArray, FloatArray]:
        return (s[:, 2] ** 2 * (1.0 / np.maximum(distance(s), 1e-300)))[:, None], np.ones(1)

    for part in solid.local_parts:
        exact = exact_moment(part, point, edge)
        if exact is None:
            exact = float(of_part(part, point, features, (distance, height_squared))[0, 0])
        total += exact
    return total


def exact_moment(part: Part, point: FloatArray, edge: FloatArray) -> float | None:
    """Return the exact KED integral of a polyhedral part about a horizontal axis; None for other shapes."""
    if not isinstance(part.shape, Polyhedron):
        return None
    if isinstance(part.shape, Prism) and np.abs(np.cross(part.rotation[:, 2], edge)).max() <= _ALONG:
        return _extruded_moment(part, part.shape, point, edge)
    return part.density * _facets(part).moment(point, edge)


def _extruded_moment(part: Part, prism: Prism, point: FloatArray, edge: FloatArray) -> float:
    across = np.array([-edge[1], edge[0], 0.0])
    frame = np.stack([across, np.array([0.0, 0.0, 1.0])])
    plane, shift = times(frame, part.rotation[:, :2]), applied(frame, part.translation - point)
    turned = float(np.sign(plane[0, 0] * plane[1, 1] - plane[0, 1] * plane[1, 0]))
    length = part.density * prism.length
    return length * turned * sum(ring_integral(times(ring, plane.T) + shift) for ring in prism.region.rings)


class _Facets:
    """Flat faces of a part in its position. Common edges of faces are included once."""

    def __init__(self, vertices: FloatArray, faces: IntArray) -> None:
        self.vertices, self.faces = vertices, faces
        self.areas = area_vectors(vertices[faces])
        ends = directed_edges(faces)
        _, first, self.numbers = np.unique(edge_numbers(faces), return_index=True, return_inverse=True)
        self.ends = ends[first]
        self.signs = np.where(ends[:, 0] == self.ends[self.numbers, 0], 1.0, -1.0)

    def moment(self, point: FloatArray, edge: FloatArray) -> float:
        """Return ``Int z^4/(t^2 + z^2) dV`` about a line [m5], with t and z normal to the line and z upwards."""
        s = self.vertices - point
        cones = (self.areas * s[self.faces[:, 0]]).sum(axis=1)
        along = self.areas[:, 0] * edge[0] + self.areas[:, 1] * edge[1]
        steep = np.abs(along) > _STEEP * np.sqrt(np.square(self.areas).sum(axis=1))
        ratios = np.divide(cones, along, out=np.zeros(len(along)), where=steep)
        weights = np.bincount(self.numbers, self.signs * np.tile(ratios, 3))
        projected = np.stack([s[:, 1] * edge[0] - s[:, 0] * edge[1], s[:, 2]], axis=1)
        start, end = projected[self.ends[weights != 0.0]].swapaxes(0, 1)
        total = float((weights[weights != 0.0] * edge_integrals(start, end)).sum()) / 20.0  # Eq. 322
        # other faces have no projected area along the line, and would cause cancellation
        horizontal_faces, distance = TriangleSurface(s[self.faces[~steep]]), distance_to(edge)
        negligible = _NEGLIGIBLE * float(np.abs(cones).sum() * np.square(s[:, 2]).max())
        for points, areas in samples([horizontal_faces], distance, negligible, height_squared):
            terms = np.square(points[:, 2] ** 2 / np.maximum(distance(points), 1e-300)) * (points * areas).sum(axis=1)
            total += 0.2 * float(terms.sum())  # Eq. 107
        return total


@lru_cache(maxsize=64)
def _facets(part: Part) -> _Facets:
    assert isinstance(part.shape, Polyhedron)
    return _Facets(placed_points(part.shape.vertices, part.rotation, part.translation), part.shape.faces)


def distance_to(edge: FloatArray) -> Distance:
    """Return the function of the distance to a line through the origin."""
    return lambda s: np.linalg.norm(np.cross(edge, s), axis=1)


def norm(s: FloatArray) -> FloatArray:
    """Return the distances of points from the origin."""
    return np.asarray(np.linalg.norm(s, axis=1))


def of_part(part: Part, point: FloatArray, features: Features, graded: tuple[Distance, Distance | None]) -> FloatArray:
    """Return ``Int f f^T dm`` over a part: the sum of ``f f^T (s . dA)/(k + 3)``, with degree k of every entry."""
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


def height_squared(s: FloatArray) -> FloatArray:
    """Return the squared heights of points."""
    return np.asarray(s[:, 2] ** 2)


_UP = np.array([0.0, 0.0, 1.0])
_PAIRS = np.array([(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)])


@dataclass(frozen=True, eq=False)
class KeptMoments:
    """Moments of the mass points with the velocities after stage 2 of KED."""

    form: FloatArray  # products of n quadratic and m linear features / squared length; shape (n + m, n + m)
    directions: FloatArray  # A: directions of the linear features [-]; shape (m, 3)
    products: FloatArray  # coefficients of linear features times s in the quadratic features [-]; shape (n, m, 3)
    # mass, first and second moments about the landing point; at a corner, the form is subtracted from these; zero at an
    # edge, where the form is added
    totals: tuple[float, FloatArray, FloatArray]
    sign: float

    @property
    def second(self) -> FloatArray:
        """``Int Q_ij dm``, shape (3, 3) [kg]."""
        count = len(self.directions)
        tensor = times(times(self.directions.T, self.form[-count:, -count:]), self.directions)
        return self.totals[0] * np.eye(3) + self.sign * tensor

    @property
    def third(self) -> FloatArray:
        """``Int Q_ij s_k dm``, shape (3, 3, 3) [kg m]."""
        count = len(self.directions)
        mixed = times(self.form[-count:, :-count], self._factors.reshape(-1, 9))
        tensor = np.einsum("pi,pjk->ijk", self.directions, mixed.reshape(-1, 3, 3))
        return np.asarray(np.einsum("ij,k->ijk", np.eye(3), self.totals[1]) + self.sign * tensor)

    @property
    def fourth(self) -> FloatArray:
        """``Int Q_ij s_k s_l dm``, shape (3, 3, 3, 3) [kg m2]."""
        count = len(self.directions)
        form = self.form[:-count, :-count]
        tensor = np.einsum("pik,pq,qjl->ijkl", self._factors, form, self._factors, optimize=True)
        return np.asarray(np.einsum("ij,kl->ijkl", np.eye(3), self.totals[2]) + self.sign * tensor)

    @cached_property
    def _factors(self) -> FloatArray:
        """B: coefficients of the quadratic features in ``sum A_i W_ik s_k``, shape (n, 3, 3)."""
        return np.asarray(np.einsum("nqk,qi->nik", self.products, self.directions))

    def coefficients(self, drift: FloatArray, gradient: FloatArray) -> FloatArray:
        """Return the coefficients of a velocity field u + W s (u [m/s], W [1/s]) in the features, quadratic first."""
        quadratic = applied(self._factors.reshape(-1, 9), gradient.ravel())
        return np.concatenate([quadratic, applied(self.directions, drift)])

    def energy_left(self, drift: FloatArray, gradient: FloatArray) -> float:
        """Return the kinetic energy of the velocities ``u + W s`` after stage 2 [J]."""
        state = self.coefficients(drift, gradient)
        along = dot(state, applied(self.form, state))  # Eq. 106
        mass, first, second = self.totals
        crossed = 2.0 * dot(drift, applied(gradient, first))
        total = mass * dot(drift, drift) + crossed + float((times(gradient, second) * gradient).sum())
        return 0.5 * max(total + self.sign * along, 0.0)


def kept_moments(solid: Solid, onto: Corner | Edge) -> KeptMoments:
    """Return the moments after stage 2 of KED about a corner or an edge in the frame of the solid [m]."""
    # at a corner two of three directions remain: the trace of the mass matrix is twice the mass; at an edge it is the
    # mass
    if isinstance(onto, Edge):
        return _about_line(solid, *onto.point.tolist(), *onto.direction.tolist())
    return _about_point(solid, *onto.point.tolist())


@lru_cache(maxsize=_CACHED)
def _about_point(solid: Solid, x: float, y: float, z: float) -> KeptMoments:
    point = np.array([x, y, z])
    form = sum((of_part(part, point, _corner_features, (norm, None)) for part in solid.local_parts), np.zeros(()))
    products = np.zeros((6, 3, 3))
    for index, (i, j) in enumerate(_PAIRS):
        products[index, i, j] = products[index, j, i] = 1.0
    moments = solid.local_moments
    totals = moments.mass, moments.mass * (moments.centre - point), moments.second_about(point)
    return KeptMoments(form, np.eye(3), products, totals, -1.0)


@lru_cache(maxsize=_CACHED)
def _about_line(solid: Solid, x: float, y: float, z: float, *direction: float) -> KeptMoments:
    point, frame = np.array([x, y, z]), edge_frame(np.array(direction))
    graded = distance_to(frame[0]), None

    def features(s: FloatArray) -> tuple[FloatArray, FloatArray]:
        return _edge_features(times(s, frame.T))

    form = sum((of_part(part, point, features, graded) for part in solid.local_parts), np.zeros(()))
    e, f, g = frame
    # s = sigma e + t f + z g; quadratic features zz, z sigma, tz, tt, t sigma; linear ones z and t
    zero = np.zeros(3)
    products = np.array([[g, zero], [e, zero], [f, g], [zero, f], [zero, e]])
    return KeptMoments(form, np.stack([-f, g]), products, (0.0, zero, np.zeros((3, 3))), 1.0)


def edge_frame(direction: FloatArray) -> FloatArray:
    """Return the axes of an edge as rows: e along the edge, f = n x e horizontal across the edge, and g = e x f."""
    across = np.cross(_UP, direction)
    across /= math.sqrt(dot(across, across))
    return np.stack([direction, across, np.cross(direction, across)])


def _corner_features(s: FloatArray) -> tuple[FloatArray, FloatArray]:
    inverse = 1.0 / np.maximum(norm(s), 1e-300)
    quadratic = s[:, _PAIRS[:, 0]] * s[:, _PAIRS[:, 1]]
    # degrees over |s| are one less than the degrees of the features
    return np.column_stack([quadratic, s]) * inverse[:, None], np.repeat([1.0, 0.0], [6, 3])


def _edge_features(local: FloatArray) -> tuple[FloatArray, FloatArray]:
    sigma, t, z = local.T
    inverse = 1.0 / np.maximum(np.sqrt(t * t + z * z), 1e-300)
    features = np.stack([z * z, z * sigma, t * z, t * t, t * sigma, z, t], axis=1)
    return features * inverse[:, None], np.repeat([1.0, 0.0], [5, 2])
