"""The connected shells of a surface: turned consistently, then outward, or inward where they line a cavity."""

from typing import TYPE_CHECKING

import numpy as np

from rocking.bodies.moments import polyhedron_moments
from rocking.bodies.solid._changes import HELP, MOST_VOLUME, Changes, InnerParts
from rocking.bodies.solid._self_crossing import inside
from rocking.bodies.solid.polyhedron import directed_edges, edge_numbers
from rocking.bodies.solid.surfaces import area_vectors
from rocking.conventions import BoolArray, FloatArray, IntArray, percent
from rocking.errors import GeometryError
from rocking.messages import Message, Option

if TYPE_CHECKING:
    from manifold3d import Manifold

MOST_FACES = 200_000  # surfaces of more faces are simplified [-]
FINEST = 1e-4  # by how much of the size their hull may move then [-]
WORTH = 0.7  # it is done if no more than so much of the faces stays [-]
_MOST_DISTANCES = 20_000_000


_READINGS = {reading: Option("body.inner_parts", reading) for reading in ("solid", "cavity")}


def manifold(points: FloatArray, faces: IntArray) -> "Manifold":
    """Return a closed, oriented surface as manifold3d holds it."""
    from manifold3d import Error, Manifold, Mesh64

    found = Manifold(Mesh64(np.ascontiguousarray(points), np.ascontiguousarray(faces, dtype=np.uint64)))
    if found.status() != Error.NoError:
        raise GeometryError(
            "the surface does not bound a volume (manifold3d: {status})", status=found.status().name, hint=HELP
        )
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
        Message(
            "simplified from {before} to {after} faces, which moves the hull by at most {hull:.2g} mm and the centre "
            "by {centre:.2g} mm",
            {"before": len(faces), "after": len(fewer), "hull": 1000.0 * moved, "centre": 1000.0 * shift},
        ),
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
        raise GeometryError(
            "a wall of {wall:.4g} m leaves nothing hollow", wall=wall, hint="is that its thickness in m?"
        )
    void = percent(float(cavity.volume()) / float(whole.volume()))
    changes.note(f"hollow, {void} of it, within walls of {1000.0 * wall:.3g} mm, its bottom too, right to about 3 %")
    return np.concatenate([points, inner]), np.concatenate([faces, inward[:, ::-1] + len(points)])


MOST_SHELLS = 200  # surfaces in more pieces are refused [-]

_PROBES, _GRID = 40, 12

_NAMED = 3  # parts that a sentence names
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
            Message(
                "turned round {turned} of {faces} faces that looked the other way than their neighbours",
                {"turned": int(turn.sum()), "faces": len(faces)},
            )
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
            "the surface is in {count} pieces; up to {limit} are read: remove the dust of the scan", count=count,
            limit=MOST_SHELLS,
        )  # fmt: skip
    order = np.argsort(labels, kind="stable")
    shells = np.split(faces[order], np.cumsum(np.bincount(labels))[:-1])
    if count > 1:
        within, crossing = _nested(points, shells)
        if crossing:
            return _united(points, shells, within, crossing, changes)
    else:
        within = np.zeros((1, 1), dtype=bool)
    volumes = np.array([polyhedron_moments(points[shell]).mass for shell in shells])
    matter = _matter(volumes, within)
    once = _once(points, shells, volumes, matter, within, changes)
    shells, volumes, matter, within = [shells[k] for k in once], volumes[once], matter[once], within[once][:, once]
    inner = _inner_parts(points, shells, volumes, matter, within, changes)
    filled, borders = _filled(matter, within, inner)
    wrong = borders & (matter == filled) & ((volumes < 0.0) == filled) & (volumes != 0.0)
    turned = sum(len(shell) for shell, bad in zip(shells, wrong, strict=True) if bad)
    if turned:
        facts = {"shells": int(wrong.sum()), "faces": turned}
        changes.say(Message("turned {shells} shell(s), {faces} faces, inside out", facts))
    if borders.sum() > 1:
        changes.note(
            Message(
                "the surface has {shells} separate shells, {cavities} of them cavities inside others; the rest add up: "
                "cut out what is not of the body, as the table that it stood on",
                {"shells": int(borders.sum()), "cavities": int((borders & ~filled).sum())},
            )
        )
    kept = [(shell, (volume < 0.0) == full) for shell, volume, full, border in
            zip(shells, volumes, filled, borders, strict=True) if border]  # fmt: skip
    return points, np.concatenate([shell[:, ::-1] if other else shell for shell, other in kept])


def _matter(volumes: FloatArray, within: BoolArray) -> BoolArray:
    """Whether each shell is wound like the outermost one about it, as the skin of matter is."""
    depth = within.sum(axis=1)
    outermost = [i if not depth[i] else int(np.flatnonzero(within[i] & (depth == 0))[0]) for i in range(len(depth))]
    matter: BoolArray = (volumes < 0.0) == (volumes[outermost] < 0.0)
    return matter


def _filled(matter: BoolArray, within: BoolArray, inner: InnerParts) -> tuple[BoolArray, BoolArray]:
    """Whether there is matter inside each shell, and whether the shell divides matter from none."""
    depth = within.sum(axis=1)
    filled, borders = np.zeros(len(depth), dtype=bool), np.zeros(len(depth), dtype=bool)
    for i in np.argsort(depth, kind="stable").tolist():
        about = np.flatnonzero(within[i])
        outside = bool(len(about)) and bool(filled[about[depth[about].argmax()]])
        # a skin of matter within matter, or of a cavity within a cavity, is read as was decided
        filled[i] = matter[i] if matter[i] != outside else inner == "solid"
        borders[i] = filled[i] != outside
    return filled, borders


