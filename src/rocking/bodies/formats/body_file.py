"""The TOML body file: one table says what the body is, and `units` is never left out.

.. code-block:: toml

    units = "cm"
    [section]
    feet = [5, 75]
    [[section.region]]
    outline = [[0, 0], [80, 0], [80, 200], [0, 200]]
    density = 2400        # kg/m3, whatever the units
"""

import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np

from rocking.bodies import shapes
from rocking.bodies.block import Block
from rocking.bodies.body import DEFAULT_DENSITY, Body
from rocking.bodies.formats.dxf import regions_from_dxf
from rocking.bodies.formats.geojson import regions_from_geojson
from rocking.bodies.formats.wkt import regions_from_wkt
from rocking.bodies.formats.words import blamed, check_count, read_text, validated
from rocking.bodies.mass_points import MassPoints
from rocking.bodies.region import Region
from rocking.bodies.section import Section
from rocking.checks import length_unit
from rocking.conventions import FloatArray
from rocking.errors import BodyFileError

if TYPE_CHECKING:
    from rocking.bodies.formats import schema

LARGEST_TOML = 16 * 2**20  # larger TOML files are refused [byte]: large outlines belong in WKT, GeoJSON or DXF


class _Options(TypedDict, total=False):
    density: float
    depth: float
    mass: float | None
    centre: tuple[float, float] | None
    moment_of_inertia: float | None


def body_from_toml(text: str, name: str = "<text>", folder: str | Path | None = None) -> Body:
    r"""Return the body that the text of a body file describes.

    Parameters
    ----------
    text : str
        TOML.
    name : str
        Name that errors show.
    folder : str or Path, optional
        Folder of the GeoJSON and DXF files that the text names; without it, text cannot name files.

    Returns
    -------
    Body
        Block, Section or MassPoints.

    Raises
    ------
    BodyFileError
        If the text is not TOML, a key is unknown or missing, or a value is not of the kind or in the range
        that its key needs.
    GeometryError
        If the shapes do not describe a body.
    InvalidValueError
        If a size or a density is beyond what a body can have.
    MissingExtraError
        If the text names a DXF file and ezdxf is not installed.

    Examples
    --------
    >>> body_from_toml('units = "cm"\n[block]\nwidth = 50\nheight = 200').slenderness_ratio
    4.0
    """
    with blamed(name):
        return body_from_tables(parsed_toml(text), folder)


def body_from_tables(tables: dict[str, Any], folder: str | Path | None = None) -> Body:
    """Return the body that the tables of a body file describe."""
    from rocking.bodies.formats.schema import BodyFile

    if "solid" in tables:
        raise BodyFileError("describes a body in space, [solid]; a plane body is needed here")
    document = validated(BodyFile, tables)
    scale = length_unit(document.units)
    if document.block:
        return _block(document.block, scale)
    if document.mass_points:
        return _mass_points(document.mass_points, scale)
    if document.section:
        return _section(document.section, document.units, None if folder is None else Path(folder))
    return _shape(document, scale)


def parsed_toml(text: Any) -> dict[str, Any]:
    """Return the tables of a TOML text."""
    if not isinstance(text, str):
        raise BodyFileError(f"a body file must be text, got {type(text).__name__}")
    if len(text) > LARGEST_TOML:
        raise BodyFileError(f"is longer than {LARGEST_TOML / 2**20:g} MiB; put large outlines in WKT, GeoJSON or DXF")
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:  # its words name line and column
        raise BodyFileError(f"is not TOML: {error}") from error
    except (ValueError, RecursionError) as error:  # an integer of thousands of digits, thousands of brackets
        raise BodyFileError(f"is not TOML that can be read: {str(error).partition(';')[0]}") from error


def _block(table: "schema.BlockTable", scale: float) -> Body:
    with blamed("block"):
        body = Block(width=table.width * scale, height=table.height * scale, **_options(table, scale))
        feet = _pair(table.feet, scale)
        return body if feet is None else body.with_feet(*feet)


