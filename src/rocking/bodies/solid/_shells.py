"""The connected shells of a surface: turned consistently, then outward, or inward where they line a cavity."""

from typing import TYPE_CHECKING

import numpy as np

from rocking.bodies.moments import polyhedron_moments
from rocking.bodies.solid._changes import HELP, Changes
from rocking.bodies.solid._self_crossing import inside
from rocking.bodies.solid.polyhedron import directed_edges, edge_numbers
from rocking.bodies.solid.surfaces import area_vectors
from rocking.conventions import BoolArray, FloatArray, IntArray, percent
from rocking.errors import GeometryError

if TYPE_CHECKING:
    from manifold3d import Manifold

MOST_FACES = 200_000  # surfaces of more faces are simplified [-]
FINEST = 1e-4  # by how much of the size their hull may move then [-]
WORTH = 0.7  # it is done if no more than so much of the faces stays [-]
_MOST_DISTANCES = 20_000_000


def manifold(points: FloatArray, faces: IntArray) -> "Manifold":
    """Return a closed, oriented surface as manifold3d holds it."""
    from manifold3d import Error, Manifold, Mesh64

    found = Manifold(Mesh64(np.ascontiguousarray(points), np.ascontiguousarray(faces, dtype=np.uint64)))
    if found.status() != Error.NoError:
        raise GeometryError(f"the surface does not bound a volume (manifold3d: {found.status().name}); {HELP}")
    return found


def surface(of: "Manifold") -> tuple[FloatArray, IntArray]:
    """Return vertices [m] and faces."""
    mesh = of.to_mesh64()
    return np.array(mesh.vert_properties[:, :3]), np.asarray(mesh.tri_verts).astype(np.int64)


def decimated(points: FloatArray, faces: IntArray, changes: Changes) -> tuple[FloatArray, IntArray]:
    """Return a surface of many faces with fewer, its convex hull nowhere moved by more than 1e-4 of the size."""
    if len(faces) <= MOST_FACES or changes.allowed == "none":
        return points, faces
    bound = FINEST * float(np.ptp(points, axis=0).max())
    try:
        whole = manifold(points, faces)
    except GeometryError:  # faces that only touch: nothing is lost but speed
        return points, faces
    for share in (1.0, 0.5, 0.25, 0.1):
        fewer_points, fewer = surface(whole.simplify(share * bound))
        if len(fewer) > WORTH * len(faces):
            return points, faces
        moved = _hull_distance(points, fewer_points, bound)
        if moved <= bound:
            break
    else:
        return points, faces
    before, after = polyhedron_moments(points[faces]), polyhedron_moments(fewer_points[fewer])
    shift = float(np.linalg.norm(after.centre - before.centre))
    changes.say(
        f"simplified from {len(faces)} to {len(fewer)} faces, which moves the hull by at most {1000.0 * moved:.2g} mm "
        f"and the centre by {1000.0 * shift:.2g} mm",
        abs(after.mass - before.mass),
    )
    return fewer_points, fewer


