"""Regions from WKT: POLYGON, MULTIPOLYGON and collections of them."""

from typing import TYPE_CHECKING

import numpy as np

from rocking import checks
from rocking.bodies.body import DEFAULT_DENSITY
from rocking.bodies.region import Region
from rocking.errors import BodyFileError

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry


def regions_from_wkt(text: str, density: float = DEFAULT_DENSITY, *, units: str = "m") -> list[Region]:
    """Return the polygons of a WKT text.

    Parameters
    ----------
    text : str
        WKT.
    density : float
        Density of all of them [kg/m3].
    units : str
        Unit of the coordinates: m, cm, mm, ft or in.

    Returns
    -------
    list of Region
        One a polygon [m].

    Raises
    ------
    BodyFileError
        If the text is not WKT, or holds anything but polygons.
    GeometryError
        If a polygon is not valid.

    Examples
    --------
    >>> len(regions_from_wkt("POLYGON ((0 0, 1 0, 1 2, 0 2, 0 0))"))
    1
    """
    import shapely

    try:
        geometry = shapely.from_wkt(text)
    except (shapely.errors.GEOSException, TypeError, ValueError) as error:
        raise BodyFileError(f"not WKT: {str(error).strip().splitlines()[0]}") from error
    return regions_of(geometry, density, units)


def regions_of(geometry: "BaseGeometry", density: float, units: str) -> list[Region]:
    """Return the polygons of a shapely geometry.

    Parameters
    ----------
    geometry : shapely geometry
        Polygon, MultiPolygon or a collection of them.
    density : float
        Density [kg/m3].
    units : str
        Unit of the coordinates.

    Returns
    -------
    list of Region
        One a polygon [m].

    Raises
    ------
    BodyFileError
        If it holds anything but polygons, or nothing.
    """
    import shapely

    scale = checks.length_unit(units)
    if isinstance(geometry, shapely.Polygon) and not geometry.is_empty:
        rings = [np.array(ring.coords)[:, :2] * scale for ring in (geometry.exterior, *geometry.interiors)]
        return [Region(rings[0], density, rings[1:])]
    if isinstance(geometry, (shapely.MultiPolygon, shapely.GeometryCollection)) and not geometry.is_empty:
        return [region for part in geometry.geoms for region in regions_of(part, density, units)]
    what = "an empty geometry" if geometry.is_empty else f"a {geometry.geom_type}"
    raise BodyFileError(f"a body is made of polygons, got {what}")
