"""GeoJSON (RFC 7946) as a drawing: polygons in a plane, y up, with a density as a property.

The coordinates are lengths (x, y) in `units`, not longitude and latitude. A ``crs`` member is ignored.
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

DEEPEST = 16  # largest depth of nested collections
_LocatedPolygon = tuple[str, list[Any], float]


def section_from_geojson(
    source: str | Mapping[str, Any],
    density: float = DEFAULT_DENSITY,
    *,
    units: str = "m",
    name: str = "GeoJSON",
    **placement: Unpack[Placement],
) -> Section:
    """Return the section from GeoJSON, without coordinate reference systems.

    Parameters
    ----------
    source : str or dict
        Polygon, MultiPolygon, Feature, FeatureCollection or GeometryCollection, as text or parsed; y up.
    density : float
        Density of features without a property ``density`` [kg/m3].
    units : {"m", "cm", "mm", "ft", "in"}
        Unit of the coordinates; never degrees.
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
        If the text is not GeoJSON, or contains other geometries than 2D polygons.
    GeometryError
        If the polygons do not describe a body.
    InvalidValueError
        If a density or the unit is invalid.

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
    """Return the polygons of GeoJSON in their order, without coordinate reference systems."""
    with located(name, "file"):
        scale = checks.length_unit(units)
        document = _parsed(source) if isinstance(source, str) else source
        regions, vertices = [], 0
        for location, coordinates, value in _polygons(document, "", density, 0):
            with located(location):
                rings = [_ring(ring, f"coordinates[{i}]") for i, ring in enumerate(coordinates)]
                vertices += sum(map(len, rings))
                check_count(vertices)
                outline, *holes = (ring * scale for ring in rings)
                regions.append(Region(outline, value, holes))
        if not regions:
            raise BodyFileError("The text contains no polygon.")
        return regions


def _parsed(text: str) -> Any:
    try:
        return json.loads(text, parse_constant=_refuse_constant)
    except json.JSONDecodeError as error:
        raise BodyFileError("Invalid JSON: {reason}", reason=str(error)) from error
    except (ValueError, RecursionError) as error:  # from too long numbers or too deep nesting
        raise BodyFileError("Unreadable JSON: {reason}", reason=str(error).partition(";")[0]) from error


def _refuse_constant(constant: str) -> NoReturn:
    raise BodyFileError("The value {constant} is not allowed", constant=constant, hint="use finite numbers")


def _polygons(member: Any, location: str, density: Any, depth: int) -> Iterator[_LocatedPolygon]:
    """Yield location, rings and density of all polygons in a member."""
    if depth > DEEPEST:
        raise BodyFileError("The collections are nested more than {limit} deep.", limit=DEEPEST)
    kind = _member(member, "type", location)
    if kind == "FeatureCollection":
        yield from _polygons_of_list(member, "features", location, density, depth)
    elif kind == "GeometryCollection":
        yield from _polygons_of_list(member, "geometries", location, density, depth)
    elif kind == "Feature":
        own_density = _own_density(member.get("properties"), location, density)
        yield from _polygons(_member(member, "geometry", location), _join(location, "geometry"), own_density, depth + 1)
    elif kind == "Polygon":
        yield location or kind, _list(member, "coordinates", location), density
    elif kind == "MultiPolygon":
        for i, rings in enumerate(_list(member, "coordinates", location)):
            location_of_rings = _join(location, f"coordinates[{i}]")
            if not isinstance(rings, (list, tuple)) or not rings:
                raise BodyFileError(
                    "{member} must be a list of rings, got {content}", member=location_of_rings, content=_short(rings)
                )
            yield location_of_rings, list(rings), density
    else:
        raise BodyFileError(
            "{member} must be Polygon, MultiPolygon, Feature, FeatureCollection or GeometryCollection, got {content}",
            member=_join(location, "type"), content=_short(kind),
        )  # fmt: skip


def _polygons_of_list(parent: Any, key: str, location: str, density: Any, depth: int) -> Iterator[_LocatedPolygon]:
    for i, member in enumerate(_list(parent, key, location)):
        yield from _polygons(member, _join(location, f"{key}[{i}]"), density, depth + 1)


def _own_density(properties: Any, location: str, default: Any) -> Any:
    if properties is None:
        return default
    if not isinstance(properties, Mapping):
        raise BodyFileError(
            "{member} must be an object, got {content}",
            member=_join(location, "properties"),
            content=_short(properties),
        )
    own = properties.get("density")
    return default if own is None else checks.density(_join(location, "properties.density"), own)


def _ring(positions: Any, name: str) -> FloatArray:
    if not isinstance(positions, (list, tuple)) or len(positions) < 4:
        raise BodyFileError(
            "{member} must be a ring of at least 4 positions with equal first and last positions", member=name
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


def _member(parent: Any, key: str, location: str) -> Any:
    if not isinstance(parent, Mapping):
        raise BodyFileError(
            "{member} must be a GeoJSON object, got {content}",
            member=location or "the document",
            content=_short(parent),
        )
    if key not in parent:
        raise BodyFileError(
            "{member} has no member {key!r}",
            member=location or "the document",
            key=key,
            hint="check that the text is GeoJSON",
        )
    return parent[key]


def _list(parent: Any, key: str, location: str) -> list[Any]:
    value = _member(parent, key, location)
    if not isinstance(value, (list, tuple)) or not value:
        raise BodyFileError(
            "{member} must be a nonempty list, got {content}", member=_join(location, key), content=_short(value)
        )
    return list(value)


def _join(location: str, key: str) -> str:
    return f"{location}.{key}" if location else key


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
