"""Polygons of one material: validation of rings, detection of holes, triangulation."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from rocking import checks
from rocking.bodies.body import DEFAULT_DENSITY
from rocking.checks import LARGEST, SMALLEST
from rocking.conventions import FloatArray
from rocking.errors import BodyFileError, GeometryError, InvalidValueError, located
from rocking.messages import Amount, Index, Message

OVERLAP_TOLERANCE = 1e-9  # tolerance for rounding: overlap / smaller area of regions with a common edge


def checked_ring(name: str, points: Any) -> FloatArray:
    """Return vertices as an open ring without repeated neighbours."""
    try:
        vertices = checks.real_array(name, points)
    except InvalidValueError as error:
        raise GeometryError("{ring} must be a list of (x, y) points in m, with numbers only", ring=name) from error
    if vertices.ndim != 2 or vertices.shape[1:] != (2,):
        raise GeometryError(
            "{ring} must be a list of (x, y) points, got an array of shape {shape}", ring=name, shape=vertices.shape
        )
    finite = np.isfinite(vertices).all(axis=1)
    if not finite.all():
        bad = int(np.argmin(finite))
        raise GeometryError(
            "{ring}: point {index} must be finite, got {point}", ring=name, index=Index(bad),
            point=tuple(vertices[bad].tolist()),
        )  # fmt: skip
    if np.abs(vertices).max(initial=0.0) > LARGEST:
        raise GeometryError(
            "{ring}: coordinates must be within {limit:g} m of the origin",
            ring=name,
            limit=LARGEST,
            hint="check the unit",
        )
    kept: FloatArray = vertices[(vertices != np.roll(vertices, 1, axis=0)).any(axis=1)]
    if len(kept) < 3:
        raise GeometryError("{name} must have at least 3 different points, got {count}", name=name, count=len(kept))
    return kept


def check_polygon(name: str, outline: FloatArray, holes: Sequence[FloatArray]) -> None:
    """Refuse crossing rings, and holes outside their outline."""
    import shapely

    # local coordinates prevent rounding errors of GEOS far from the origin
    origin = 0.5 * (outline.min(axis=0) + outline.max(axis=0))
    rings: list[tuple[str | Message, FloatArray]] = [("outline", outline)]
    rings += [(Message("hole {hole}", {"hole": Index(i)}), hole) for i, hole in enumerate(holes)]
    with located(name):
        for ring, points in rings:
            polygon = shapely.Polygon(points - origin)
            if not polygon.is_valid:
                raise _crossing(shapely.is_valid_reason(polygon), origin, ring)
            box = np.ptp(points, axis=0)
            if box.max() < SMALLEST:
                limit = Amount(SMALLEST, "m")
                raise GeometryError("{ring} is smaller than {limit}", ring=ring, limit=limit, hint="check the unit")
            if polygon.area <= 1e-14 * float(box.max()) ** 2:
                raise GeometryError(
                    "{ring} encloses no area", ring=ring, hint="check that its points are not collinear"
                )
        if holes:
            polygon = shapely.Polygon(outline - origin, [hole - origin for hole in holes])
            if not polygon.is_valid:
                raise _invalid_hole(shapely.is_valid_reason(polygon), origin)


def check_disjoint(polygons: Sequence[tuple[FloatArray, Sequence[FloatArray]]]) -> None:
    """Refuse overlapping regions; common edges are allowed."""
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
                "regions {first} and {second} overlap over {area}",
                hint="cut a hole for one region in the other",
                first=Index(i), second=Index(j), area=Amount(shared, "m2", ".6g"),
            )  # fmt: skip


def _crossing(geos_reason: str, origin: FloatArray, ring: str | Message) -> GeometryError:
    """Return the error of a ring that is not simple, with the location from GEOS."""
    kind, facts = _split(geos_reason, origin)
    if "Self-intersection" in kind:
        return GeometryError(
            "{ring} crosses or touches itself" + _NEAR, ring=ring, **facts, hint="check the order of the points"
        )
    return GeometryError("{ring} is not a simple ring: {kind}" + _NEAR, ring=ring, kind=kind.lower(), **facts)


def _invalid_hole(geos_reason: str, origin: FloatArray) -> GeometryError:
    kind, facts = _split(geos_reason, origin)
    if "outside" in kind:
        hint = "check that hole and outline are not exchanged"
        return GeometryError("a hole lies outside the outline" + _NEAR, **facts, hint=hint)
    if "nested" in kind.lower() or "Duplicate" in kind:
        return GeometryError("one hole lies inside another" + _NEAR, **facts)
    if "disconnected" in kind:
        hint = "use one region for each piece"
        return GeometryError("the holes cut the region in two" + _NEAR, **facts, hint=hint)
    return GeometryError("a hole crosses the outline or another hole" + _NEAR, **facts)


_NEAR = " near x = {x}, y = {y}"


def _split(geos_reason: str, origin: FloatArray) -> tuple[str, dict[str, Any]]:
    """Return fault and coordinates from a text of GEOS such as "Self-intersection[1 2]"."""
    kind, x, y = re.fullmatch(r"(.*?)\[(\S+) (\S+)\]", geos_reason).groups()  # type: ignore[union-attr]
    point = float(x) + float(origin[0]), float(y) + float(origin[1])
    return kind, {axis: Amount(value, "m", ".9g") for axis, value in zip("xy", point, strict=True)}


Nested = tuple[FloatArray, list[FloatArray]]


def nested(rings: Sequence[FloatArray], names: Sequence[str]) -> list[Nested]:
    """Return the outlines with their holes; outlines lie inside an even number of rings, holes inside an odd number."""
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
            raise BodyFileError("{curve} and {copy} are the same curve. Remove one.", curve=names[i], copy=names[j])
        # a point of a large ring can lie inside a small ring; only covered rings are nested
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


@dataclass(frozen=True, eq=False, init=False)
class Region:
    """One polygon of one material.

    Parameters
    ----------
    outline : array_like, shape (n, 2)
        Vertices (x, y), y upwards, clockwise or counter-clockwise, with or without a repeated first vertex [m].
    density : float
        Density [kg/m3].
    holes : sequence of array_like
        Rings of the holes in the outline [m].

    Raises
    ------
    GeometryError
        If a ring crosses itself or another, or a hole lies outside the outline.
    InvalidValueError
        If the density is not a finite number above zero.

    Examples
    --------
    >>> from rocking import Region
    >>> Region([(0, 0), (1, 0), (1, 2), (0, 2)], density=2400.0).outline.shape
    (4, 2)
    """

    outline: FloatArray
    density: float
    holes: tuple[FloatArray, ...]

    def __init__(self, outline: ArrayLike, density: float = DEFAULT_DENSITY, holes: Sequence[ArrayLike] = ()) -> None:
        rings: object = holes
        if not isinstance(rings, (Sequence, np.ndarray)):
            raise GeometryError("holes must be a list of rings, each a list of (x, y) points in m")
        outer = checked_ring("outline", outline)
        inner = tuple(checked_ring(Message("hole {hole}", {"hole": Index(i)}), hole) for i, hole in enumerate(holes))
        check_polygon("region", outer, inner)
        self._set(outer, checks.density("density", density), inner)

    def _set(self, outline: FloatArray, density: float, holes: Sequence[FloatArray]) -> None:
        # the outline is counter-clockwise and holes are clockwise, so that boundary integrals can be added
        object.__setattr__(self, "outline", _turned(outline, 1.0))
        object.__setattr__(self, "density", density)
        object.__setattr__(self, "holes", tuple(_turned(hole, -1.0) for hole in holes))

    @property
    def rings(self) -> tuple[FloatArray, ...]:
        """Outline (counter-clockwise) and holes (clockwise) [m]."""
        return (self.outline, *self.holes)

    def moved(self, dx: float, dy: float) -> "Region":
        """Return the region moved by (dx, dy).

        Parameters
        ----------
        dx, dy : float
            Displacement [m].

        Returns
        -------
        Region
            Moved region.
        """
        return self.mapped(lambda ring: ring + np.array([dx, dy]))

    def mapped(self, change: Callable[[FloatArray], FloatArray], density: float = 1.0) -> "Region":
        """Return the region after a similarity transformation, with a scaled density.

        Parameters
        ----------
        change : callable
            Function from a ring (n, 2) to the moved, mirrored or scaled ring [m].
        density : float
            Scale factor of the density [-].

        Returns
        -------
        Region
            Transformed region, without further checks.
        """
        region = object.__new__(Region)
        outline, *holes = (change(ring) for ring in self.rings)
        region._set(outline, type(self.density)(self.density * density), holes)
        return region


def _turned(ring: FloatArray, sense: float) -> FloatArray:
    x, y = (ring - ring[0]).T
    twice_area = float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum())
    result = ring if twice_area * sense > 0.0 else ring[::-1]
    return np.ascontiguousarray(result)
