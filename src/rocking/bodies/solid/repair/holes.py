"""Closing of holes: a horizontal face closes an open bottom, patches close other holes."""

import math

import numpy as np

from rocking.bodies.equilibria.poses import set_down
from rocking.bodies.solid.repair.log import HELP, RepairLog
from rocking.bodies.solid.surfaces import area_vectors
from rocking.bodies.solid.triangles import box_diagonal, largest_extent, single_edges, total_area
from rocking.conventions import FloatArray, IntArray, percent
from rocking.errors import GeometryError
from rocking.messages import Message, Option

LOW = 0.1  # largest median height of the rim of a bottom / height of the body [-]
_LEVEL = 0.7  # smallest vertical component of the unit normal of a bottom [-]
_NOTCH = 0.01  # largest height of the rim of a bottom above its median / height of the body [-]
_INCLINED = 0.05  # largest inclination of a bottom that is not reported [deg]
_SLIT = 1e-6  # largest area / squared diagonal of a hole without area [-]
_LOOSE = 0.5  # largest fraction of open edges of a surface [-]
_LISTED = 3  # largest number of holes in a message [-]


def close_holes(points: FloatArray, faces: IntArray, log: RepairLog) -> tuple[FloatArray, IntArray]:
    """Return the surface without holes: a horizontal face closes an open bottom, patches close other holes."""
    loops = boundary_loops(faces)
    if not loops:
        return points, faces
    if log.allowed == "none":
        hint = Message("{safe} closes an open bottom and small holes", {"safe": Option("body.repair", "safe")})
        raise GeometryError(_not_closed(loops, points, log), hint=hint)
    if (open_fraction := sum(map(len, loops)) / (3 * len(faces))) > _LOOSE:
        raise GeometryError(
            "{loops}; {share} of its edges are open: too few faces are connected",
            loops=_not_closed(loops, points, log), share=percent(open_fraction), hint=HELP,
        )  # fmt: skip
    added, slits, rings, bound, moment = [faces], 0, [], 0.0, np.zeros(3)
    for ring in loops:
        if _is_bottom(points, faces, ring):
            points, level = _close_bottom(points, ring, log)
            added.append(level)
            log.patches.append(points[level])
            continue
        patch = _triangulated(points[ring], _normal(points[ring]))
        added.append(ring[patch])
        area, width = total_area(points[ring[patch]]), box_diagonal(points[ring])
        if area <= _SLIT * width**2:
            slits += 1
            continue
        # the bound is the volume of a dome over the hole with a height of half the width
        bound, moment = bound + area * width / 3.0, moment + area * width / 3.0 * points[ring].mean(axis=0)
        rings.append(ring)
        log.patches.append(points[ring[patch]])
    if slits:
        log.add_repair(
            Message(
                "closed {slits} slit(s) without area at vertices on edges of other faces",
                {"slits": slits},
            )
        )
    if rings:
        closed_holes = Message("closed {holes}", {"holes": _list_holes(rings, points, log)})
        log.add_repair(closed_holes, bound, moment / bound)
    return points, np.concatenate(added)


def boundary_loops(faces: IntArray) -> list[IntArray]:
    """Return the rings of edges with a face on one side only; rings with a common vertex are separate."""
    following: dict[int, list[int]] = {}
    for end, start in single_edges(faces).tolist():
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
            loop_start = position[vertex]
            loops.append(np.array(path[loop_start:]))
            for removed in path[loop_start + 1 :]:
                del position[removed]
            del path[loop_start + 1 :]
        if len(path) > 1:
            raise GeometryError(
                "The open edges of the surface do not form closed rings, because more than two faces meet at an edge",
                hint=HELP,
            )
    return loops


def _list_holes(loops: list[IntArray], points: FloatArray, log: RepairLog) -> str:
    """Return the number of holes, with size and location of the largest, as a text."""
    order = sorted(loops, key=lambda ring: -box_diagonal(points[ring]))
    holes = tuple(
        Message(
            "{width:.3g} m wide ({edges} edges) at {location}",
            {
                "width": box_diagonal(points[ring]),
                "edges": len(ring),
                "location": log.describe(points[ring].mean(axis=0)),
            },
        )
        for ring in order[:_LISTED]
    )
    facts = {"number": len(loops), "holes": holes, "smaller": len(loops) - _LISTED}
    if len(loops) > _LISTED:
        return Message("{number} hole(s): {holes} and {smaller} smaller", facts)
    return Message("{number} hole(s): {holes}", facts)


def _not_closed(loops: list[IntArray], points: FloatArray, log: RepairLog) -> str:
    return Message("The surface is not closed: {holes}", {"holes": _list_holes(loops, points, log)})