def _inner_parts(
    points: FloatArray, shells: list[IntArray], volumes: FloatArray, matter: BoolArray, within: BoolArray,
    changes: Changes,
) -> InnerParts:  # fmt: skip
    """Return how closed parts inside others and wound like them are read; refuse what the user has to decide."""
    readings: tuple[InnerParts, InnerParts] = ("solid", "cavity")
    filled, borders = _filled(matter, within, "solid")
    doubtful = np.flatnonzero(~borders | (filled & ~matter))
    if not len(doubtful):
        return "cavity"
    wholes = []
    for reading in readings:
        full, border = _filled(matter, within, reading)
        wholes.append(float((np.abs(volumes) * (full * 1.0 - ~full) * border).sum()))
    middles = [polyhedron_moments(points[shells[i]]).centre for i in doubtful]
    sizes = np.abs(volumes[doubtful])
    parts = zip(sizes[:_NAMED].tolist(), middles[:_NAMED], strict=True)
    named = ", ".join(f"{size:.4g} m3 about {changes.place(middle)}" for size, middle in parts)
    more = f" and {len(doubtful) - _NAMED} more" if len(doubtful) > _NAMED else ""
    count = "1 closed part" if len(doubtful) == 1 else f"{len(doubtful)} closed parts"
    words = f"{count} inside another one, wound like it ({named}{more})"
    solid, hollow = wholes
    differ = f"the body encloses {solid:.4g} m3 if solid and {hollow:.4g} m3 if hollow"
    if changes.inner_parts != "refuse":
        changes.note(f'took {words}, as inner_parts="{changes.inner_parts}" states: {differ}')
        return changes.inner_parts
    share = (solid - hollow) / solid
    if share > MOST_VOLUME:
        raise GeometryError(
            "{shells} can be matter or cavities: {volumes}, which is {share} of the volume", shells=words,
            volumes=differ, share=percent(share), hint=Message("state {solid} or {cavity}", _READINGS),
        )  # fmt: skip
    where = np.average(middles, axis=0, weights=sizes)
    changes.say(f'took {words}, as solid; inner_parts="cavity" states the other reading', solid - hollow, where)
    return "solid"


def _once(
    points: FloatArray, shells: list[IntArray], volumes: FloatArray, matter: BoolArray, within: BoolArray,
    changes: Changes,
) -> IntArray:  # fmt: skip
    """Return the numbers of the shells without those that another one, closely about them, repeats."""
    areas = np.array([np.linalg.norm(area_vectors(points[shell]), axis=1).sum() for shell in shells])
    gaps = (np.abs(volumes) - np.abs(volumes)[:, None]) / areas  # from inner i to outer j
    size = float(np.ptp(points, axis=0).max())
    twice = within & (volumes * volumes[:, None] > 0.0) & (gaps < _TWICE * size)
    if changes.inner_parts == "cavity":  # then a second skin is the inner side of a thin wall
        twice &= ~matter
    for i, j in np.argwhere(twice).tolist():
        changes.say(
            Message(
                "left out a shell {distance:.2g} mm within another, as of a surface scanned twice",
                {"distance": float(1000.0 * gaps[i, j])},
            ),
            abs(abs(volumes[j]) - abs(volumes[i])),
        )
    return np.flatnonzero(~twice.any(axis=1))


def _united(
    points: FloatArray, shells: list[IntArray], within: BoolArray, crossing: list[tuple[int, int]], changes: Changes
) -> tuple[FloatArray, IntArray]:
    """Surface with what overlaps united, then oriented."""
    from manifold3d import Manifold, OpType

    involved = np.unique(crossing)
    if (within[involved].sum(axis=1) % 2).any():
        i, j = crossing[0]
        raise GeometryError(
            "shells {first} and {second} of the surface pass through each other within another one", first=int(i),
            second=int(j), hint=HELP,
        )  # fmt: skip
    bodies = [_outward(points, shells[i]) for i in involved]
    whole = Manifold.batch_boolean([manifold(points, shell) for shell in bodies], OpType.Add)
    volumes = [polyhedron_moments(points[shell]).mass for shell in bodies]
    # of a surface scanned twice either may be right, or what both hold, or what one of them does
    doubt = len(bodies) * float(whole.volume()) - sum(volumes)
    overlap = sum(volumes) - float(whole.volume())
    changes.say(
        Message(
            "united {shells} shells that pass through each other and share {overlap:.3g} m3",
            {"shells": len(bodies), "overlap": overlap},
        ),
        doubt if doubt < 0.1 * overlap else 0.0,
    )
    new, joined = surface(whole)
    # what lies within one that was turned is turned with it
    inward = np.array([polyhedron_moments(points[shell]).mass < 0.0 for shell in shells])
    inward[np.setdiff1d(np.arange(len(shells)), involved)] = False
    rest = [
        shell[:, ::-1] if (within[i] & inward).any() else shell for i, shell in enumerate(shells) if i not in involved
    ]
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
