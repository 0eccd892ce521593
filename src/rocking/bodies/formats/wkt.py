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

DEEPEST = 16  # largest depth of nested collections, which protects the stack of GEOS


def section_from_wkt(
    text: str,
    density: float | Sequence[float] = DEFAULT_DENSITY,
    *,
    units: str = "m",
    name: str = "WKT",
    **placement: Unpack[Placement],
) -> Section:
    """Return the section from well-known text.

    Parameters
    ----------
    text : str
        POLYGON with holes, MULTIPOLYGON, or GEOMETRYCOLLECTION of those; y up.
    density : float or sequence of float
        Density of all polygons, or densities of the polygons in order [kg/m3].
    units : {"m", "cm", "mm", "ft", "in"}
        Unit of the coordinates.
    name : str
        Name of the text in error messages.
    **placement
        ``feet`` [m], ``depth`` [m] and ``ground`` [m], as for `Section`; always in m.

    Returns
    -------
    Section
        The body.

    Raises
    ------
    BodyFileError
        If the text is not WKT, or contains other geometries than 2D polygons.
    GeometryError
        If the polygons do not describe a body.
    InvalidValueError
        If a density or the unit is invalid.

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
    """Return the polygons of well-known text in their order."""
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
        raise BodyFileError("The text is empty. Use a POLYGON, MULTIPOLYGON or GEOMETRYCOLLECTION.")
    if "\0" in text:
        raise BodyFileError("Invalid WKT: the text contains a NUL character.")
    if _depth(text) > DEEPEST:
        raise BodyFileError("The brackets are nested more than {limit} deep.", limit=DEEPEST)
    try:
        with np.errstate(all="ignore"):  # the coordinates are checked later
            geometry: BaseGeometry = shapely.from_wkt(text.strip())
    except (shapely.errors.ShapelyError, NotImplementedError, UnicodeError) as error:
        raise BodyFileError("Invalid WKT: {reason}", reason=_one_line(error)) from error
    if geometry.has_z or getattr(geometry, "has_m", False):
        raise BodyFileError("z and m coordinates are not allowed. Use x and y only.")
    check_count(int(shapely.get_num_coordinates(geometry)))
    return geometry


def _polygons(geometry: "BaseGeometry") -> "list[Polygon]":
    if geometry.geom_type in {"MultiPolygon", "GeometryCollection"}:
        polygons = [polygon for member in geometry.geoms for polygon in _polygons(member)]  # type: ignore[attr-defined]
        if not polygons:
            raise BodyFileError("The {geometry} is empty.", geometry=geometry.geom_type.upper())
        return polygons
    if geometry.geom_type != "Polygon":
        raise BodyFileError("A {geometry} encloses no area", geometry=geometry.geom_type.upper(), hint="use POLYGONs")
    if geometry.is_empty:
        raise BodyFileError("The POLYGON is empty.")
    return [geometry]  # type: ignore[list-item]


def _densities(density: Any, count: int) -> list[Any]:
    if isinstance(density, str) or not isinstance(density, (Sequence, np.ndarray)):
        return [density] * count  # `Region` checks the density
    if len(density) != count:
        raise BodyFileError(
            "The number of densities must be 1 or the number of polygons, {count}, got {densities}.",
            count=count,
            densities=len(density),
        )
    return list(density)


def _depth(text: str) -> int:
    deepest = depth = 0
    for bracket in (c for c in text if c in "()"):
        depth += 1 if bracket == "(" else -1
        deepest = max(deepest, depth)
    return deepest


def _one_line(error: Exception) -> str:
    text = " ".join(str(error).split()).split("Exception: ", 1)[-1]
    return text if len(text) <= 120 else text[:117] + "..."
