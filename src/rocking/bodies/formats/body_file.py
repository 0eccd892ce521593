"""Body files: TOML with a unit and one shape, or a drawing in WKT, GeoJSON or DXF."""

import difflib
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking import checks
from rocking.bodies.block import Block
from rocking.bodies.body import Body
from rocking.bodies.formats.dxf import regions_from_dxf
from rocking.bodies.formats.geojson import regions_from_geojson
from rocking.bodies.formats.wkt import regions_from_wkt
from rocking.bodies.mass_points import MassPoints
from rocking.bodies.region import Region
from rocking.bodies.section import Section
from rocking.errors import BodyFileError, RockingError

if TYPE_CHECKING:
    from pydantic import ValidationError
    from pydantic_core import ErrorDetails

    from rocking.bodies.formats.schema import BodyFile

LARGEST_FILE = 64 * 2**20
"""Body files beyond this size are refused [bytes]."""

SUFFIXES = (".toml", ".wkt", ".geojson", ".json", ".dxf")


def read_body(path: str | Path, *, units: str | None = None) -> Body:
    """Read a body from a file.

    Parameters
    ----------
    path : str or Path
        ``.toml`` body file, or a drawing: ``.wkt``, ``.geojson``, ``.json``, ``.dxf``.
    units : str, optional
        Unit of the drawing (m, cm, mm, ft, in); needed for WKT and GeoJSON, and for DXF files that state none. A TOML
        file states its own.

    Returns
    -------
    Body
        The body, standing on the lowest point of its drawing.

    Raises
    ------
    BodyFileError
        If the file cannot be read as a body; the message names file and cause.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise BodyFileError(f"{path.name}: a body file ends in {', '.join(SUFFIXES)}")
    text = "" if suffix == ".dxf" else _text(path)
    try:
        if suffix == ".toml":
            if units is not None:
                raise BodyFileError("a TOML body file states its own units")
            return body_from_toml(text)
        return _drawing(path, suffix, text, units)
    except RockingError as error:
        words = str(error)
        raise BodyFileError(words if words.startswith(path.name) else f"{path.name}: {words}") from error


def body_from_toml(text: str) -> Body:
    """Return the body that a TOML text describes.

    Parameters
    ----------
    text : str
        TOML with ``units`` and one of the tables block, trapezoid, ellipse, regular_polygon, section, mass_points.

    Returns
    -------
    Body
        The body [m].

    Raises
    ------
    BodyFileError
        If the text is not TOML, or a key or value is not allowed.

    Examples
    --------
    >>> lines = ['units = "cm"', "[block]", "width = 50", "height = 200"]
    >>> body_from_toml(chr(10).join(lines)).slenderness_ratio
    4.0
    """
    try:
        plain = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise BodyFileError(f"not TOML: {error}") from error
    from pydantic import ValidationError

    from rocking.bodies.formats.schema import BodyFile

    try:
        described = BodyFile.model_validate(plain)
    except ValidationError as error:
        raise BodyFileError(_sentence(error)) from error
    tables = described.tables
    if len(tables) != 1:
        found = " and ".join(f"[{name}]" for name in tables) or "none"
        raise BodyFileError(f"a body file holds one shape, [block], [section] or another; got {found}")
    return _built(described)


def _text(path: Path) -> str:
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise BodyFileError(f"{path.name}: larger than {LARGEST_FILE // 2**20} MiB")
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise BodyFileError(f"{path.name}: cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise BodyFileError(f"{path.name}: not a text file in UTF-8") from error


def _drawing(path: Path, suffix: str, text: str, units: str | None) -> Body:
    if suffix == ".dxf":
        regions = regions_from_dxf(path, units=units)
    elif units is None:
        raise BodyFileError("a drawing states no unit; give one of m, cm, mm, ft, in")
    elif suffix == ".wkt":
        regions = regions_from_wkt(text, units=units)
    else:
        regions = regions_from_geojson(text, units=units)
    return Section(regions, ground=min(float(region.outline[:, 1].min()) for region in regions))


def _built(described: "BodyFile") -> Body:
    scale = checks.length_unit(described.units)
    ((name, table),) = described.tables.items()
    options: dict[str, Any] = {}
    if getattr(table, "depth", None) is not None:
        options["depth"] = table.depth * scale
    if getattr(table, "feet", None) is not None:
        options["feet"] = (table.feet[0] * scale, table.feet[1] * scale)
    if name == "mass_points":
        return MassPoints([(x * scale, y * scale) for x, y in table.points], table.masses, options["feet"])
    if name == "section":
        regions = [region for part in table.region for region in _regions(part, described.units, scale)]
        return Section(regions, ground=table.ground * scale, **options)
    options["density"] = table.density
    if name == "block":
        return Block(width=table.width * scale, height=table.height * scale, **options)
    if name == "trapezoid":
        sizes = (table.base * scale, table.top * scale, table.height * scale, table.lean * scale)
        return Section.from_trapezoid(*sizes, **options)
    if name == "ellipse":
        return Section.from_ellipse(table.width * scale, table.height * scale, table.sides, **options)
    return Section.from_regular_polygon(table.sides, table.radius * scale, **options)


def _regions(part: Any, units: str, scale: float) -> list[Region]:
    if (part.outline is None) == (part.wkt is None):
        raise BodyFileError("section.region needs either an outline or wkt")
    if part.wkt is not None:
        return regions_from_wkt(part.wkt, part.density, units=units)
    rings = [[(x * scale, y * scale) for x, y in ring] for ring in (part.outline, *part.holes)]
    return [Region(rings[0], part.density, rings[1:])]


def _sentence(error: "ValidationError") -> str:
    first = error.errors(include_url=False)[0]
    place = ".".join(str(part) for part in first["loc"])
    if first["type"] == "extra_forbidden":
        return f"unknown key {place!r}{_near(first)}"
    if first["type"] == "missing":
        hint = ' = "m", "cm", "mm", "ft" or "in": units are never guessed' if place == "units" else ""
        return f"{place}{hint} is missing" if not hint else f"{place} is missing: write {place}{hint}"
    value = first.get("input")
    shown = repr(value) if len(repr(value)) <= 40 else repr(value)[:37] + "..."
    return f"{place}: {first['msg'][0].lower()}{first['msg'][1:]}, got {shown}"


def _near(first: "ErrorDetails") -> str:
    from pydantic import BaseModel

    from rocking.bodies.formats import schema

    known = {
        field
        for table in vars(schema).values()
        if isinstance(table, type) and issubclass(table, BaseModel)
        for field in table.model_fields
    }
    close = difflib.get_close_matches(str(first["loc"][-1]), sorted(known), n=1)
    return f"; did you mean {close[0]!r}?" if close else ""