def _hull_distance(points: FloatArray, fewer: FloatArray, enough: float) -> float:
    """How far the hull of points reaches out of that of others at most, if it is more than enough [m]."""
    from scipy.spatial import ConvexHull, cKDTree

    corners = points[ConvexHull(points).vertices]
    near = np.asarray(cKDTree(fewer).query(corners)[0])
    far = corners[near > enough]
    most = float(near[near <= enough].max(initial=0.0))
    if len(far):
        planes = np.unique(ConvexHull(fewer).equations.round(12), axis=0)
        for some in np.array_split(far, 1 + len(far) * len(planes) // _MOST_DISTANCES):
            most = max(most, float((some @ planes[:, :3].T + planes[:, 3]).max()))
    return most


_ROUND, _MOST_HOLLOWED, _COARSE = 12, 2000, (0.02, 0.05, 0.1, 0.2)


def hollowed(points: FloatArray, faces: IntArray, wall: float, changes: Changes) -> tuple[FloatArray, IntArray]:
    """Return the surface with another one within, a wall [m] inside it: parts thinner than two walls stay solid."""
    # The hollow is where a ball whose radius is the wall finds room for its middle (the Minkowski difference). The ball
    # is a polyhedron, and the surface is simplified first, by up to a fifth of the wall; the radius makes up for both.
    from manifold3d import Manifold

    whole = manifold(points, faces)
    for share in _COARSE:
        coarse = whole.simplify(share * wall)
        if coarse.num_tri() <= _MOST_HOLLOWED:
            break
    ball = Manifold.sphere(1.0, _ROUND)
    directions = np.random.default_rng(0).normal(size=(2000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    mean = float((directions @ surface(ball)[0].T).max(axis=1).mean())
    sunk = (float(whole.volume()) - float(coarse.volume())) / float(whole.surface_area())
    cavity = coarse.minkowski_difference(ball.scale([(wall - sunk) / mean] * 3))
    inner, inward = surface(cavity)
    if not len(inward):
        raise GeometryError(f"a wall of {wall:.4g} m leaves nothing hollow; is that its thickness in m?")
    void = percent(float(cavity.volume()) / float(whole.volume()))
    changes.note(f"hollow, {void} of it, within walls of {1000.0 * wall:.3g} mm, its bottom too, right to about 3 %")
    return np.concatenate([points, inner]), np.concatenate([faces, inward[:, ::-1] + len(points)])


MOST_SHELLS = 200  # surfaces in more pieces are refused [-]

_PROBES, _GRID = 40, 12

_TWICE = 2e-3  # two shells this close, over the size, may be one surface scanned twice [-]


def turned_consistently(faces: IntArray, changes: Changes) -> IntArray:
    """Return the faces turned so that neighbours across an edge agree; in each connected piece the smaller number."""
    first, second, disagree = neighbours(faces)
    labels = connected(len(faces), first, second)
    flip = _parities(len(faces), first, second, disagree)
    minority = np.bincount(labels, weights=flip) > 0.5 * np.bincount(labels)
    turn = flip != minority[labels]
    if turn.any():
        changes.say(
            f"turned round {int(turn.sum())} of {len(faces)} faces that looked the other way than their neighbours"
        )
    return np.where(turn[:, None], faces[:, ::-1], faces)


def oriented_shells(points: FloatArray, faces: IntArray, changes: Changes) -> tuple[FloatArray, IntArray]:
    """Return the surface with outer shells looking outward and shells inside others looking inward."""
    # shells that overlap are united; of two that lie closely one within the other and look the same way, which is what
    # a surface scanned twice looks like, the inner one goes
    labels = connected(len(faces), *neighbours(faces)[:2])
    count = int(labels.max()) + 1
    if count > MOST_SHELLS:
        raise GeometryError(
            f"the surface is in {count} pieces; up to {MOST_SHELLS} are read: remove the dust of the scan"
        )
    order = np.argsort(labels, kind="stable")
    shells = np.split(faces[order], np.cumsum(np.bincount(labels))[:-1])
    if count > 1:
        within, crossing = _nested(points, shells)
        if crossing:
            return _united(points, shells, within, crossing, changes)
        shells, within = _once(points, shells, within, changes)
    else:
        within = np.zeros((1, 1), dtype=bool)
    depth = within.sum(axis=1)
    volumes = np.array([polyhedron_moments(points[shell]).mass for shell in shells])
    wrong = ((volumes < 0.0) == (depth % 2 == 0)) & (volumes != 0.0)
    turned = sum(len(shell) for shell, bad in zip(shells, wrong, strict=True) if bad)
    if turned:
        changes.say(f"turned {wrong.sum()} shell(s), {turned} faces, inside out")
    if len(shells) > 1:
        changes.note(
            f"the surface has {len(shells)} separate shells, {(depth % 2).sum()} of them cavities inside others; the "
            "rest add up: cut out what is not of the body, as the table that it stood on"
        )
    return points, np.concatenate([s[:, ::-1] if bad else s for s, bad in zip(shells, wrong, strict=True)])


def _once(
    points: FloatArray, shells: list[IntArray], within: BoolArray, changes: Changes
) -> tuple[list[IntArray], BoolArray]:
    """Shells without those that another one, closely about them, repeats."""
    volumes = np.array([polyhedron_moments(points[shell]).mass for shell in shells])
    areas = np.array([np.linalg.norm(area_vectors(points[shell]), axis=1).sum() for shell in shells])
    gaps = (np.abs(volumes) - np.abs(volumes)[:, None]) / areas  # from inner i to outer j
    size = float(np.ptp(points, axis=0).max())
    twice = within & (volumes * volumes[:, None] > 0.0) & (gaps < _TWICE * size)
    for i, j in np.argwhere(twice).tolist():
        changes.say(
            f"left out a shell {1000.0 * gaps[i, j]:.2g} mm within another, as of a surface scanned twice",
            abs(abs(volumes[j]) - abs(volumes[i])),
        )
    keep = ~twice.any(axis=1)
    return [shell for shell, kept in zip(shells, keep, strict=True) if kept], within[keep][:, keep]


def _united(
    points: FloatArray, shells: list[IntArray], within: BoolArray, crossing: list[tuple[int, int]], changes: Changes
) -> tuple[FloatArray, IntArray]:
    """Surface with what overlaps united, then oriented."""
    from manifold3d import Manifold, OpType

    involved = np.unique(crossing)
    if (within[involved].sum(axis=1) % 2).any():
        i, j = crossing[0]
        raise GeometryError(f"shells {i} and {j} of the surface pass through each other within another one; {HELP}")
    bodies = [_outward(points, shells[i]) for i in involved]
    whole = Manifold.batch_boolean([manifold(points, shell) for shell in bodies], OpType.Add)
    volumes = [polyhedron_moments(points[shell]).mass for shell in bodies]
    # of a surface scanned twice either may be right, or what both hold, or what one of them does
    doubt = len(bodies) * float(whole.volume()) - sum(volumes)
    overlap = sum(volumes) - float(whole.volume())
    changes.say(
        f"united {len(bodies)} shells that pass through each other and share {overlap:.3g} m3",
        doubt if doubt < 0.1 * overlap else 0.0,
    )
    new, joined = surface(whole)
    rest = [shell for i, shell in enumerate(shells) if i not in involved]
    return oriented_shells(np.concatenate([points, new]), np.concatenate([*rest, joined + len(points)]), changes)


def _outward(points: FloatArray, shell: IntArray) -> IntArray:
    return shell if polyhedron_moments(points[shell]).mass > 0.0 else shell[:, ::-1]


def neighbours(faces: IntArray) -> tuple[IntArray, IntArray, BoolArray]:
    """Pairs of faces across edges that exactly two share, and whether they run along it the same way."""
    edges = directed_edges(faces)
    owner = np.tile(np.arange(len(faces)), 3)
    forward = edges[:, 0] < edges[:, 1]
    numbers = edge_numbers(faces)
    counts, order = np.bincount(numbers), np.argsort(numbers, kind="stable")
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
    """Whether each face disagrees with the first of its piece, along a tree of neighbours."""
    # every face stands twice, as it is and turned; along the tree the one that agrees with the first is connected to it
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import minimum_spanning_tree

    weights = np.where(disagree, 2.0, 1.0)
    tree = minimum_spanning_tree(coo_matrix((weights, (first, second)), shape=(count, count))).tocoo()
    one, two, swapped = tree.row.astype(np.int64), tree.col.astype(np.int64), count * (tree.data > 1.5)
    sides = connected(2 * count, np.append(one, one + count), np.append(two + swapped, two + count - swapped))
    _, roots, piece = np.unique(connected(count, one, two), return_index=True, return_inverse=True)
    differs: BoolArray = sides[:count] != sides[roots][piece]
    return differs


def _nested(points: FloatArray, shells: list[IntArray]) -> tuple[BoolArray, list[tuple[int, int]]]:
    """Whether each shell lies inside each other one, and the pairs that pass through each other."""
    within, crossing = np.zeros((len(shells), len(shells)), dtype=bool), []
    boxes = np.array([[points[shell].min(axis=(0, 1)), points[shell].max(axis=(0, 1))] for shell in shells])
    for i, shell in enumerate(shells):
        numbers = np.unique(shell)
        probes = points[numbers[:: max(1, len(numbers) // _PROBES)]]
        for j, other in enumerate(shells):
            apart = (boxes[i, 0] > boxes[j, 1]).any() or (boxes[j, 0] > boxes[i, 1]).any()
            if i == j or apart or len(np.intersect1d(numbers, other)):
                continue
            found = inside(probes, points[other]) | inside(probes, points[other][:, ::-1])
            if (found.any() and not found.all()) or (not found.any() and _share_room(points[shell], points[other])):
                crossing.append((i, j))
            within[i, j] = found.all()
    return within, crossing


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