def _is_bottom(points: FloatArray, faces: IntArray, ring: IntArray) -> bool:
    """Return True for the rim of a bottom: a nearly horizontal, low rim with a downward outward normal."""
    low, high, normal = points[:, 2].min(), points[:, 2].max(), _normal(points[ring])
    is_level = abs(normal[2]) >= _LEVEL * np.linalg.norm(normal)
    if not is_level or np.median(points[ring, 2]) - low > LOW * (high - low):
        return False
    a, b, c = np.moveaxis(points[faces] - points[ring].mean(axis=0), 1, 0)
    outward = np.sign(np.einsum("ij,ij->", a, np.cross(b, c)))  # sign of the volume, > 0 for outward faces
    return bool(normal[2] * outward < 0.0)


def _without_notches(height: FloatArray, ring: IntArray) -> tuple[IntArray, IntArray]:
    """Return a rim without the tops of its notches, and the faces of the notches."""
    limit = np.median(height[ring]) + _NOTCH * np.ptp(height)
    rim, ears = ring.tolist(), []
    while len(rim) > 3 and height[top := max(rim, key=height.item)] > limit:
        index = rim.index(top)
        ears.append((rim[index - 1], top, rim[(index + 1) % len(rim)]))
        del rim[index]
    return np.array(rim), np.array(ears, dtype=np.int64).reshape(-1, 3)


def _close_bottom(points: FloatArray, ring: IntArray, log: RepairLog) -> tuple[FloatArray, IntArray]:
    """Return points with a rim lowered to the lowest point, and the faces of skirt and bottom."""
    # the direction is normal to the plane of the rim, so the body is upright on its bottom
    ring, _ = _without_notches(points[:, 2], ring)
    normal = np.linalg.svd(points[ring] - points[ring].mean(axis=0), full_matrices=False)[2][2]
    upright = set_down(-normal * (1.0 if normal[2] > 0.0 else -1.0))
    inclination = math.degrees(math.acos(min(1.0, abs(float(normal[2])))))
    upright_points = points @ upright.T
    ring, ears = _without_notches(upright_points[:, 2], ring)
    low, rim = float(upright_points[:, 2].min()), upright_points[ring]
    lowered = rim * [1.0, 1.0, 0.0] + [0.0, 0.0, low]
    is_low = rim[:, 2] - low <= 1e-9 * largest_extent(points)
    below = np.where(is_low, ring, len(points) + np.cumsum(~is_low) - 1)
    after, after_below = np.roll(ring, -1), np.roll(below, -1)
    skirt = np.concatenate([np.stack([ring, after, after_below], 1), np.stack([ring, after_below, below], 1)])
    skirt = skirt[(skirt != np.roll(skirt, 1, axis=1)).all(axis=1)]
    patch = _triangulated(lowered, _normal(lowered))
    plan = np.abs(area_vectors(lowered[patch])[:, 2])
    volume = 0.0 if is_low.all() else float((plan * (rim[patch][..., 2].mean(axis=1) - low)).sum())
    bottom = Message(
        "closed the open bottom, {width:.3g} m wide ({edges} edges), by a flat face at its lowest point",
        {"width": box_diagonal(rim), "edges": len(ring)},
    )
    inclined = Message(
        "{repair}, inclined by {angle:.2g} degrees like its rim", {"repair": bottom, "angle": inclination}
    )
    log.add_repair(
        inclined if inclination > _INCLINED else bottom,
        volume,
        (lowered @ upright).mean(axis=0),
    )
    return np.concatenate([points, (lowered @ upright)[~is_low]]), np.concatenate([ears, skirt, below[patch]])


def _normal(ring: FloatArray) -> FloatArray:
    """Return the vector area of a ring [m2]."""
    arms = ring - ring.mean(axis=0)
    normal: FloatArray = 0.5 * np.cross(arms, np.roll(arms, -1, axis=0)).sum(axis=0)
    return normal


def _triangulated(ring: FloatArray, normal: FloatArray) -> IntArray:
    """Return triangles between the corners of a ring, as seen along its normal."""
    from manifold3d import triangulate

    area, width = float(np.linalg.norm(normal)), box_diagonal(ring)
    if len(ring) == 3 or area <= _SLIT * width**2:
        steps = np.arange(1, len(ring) - 1)
        return np.stack([np.zeros_like(steps), steps, steps + 1], axis=1)
    first = np.linalg.svd(normal[None])[2][1]
    second = np.cross(normal / area, first)
    plan = np.ascontiguousarray((ring - ring.mean(axis=0)) @ np.stack([first, second], axis=1))
    return np.asarray(triangulate([plan]), dtype=np.int64)