def _shape(document: "schema.BodyFile", scale: float) -> Section:
    from rocking.bodies.formats import schema

    kind = next(each for each in _OUTLINES if getattr(document, each))  # the schema lets exactly one table through
    table: schema.ShapeTable = getattr(document, kind)
    sizes = table.model_dump(exclude=set(schema.ShapeTable.model_fields))
    with blamed(kind):
        outline = _OUTLINES[kind](**{key: value * (1 if key == "sides" else scale) for key, value in sizes.items()})
        return Section.from_points(outline, feet=_pair(table.feet, scale), **_options(table, scale))


_OUTLINES: dict[str, Callable[..., FloatArray]] = {
    "trapezoid": shapes.trapezoid,
    "ellipse": shapes.ellipse,
    "regular_polygon": shapes.regular_polygon,
}
"""Shapes of which the keys of their tables are the arguments: lengths, and `sides`."""


def _options(table: "schema.ShapeTable", scale: float) -> "_Options":
    options = _known(table, scale)
    if table.density is not None:
        options["density"] = table.density
    if table.depth is not None:
        options["depth"] = table.depth * scale
    return options


def _known(table: "schema.KnownTable", scale: float) -> "_Options":
    centre = _pair(table.centre, scale)
    return {"mass": table.mass, "centre": centre, "moment_of_inertia": table.moment_of_inertia}


def _mass_points(table: "schema.MassPointsTable", scale: float) -> MassPoints:
    contact = None if table.contact is None else [(a * scale, b * scale) for a, b in table.contact]
    check_count(len(table.points))
    with blamed("mass_points"):
        for i, (a, b) in enumerate(table.contact or ()):
            if not a < b:
                raise BodyFileError(f"contact[{i}] must run from left to right, got [{a:g}, {b:g}]")
        points = [(x * scale, y * scale) for x, y in table.points]
        return MassPoints(points, table.masses, (table.feet[0] * scale, table.feet[1] * scale), contact)


def _section(table: "schema.SectionTable", units: str, folder: Path | None) -> Section:
    scale = length_unit(units)
    regions: list[Region] = []
    for i, part in enumerate(table.region):
        with blamed(f"section.region[{i}]"):
            regions += _regions(part, units, folder)
        check_count(sum(len(ring) for region in regions for ring in region.rings))
    with blamed("section"):
        depth = 1.0 if table.depth is None else table.depth * scale
        known: Any = _known(table, scale)
        return Section(regions, _pair(table.feet, scale), depth=depth, ground=table.ground * scale, **known)


def _regions(table: "schema.RegionTable", units: str, folder: Path | None) -> list[Region]:
    density = DEFAULT_DENSITY if table.density is None else table.density
    own = table.units or units
    if table.wkt is not None:
        return regions_from_wkt(table.wkt, density, units=own, name="wkt")
    if table.geojson is not None:
        path = beside(folder, table.geojson)
        with blamed(path.name):
            text = read_text(path)
        return regions_from_geojson(text, density, units=own, name=path.name)
    if table.dxf is not None:
        return regions_from_dxf(beside(folder, table.dxf), density, units=own, layers=table.layers)
    scale = length_unit(units)
    outline, *holes = (np.array(ring) * scale for ring in (table.outline or [], *(table.holes or ())))
    return [Region(outline, density, holes)]


def beside(folder: Path | None, name: str) -> Path:
    """Return the path of a file that a body file names: below its own folder, wherever the text came from."""
    if folder is None:
        raise BodyFileError(f"names the file {name!r}, but text without a folder cannot name files")
    try:
        root = folder.resolve()
        path = (root / name).resolve()
    except (OSError, ValueError, RuntimeError) as error:
        raise BodyFileError(f"the file name {name!r} cannot be used") from error
    if not path.is_relative_to(root):
        raise BodyFileError(f"the file {name!r} must lie in the folder of the body file or below it")
    return path


def _pair(values: list[float] | None, scale: float) -> tuple[float, float] | None:
    return None if values is None else (values[0] * scale, values[1] * scale)
