"""Connected shells of a surface: consistent orientation, outward for solids and inward for cavities."""

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

MOST_FACES = 200_000  # largest number of faces without simplification [-]
FINEST = 1e-4  # largest shift of the hull by the simplification / size [-]
WORTH = 0.7  # largest fraction of faces after a useful simplification [-]
_MOST_DISTANCES = 20_000_000


_READINGS = {reading: Option("body.inner_parts", reading) for reading in ("solid", "cavity")}


def manifold(points: FloatArray, faces: IntArray) -> "Manifold":
    """Return a closed, oriented surface as a Manifold of manifold3d."""
    from manifold3d import Error, Manifold, Mesh64

    body = Manifold(Mesh64(np.ascontiguousarray(points), np.ascontiguousarray(faces, dtype=np.uint64)))
    if body.status() != Error.NoError:
        raise GeometryError(
            "The surface does not bound a volume (manifold3d: {status})", status=body.status().name, hint=HELP
        )
    return body


def surface(body: "Manifold") -> tuple[FloatArray, IntArray]:
    """Return vertices [m] and faces of a Manifold."""
    mesh = body.to_mesh64()
    return np.array(mesh.vert_properties[:, :3]), np.asarray(mesh.tri_verts).astype(np.int64)


def decimated(points: FloatArray, faces: IntArray, changes: Changes) -> tuple[FloatArray, IntArray]:
    """Return a simplified surface with a shift of the convex hull of at most 1e-4 of the size."""
    if len(faces) <= MOST_FACES or changes.allowed == "none":
        return points, faces
    bound = FINEST * float(np.ptp(points, axis=0).max())
    try:
        body = manifold(points, faces)
    except GeometryError:  # touching faces; the simplification only affects speed
        return points, faces
    for fraction in (1.0, 0.5, 0.25, 0.1):
        fewer_points, fewer = surface(body.simplify(fraction * bound))
        if len(fewer) > WORTH * len(faces):
            return points, faces
        moved = _hull_distance(points, fewer_points, bound)
        if moved <= bound:
            break
    else:
        return points, faces
    before, after = polyhedron_moments(points[faces]), polyhedron_moments(fewer_points[fewer])
    shift = float(np.linalg.norm(after.centre - before.centre))
    changes.add_repair(
        Message(
            "simplified from {before} to {after} faces; shift of the hull at most {hull:.2g} mm, of the centre "
            "{centre:.2g} mm",
            {"before": len(faces), "after": len(fewer), "hull": 1000.0 * moved, "centre": 1000.0 * shift},
        ),
        abs(after.mass - before.mass),
    )
    return fewer_points, fewer


def _hull_distance(points: FloatArray, fewer: FloatArray, bound: float) -> float:
    """Return the largest distance of a hull outside the hull of fewer points, or a lower bound below `bound` [m]."""
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


_ROUND, _MOST_HOLLOWED, _COARSE = 12, 2000, (0.02, 0.05, 0.1, 0.2)


