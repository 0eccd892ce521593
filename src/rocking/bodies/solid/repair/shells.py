"""Orientation of closed shells: outward for solids and inward for cavities; union of overlapping shells."""

import numpy as np

from rocking.bodies.moments import polyhedron_moments
from rocking.bodies.solid.repair.log import HELP, MOST_VOLUME, InnerParts, RepairLog
from rocking.bodies.solid.repair.manifolds import manifold, triangles_of
from rocking.bodies.solid.surfaces import grid_points
from rocking.bodies.solid.triangles import connected, largest_extent, neighbours, total_area
from rocking.bodies.solid.winding import inside
from rocking.conventions import BoolArray, FloatArray, IntArray, percent
from rocking.errors import GeometryError
from rocking.messages import Message, Option

MOST_SHELLS = 200  # largest number of separate pieces of a surface [-]
_PROBES = 40  # number of vertices of a shell that are located relative to another shell [-]
_GRID = 12  # number of points along each side of the common box of two shells [-]
_NAMED = 3  # largest number of parts in a message [-]
_TWICE = 2e-3  # largest distance / size of two shells of a double scan [-]
_READINGS = {reading: Option("body.inner_parts", reading) for reading in ("solid", "cavity")}


def orient_shells(points: FloatArray, faces: IntArray, log: RepairLog) -> tuple[FloatArray, IntArray]:
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
            return _unite_shells(points, shells, within, crossing, log)
    else:
        within = np.zeros((1, 1), dtype=bool)
    volumes = np.array([polyhedron_moments(points[shell]).mass for shell in shells])
    matter = _matter(volumes, within)
    once = _without_double_scans(points, shells, volumes, matter, within, log)
    shells, volumes, matter, within = [shells[k] for k in once], volumes[once], matter[once], within[once][:, once]
    inner = _inner_parts(points, shells, volumes, matter, within, log)
    filled, borders = _filled(matter, within, inner)
    wrong = borders & (matter == filled) & ((volumes < 0.0) == filled) & (volumes != 0.0)
    turned = sum(len(shell) for shell, bad in zip(shells, wrong, strict=True) if bad)
    if turned:
        facts = {"shells": int(wrong.sum()), "faces": turned}
        log.add_repair(Message("reversed {shells} shell(s) with {faces} faces", facts))
    if borders.sum() > 1:
        log.add_note(
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
        # `inner` applies to a shell of matter within matter, and to a shell of a cavity within a cavity
        filled[i] = matter[i] if matter[i] != outside else inner == "solid"
        borders[i] = filled[i] != outside
    return filled, borders


def _inner_parts(
    points: FloatArray, shells: list[IntArray], volumes: FloatArray, matter: BoolArray, within: BoolArray,
    log: RepairLog,
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
    named = ", ".join(f"{size:.4g} m3 about {log.describe(middle)}" for size, middle in parts)
    more = f" and {len(doubtful) - _NAMED} more" if len(doubtful) > _NAMED else ""
    count = "1 closed part" if len(doubtful) == 1 else f"{len(doubtful)} closed parts"
    description = f"{count} inside another part with the same orientation ({named}{more})"
    solid, hollow = volumes_by_reading
    differ = f"the body has {solid:.4g} m3 if solid and {hollow:.4g} m3 if hollow"
    if log.inner_parts != "refuse":
        log.add_note(f'{description}: inner_parts="{log.inner_parts}" applied; {differ}')
        return log.inner_parts
    difference = (solid - hollow) / solid
    if difference > MOST_VOLUME:
        raise GeometryError(
            "{shells}: solid parts and cavities cannot be distinguished: {volumes}, a difference of {share}",
            shells=description, volumes=differ, share=percent(difference),
            hint=Message("use {solid} or {cavity}", _READINGS),
        )  # fmt: skip
    location = np.average(middles, axis=0, weights=sizes)
    log.add_repair(f'{description}: solid assumed; inner_parts="cavity" selects cavities', solid - hollow, location)
    return "solid"


def _without_double_scans(
    points: FloatArray, shells: list[IntArray], volumes: FloatArray, matter: BoolArray, within: BoolArray,
    log: RepairLog,
) -> IntArray:  # fmt: skip
    """Return the indices of all shells except the inner shells of double scans."""
    areas = np.array([total_area(points[shell]) for shell in shells])
    gaps = (np.abs(volumes) - np.abs(volumes)[:, None]) / areas  # distance from the inner shell i to the outer shell j
    size = largest_extent(points)
    twice = within & (volumes * volumes[:, None] > 0.0) & (gaps < _TWICE * size)
    if log.inner_parts == "cavity":  # an inner shell with the same orientation is the inner side of a thin wall
        twice &= ~matter
    for i, j in np.argwhere(twice).tolist():
        log.add_repair(
            Message(
                "removed a shell {distance:.2g} mm inside another shell (double scan)",
                {"distance": float(1000.0 * gaps[i, j])},
            ),
            abs(abs(volumes[j]) - abs(volumes[i])),
        )
    return np.flatnonzero(~twice.any(axis=1))


def _unite_shells(
    points: FloatArray, shells: list[IntArray], within: BoolArray, crossing: list[tuple[int, int]], log: RepairLog
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
    # for a double scan, the true volume can be that of one shell, of the union or of the intersection
    doubt = len(bodies) * float(union.volume()) - sum(volumes)
    overlap = sum(volumes) - float(union.volume())
    log.add_repair(
        Message(
            "united {shells} intersecting shells with a common volume of {overlap:.3g} m3",
            {"shells": len(bodies), "overlap": overlap},
        ),
        doubt if doubt < 0.1 * overlap else 0.0,
    )
    union_points, joined = triangles_of(union)
    # shells inside a reversed shell are reversed too
    inward = np.array([polyhedron_moments(points[shell]).mass < 0.0 for shell in shells])
    inward[np.setdiff1d(np.arange(len(shells)), involved)] = False
    other_shells = [
        shell[:, ::-1] if (within[i] & inward).any() else shell for i, shell in enumerate(shells) if i not in involved
    ]
    return orient_shells(
        np.concatenate([points, union_points]), np.concatenate([*other_shells, joined + len(points)]), log
    )


def _outward(points: FloatArray, shell: IntArray) -> IntArray:
    return shell if polyhedron_moments(points[shell]).mass > 0.0 else shell[:, ::-1]


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
                not is_inside.any() and _overlap(points[shell], points[other])
            ):
                crossing.append((i, j))
            within[i, j] = is_inside.all()
    return within, crossing


def _overlap(first_shell: FloatArray, second_shell: FloatArray) -> bool:
    """Return True if two shells overlap and neither shell contains vertices of the other shell."""
    low = np.maximum(first_shell.min(axis=(0, 1)), second_shell.min(axis=(0, 1)))
    high = np.minimum(first_shell.max(axis=(0, 1)), second_shell.max(axis=(0, 1)))
    if (high - low <= 1e-9 * np.ptp(first_shell, axis=(0, 1)).max()).any():
        return False
    points = grid_points(low, high, _GRID)
    for shell in (first_shell, second_shell):
        points = points[inside(points, shell) | inside(points, shell[:, ::-1])]
    # if the common box is not smaller than the smaller shell, one shell contains the other
    volume_difference = np.prod(high - low) - np.prod(
        np.minimum(np.ptp(first_shell, axis=(0, 1)), np.ptp(second_shell, axis=(0, 1)))
    )
    return bool(len(points)) and bool(volume_difference < 0.0)
