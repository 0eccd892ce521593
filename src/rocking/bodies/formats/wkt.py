"""Well-known text (OGC 06-103r4, clause 7): POLYGON, MULTIPOLYGON, and collections of them."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np

from rocking.bodies.body import DEFAULT_DENSITY
from rocking.bodies.formats.words import Placement, check_count
from rocking.bodies.region import Region
from rocking.bodies.section import Section
from rocking.checks import length_unit
from rocking.errors import BodyFileError, located

if TYPE_CHECKING:
    from shapely import Polygon
    from shapely.geometry.base import BaseGeometry

DEEPEST = 16  # collections nested deeper are refused, before GEOS would run out of stack


def section_from_wkt(
    text: str,
    density: float | Sequence[float] = DEFAULT_DENSITY,
    *,
    units: str = "m",
    name: str = "WKT",
    **placement: Unpack[Placement],
) -> Section:
    """Return the section that well-known text describes.

    Parameters
    ----------
    text : str
        POLYGON with holes, MULTIPOLYGON, or GEOMETRYCOLLECTION of those; y up.
    density : float or sequence of float
        One density for all polygons, or one for each in order [kg/m3].
    units : {"m", "cm", "mm", "ft", "in"}
        Unit of the coordinates.
    name : str
        Name that errors show.
    **placement
        ``feet`` [m], ``depth`` [m] and ``ground`` [m], as for `Section`; always in m.

    Returns
    -------
    Section
        The body.

    Raises
    ------
    BodyFileError
        If the text is not WKT, or is not made of plane polygons.
    GeometryError
        If the polygons do not describe a body.
    InvalidValueError
        If a density or the unit is refused.

    Examples
    --------
    >>> section_from_wkt("POLYGON ((0 0, 80 0, 80 200, 0 200, 0 0))", units="cm").centre
    (0.4, 1.0)
    """
    regions = regions_from_wkt(text, density, units=units, name=name)
    with located(name, "file"):
        return Section(regions, **placement)


def regions_from_wkt(
    text: str,
    density: float | Sequence[float] = DEFAULT_DENSITY,
    *,
    units: str = "m",
    name: str = "WKT",
) -> list[Region]:
    """Return the polygons that well-known text describes, in its order."""
    with located(name, "file"):
        scale = length_unit(units)
        polygons = _polygons(_geometry(text))
        regions = []
        for i, (polygon, value) in enumerate(zip(polygons, _densities(density, len(polygons)), strict=True)):
            with located(f"polygon {i}"):
                outline, *holes = (np.asarray(r.coords)[:, :2] * scale for r in (polygon.exterior, *polygon.interiors))
                regions.append(Region(outline, value, holes))
        return regions


def _geometry(text: Any) -> "BaseGeometry":
    import shapely

    if not isinstance(text, str) or not text.strip():
        raise BodyFileError("has no text; it must be a POLYGON, MULTIPOLYGON or GEOMETRYCOLLECTION")
    if "\0" in text:
        raise BodyFileError("is not WKT: it holds a NUL character")
    if _depth(text) > DEEPEST:
        raise BodyFileError("is nested more than {limit} brackets deep", limit=DEEPEST)
    try:
        with np.errstate(all="ignore"):  # the coordinates are checked afterwards, by name
            geometry: BaseGeometry = shapely.from_wkt(text.strip())
    except (shapely.errors.ShapelyError, NotImplementedError, UnicodeError) as error:
        raise BodyFileError("is not WKT: {reason}", reason=_one_line(error)) from error
    if geometry.has_z or getattr(geometry, "has_m", False):
        raise BodyFileError("has z or m coordinates; a section is plane, give x and y only")
    check_count(int(shapely.get_num_coordinates(geometry)))
    return geometry


def _polygons(geometry: "BaseGeometry") -> "list[Polygon]":
    if geometry.geom_type in {"MultiPolygon", "GeometryCollection"}:
        found = [polygon for part in geometry.geoms for polygon in _polygons(part)]  # type: ignore[attr-defined]
        if not found:
            raise BodyFileError("the {geometry} is empty", geometry=geometry.geom_type.upper())
        return found
    if geometry.geom_type != "Polygon":
        raise BodyFileError(
            "a {geometry} encloses no area", geometry=geometry.geom_type.upper(), hint="a body is made of POLYGONs"
        )
    if geometry.is_empty:
        raise BodyFileError("the POLYGON is empty")
    return [geometry]  # type: ignore[list-item]


def _densities(density: Any, count: int) -> list[Any]:
    if isinstance(density, str) or not isinstance(density, (Sequence, np.ndarray)):
        return [density] * count  # whatever it is, Region judges it
    if len(density) != count:
        raise BodyFileError(
            "has {count} polygon(s), but {densities} densities were given", count=count, densities=len(density)
        )
    return list(density)


def _depth(text: str) -> int:
    deepest = depth = 0
    for bracket in (c for c in text if c in "()"):
        depth += 1 if bracket == "(" else -1
        deepest = max(deepest, depth)
    return deepest


def _one_line(error: Exception) -> str:
    words = " ".join(str(error).split()).split("Exception: ", 1)[-1]
    return words if len(words) <= 120 else words[:117] + "..."
