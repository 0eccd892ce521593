"""Rings of polygons: which are valid (by GEOS, in words a user can act on), which are holes, and their triangles."""

import re
from collections.abc import Sequence
from typing import Any

import numpy as np

from rocking import checks
from rocking.checks import LARGEST, SMALLEST
from rocking.conventions import FloatArray
from rocking.errors import BodyFileError, GeometryError, InvalidValueError

# Neighbouring regions share edges that rounding may cross: overlaps below this share of the smaller area pass.
OVERLAP_TOLERANCE = 1e-9


def checked_ring(name: str, points: Any) -> FloatArray:
    """Return vertices as an open ring of distinct neighbours."""
    try:
        vertices = checks.real_array(name, points)
    except InvalidValueError as error:
        raise GeometryError(f"{name} must be a list of (x, y) points in m, all numbers") from error
    if vertices.ndim != 2 or vertices.shape[1:] != (2,):
        raise GeometryError(f"{name} must be a list of (x, y) points, got an array of shape {vertices.shape}")
    finite = np.isfinite(vertices).all(axis=1)
    if not finite.all():
        bad = int(np.argmin(finite))
        raise GeometryError(f"{name}: point {bad} must be finite, got {tuple(vertices[bad].tolist())}")
    if np.abs(vertices).max(initial=0.0) > LARGEST:
        raise GeometryError(f"{name}: coordinates must be within {LARGEST:g} m of the origin; wrong unit?")
    kept: FloatArray = vertices[(vertices != np.roll(vertices, 1, axis=0)).any(axis=1)]
    if len(kept) < 3:
        raise GeometryError(f"{name} must have at least 3 different points, got {len(kept)}")
    return kept


def check_polygon(name: str, outline: FloatArray, holes: Sequence[FloatArray]) -> None:
    """Refuse rings that cross themselves or each other, and holes outside their outline."""
    import shapely

    # local coordinates: far from the origin GEOS would work on what rounding leaves over
    origin = 0.5 * (outline.min(axis=0) + outline.max(axis=0))
    for label, points in [(f"{name}: outline", outline)] + [
        (f"{name}: hole {i}", hole) for i, hole in enumerate(holes)
    ]:
        polygon = shapely.Polygon(points - origin)
        if not polygon.is_valid:
            raise GeometryError(f"{label} {_reason(shapely.is_valid_reason(polygon), origin)}")
        box = np.ptp(points, axis=0)
        if box.max() < SMALLEST:
            raise GeometryError(f"{label} is smaller than {SMALLEST:g} m; wrong unit?")
        if polygon.area <= 1e-14 * float(box.max()) ** 2:
            raise GeometryError(f"{label} encloses no area; are all its points on one line?")
    if holes:
        whole = shapely.Polygon(outline - origin, [hole - origin for hole in holes])
        if not whole.is_valid:
            raise GeometryError(f"{name}: {_hole_reason(shapely.is_valid_reason(whole), origin)}")


def check_disjoint(polygons: Sequence[tuple[FloatArray, Sequence[FloatArray]]]) -> None:
    """Refuse regions that overlap; shared edges are welcome."""
    if len(polygons) < 2:
        return
    import shapely

    shapes = np.array([shapely.Polygon(outline, holes) for outline, holes in polygons])
    first, second = shapely.STRtree(shapes).query(shapes, predicate="intersects")
    for i, j in zip(first.tolist(), second.tolist(), strict=True):
        if i >= j:
            continue
        shared = shapely.intersection(shapes[i], shapes[j]).area
        if shared > OVERLAP_TOLERANCE * min(shapes[i].area, shapes[j].area):
            raise GeometryError(
                f"regions {i} and {j} overlap over {shared:.6g} m2; cut a hole in one of them where the other lies"
            )


def _reason(words: str, origin: FloatArray) -> str:
    kind, place = _split(words, origin)
    if "Self-intersection" in kind:
        return f"crosses or touches itself{place}; are two points swapped?"
    return f"is not a simple ring: {kind.lower()}{place}"


def _hole_reason(words: str, origin: FloatArray) -> str:
    kind, place = _split(words, origin)
    if "outside" in kind:
        return f"a hole lies outside the outline{place}; are hole and outline swapped?"
    if "nested" in kind.lower() or "Duplicate" in kind:
        return f"one hole lies inside another{place}"
    if "disconnected" in kind:
        return f"the holes cut the region in two{place}; give each piece as a region of its own"
    return f"a hole crosses the outline or another hole{place}"


def _split(words: str, origin: FloatArray) -> tuple[str, str]:
    match = re.match(r"(.*?)\[(\S+) (\S+)\]", words)
    if not match:
        return words, ""
    x, y = float(match[2]) + origin[0], float(match[3]) + origin[1]
    return match[1], f" near x = {x:.9g} m, y = {y:.9g} m"


Nested = tuple[FloatArray, list[FloatArray]]


def nested(rings: Sequence[FloatArray], names: Sequence[str]) -> list[Nested]:
    """Sort rings into outlines, inside an even number of others, and the holes of the innermost outline around them."""
    import shapely

    kept = [checked_ring(name, ring) for name, ring in zip(names, rings, strict=True)]
    for name, ring in zip(names, kept, strict=True):
        check_polygon(name, ring, [])
    origin = np.min([ring.min(axis=0) for ring in kept], axis=0)
    shapes = np.array([shapely.Polygon(ring - origin) for ring in kept])
    areas = shapely.area(shapes)
    inner, outer = shapely.STRtree(shapes).query(shapely.point_on_surface(shapes), predicate="within")
    around: list[list[int]] = [[] for _ in kept]
    for i, j in zip(inner.tolist(), outer.tolist(), strict=True):
        if i < j and shapes[i].normalize().equals_exact(shapes[j].normalize(), 1e-12 * float(np.sqrt(areas[i]))):
            raise BodyFileError(f"{names[i]} and {names[j]} are the same curve drawn twice; delete one")
        # a point of a large ring may fall inside a small one in its middle: that is no nesting
        if areas[i] < areas[j] and shapes[j].covers(shapes[i]):
            around[i].append(j)
    return [
        (ring, [kept[k] for k in range(len(kept)) if _is_hole_of(k, i, around)])
        for i, ring in enumerate(kept)
        if len(around[i]) % 2 == 0
    ]


def _is_hole_of(ring: int, outline: int, around: list[list[int]]) -> bool:
    return outline in around[ring] and len(around[ring]) == len(around[outline]) + 1


def triangulated(outline: FloatArray, holes: Sequence[FloatArray] = ()) -> FloatArray:
    """Return counter-clockwise triangles that fill a polygon."""
    import shapely

    pieces = shapely.constrained_delaunay_triangles(shapely.Polygon(outline, holes))
    triangles = shapely.get_coordinates(shapely.get_parts(pieces)).reshape(-1, 4, 2)[:, :3]
    side, other = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    turned = side[:, 0] * other[:, 1] - side[:, 1] * other[:, 0] < 0.0
    ordered: FloatArray = np.where(turned[:, None, None], triangles[:, ::-1], triangles)
    return ordered
