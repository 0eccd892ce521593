"""GeoJSON (RFC 7946) as a drawing: polygons in a plane, y up, with a density as a property.

Coordinate reference systems are not interpreted: RFC 7946 means longitude and latitude in degrees, but a body is
drawn in lengths. Positions are taken as (x, y) in `units`, and a ``crs`` member is ignored.
"""

import json
from collections.abc import Iterator, Mapping
from typing import Any, NoReturn, Unpack

import numpy as np

from rocking import checks
from rocking.bodies.body import DEFAULT_DENSITY
from rocking.bodies.formats.words import Placement, check_count
from rocking.bodies.region import Region
from rocking.bodies.section import Section
from rocking.conventions import FloatArray
from rocking.errors import BodyFileError, located

DEEPEST = 16  # collections nested deeper are refused
_Found = tuple[str, list[Any], float]


def section_from_geojson(
    source: str | Mapping[str, Any],
    density: float = DEFAULT_DENSITY,
    *,
    units: str = "m",
    name: str = "GeoJSON",
    **placement: Unpack[Placement],
) -> Section:
    """Return the section that GeoJSON describes; coordinate reference systems are not interpreted.

    Parameters
    ----------
    source : str or dict
        Polygon, MultiPolygon, Feature, FeatureCollection or GeometryCollection, as text or parsed; y up.
    density : float
        Density of what has no property ``density`` of its own [kg/m3].
    units : {"m", "cm", "mm", "ft", "in"}
        Unit of the coordinates; never degrees.
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
        If it is not GeoJSON, or is not made of plane polygons.
    GeometryError
        If the polygons do not describe a body.
    InvalidValueError
        If a density or the unit is refused.

    Examples
    --------
    >>> square = {"type": "Polygon", "coordinates": [[[0, 0], [2, 0], [2, 2], [0, 2], [0, 0]]]}
    >>> section_from_geojson({"type": "Feature", "properties": {"density": 2000.0}, "geometry": square}).mass
    8000.0
    """
    regions = regions_from_geojson(source, density, units=units, name=name)
    with located(name, "file"):
        return Section(regions, **placement)


def regions_from_geojson(
    source: str | Mapping[str, Any],
    density: float = DEFAULT_DENSITY,
    *,
    units: str = "m",
    name: str = "GeoJSON",
) -> list[Region]:
    """Return the polygons that GeoJSON describes, in its order; coordinate reference systems are not interpreted."""
    with located(name, "file"):
        scale = checks.length_unit(units)
        given = _parsed(source) if isinstance(source, str) else source
        regions, vertices = [], 0
        for where, coordinates, value in _polygons(given, "", density, 0):
            with located(where):
                rings = [_ring(ring, f"coordinates[{i}]") for i, ring in enumerate(coordinates)]
                vertices += sum(map(len, rings))
                check_count(vertices)
                outline, *holes = (ring * scale for ring in rings)
                regions.append(Region(outline, value, holes))
        if not regions:
            raise BodyFileError("holds no polygon")
        return regions


def _parsed(text: str) -> Any:
    try:
        return json.loads(text, parse_constant=_refuse_constant)
    except json.JSONDecodeError as error:
        raise BodyFileError("is not JSON: {reason}", reason=str(error)) from error
    except (ValueError, RecursionError) as error:  # an integer of thousands of digits, thousands of brackets
        raise BodyFileError("is not JSON that can be read: {reason}", reason=str(error).partition(";")[0]) from error


def _refuse_constant(word: str) -> NoReturn:
    raise BodyFileError("holds {constant}", constant=word, hint="every number must be finite")


def _polygons(thing: Any, where: str, density: Any, depth: int) -> Iterator[_Found]:
    """Walk down to the polygons, with the place for errors and the density that applies."""
    if depth > DEEPEST:
        raise BodyFileError("is nested more than {limit} collections deep", limit=DEEPEST)
    kind = _member(thing, "type", where)
    if kind == "FeatureCollection":
        yield from _each(thing, "features", where, density, depth)
    elif kind == "GeometryCollection":
        yield from _each(thing, "geometries", where, density, depth)
    elif kind == "Feature":
        own = _own_density(thing.get("properties"), where, density)
        yield from _polygons(_member(thing, "geometry", where), _join(where, "geometry"), own, depth + 1)
    elif kind == "Polygon":
        yield where or kind, _list(thing, "coordinates", where), density
    elif kind == "MultiPolygon":
        for i, rings in enumerate(_list(thing, "coordinates", where)):
            place = _join(where, f"coordinates[{i}]")
            if not isinstance(rings, (list, tuple)) or not rings:
                raise BodyFileError(
                    "{member} must be a list of rings, got {content}", member=place, content=_short(rings)
                )
            yield place, list(rings), density
    else:
        raise BodyFileError(
            "{member} must be Polygon, MultiPolygon, Feature, FeatureCollection or GeometryCollection, got {content}",
            member=_join(where, "type"), content=_short(kind),
        )  # fmt: skip


def _each(thing: Any, key: str, where: str, density: Any, depth: int) -> Iterator[_Found]:
    for i, part in enumerate(_list(thing, key, where)):
        yield from _polygons(part, _join(where, f"{key}[{i}]"), density, depth + 1)


def _own_density(properties: Any, where: str, default: Any) -> Any:
    if properties is None:
        return default
    if not isinstance(properties, Mapping):
        raise BodyFileError(
            "{member} must be an object, got {content}", member=_join(where, "properties"), content=_short(properties)
        )
    own = properties.get("density")
    return default if own is None else checks.density(_join(where, "properties.density"), own)


def _ring(positions: Any, name: str) -> FloatArray:
    if not isinstance(positions, (list, tuple)) or len(positions) < 4:
        raise BodyFileError(
            "{member} must be a ring of at least 4 positions, the last one equal to the first", member=name
        )
    points = [_position(p, f"{name}[{i}]") for i, p in enumerate(positions)]
    if points[0] != points[-1]:
        raise BodyFileError(
            "{member} must end at its first position (RFC 7946, 3.1.6), got {point}", member=name, point=points[-1]
        )
    return np.array(points, dtype=np.float64)


def _position(position: Any, name: str) -> tuple[float, float]:
    if not isinstance(position, (list, tuple)) or len(position) != 2:
        raise BodyFileError(
            "{member} must be a position [x, y] in the plane, got {content}", member=name, content=_short(position)
        )
    return checks.number(f"{name}[0]", position[0]), checks.number(f"{name}[1]", position[1])


def _member(thing: Any, key: str, where: str) -> Any:
    if not isinstance(thing, Mapping):
        raise BodyFileError(
            "{member} must be a GeoJSON object, got {content}", member=where or "the document", content=_short(thing)
        )
    if key not in thing:
        raise BodyFileError(
            "{member} has no member {key!r}", member=where or "the document", key=key, hint="is it GeoJSON?"
        )
    return thing[key]


def _list(thing: Any, key: str, where: str) -> list[Any]:
    value = _member(thing, key, where)
    if not isinstance(value, (list, tuple)) or not value:
        raise BodyFileError(
            "{member} must be a list that is not empty, got {content}", member=_join(where, key), content=_short(value)
        )
    return list(value)


def _join(where: str, key: str) -> str:
    return f"{where}.{key}" if where else key


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