def hollowed(points: FloatArray, faces: IntArray, wall: float, changes: Changes) -> tuple[FloatArray, IntArray]:
    """Return the surface with a cavity at the wall thickness [m]; parts thinner than two walls stay solid."""
    # The cavity is the set of possible centres of a ball with the wall thickness as radius (Minkowski difference). The
    # ball is a polyhedron, and the surface is simplified by up to a fifth of the wall. The radius corrects for both.
    from manifold3d import Manifold

    body = manifold(points, faces)
    for fraction in _COARSE:
        coarse = body.simplify(fraction * wall)
        if coarse.num_tri() <= _MOST_HOLLOWED:
            break
    ball = Manifold.sphere(1.0, _ROUND)
    directions = np.random.default_rng(0).normal(size=(2000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    mean = float((directions @ surface(ball)[0].T).max(axis=1).mean())
    sunk = (float(body.volume()) - float(coarse.volume())) / float(body.surface_area())
    cavity = coarse.minkowski_difference(ball.scale([(wall - sunk) / mean] * 3))
    inner, inward = surface(cavity)
    if not len(inward):
        raise GeometryError(
            "A wall of {wall:.4g} m leaves no cavity", wall=wall, hint="check that the wall thickness is in m"
        )
    void = percent(float(cavity.volume()) / float(body.volume()))
    changes.add_note(f"cavity of {void} of the volume (accuracy 3 %) for walls and bottom of {1000.0 * wall:.3g} mm")
    return np.concatenate([points, inner]), np.concatenate([faces, inward[:, ::-1] + len(points)])


MOST_SHELLS = 200  # largest number of separate pieces of a surface [-]

_PROBES, _GRID = 40, 12

_NAMED = 3  # largest number of parts in a sentence
_TWICE = 2e-3  # largest distance / size of two shells of a double scan [-]


def turned_consistently(faces: IntArray, changes: Changes) -> IntArray:
    """Return consistently oriented faces; in each connected piece the smaller number of faces is reversed."""
    first, second, disagree = neighbours(faces)
    labels = connected(len(faces), first, second)
    flip = _parities(len(faces), first, second, disagree)
    minority = np.bincount(labels, weights=flip) > 0.5 * np.bincount(labels)
    turn = flip != minority[labels]
    if turn.any():
        changes.add_repair(
            Message(
                "reversed {turned} of {faces} faces with an orientation opposite to their neighbours",
                {"turned": int(turn.sum()), "faces": len(faces)},
            )
        )
    return np.where(turn[:, None], faces[:, ::-1], faces)


def oriented_shells(points: FloatArray, faces: IntArray, changes: Changes) -> tuple[FloatArray, IntArray]:
    """Return the surface with outward normals on outer shells and inward normals on cavities."""
    # Overlapping shells are united. Of two close shells with the same orientation (double scan), the inner one is
    # removed.
    labels = connected(len(faces), *neighbours(faces)[:2])
    count = int(labels.max()) + 1
    if count > MOST_SHELLS:
        raise GeometryError(
            "The surface has {count} separate pieces; at most {limit} are allowed. Remove loose pieces.", count=count,
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
        changes.add_repair(Message("reversed {shells} shell(s) with {faces} faces", facts))
    if borders.sum() > 1:
        changes.add_note(
            Message(
                "the surface has {shells} separate shells, including {cavities} cavities. The volume includes all "
                "other shells: remove objects such as the support of a scan",
                {"shells": int(borders.sum()), "cavities": int((borders & ~filled).sum())},
            )
        )
    kept = [(shell, (volume < 0.0) == full) for shell, volume, full, border in
            zip(shells, volumes, filled, borders, strict=True) if border]  # fmt: skip
    return points, np.concatenate([shell[:, ::-1] if other else shell for shell, other in kept])


def _matter(volumes: FloatArray, within: BoolArray) -> BoolArray:
    """Return True for shells with the orientation of the outermost shell around them."""
    depth = within.sum(axis=1)
    outermost = [i if not depth[i] else int(np.flatnonzero(within[i] & (depth == 0))[0]) for i in range(len(depth))]
    matter: BoolArray = (volumes < 0.0) == (volumes[outermost] < 0.0)
    return matter


def _filled(matter: BoolArray, within: BoolArray, inner: InnerParts) -> tuple[BoolArray, BoolArray]:
    """Return True for shells with matter inside, and True for shells between matter and void."""
    depth = within.sum(axis=1)
    filled, borders = np.zeros(len(depth), dtype=bool), np.zeros(len(depth), dtype=bool)
    for i in np.argsort(depth, kind="stable").tolist():
        about = np.flatnonzero(within[i])
        outside = bool(len(about)) and bool(filled[about[depth[about].argmax()]])
        # `inner` decides for a shell of matter within matter, and for a shell of a cavity within a cavity
        filled[i] = matter[i] if matter[i] != outside else inner == "solid"
        borders[i] = filled[i] != outside
    return filled, borders


def _inner_parts(
    points: FloatArray, shells: list[IntArray], volumes: FloatArray, matter: BoolArray, within: BoolArray,
    changes: Changes,
) -> InnerParts:  # fmt: skip
    """Return the treatment of closed parts inside others with equal orientation; refuse an ambiguous surface."""
    readings: tuple[InnerParts, InnerParts] = ("solid", "cavity")
    filled, borders = _filled(matter, within, "solid")
    doubtful = np.flatnonzero(~borders | (filled & ~matter))
    if not len(doubtful):
        return "cavity"
    volumes_by_reading = []
    for reading in readings:
        full, border = _filled(matter, within, reading)
        volumes_by_reading.append(float((np.abs(volumes) * (full * 1.0 - ~full) * border).sum()))
    middles = [polyhedron_moments(points[shells[i]]).centre for i in doubtful]
    sizes = np.abs(volumes[doubtful])
    parts = zip(sizes[:_NAMED].tolist(), middles[:_NAMED], strict=True)
    named = ", ".join(f"{size:.4g} m3 about {changes.describe(middle)}" for size, middle in parts)
    more = f" and {len(doubtful) - _NAMED} more" if len(doubtful) > _NAMED else ""
    count = "1 closed part" if len(doubtful) == 1 else f"{len(doubtful)} closed parts"
    description = f"{count} inside another part with the same orientation ({named}{more})"
    solid, hollow = volumes_by_reading
    differ = f"the body has {solid:.4g} m3 if solid and {hollow:.4g} m3 if hollow"
    if changes.inner_parts != "refuse":
        changes.add_note(f'{description}: inner_parts="{changes.inner_parts}" applied; {differ}')
        return changes.inner_parts
    difference = (solid - hollow) / solid
    if difference > MOST_VOLUME:
        raise GeometryError(
            "{shells}: solid or cavity is ambiguous; {volumes}, a difference of {share}", shells=description,
            volumes=differ, share=percent(difference), hint=Message("use {solid} or {cavity}", _READINGS),
        )  # fmt: skip
    location = np.average(middles, axis=0, weights=sizes)
    changes.add_repair(f'{description}: solid assumed; inner_parts="cavity" selects cavities', solid - hollow, location)
    return "solid"


def _once(
    points: FloatArray, shells: list[IntArray], volumes: FloatArray, matter: BoolArray, within: BoolArray,
    changes: Changes,
) -> IntArray:  # fmt: skip
    """Return the indices of the shells without inner shells of double scans."""
    areas = np.array([np.linalg.norm(area_vectors(points[shell]), axis=1).sum() for shell in shells])
    gaps = (np.abs(volumes) - np.abs(volumes)[:, None]) / areas  # from inner i to outer j
    size = float(np.ptp(points, axis=0).max())
    twice = within & (volumes * volumes[:, None] > 0.0) & (gaps < _TWICE * size)
    if changes.inner_parts == "cavity":  # a second shell is the inner side of a thin wall
        twice &= ~matter
    for i, j in np.argwhere(twice).tolist():
        changes.add_repair(
            Message(
                "removed a shell {distance:.2g} mm inside another shell (double scan)",
                {"distance": float(1000.0 * gaps[i, j])},
            ),
            abs(abs(volumes[j]) - abs(volumes[i])),
        )
    return np.flatnonzero(~twice.any(axis=1))


def _united(
    points: FloatArray, shells: list[IntArray], within: BoolArray, crossing: list[tuple[int, int]], changes: Changes
) -> tuple[FloatArray, IntArray]:
    """Return the oriented surface after the union of overlapping shells."""
    from manifold3d import Manifold, OpType

    involved = np.unique(crossing)
    if (within[involved].sum(axis=1) % 2).any():
        i, j = crossing[0]
        raise GeometryError(
            "Shells {first} and {second} inside another shell intersect each other", first=int(i),
            second=int(j), hint=HELP,
        )  # fmt: skip
    bodies = [_outward(points, shells[i]) for i in involved]
    union = Manifold.batch_boolean([manifold(points, shell) for shell in bodies], OpType.Add)
    volumes = [polyhedron_moments(points[shell]).mass for shell in bodies]
    # for a double scan, each shell, the union and the intersection are possible
    doubt = len(bodies) * float(union.volume()) - sum(volumes)
    overlap = sum(volumes) - float(union.volume())
    changes.add_repair(
        Message(
            "united {shells} intersecting shells with a common volume of {overlap:.3g} m3",
            {"shells": len(bodies), "overlap": overlap},
        ),
        doubt if doubt < 0.1 * overlap else 0.0,
    )
    union_points, joined = surface(union)
    # shells inside a reversed shell are reversed too
    inward = np.array([polyhedron_moments(points[shell]).mass < 0.0 for shell in shells])
    inward[np.setdiff1d(np.arange(len(shells)), involved)] = False
    other_shells = [
        shell[:, ::-1] if (within[i] & inward).any() else shell for i, shell in enumerate(shells) if i not in involved
    ]
    return oriented_shells(
        np.concatenate([points, union_points]), np.concatenate([*other_shells, joined + len(points)]), changes
    )


def _outward(points: FloatArray, shell: IntArray) -> IntArray:
    return shell if polyhedron_moments(points[shell]).mass > 0.0 else shell[:, ::-1]


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


def _parities(count: int, first: IntArray, second: IntArray, disagree: BoolArray) -> BoolArray:
    """Return True for faces with an orientation opposite to the first face of their piece, along a spanning tree."""
    # the graph contains every face twice, original and reversed; the first face connects to the consistent one
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import minimum_spanning_tree

    weights = np.where(disagree, 2.0, 1.0)
    tree = minimum_spanning_tree(coo_matrix((weights, (first, second)), shape=(count, count))).tocoo()
    parent, child, swapped = tree.row.astype(np.int64), tree.col.astype(np.int64), count * (tree.data > 1.5)
    sides = connected(2 * count, np.append(parent, parent + count), np.append(child + swapped, child + count - swapped))
    _, roots, piece = np.unique(connected(count, parent, child), return_index=True, return_inverse=True)
    differs: BoolArray = sides[:count] != sides[roots][piece]
    return differs


def _nested(points: FloatArray, shells: list[IntArray]) -> tuple[BoolArray, list[tuple[int, int]]]:
    """Return True for shells inside others, shape (n, n), and the pairs of intersecting shells."""
    within, crossing = np.zeros((len(shells), len(shells)), dtype=bool), []
    boxes = np.array([[points[shell].min(axis=(0, 1)), points[shell].max(axis=(0, 1))] for shell in shells])
    for i, shell in enumerate(shells):
        numbers = np.unique(shell)
        probes = points[numbers[:: max(1, len(numbers) // _PROBES)]]
        for j, other in enumerate(shells):
            apart = (boxes[i, 0] > boxes[j, 1]).any() or (boxes[j, 0] > boxes[i, 1]).any()
            if i == j or apart or len(np.intersect1d(numbers, other)):
                continue
            is_inside = inside(probes, points[other]) | inside(probes, points[other][:, ::-1])
            if (is_inside.any() and not is_inside.all()) or (
                not is_inside.any() and _share_room(points[shell], points[other])
            ):
                crossing.append((i, j))
            within[i, j] = is_inside.all()
    return within, crossing


def _share_room(first_shell: FloatArray, second_shell: FloatArray) -> bool:
    """Return True if two shells overlap although neither contains vertices of the other."""
    low = np.maximum(first_shell.min(axis=(0, 1)), second_shell.min(axis=(0, 1)))
    high = np.minimum(first_shell.max(axis=(0, 1)), second_shell.max(axis=(0, 1)))
    if (high - low <= 1e-9 * np.ptp(first_shell, axis=(0, 1)).max()).any():
        return False
    positions = (np.arange(_GRID) + 0.5) / _GRID
    points = low + (high - low) * np.stack(
        np.meshgrid(positions, positions, positions, indexing="ij"), axis=-1
    ).reshape(-1, 3)
    for shell in (first_shell, second_shell):
        points = points[inside(points, shell) | inside(points, shell[:, ::-1])]
    # all of them: one shell contains the other, as the vertices of the inner shell show
    volume_difference = np.prod(high - low) - np.prod(
        np.minimum(np.ptp(first_shell, axis=(0, 1)), np.ptp(second_shell, axis=(0, 1)))
    )
    return bool(len(points)) and bool(volume_difference < 0.0)
