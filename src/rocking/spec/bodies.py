"""Construction of bodies from their tables."""

from pathlib import Path
from typing import Any

from rocking import checks
from rocking.bodies import PLANE_BODIES, Block, Body, Isolated, Restrained, Section, Stack
from rocking.bodies.formats import read_body
from rocking.bodies.formats.body_file import body_from_tables
from rocking.bodies.formats.reader import KNOWN
from rocking.bodies.formats.words import suggestion
from rocking.bodies.solid import Solid
from rocking.checks import length_unit
from rocking.errors import InvalidValueError
from rocking.spec.reading import InputFiles, tables_in

_OUTSIDE = ("units", "name", "note", "frame", "isolator", "restraint", "floor_slope")


def body_of(table: dict[str, Any], inputs: InputFiles | None) -> Body:
    """Return the 2D body of a table."""
    body = without_restraints(any_body_of(table, inputs))
    if not isinstance(body, Body):
        raise InvalidValueError("This is a 3D body; a 2D body is needed.")
    return body


def without_restraints(body: Body | Restrained | Isolated | Stack | Solid) -> Body | Solid:
    """Return a body, or raise an error if it has restraints or an isolated base, or is a stack."""
    if isinstance(body, Stack):
        raise InvalidValueError("This analysis does not support stacks. `rocking simulate` supports stacks.")
    if isinstance(body, Restrained):
        if not body.restraints:
            raise InvalidValueError("This analysis does not support a sloping floor. Remove floor_slope.")
        raise InvalidValueError("This analysis does not support restraints. Remove [[restraint]].")
    if isinstance(body, Isolated):
        raise InvalidValueError("This analysis does not support isolated bases. Remove [isolator].")
    return body


def any_body_of(table: dict[str, Any], inputs: InputFiles | None) -> Body | Restrained | Isolated | Stack | Solid:
    """Return the 2D or 3D body of a table."""
    if "file" in table:
        return _body_in_file(table, inputs)
    sizes, angle = {"width", "height"} & set(table), {"slenderness_angle", "semi_diagonal"} & set(table)
    if angle and sizes:
        raise InvalidValueError("Use width and height, or slenderness_angle and semi_diagonal, not both.")
    if angle:
        return _from_angle(table)
    if sizes:
        own = {key: value for key, value in table.items() if key not in _OUTSIDE}
        table = {**{key: value for key, value in table.items() if key in _OUTSIDE}, "block": own}
    tables = {key: value for key, value in table.items() if value is not None}
    if inputs is not None:
        _note_outlines(tables, ".", inputs)
    return body_from_tables(tables, None if inputs is None else inputs.folder)


def name_of(table: dict[str, Any], folder: Path) -> str:
    """Return the key `name` of a body or of its file, otherwise the name of the file; empty without both."""
    if "file" not in table:
        return str(table.get("name") or "")
    path = folder / str(table["file"])
    return str((tables_in(path) or {}).get("name") or path.stem)


def body_for_motion(
    table: dict[str, Any], inputs: InputFiles | None, *, in_space: bool, with_stacks: bool = False
) -> Body | Restrained | Isolated | Stack | Solid:
    """Return the body of a table. With `in_space`, a 2D body with a stated depth becomes a 3D body."""
    body = any_body_of(table, inputs)
    if isinstance(body, Stack):
        if not with_stacks:
            without_restraints(body)
        if in_space:
            raise InvalidValueError("A stack moves along x and z only.")
    if not in_space or not isinstance(body, PLANE_BODIES):
        return body
    without_restraints(body)
    tables = (tables_in(inputs.file(table["file"])) or {}) if inputs is not None and "file" in table else table
    inner_tables = (table_with_depth for table_with_depth in tables.values() if isinstance(table_with_depth, dict))
    if not isinstance(body, (Block, Section)) or not any(
        "depth" in table_with_depth for table_with_depth in (tables, *inner_tables)
    ):
        raise InvalidValueError(
            "A 2D body has motions along x and z only. For a motion along y or a 3D file, use a 3D body, or a block or "
            "section with a depth (--depth, or depth in its table)."
        )
    return Solid.from_section(body)


_WITH_FILE = ("units", "density", "up", "repair", "surface", "wall", "inner_parts", "base_tolerance", *KNOWN)
_OF_ANGLE = (
    "units", "name", "note", "slenderness_angle", "semi_diagonal", "depth", "density", "mass", "moment_of_inertia",
)  # fmt: skip


def _body_in_file(table: dict[str, Any], inputs: InputFiles | None) -> Body | Restrained | Isolated | Stack | Solid:
    options = {key: value for key, value in table.items() if key != "file"}
    if odd := sorted(set(options) - set(_WITH_FILE)):
        raise InvalidValueError(
            "Key {key!r:.60} is not allowed with file", key=odd[0], hint=suggestion(odd[0], _WITH_FILE)
        )
    if not isinstance(table["file"], str):
        raise InvalidValueError(parameter="file", allowed="text", value=table["file"])
    if inputs is None:
        raise InvalidValueError(
            "The file {value} is not allowed here. State the body itself.", parameter="file", value=table["file"]
        )
    path = inputs.file(table["file"])
    _note_outlines(tables_in(path) or {}, str(Path(table["file"]).parent), inputs)
    length = length_unit(options.get("units") or "m")
    for key in ("base_tolerance", "wall"):
        if options.get(key) is not None:
            options[key] *= length
    if isinstance(options.get("centre"), list):
        options["centre"] = [checks.number("centre", value, "m") * length for value in options["centre"]]
    return read_body(path, **options)


def _from_angle(table: dict[str, Any]) -> Body:
    """Return a block from slenderness angle [rad] and semi-diagonal."""
    if odd := sorted(set(table) - set(_OF_ANGLE)):
        raise InvalidValueError("unknown key {key!r:.60}", key=odd[0], hint=suggestion(odd[0], sorted(_OF_ANGLE)))
    if missing := sorted({"units", "slenderness_angle", "semi_diagonal"} - set(table)):
        raise InvalidValueError(
            "{parameter} is missing. A block needs slenderness_angle, semi_diagonal and units.", parameter=missing[0]
        )
    scale = length_unit(table["units"])
    sizes = {key: checks.number(key, table[key]) for key in ("semi_diagonal", "depth") if key in table}
    options: dict[str, Any] = {key: table[key] for key in ("density", "mass", "moment_of_inertia") if key in table}
    if "depth" in sizes:
        options["depth"] = sizes["depth"] * scale
    return Block.from_angle(table["slenderness_angle"], sizes["semi_diagonal"] * scale, **options)


def _note_outlines(tables: dict[str, Any], folder: str, inputs: InputFiles) -> None:
    """Add the outline files of a body to the input files. Errors are ignored, because the reader reports them later."""
    try:
        regions = tables.get("section", {}).get("region", [])
        names = [region[key] for region in regions for key in ("geojson", "dxf") if key in region]
    except (AttributeError, TypeError):
        return
    for name in names:
        if isinstance(name, str):
            inputs.file((Path(folder) / name).as_posix())
