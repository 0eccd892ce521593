"""Read a body from a file: the suffix says which format, and the units are never guessed."""

import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Unpack

from rocking.bodies.body import DEFAULT_DENSITY, Body
from rocking.bodies.formats.body_file import LARGEST_TOML, body_from_toml
from rocking.bodies.formats.dxf import regions_from_dxf
from rocking.bodies.formats.geojson import regions_from_geojson
from rocking.bodies.formats.source import Placement, blamed, read_text, readable
from rocking.bodies.formats.wkt import regions_from_wkt
from rocking.bodies.region import Region
from rocking.bodies.section import Section
from rocking.conventions import LENGTH_UNITS
from rocking.errors import BodyFileError


@dataclass(frozen=True)
class Request:
    """What the user asked for: a file, a unit, a density, and how the body stands."""

    path: Path  # the file
    units: str | None  # unit of its coordinates
    density: float | None  # density of what has none of its own [kg/m3]
    placement: Placement  # feet, depth and ground [m]

    @property
    def some_density(self) -> float:
        """The density, by default that of plain concrete [kg/m3]."""
        return DEFAULT_DENSITY if self.density is None else self.density

    def needed_units(self) -> str:
        """Return the unit of a file whose format has no place for one."""
        if self.units is None:
            raise BodyFileError(f"does not state its unit; give units=, one of {', '.join(LENGTH_UNITS)}")
        return self.units


def read_body(
    path: str | Path, *, units: str | None = None, density: float | None = None, **placement: Unpack[Placement]
) -> Body:
    """Return the body that a file describes.

    Parameters
    ----------
    path : str or Path
        TOML body file, WKT (.wkt), GeoJSON (.geojson, .json) or DXF drawing (.dxf).
    units : {"m", "cm", "mm", "ft", "in"}, optional
        Unit of the coordinates: needed for WKT and GeoJSON, and for a drawing that does not state its unit. A unit
        that contradicts the file is refused.
    density : float, optional
        Density of what has none of its own in a WKT, GeoJSON or DXF file [kg/m3]; plain concrete if not given.
    **placement
        ``feet`` [m], ``depth`` [m] and ``ground`` [m] for WKT, GeoJSON and DXF, as for `Section`; a drawing stands
        on its lowest point if ``ground`` is not given.

    Returns
    -------
    Body
        Block, Section or MassPoints.

    Raises
    ------
    BodyFileError
        If the file cannot be read as a body.
    GeometryError
        If its shapes do not describe a body.
    InvalidValueError
        If one of its numbers, or the unit, is outside its range.
    MissingExtraError
        If it is a DXF drawing and ezdxf is not installed.
    TypeError
        If there is no such keyword.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder) / "crate.wkt"
    ...     _ = file.write_text("POLYGON ((0 0, 1000 0, 1000 2000, 0 2000, 0 0))")
    ...     read_body(file, units="mm", density=800.0).mass
    1600.0
    """
    try:
        path = Path(path)
    except TypeError as error:
        raise BodyFileError(f"a body file is given by its path, got {path!r}") from error
    reader = FORMATS.get(path.suffix.lower())
    if reader is None:
        raise BodyFileError(f"{path.name}: the name must end in {', '.join(FORMATS)}")
    if unknown := placement.keys() - Placement.__annotations__.keys():
        raise TypeError(f"read_body() has no {', '.join(sorted(unknown))}")
    with readable(path):
        return reader(Request(path, units, density, placement))


def _toml(request: Request) -> Body:
    path = request.path
    with blamed(path.name):
        text = read_text(path, LARGEST_TOML)
        if request.density is not None or request.placement:
            raise BodyFileError("a TOML body file states density, feet, depth and ground itself; change them there")
    body = body_from_toml(text, path.name, path.parent)
    stated = tomllib.loads(text)["units"] if request.units is not None else None
    if stated != request.units:
        raise BodyFileError(f'{path.name}: states units = "{stated}", but units = "{request.units}" was asked for')
    return body


def _wkt(request: Request) -> Body:
    name = request.path.name
    with blamed(name):
        units, text = request.needed_units(), read_text(request.path)
    return _standing(regions_from_wkt(text, request.some_density, units=units, name=name), request)


def _geojson(request: Request) -> Body:
    name = request.path.name
    with blamed(name):
        units, text = request.needed_units(), read_text(request.path)
    return _standing(regions_from_geojson(text, request.some_density, units=units, name=name), request)


def _dxf(request: Request) -> Body:
    return _standing(regions_from_dxf(request.path, request.some_density, units=request.units), request)


def _standing(regions: list[Region], request: Request) -> Section:
    lowest = min(float(region.outline[:, 1].min()) for region in regions)
    placement: Placement = {"ground": lowest, **request.placement}
    with blamed(request.path.name):
        return Section(regions, **placement)


FORMATS: dict[str, Callable[[Request], Body]] = {
    ".toml": _toml,
    ".wkt": _wkt,
    ".geojson": _geojson,
    ".json": _geojson,
    ".dxf": _dxf,
}
"""Suffix and reader: a new format is one line here."""
