"""From the triangles of a file to a closed surface: weld, clean, orient, close and repair, with a list of repairs.

The order matters. Faces have neighbours only after welding, which is necessary for orientation and the closing of
holes. Volumes need a closed surface, and the union of shells needs separate shells.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import get_args

import numpy as np

from rocking import checks
from rocking.bodies.body import DEFAULT_DENSITY
from rocking.bodies.equilibria.poses import set_down
from rocking.bodies.solid._changes import HELP, SKINS, Changes, InnerParts, Repair, coordinates_text
from rocking.bodies.solid._mending import uncrossed, without_dust, without_fins
from rocking.bodies.solid._shells import connected, decimated, hollowed, oriented_shells, turned_consistently
from rocking.bodies.solid._skin import Surface, skin
from rocking.bodies.solid.part import Part
from rocking.bodies.solid.polyhedron import Polyhedron, alone, checked_triangles, numbered, open_edges
from rocking.bodies.solid.surfaces import area_vectors
from rocking.conventions import FloatArray, IntArray, percent
from rocking.errors import GeometryError
from rocking.messages import Message, Option

LOW = 0.1  # largest median height of the rim of a bottom / height of the body [-]

_LEVEL, _NOTCH, _LISTED, _SLIT, _LOOSE, _INCLINED = 0.7, 0.01, 3, 1e-6, 0.5, 0.05


def boundary_loops(faces: IntArray) -> list[IntArray]:
    """Return the rings of edges with a face on one side only; rings with a common vertex are separate."""
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
            loop_start = position[vertex]
            loops.append(np.array(path[loop_start:]))
            for removed in path[loop_start + 1 :]:
                del position[removed]
            del path[loop_start + 1 :]
        if len(path) > 1:
            raise GeometryError(
                "The open edges of the surface form no rings, because more than two faces meet there", hint=HELP
            )
    return loops


def closed(points: FloatArray, faces: IntArray, changes: Changes) -> tuple[FloatArray, IntArray]:
    """Return the surface without holes: a horizontal face closes an open bottom, patches close other holes."""
    loops = boundary_loops(faces)
    if not loops:
        return points, faces
    if changes.allowed == "none":
        hint = Message("{safe} closes an open bottom and small holes", {"safe": Option("body.repair", "safe")})
        raise GeometryError(_not_closed(loops, points, changes), hint=hint)
    if (open_fraction := sum(map(len, loops)) / (3 * len(faces))) > _LOOSE:
        raise GeometryError(
            "{loops}; {share} of its edges are open: too few faces are connected",
            loops=_not_closed(loops, points, changes), share=percent(open_fraction), hint=HELP,
        )  # fmt: skip
    added, slits, patches, bound, moment = [faces], 0, [], 0.0, np.zeros(3)
    for ring in loops:
        if _is_bottom(points, faces, ring):
            points, level = _levelled(points, ring, changes)
            added.append(level)
            changes.mended.append(points[level])
            continue
        patch = _patch(points[ring], _normal(points[ring]))
        added.append(ring[patch])
        area, width = _area(points[ring[patch]]), _width(points[ring])
        if area <= _SLIT * width**2:
            slits += 1
            continue
        # volume of a dome of half the width over the hole
        bound, moment = bound + area * width / 3.0, moment + area * width / 3.0 * points[ring].mean(axis=0)
        patches.append(ring)
        changes.mended.append(points[ring[patch]])
    if slits:
        changes.add_repair(
            Message(
                "closed {slits} slit(s) without area at vertices on edges of other faces",
                {"slits": slits},
            )
        )
    if patches:
        closed_holes = Message("closed {holes}", {"holes": _listed(patches, points, changes)})
        changes.add_repair(closed_holes, bound, moment / bound)
    return points, np.concatenate(added)


def _listed(loops: list[IntArray], points: FloatArray, changes: Changes) -> str:
    """Return the number of holes, with size and location of the largest, as a text."""
    order = sorted(loops, key=lambda ring: -_width(points[ring]))
    holes = tuple(
        Message(
            "{width:.3g} m wide ({edges} edges) at {location}",
            {
                "width": _width(points[ring]),
                "edges": len(ring),
                "location": changes.describe(points[ring].mean(axis=0)),
            },
        )
        for ring in order[:_LISTED]
    )
    facts = {"number": len(loops), "holes": holes, "smaller": len(loops) - _LISTED}
    if len(loops) > _LISTED:
        return Message("{number} hole(s): {holes} and {smaller} smaller", facts)
    return Message("{number} hole(s): {holes}", facts)


def _not_closed(loops: list[IntArray], points: FloatArray, changes: Changes) -> str:
    return Message("The surface is not closed: {holes}", {"holes": _listed(loops, points, changes)})


def _is_bottom(points: FloatArray, faces: IntArray, ring: IntArray) -> bool:
    """Return True for the rim of a bottom: about horizontal, median height low, and outward normal downwards."""
    low, high, normal = points[:, 2].min(), points[:, 2].max(), _normal(points[ring])
    is_level = abs(normal[2]) >= _LEVEL * np.linalg.norm(normal)
    if not is_level or np.median(points[ring, 2]) - low > LOW * (high - low):
        return False
    a, b, c = np.moveaxis(points[faces] - points[ring].mean(axis=0), 1, 0)
    outward = np.sign(np.einsum("ij,ij->", a, np.cross(b, c)))  # sign of the volume, > 0 for outward faces
    return bool(normal[2] * outward < 0.0)


def _notched(height: FloatArray, ring: IntArray) -> tuple[IntArray, IntArray]:
    """Return a rim without the tops of its notches, and the faces of the notches."""
    limit = np.median(height[ring]) + _NOTCH * np.ptp(height)
    rim, ears = ring.tolist(), []
    while len(rim) > 3 and height[top := max(rim, key=height.item)] > limit:
        index = rim.index(top)
        ears.append((rim[index - 1], top, rim[(index + 1) % len(rim)]))
        del rim[index]
    return np.array(rim), np.array(ears, dtype=np.int64).reshape(-1, 3)


def _levelled(points: FloatArray, ring: IntArray, changes: Changes) -> tuple[FloatArray, IntArray]:
    """Return points with a rim lowered to the lowest point, and the faces of skirt and bottom."""
    # the direction is normal to the plane of the rim, so the body is upright on its bottom
    ring, _ = _notched(points[:, 2], ring)
    normal = np.linalg.svd(points[ring] - points[ring].mean(axis=0), full_matrices=False)[2][2]
    upright = set_down(-normal * (1.0 if normal[2] > 0.0 else -1.0))
    inclination = math.degrees(math.acos(min(1.0, abs(float(normal[2])))))
    upright_points = points @ upright.T
    ring, ears = _notched(upright_points[:, 2], ring)
    low, rim = float(upright_points[:, 2].min()), upright_points[ring]
    lowered = rim * [1.0, 1.0, 0.0] + [0.0, 0.0, low]
    is_low = rim[:, 2] - low <= 1e-9 * float(np.ptp(points, axis=0).max())
    below = np.where(is_low, ring, len(points) + np.cumsum(~is_low) - 1)
    after, after_below = np.roll(ring, -1), np.roll(below, -1)
    skirt = np.concatenate([np.stack([ring, after, after_below], 1), np.stack([ring, after_below, below], 1)])
    skirt = skirt[(skirt != np.roll(skirt, 1, axis=1)).all(axis=1)]
    patch = _patch(lowered, _normal(lowered))
    plan = np.abs(area_vectors(lowered[patch])[:, 2])
    volume = 0.0 if is_low.all() else float((plan * (rim[patch][..., 2].mean(axis=1) - low)).sum())
    bottom = Message(
        "closed the open bottom, {width:.3g} m wide ({edges} edges), by a flat face at its lowest point",
        {"width": _width(rim), "edges": len(ring)},
    )
    inclined = Message(
        "{repair}, inclined by {angle:.2g} degrees like its rim", {"repair": bottom, "angle": inclination}
    )
    changes.add_repair(
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


def _patch(ring: FloatArray, normal: FloatArray) -> IntArray:
    """Return triangles between the corners of a ring, as seen along its normal."""
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


WELD = 1e-6  # distance of merged vertices / size, if merging of equal vertices leaves the surface open [-]


@dataclass(frozen=True, eq=False)
class Repaired:
    """A closed surface with its repairs."""

    shape: Polyhedron  # the volume, with the middle of its box at the origin
    middle: FloatArray  # middle of the box in the coordinates of the input [m]; shape (3,)
    repairs: tuple[str, ...]  # one sentence per change; empty without changes

    def part(self, density: float = DEFAULT_DENSITY) -> Part:
        """Return the volume at its original position with one density [kg/m3]."""
        return Part(self.shape, density, translation=self.middle)


def repaired(
    vertices: FloatArray,
    faces: IntArray,
    *,
    weld_tolerance: float | None = None,
    repair: Repair = "safe",
    surface: Surface = "faces",
    wall: float | None = None,
    inner_parts: InnerParts = "refuse",
    describe: Callable[[FloatArray], str] = coordinates_text,
) -> Repaired:
    """Return the closed surface of triangles or of points, with one sentence per change."""
    surface = checks.one_of("surface", surface, get_args(Surface))
    vertices, faces = checked_triangles(vertices, faces, int(surface == "faces"))
    middle = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    points = vertices - middle
    size = checks.length("largest dimension of the mesh", float(np.ptp(points, axis=0).max()))
    changes = Changes(repair, inner_parts, lambda point: describe(point + middle))
    if surface == "faces":
        points, faces = _closed_surface(points, faces, weld_tolerance, size, changes)
    else:
        points, faces = skin(points, surface, changes)
    points, faces = oriented_shells(points, faces, changes)
    points, faces = decimated(points, faces, changes)
    points, faces = uncrossed(points, faces, changes)
    if wall is not None:
        points, faces = hollowed(
            points, faces, checks.within("wall", wall, 0.0, 0.5 * size, unit="m", open_low=True), changes
        )
    shape = Polyhedron(*_used(points, faces), simple=True, mended=changes.mended)
    _check_hull(shape)
    return Repaired(shape, middle, changes.sentences(shape.moments(), float(np.ptp(shape.vertices, axis=0).max())))


def _closed_surface(
    points: FloatArray, faces: IntArray, weld_tolerance: float | None, size: float, changes: Changes
) -> tuple[FloatArray, IntArray]:
    points, faces = _welded(points, faces, weld_tolerance, size, changes)
    faces = _cleaned(faces, changes)
    faces = without_fins(points, without_dust(points, faces, changes), changes)
    points, faces = _used(points, turned_consistently(faces, changes))
    count = len(faces)
    points, faces = closed(points, faces, changes)
    faces = turned_consistently(faces, changes) if len(faces) > count else faces
    if count := len(open_edges(faces)):
        raise GeometryError(
            "The surface has no consistent orientation: {count} edges have no matching neighbour. Check for edges with "
            "more than two faces, and for a one-sided surface", count=count,
            hint=Message("{wrap} uses a skin around the points", SKINS),
        )  # fmt: skip
    return points, faces


def _used(points: FloatArray, faces: IntArray) -> tuple[FloatArray, IntArray]:
    used, numbers = np.unique(faces, return_inverse=True)
    return points[used], numbers.reshape(faces.shape)


def _welded(
    points: FloatArray, faces: IntArray, tolerance: float | None, size: float, changes: Changes
) -> tuple[FloatArray, IntArray]:
    from scipy.spatial import cKDTree

    same, inverse = _same(points)
    merged, welded_faces = len(points) - len(same), inverse[faces]
    distance = checks.within("weld_tolerance", tolerance, 0.0, 0.01 * size, unit="m") if tolerance is not None else 0.0
    if tolerance is None and len(alone(welded_faces)):
        distance = WELD * size
    if distance > 0.0:
        labels = connected(len(same), *cKDTree(same).query_pairs(distance, output_type="ndarray").T)
        count = int(labels.max()) + 1
        merged += len(same) - count
        first = np.unique(labels, return_index=True)[1]
        same, welded_faces = same[first], labels[welded_faces]
    if merged:
        facts = {"merged": merged, "total": len(points), "distance": distance}
        near_each_other = Message("merged {merged} of {total} vertices at distances up to {distance:.3g} m", facts)
        in_one_place = Message("merged {merged} of {total} vertices with equal coordinates", facts)
        changes.add_note(near_each_other if distance > 0.0 else in_one_place)
    return same, welded_faces


def _same(points: FloatArray) -> tuple[FloatArray, IntArray]:
    """Return the different points, and the index of every point among them."""
    # a 64-bit hash of the three coordinates per point; the comparison detects the rare collisions
    bits = np.ascontiguousarray(points + 0.0).view(np.uint64)
    mixed = bits[:, 0] * np.uint64(0x9E3779B97F4A7C15) + bits[:, 1] * np.uint64(0xC2B2AE3D27D4EB4F)
    mixed = (mixed ^ (mixed >> np.uint64(29))) + bits[:, 2] * np.uint64(0x165667B19E3779F9)
    _, first, inverse = np.unique(mixed, return_index=True, return_inverse=True)
    if not (points[first][inverse] == points).all():
        same, inverse = np.unique(points, axis=0, return_inverse=True)
        return same, inverse.ravel()
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return points[first[order]], rank[inverse]


def _cleaned(faces: IntArray, changes: Changes) -> IntArray:
    a, b, c = faces.T
    is_triangle = (a != b) & (b != c) & (c != a)
    if not is_triangle.all():
        facts = {"number": int((~is_triangle).sum())}
        changes.add_repair(Message("removed {number} degenerate faces", facts))
    faces = faces[is_triangle]
    low, middle, high = np.sort(faces, axis=1).T
    edge = numbered(np.stack([low, middle], axis=1))
    _, first, inverse = np.unique(numbered(np.stack([edge, high], axis=1)), return_index=True, return_inverse=True)
    if len(first) == len(faces):
        return faces
    # faces with equal corners: those of the same orientation are one face, those of opposite orientation cancel
    net = np.bincount(inverse, weights=_parity(faces), minlength=len(first))
    sense = _parity(faces[first])
    keep = net != 0.0
    result: IntArray = np.where((net * sense < 0.0)[:, None], faces[first][:, ::-1], faces[first])[keep]
    if len(result) < 4:
        raise GeometryError("The faces coincide and enclose no volume: the surface is a sheet")
    changes.add_repair(Message("removed {number} duplicate faces", {"number": len(faces) - len(result)}))
    return result


def _parity(faces: IntArray) -> FloatArray:
    a, b, c = faces.T
    return np.where(((a < b) & (b < c)) | ((b < c) & (c < a)) | ((c < a) & (a < b)), 1.0, -1.0)


def _check_hull(shape: Polyhedron) -> None:
    hull_volume = float(shape.hull.volume)
    volume = shape.moments().mass
    if volume > hull_volume * (1.0 + 1e-9):
        raise GeometryError(
            "The surface encloses {volume:.6g} m3, more than its hull ({hull:.6g} m3): the surface intersects itself",
            volume=volume, hull=hull_volume,
        )  # fmt: skip
