"""Holes of a surface: the open bottom of a scan gets a level face, others a patch between their edges."""

import math

import numpy as np

from rocking.bodies.equilibria.poses import set_down
from rocking.bodies.solid._changes import HELP, Changes
from rocking.bodies.solid.polyhedron import alone
from rocking.bodies.solid.surfaces import area_vectors
from rocking.conventions import FloatArray, IntArray, percent
from rocking.errors import GeometryError

LOW = 0.1  # a rim is that of a bottom if half of it lies so low, over the height of the body [-]

_LEVEL, _NOTCH, _LISTED, _SLIT, _LOOSE, _LEANS = 0.7, 0.01, 3, 1e-6, 0.5, 0.05


def boundary_loops(faces: IntArray) -> list[IntArray]:
    """Return the rings of edges that have a face on one side only; rings that share a vertex are two."""
    following: dict[int, list[int]] = {}
    for end, start in alone(faces).tolist():
        following.setdefault(start, []).append(end)
    loops = []
    while following:
        path = [next(iter(following))]
        position = {path[0]: 0}
        while path[-1] in following:
            ends = following[path[-1]]
            vertex = ends.pop()
            if not ends:
                del following[path[-1]]
            if vertex not in position:
                position[vertex] = len(path)
                path.append(vertex)
                continue
            at = position[vertex]
            loops.append(np.array(path[at:]))
            for gone in path[at + 1 :]:
                del position[gone]
            del path[at + 1 :]
        if len(path) > 1:
            raise GeometryError(
                f"the open edges of the surface form no rings, as more than two faces meet there; {HELP}"
            )
    return loops


def closed(points: FloatArray, faces: IntArray, changes: Changes) -> tuple[FloatArray, IntArray]:
    """Return the surface without holes: an open bottom becomes level, other holes are closed between their edges."""
    loops = boundary_loops(faces)
    if not loops:
        return points, faces
    if changes.allowed == "none":
        raise GeometryError(f'{_listed(loops, points, changes)}; repair="safe" closes an open bottom and small holes')
    if (share := sum(map(len, loops)) / (3 * len(faces))) > _LOOSE:
        raise GeometryError(
            f"{_listed(loops, points, changes)}; {percent(share)} of its edges are open: its faces hardly hang "
            f"together; {HELP}"
        )
    added, slits, patches, bound, where = [faces], 0, [], 0.0, np.zeros(3)
    for ring in loops:
        if _is_bottom(points, faces, ring):
            points, level = _levelled(points, ring, changes)
            added.append(level)
            continue
        patch = _patch(points[ring], _normal(points[ring]))
        added.append(ring[patch])
        area, width = _area(points[ring[patch]]), _width(points[ring])
        if area <= _SLIT * width**2:
            slits += 1
            continue
        # as much as a dome of half the width over the hole would hold
        bound, where = bound + area * width / 3.0, where + area * width / 3.0 * points[ring].mean(axis=0)
        patches.append(ring)
    if slits:
        changes.say(f"closed {slits} slit(s) without area, where vertices lay within the edges of other faces")
    if patches:
        changes.say(f"closed {_listed(patches, points, changes).partition('it has ')[2]}", bound, where / bound)
    return points, np.concatenate(added)


def _listed(loops: list[IntArray], points: FloatArray, changes: Changes) -> str:
    """Say what a user must know about the holes of a surface."""
    order = sorted(loops, key=lambda ring: -_width(points[ring]))
    words = "; ".join(
        f"{_width(points[ring]):.3g} m wide ({len(ring)} edges) at {changes.place(points[ring].mean(axis=0))}"
        for ring in order[:_LISTED]
    )
    more = f" and {len(loops) - _LISTED} smaller" if len(loops) > _LISTED else ""
    return f"the surface is not closed, it has {len(loops)} hole(s): {words}{more}"


def _is_bottom(points: FloatArray, faces: IntArray, ring: IntArray) -> bool:
    """Whether a ring is about level, half of it lies low, and a face across it looks down out of the body."""
    low, high, normal = points[:, 2].min(), points[:, 2].max(), _normal(points[ring])
    is_level = abs(normal[2]) >= _LEVEL * np.linalg.norm(normal)
    if not is_level or np.median(points[ring, 2]) - low > LOW * (high - low):
        return False
    a, b, c = np.moveaxis(points[faces] - points[ring].mean(axis=0), 1, 0)
    outward = np.sign(np.einsum("ij,ij->", a, np.cross(b, c)))  # of the volume, above zero where faces look outward
    return bool(normal[2] * outward < 0.0)


