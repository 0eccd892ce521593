"""Triangles as vertex indices: edges, neighbours, connected pieces, orientation, areas."""

import numpy as np
from numpy.typing import ArrayLike

from rocking import checks
from rocking.bodies.solid.surfaces import area_vectors
from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.errors import GeometryError


def checked_triangles(vertices: ArrayLike, faces: ArrayLike, fewest: int = 4) -> tuple[FloatArray, IntArray]:
    """Return checked points [m] and triangles; `fewest` is the smallest allowed number of triangles."""
    points, numbers = checks.real_array("vertices", vertices, "m"), np.asarray(faces)
    if points.ndim != 2 or points.shape[1:] != (3,) or len(points) < 4:
        raise GeometryError(
            "vertices must be at least 4 points (x, y, z) in m, got an array of shape {shape}", shape=points.shape
        )
    finite = np.isfinite(points).all(axis=1)
    if not finite.all():
        bad = int(np.argmin(finite))
        raise GeometryError(
            "vertex {vertex} must be finite, got {point}", vertex=bad, point=tuple(points[bad].tolist()),
            hint="check the file",
        )  # fmt: skip
    if np.abs(points).max() > checks.LARGEST:
        raise GeometryError(
            "coordinates must be within {limit:g} m of the origin", limit=checks.LARGEST, hint="check the unit"
        )
    if numbers.ndim != 2 or numbers.shape[1:] != (3,) or numbers.dtype.kind not in "iu" or len(numbers) < fewest:
        raise GeometryError(
            ("faces must be at least {fewest} triangles of three vertex indices, got {type} of shape {shape}"),
            fewest=fewest,
            type=numbers.dtype,
            shape=numbers.shape,
        )
    if len(numbers) and (numbers.min() < 0 or numbers.max() >= len(points)):
        raise GeometryError(
            "faces must contain vertex indices from 0 to {last}, got {low} to {high}", last=len(points) - 1,
            low=int(numbers.min()), high=int(numbers.max()), hint="check that the indices start at 0",
        )  # fmt: skip
    return points.copy(), numbers.astype(np.int64)


def directed_edges(faces: IntArray) -> IntArray:
    """Return the directed edges of faces, shape (3 m, 2): all first edges, then all second and all third edges."""
    edges: IntArray = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    return edges


def numbered(pairs: IntArray) -> IntArray:
    """Return the index of each pair among the different pairs of integers."""
    base = int(pairs.max(initial=0)) + 1
    keys = pairs[:, 0] * base + pairs[:, 1]
    numbers: IntArray = np.unique(keys, return_inverse=True)[1]
    return numbers


def edge_numbers(faces: IntArray) -> IntArray:
    """Return the index of the undirected edge of each of `directed_edges`."""
    return numbered(np.sort(directed_edges(faces), axis=1))


def single_edges(faces: IntArray) -> IntArray:
    """Return the directed edges with exactly one face."""
    numbers = edge_numbers(faces)
    edges: IntArray = directed_edges(faces)[np.bincount(numbers)[numbers] == 1]
    return edges


def open_edges(faces: IntArray) -> IntArray:
    """Return the directed edges without a face in the opposite direction."""
    edges = directed_edges(faces).astype(np.int64)
    base = int(edges.max(initial=0)) + 1
    forward, back = edges[:, 0] * base + edges[:, 1], edges[:, 1] * base + edges[:, 0]
    keys, inverse = np.unique(np.concatenate([forward, back]), return_inverse=True)
    forward_count = np.bincount(inverse[: len(edges)], minlength=len(keys))
    reverse = np.bincount(inverse[len(edges) :], minlength=len(keys))
    unmatched = np.repeat(keys, np.maximum(forward_count - reverse, 0))
    return np.stack([unmatched // base, unmatched % base], axis=1)


def neighbours(faces: IntArray) -> tuple[IntArray, IntArray, BoolArray]:
    """Return pairs of faces at edges with exactly two faces, and True for equal directions along the edge."""
    edges = directed_edges(faces)
    owner = np.tile(np.arange(len(faces)), 3)
    forward = edges[:, 0] < edges[:, 1]
    numbers = edge_numbers(faces)
    counts, order = np.bincount(numbers), np.argsort(numbers, kind="stable")
    starts = (np.cumsum(counts) - counts)[counts == 2]
    first_edge, second_edge = order[starts], order[starts + 1]
    return owner[first_edge], owner[second_edge], forward[first_edge] == forward[second_edge]


def connected(count: int, first: IntArray, second: IntArray) -> IntArray:
    """Return the index of the connected component of each of `count` nodes with the given pairs as links."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    graph = coo_matrix((np.ones(len(first)), (first, second)), shape=(count, count))
    labels: IntArray = connected_components(graph, directed=False)[1].astype(np.int64)
    return labels


def used_points(points: FloatArray, faces: IntArray) -> tuple[FloatArray, IntArray]:
    """Return the points that faces use, and the faces with their new indices."""
    used, numbers = np.unique(faces, return_inverse=True)
    return points[used], numbers.reshape(faces.shape)


def total_area(triangles: FloatArray) -> float:
    """Return the area of triangles [m2]."""
    return float(np.linalg.norm(area_vectors(triangles), axis=1).sum())


def oriented_along(points: FloatArray, faces: IntArray, directions: FloatArray) -> IntArray:
    """Return the faces with normals along the given directions, one per face."""
    a, b, c = np.moveaxis(points[faces], 1, 0)
    against = (np.cross(b - a, c - a) * directions).sum(axis=1) < 0.0
    return np.where(against[:, None], faces[:, ::-1], faces)


def largest_extent(points: FloatArray) -> float:
    """Return the largest side of the box of points [m]."""
    return float(np.ptp(points, axis=0).max())


def box_diagonal(points: FloatArray) -> float:
    """Return the diagonal of the box of points [m]."""
    return float(np.linalg.norm(np.ptp(points, axis=0)))
