"""Is this set of rings a body? Validity is GEOS's verdict (shapely), put in words a user can act on."""

import re
from collections.abc import Sequence
from typing import Any

import numpy as np

from rocking import checks
from rocking.checks import LARGEST, SMALLEST
from rocking.conventions import FloatArray
from rocking.errors import GeometryError, InvalidValueError

# Neighbouring regions share edges that rounding may cross: overlaps below this share of the smaller area pass.
OVERLAP_TOLERANCE = 1e-9


def ring(name: str, points: Any) -> FloatArray:
    """Return vertices as an open ring of distinct neighbours.

    points: vertices [m]; a repeated closing point and repeated neighbours are dropped.
    """
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
    """Refuse rings that cross themselves or each other, and holes outside their outline.

    outline: outer ring [m]; holes: inner rings [m].
    """
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
    """Refuse regions that overlap; shared edges are welcome.

    polygons: one pair per region, in one frame near the origin [m].
    """
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
