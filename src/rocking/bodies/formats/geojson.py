"""Regions from GeoJSON: polygons, features with a density property, and collections of them."""

import json
from typing import Any

from rocking.bodies.body import DEFAULT_DENSITY
from rocking.bodies.formats.wkt import regions_of
from rocking.bodies.region import Region
from rocking.errors import BodyFileError


def regions_from_geojson(
    source: str | dict[str, Any], density: float = DEFAULT_DENSITY, *, units: str = "m"
) -> list[Region]:
    """Return the polygons of a GeoJSON text or object.

    Coordinates are lengths in the plane of the body; coordinate reference systems are not interpreted.

    Parameters
    ----------
    source : str or dict
        GeoJSON.
    density : float
        Density of features without a ``density`` property [kg/m3].
    units : str
        Unit of the coordinates: m, cm, mm, ft or in.

    Returns
    -------
    list of Region
        One a polygon [m].

    Raises
    ------
    BodyFileError
        If it is not GeoJSON, or holds anything but polygons.
    GeometryError
        If a polygon is not valid.

    Examples
    --------
    >>> square = {"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]]}
    >>> regions_from_geojson(square, density=2700.0)[0].density
    2700.0
    """
    if isinstance(source, str):
        try:
            source = json.loads(source)
        except (json.JSONDecodeError, RecursionError) as error:
            raise BodyFileError(f"not GeoJSON: {error}") from error
    return _regions(source, density, units)


def _regions(thing: Any, density: float, units: str) -> list[Region]:
    if not isinstance(thing, dict) or not isinstance(thing.get("type"), str):
        raise BodyFileError('not GeoJSON: an object with a "type" is needed')
    if thing["type"] == "FeatureCollection":
        return [region for part in _list(thing, "features") for region in _regions(part, density, units)]
    if thing["type"] == "Feature":
        properties = thing.get("properties") or {}
        own = properties.get("density", density) if isinstance(properties, dict) else density
        return _regions(thing.get("geometry"), own, units)
    if thing["type"] == "GeometryCollection":
        return [region for part in _list(thing, "geometries") for region in _regions(part, density, units)]
    return _geometry(thing, density, units)


def _list(thing: dict[str, Any], key: str) -> list[Any]:
    parts = thing.get(key)
    if not isinstance(parts, list) or not parts:
        raise BodyFileError(f'not GeoJSON: {thing["type"]} needs a list "{key}"')
    return parts


def _geometry(thing: dict[str, Any], density: float, units: str) -> list[Region]:
    import shapely
    from shapely.geometry import shape

    try:
        geometry = shape(thing)
    except (shapely.errors.ShapelyError, AttributeError, KeyError, TypeError, ValueError, IndexError) as error:
        raise BodyFileError(f"not a GeoJSON geometry: {error}") from error
    return regions_of(geometry, density, units)