def _notched(height: FloatArray, ring: IntArray) -> tuple[IntArray, IntArray]:
    """Return a rim without the tops of its notches, and the faces that fill them."""
    most = np.median(height[ring]) + _NOTCH * np.ptp(height)
    rest, ears = ring.tolist(), []
    while len(rest) > 3 and height[top := max(rest, key=height.item)] > most:
        at = rest.index(top)
        ears.append((rest[at - 1], top, rest[(at + 1) % len(rest)]))
        del rest[at]
    return np.array(rest), np.array(ears, dtype=np.int64).reshape(-1, 3)


def _levelled(points: FloatArray, ring: IntArray, changes: Changes) -> tuple[FloatArray, IntArray]:
    """Return points with those of a rim let down to the lowest one, and the faces down there and beneath."""
    # down is across the plane of the rim, so that a body that leans stands upright once it is set on its bottom
    ring, _ = _notched(points[:, 2], ring)
    normal = np.linalg.svd(points[ring] - points[ring].mean(axis=0), full_matrices=False)[2][2]
    upright = set_down(-normal * (1.0 if normal[2] > 0.0 else -1.0))
    leans = math.degrees(math.acos(min(1.0, abs(float(normal[2])))))
    stood = points @ upright.T
    ring, ears = _notched(stood[:, 2], ring)
    low, rim = float(stood[:, 2].min()), stood[ring]
    lowered = rim * [1.0, 1.0, 0.0] + [0.0, 0.0, low]
    is_low = rim[:, 2] - low <= 1e-9 * float(np.ptp(points, axis=0).max())
    below = np.where(is_low, ring, len(points) + np.cumsum(~is_low) - 1)
    after, after_below = np.roll(ring, -1), np.roll(below, -1)
    skirt = np.concatenate([np.stack([ring, after, after_below], 1), np.stack([ring, after_below, below], 1)])
    skirt = skirt[(skirt != np.roll(skirt, 1, axis=1)).all(axis=1)]
    patch = _patch(lowered, _normal(lowered))
    plan = np.abs(area_vectors(lowered[patch])[:, 2])
    volume = 0.0 if is_low.all() else float((plan * (rim[patch][..., 2].mean(axis=1) - low)).sum())
    changes.say(
        f"closed the open bottom, {_width(rim):.3g} m wide ({len(ring)} edges), by a flat face at its lowest point"
        + (f", {leans:.2g} degrees from level as its rim is" if leans > _LEANS else ""),
        volume,
        (lowered @ upright).mean(axis=0),
    )
    return np.concatenate([points, (lowered @ upright)[~is_low]]), np.concatenate([ears, skirt, below[patch]])


def _normal(ring: FloatArray) -> FloatArray:
    """Vector area of a ring [m2]."""
    arms = ring - ring.mean(axis=0)
    normal: FloatArray = 0.5 * np.cross(arms, np.roll(arms, -1, axis=0)).sum(axis=0)
    return normal


def _patch(ring: FloatArray, normal: FloatArray) -> IntArray:
    """Triangles between the corners of a ring, as it looks along its normal."""
    from manifold3d import triangulate

    area, width = float(np.linalg.norm(normal)), _width(ring)
    if len(ring) == 3 or area <= _SLIT * width**2:
        steps = np.arange(1, len(ring) - 1)
        return np.stack([np.zeros_like(steps), steps, steps + 1], axis=1)
    first = np.linalg.svd(normal[None])[2][1]
    second = np.cross(normal / area, first)
    plan = np.ascontiguousarray((ring - ring.mean(axis=0)) @ np.stack([first, second], axis=1))
    return np.asarray(triangulate([plan]), dtype=np.int64)


def _area(triangles: FloatArray) -> float:
    return float(np.linalg.norm(area_vectors(triangles), axis=1).sum())


def _width(ring: FloatArray) -> float:
    return float(np.linalg.norm(np.ptp(ring, axis=0)))
