"""The connected shells of a surface: turned consistently, then outward, or inward where they line a cavity."""

import numpy as np

from rocking.bodies.moments import polyhedron_moments
from rocking.bodies.solid._self_crossing import inside
from rocking.bodies.solid.polyhedron import directed_edges
from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.errors import GeometryError

MOST_SHELLS = 200
"""Surfaces in more pieces are refused [-]."""

_PROBES, _GRID = 40, 12


def turned_consistently(faces: IntArray, repairs: list[str]) -> IntArray:
    """Return the faces turned so that neighbours across an edge agree.

    In each connected piece the smaller number of faces is turned.
    """
    first, second, disagree = _neighbours(faces)
    labels = connected(len(faces), first, second)
    flip = _parities(len(faces), first, second, disagree)
    minority = np.bincount(labels, weights=flip) > 0.5 * np.bincount(labels)
    turn = flip != minority[labels]
    if turn.any():
        repairs.append(
            f"turned round {int(turn.sum())} of {len(faces)} faces that looked the other way than their neighbours"
        )
    return np.where(turn[:, None], faces[:, ::-1], faces)


def oriented_shells(points: FloatArray, faces: IntArray, repairs: list[str]) -> IntArray:
    """Return the faces with outer shells looking outward and shells inside others looking inward."""
    labels = connected(len(faces), *_neighbours(faces)[:2])
    count = int(labels.max()) + 1
    if count > MOST_SHELLS:
        raise GeometryError(
            f"the surface is in {count} pieces; up to {MOST_SHELLS} are read: remove the dust of the scan"
        )
    shells = [faces[labels == i] for i in range(count)]
    depth = _depths(points, shells)
    volumes = [polyhedron_moments(points[shell]).mass for shell in shells]
    wrong = [(volume < 0.0) == (level % 2 == 0) and volume != 0.0 for volume, level in zip(volumes, depth, strict=True)]
    turned = sum(len(shell) for shell, bad in zip(shells, wrong, strict=True) if bad)
    if turned:
        repairs.append(f"turned {sum(wrong)} shell(s), {turned} faces, inside out")
    cavities = sum(level % 2 for level in depth)
    if count > 1:
        repairs.append(
            f"the surface has {count} separate shells, {cavities} of them cavities inside others; the rest add up"
        )
    return np.where(np.array(wrong)[labels][:, None], faces[:, ::-1], faces)


def _neighbours(faces: IntArray) -> tuple[IntArray, IntArray, BoolArray]:
    """Pairs of faces across edges that exactly two share, and whether they run along it the same way."""
    edges = directed_edges(faces)
    owner = np.tile(np.arange(len(faces)), 3)
    forward = edges[:, 0] < edges[:, 1]
    _, inverse, counts = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True, return_counts=True)
    order = np.argsort(inverse.ravel(), kind="stable")
    starts = (np.cumsum(counts) - counts)[counts == 2]
    one, two = order[starts], order[starts + 1]
    return owner[one], owner[two], forward[one] == forward[two]


def connected(count: int, first: IntArray, second: IntArray) -> IntArray:
    """Return the number of the connected piece that each of `count` things belongs to, joined pair by pair."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    graph = coo_matrix((np.ones(len(first)), (first, second)), shape=(count, count))
    labels: IntArray = connected_components(graph, directed=False)[1].astype(np.int64)
    return labels


def _parities(count: int, first: IntArray, second: IntArray, disagree: BoolArray) -> BoolArray:
    """Whether each face disagrees with the first of its piece, along a tree of neighbours.

    Every face stands twice, as it is and turned; along the tree the one that agrees with the first is connected to it.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import minimum_spanning_tree

    weights = np.where(disagree, 2.0, 1.0)
    tree = minimum_spanning_tree(coo_matrix((weights, (first, second)), shape=(count, count))).tocoo()
    one, two, swapped = tree.row.astype(np.int64), tree.col.astype(np.int64), count * (tree.data > 1.5)
    sides = connected(2 * count, np.append(one, one + count), np.append(two + swapped, two + count - swapped))
    _, roots, piece = np.unique(connected(count, one, two), return_index=True, return_inverse=True)
    differs: BoolArray = sides[:count] != sides[roots][piece]
    return differs


def _depths(points: FloatArray, shells: list[IntArray]) -> list[int]:
    """How many other shells each lies inside."""
    depth = []
    for i, shell in enumerate(shells):
        numbers = np.unique(shell)
        probes = points[numbers[:: max(1, len(numbers) // _PROBES)]]
        within = 0
        for j, other in enumerate(shells):
            if i == j or len(np.intersect1d(numbers, other)):
                continue
            found = inside(probes, points[other]) | inside(probes, points[other][:, ::-1])
            if (found.any() and not found.all()) or (not found.any() and _share_room(points[shell], points[other])):
                raise GeometryError(f"shells {i} and {j} of the surface pass through each other")
            within += int(found.all())
        depth.append(within)
    return depth


def _share_room(one: FloatArray, two: FloatArray) -> bool:
    """Whether two shells of which neither holds the other's vertices have points in common."""
    low = np.maximum(one.min(axis=(0, 1)), two.min(axis=(0, 1)))
    high = np.minimum(one.max(axis=(0, 1)), two.max(axis=(0, 1)))
    if (high - low <= 1e-9 * np.ptp(one, axis=(0, 1)).max()).any():
        return False
    share = (np.arange(_GRID) + 0.5) / _GRID
    points = low + (high - low) * np.stack(np.meshgrid(share, share, share, indexing="ij"), axis=-1).reshape(-1, 3)
    for shell in (one, two):
        points = points[inside(points, shell) | inside(points, shell[:, ::-1])]
    # all of them: one holds the other, which the vertices of the inner one tell
    both = np.prod(high - low) - np.prod(np.minimum(np.ptp(one, axis=(0, 1)), np.ptp(two, axis=(0, 1))))
    return bool(len(points)) and bool(both < 0.0)
