"""Reading and writing of the TOML body file, which contains one table of the body and always `units`."""

import dataclasses
import math
import re
import tomllib
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import singledispatch
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.bodies import shapes
from rocking.bodies.block import Block
from rocking.bodies.body import DEFAULT_DENSITY, DEFAULT_DEPTH, Body
from rocking.bodies.formats.dxf import regions_from_dxf
from rocking.bodies.formats.geojson import regions_from_geojson
from rocking.bodies.formats.wkt import regions_from_wkt
from rocking.bodies.formats.words import check_count, read_text, validated
from rocking.bodies.frame import Frame
from rocking.bodies.isolated import Isolated
from rocking.bodies.mass_points import MassPoints
from rocking.bodies.region import Region
from rocking.bodies.restrained import Restrained
from rocking.bodies.restraints import KINDS, Restraint
from rocking.bodies.section import Section
from rocking.bodies.stack import Stack
from rocking.checks import length_unit
from rocking.conventions import Assumed, FloatArray
from rocking.errors import BodyFileError, InvalidValueError, located
from rocking.messages import Index

if TYPE_CHECKING:
    from rocking.bodies.formats import schema

LARGEST_TOML = 16 * 2**20  # largest size of a TOML file; WKT, GeoJSON and DXF files may be larger [byte]


def body_from_toml(
    text: str, name: str = "<text>", folder: str | Path | None = None
) -> Body | Restrained | Isolated | Stack:
    r"""Return the body from the text of a body file.

    Parameters
    ----------
    text : str
        TOML.
    name : str
        Name of the text in error messages.
    folder : str or Path, optional
        Folder of the GeoJSON and DXF files that the text names. By default, the text must not name files.

    Returns
    -------
    Body, Restrained, Isolated or Stack
        Block, Section or MassPoints. With tables [[restraint]] a body with restraints, with a table [stack] a stack,
        with a table [isolator] a body on an isolated base.

    Raises
    ------
    BodyFileError
        If the text is not TOML, a key is unknown or missing, or a value has a wrong type or is outside its range.
    GeometryError
        If the shapes do not describe a body.
    InvalidValueError
        If a size or a density is outside the range for bodies.
    MissingExtraError
        If the text names a DXF file and ezdxf is not installed.

    Examples
    --------
    >>> body_from_toml('units = "cm"\n[block]\nwidth = 50\nheight = 200').slenderness_ratio
    4.0
    """
    with located(name, "file"):
        return body_from_tables(parsed_toml(text), folder)


def body_from_tables(tables: dict[str, Any], folder: str | Path | None = None) -> Body | Restrained | Isolated | Stack:
    """Return the body from the tables of a body file."""
    from rocking.bodies.formats.schema import BodyFile

    if "solid" in tables:
        raise BodyFileError("This is a 3D body, [solid]; a 2D body is needed.")
    if "stack" in tables:
        return _stack(tables, folder)
    document = validated(BodyFile, tables)
    body = _without_restraints(document, folder)
    if document.frame:
        with located("frame"):
            body = Frame([body] * document.frame.columns, **document.frame.model_dump(exclude={"columns"}))
    if document.isolator:
        if document.restraint or document.floor_slope:
            raise BodyFileError("A body with [isolator] has no [[restraint]] and no floor_slope. Remove them.")
        with located("isolator"):
            return Isolated(body, **document.isolator.model_dump(exclude_none=True))
    if not document.restraint and not document.floor_slope:
        return body
    restraints = _restraints(document.restraint or [], length_unit(document.units))
    return Restrained(body, restraints, floor_slope=document.floor_slope or 0.0)


def _stack(tables: dict[str, Any], folder: str | Path | None) -> Stack:
    from rocking.bodies.formats.schema import BODIES, BodyFile, StackDocument

    document = validated(StackDocument, tables)
    table, scale, bodies = document.stack, length_unit(document.units), []
    for k, body in enumerate(table.body):
        with located(f"stack.body[{k}]"):
            if odd := sorted(set(body) - set(BODIES)):
                raise BodyFileError(
                    "Key {key!r:.60} is not allowed for a body of a stack. Use one of {choice}.", key=odd[0],
                    choice=", ".join(BODIES),
                )  # fmt: skip
            tables_of_body = validated(BodyFile, {"units": document.units, **body})
            bodies.append(_without_restraints(tables_of_body, folder))
    offsets = [value * scale for value in table.offsets] if isinstance(table.offsets, list) else table.offsets * scale
    with located("stack"):
        return Stack(bodies, friction=table.friction, restitution=table.restitution, offsets=offsets)


def _without_restraints(document: "schema.BodyFile", folder: str | Path | None) -> Body:
    scale = length_unit(document.units)
    if document.block:
        return _block(document.block, scale)
    if document.mass_points:
        return _mass_points(document.mass_points, scale)
    if document.section:
        return _section(document.section, document.units, None if folder is None else Path(folder))
    return _shape(document, scale)


def _restraints(tables: "list[schema.RestraintTable]", scale: float) -> list[Restraint]:
    from rocking.bodies.formats.schema import LENGTHS_OF_RESTRAINTS

    restraints: list[Restraint] = []
    for i, table in enumerate(tables):
        values = table.model_dump(exclude={"kind"}, exclude_none=True)
        kind = KINDS[table.kind]
        with located(f"restraint[{i}]"):
            names = {entry.name for entry in dataclasses.fields(kind)}
            required = {entry.name for entry in dataclasses.fields(kind) if entry.default is dataclasses.MISSING}
            if odd := sorted(set(values) - names):
                raise BodyFileError("{key} is not allowed for a {kind}.", key=odd[0], kind=table.kind)
            if missing := sorted(required - set(values)):
                raise BodyFileError("{key} is missing for a {kind}.", key=missing[0], kind=table.kind)
            for name in values.keys() & set(LENGTHS_OF_RESTRAINTS):
                length = values[name]
                values[name] = tuple(v * scale for v in length) if isinstance(length, list) else length * scale
            restraints.append(kind(**values))
    return restraints


def parsed_toml(text: Any) -> dict[str, Any]:
    """Return the tables of a TOML text."""
    if not isinstance(text, str):
        raise BodyFileError("A body file must be text, got {type}.", type=type(text).__name__)
    if len(text) > LARGEST_TOML:
        raise BodyFileError(
            "The text is longer than {limit:g} MiB",
            limit=LARGEST_TOML / 2**20,
            hint="use WKT, GeoJSON or DXF for large outlines",
        )
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:  # the text of the exception contains line and column
        raise BodyFileError("Invalid TOML: {reason}", reason=str(error)) from error
    except (ValueError, RecursionError) as error:  # from too long numbers or too deep nesting
        raise BodyFileError("Unreadable TOML: {reason}", reason=str(error).partition(";")[0]) from error


def _block(table: "schema.BlockTable", scale: float) -> Body:
    with located("block"):
        width, height = table.width * scale, table.height * scale
        return Block(width=width, height=height, feet=_pair(table.feet, scale), **_options(table, scale))


def _shape(document: "schema.BodyFile", scale: float) -> Section:
    from rocking.bodies.formats import schema

    kind = next(name for name in _OUTLINES if getattr(document, name))  # the schema allows exactly one table
    table: schema.ShapeTable = getattr(document, kind)
    sizes = table.model_dump(exclude=set(schema.ShapeTable.model_fields))
    with located(kind):
        outline = _OUTLINES[kind](**{key: value * (1 if key == "sides" else scale) for key, value in sizes.items()})
        return Section.from_points(outline, feet=_pair(table.feet, scale), **_options(table, scale))


_OUTLINES: dict[str, Callable[..., FloatArray]] = {
    "trapezoid": shapes.trapezoid,
    "ellipse": shapes.ellipse,
    "regular_polygon": shapes.regular_polygon,
}
"""Functions for outlines; their arguments are the keys of the tables: lengths, and `sides`."""


def _options(table: "schema.ShapeTable", scale: float) -> dict[str, Any]:
    options = _known(table, scale)
    if table.density is not None:
        options["density"] = table.density
    if table.depth is not None:
        options["depth"] = table.depth * scale
    return options


def _known(table: "schema.KnownTable", scale: float) -> dict[str, Any]:
    centre = _pair(table.centre, scale)
    return {"mass": table.mass, "centre": centre, "moment_of_inertia": table.moment_of_inertia}


def _mass_points(table: "schema.MassPointsTable", scale: float) -> MassPoints:
    contact = None if table.contact is None else [(a * scale, b * scale) for a, b in table.contact]
    check_count(len(table.points))
    with located("mass_points"):
        for i, (a, b) in enumerate(table.contact or ()):
            if not a < b:
                raise BodyFileError(
                    "{parameter}[{index}] must run from left to right, got [{left:g}, {right:g}]", parameter="contact",
                    index=Index(i), left=a, right=b,
                )  # fmt: skip
        points = [(x * scale, y * scale) for x, y in table.points]
        return MassPoints(points, table.masses, (table.feet[0] * scale, table.feet[1] * scale), contact)


def _section(table: "schema.SectionTable", units: str, folder: Path | None) -> Section:
    scale = length_unit(units)
    regions: list[Region] = []
    for i, region_table in enumerate(table.region):
        with located(f"section.region[{i}]"):
            regions += _regions(region_table, units, folder)
        check_count(sum(len(ring) for region in regions for ring in region.rings))
    with located("section"):
        depth = DEFAULT_DEPTH if table.depth is None else table.depth * scale
        options, feet = _known(table, scale), _pair(table.feet, scale)
        return Section(regions, feet, depth=depth, ground=table.ground * scale, **options)


def _regions(table: "schema.RegionTable", units: str, folder: Path | None) -> list[Region]:
    density = DEFAULT_DENSITY if table.density is None else table.density
    units_of_region = table.units or units
    if table.wkt is not None:
        return regions_from_wkt(table.wkt, density, units=units_of_region, name="wkt")
    if table.geojson is not None:
        path = beside(folder, table.geojson)
        with located(path.name, "file"):
            text = read_text(path)
        return regions_from_geojson(text, density, units=units_of_region, name=path.name)
    if table.dxf is not None:
        return regions_from_dxf(beside(folder, table.dxf), density, units=units_of_region, layers=table.layers)
    scale = length_unit(units)
    outline, *holes = (np.array(ring) * scale for ring in (table.outline or [], *(table.holes or ())))
    return [Region(outline, density, holes)]


def beside(folder: Path | None, name: str) -> Path:
    """Return the path of a file that a body file names; refuse files outside its folder."""
    if folder is None:
        raise BodyFileError("The file {file!r} is not allowed in a text without a folder.", file=name)
    try:
        root = folder.resolve()
        path = (root / name).resolve()
    except (OSError, ValueError, RuntimeError) as error:
        raise BodyFileError("Invalid file name {file!r}.", file=name) from error
    if not path.is_relative_to(root):
        raise BodyFileError("The file {file!r} must be in the folder of the body file or below.", file=name)
    return path


def _pair(values: list[float] | None, scale: float) -> tuple[float, float] | None:
    return None if values is None else (values[0] * scale, values[1] * scale)


_Coordinates = dict[float, float]


@singledispatch
def body_to_toml(body: Body | Restrained | Isolated | Stack) -> str:
    """Return a body as the text of a body file.

    The text contains the same numbers to the last bit. Only a mirrored or scaled `Section` can differ in the last bits.
    A small `Section` far from its origin is written about its own origin, with a comment.

    Parameters
    ----------
    body : Body, Restrained, Isolated or Stack
        Block, Section or MassPoints, without or with restraints or an isolated base, or a stack of bodies.

    Returns
    -------
    str
        TOML, in m and kg/m3.

    Raises
    ------
    InvalidValueError
        If the file format has no table for this type of body.

    Examples
    --------
    >>> print(body_to_toml(Block(width=1.0, height=4.0)))
    units = "m"
    <BLANKLINE>
    [block]
    width = 1.0
    height = 4.0
    density = 2400.0
    <BLANKLINE>
    """
    raise InvalidValueError("A {type} body has no body file.", type=type(body).__name__)


@body_to_toml.register
def _(body: Block) -> str:
    width, height, density = (f"{key} = {_number(getattr(body, key))}" for key in ("width", "height", "density"))
    sizes = (width, height, *_depth_of(body), density)
    feet = [] if body.stands_on_corners else [f"feet = {_row(body.feet)}"]
    return _lines('units = "m"', "", "[block]", *sizes, *feet, *_known_of(body, 0.0, 0.0))


@body_to_toml.register
def _(body: MassPoints) -> str:
    lines = [f"points = {_points(body.points)}", f"masses = {_row(body.masses)}", f"feet = {_row(body.feet)}"]
    if body.local_contact != (body.feet,):
        lines.append(f"contact = {_points(body.local_contact)}")
    return _lines('units = "m"', "", "[mass_points]", *lines)


@body_to_toml.register
def _(body: Section) -> str:
    remarks, x, y = _coordinates(body)
    lines = [*remarks, 'units = "m"', "", "[section]", f"feet = {_row([x[foot] for foot in body.local_feet])}"]
    lines += _depth_of(body)
    lines.append(f"ground = {_number(0.0 if remarks else body.ground)}")
    lines += _known_of(body, 0.0 if remarks else body.origin_x, 0.0 if remarks else body.ground)
    for region in body.regions:
        outline, *holes = ([(x[a], y[b]) for a, b in ring.tolist()] for ring in region.rings)
        lines += ["", "[[section.region]]", f"density = {_number(region.density)}", f"outline = {_points(outline)}"]
        if holes:
            lines.append(f"holes = [{', '.join(_points(hole) for hole in holes)}]")
    return _lines(*lines)


@body_to_toml.register
def _(body: Frame) -> str:
    texts = list(dict.fromkeys(map(body_to_toml, body.columns)))
    if len(texts) > 1:
        raise InvalidValueError("A body file describes frames with equal columns only.")
    beam = f"beam_mass = {_number(body.beam_mass)}", f'beam_on = "{body.beam_on}"'
    return _lines(texts[0].rstrip("\n"), "", "[frame]", f"columns = {len(body.columns)}", *beam)


@body_to_toml.register
def _(body: Isolated) -> str:
    names = ("base_mass", "stiffness", "damping", "friction")
    values = (f"{name} = {_number(getattr(body, name))}" for name in names)
    return _lines(body_to_toml(body.body).rstrip("\n"), "", "[isolator]", *values)


@body_to_toml.register
def _(body: Restrained) -> str:
    lines = [body_to_toml(body.body).rstrip("\n")]
    if body.floor_slope:
        lines.insert(0, f"floor_slope = {_number(body.floor_slope)}")
    for restraint in body.restraints:
        stated = {"kind": restraint.kind, "name": restraint.name, **restraint.constants}
        if restraint.x is not None:
            stated |= {"x": restraint.x} | ({} if restraint.kind == "wall" else {"length": restraint.length})
        else:
            stated |= {"ground": list(restraint.ends[0]), "point": list(restraint.ends[1])}
        if "area" in stated:
            del stated["stiffness"]
        lines += ["", "[[restraint]]", *(f"{name} = {_toml(value)}" for name, value in stated.items())]
    return _lines(*lines)


@body_to_toml.register
def _(body: Stack) -> str:
    joints = {"restitution": list(body.restitution), "offsets": list(body.offsets)}
    if max(body.friction) < math.inf:
        joints["friction"] = list(body.friction)
    lines = ['units = "m"', "", "[stack]", *(f"{name} = {_row(values)}" for name, values in joints.items())]
    for own in body.bodies:
        tables = body_to_toml(own).removeprefix('units = "m"\n').rstrip("\n")
        lines += ["", "[[stack.body]]", re.sub(r"^(\[+)", r"\1stack.body.", tables.lstrip("\n"), flags=re.MULTILINE)]
    return _lines(*lines)


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return _row(value) if isinstance(value, list) else f'"{value}"' if isinstance(value, str) else _number(value)


def _depth_of(body: Block | Section) -> list[str]:
    """Return the line of the depth, unless it is the default, which stays assumed."""
    is_default = isinstance(body.depth, Assumed) and body.depth == DEFAULT_DEPTH
    return [] if is_default else [f"depth = {_number(body.depth)}"]


def _known_of(body: Block | Section, x: float, y: float) -> list[str]:
    """Return the lines of the known values of a body; the centre of mass is relative to the origin (-x, -y) [m]."""
    values = body.known
    lines = []
    if values is not None and values.centre is not None:
        centre = (next(_preimages(c, shift), c + shift) for c, shift in zip(values.centre, (x, y), strict=True))
        lines.append(f"centre = {_row(list(centre))}")
    if values is not None and values.moment_of_inertia is not None:
        lines.append(f"moment_of_inertia = {_number(values.moment_of_inertia)}")
    return lines


def _coordinates(body: Section) -> tuple[list[str], _Coordinates, _Coordinates]:
    """Return comments for the file, the user's x by local x, and the user's y by local y [m]."""
    rings = [ring for region in body.regions for ring in region.rings]
    x = np.unique(np.concatenate([*(ring[:, 0] for ring in rings), body.local_feet]))
    y = np.unique(np.concatenate([ring[:, 1] for ring in rings]))
    low, _, high, _ = body.local_box
    user_x, user_y = _placed(x, body.origin_x), _placed(y, body.ground)
    _keep_middle(user_x, low, high, body.origin_x)
    is_exact = all(
        b - shift == a
        for user_values, shift in ((user_x, body.origin_x), (user_y, body.ground))
        for a, b in user_values.items()
    )
    is_coarse = max(math.ulp(body.origin_x), math.ulp(body.ground)) > 1e-12 * (high - low)
    if is_exact or not is_coarse:
        return [], user_x, user_y
    remark = f"# about its own origin, x = {body.origin_x!r} m, y = {body.ground!r} m"
    return [remark], _placed(x, 0.0), _placed(y, 0.0)


def _placed(values: FloatArray, shift: float) -> _Coordinates:
    """Return the nearest number u with u - shift == value in floating point, by local value."""
    return {value: next(_preimages(value, shift), value + shift) for value in values.tolist()}


def _preimages(value: float, shift: float) -> Iterator[float]:
    """Yield numbers u near value + shift with u - shift == value in floating point."""
    nearest = value + shift
    ulp = math.ulp(value)
    candidates = [nearest, math.nextafter(nearest, math.inf), math.nextafter(nearest, -math.inf)]
    candidates += [nearest + k * ulp for k in (0.25, -0.25, 0.5, -0.5)]
    return (u for u in candidates if u - shift == value)


def _keep_middle(coordinates: _Coordinates, low: float, high: float, origin: float) -> None:
    """Choose ends of the box whose middle is equal to the local origin to the last bit."""
    for a in _preimages(low, origin):
        for b in _preimages(high, origin):
            if 0.5 * (a + b) == origin:
                coordinates[low], coordinates[high] = a, b
                return


def _number(value: float) -> str:
    return repr(float(value))


def _row(values: Sequence[float] | FloatArray) -> str:
    return f"[{', '.join(_number(value) for value in values)}]"


def _points(points: Iterable[Sequence[float]] | FloatArray) -> str:
    return f"[{', '.join(_row(point) for point in points)}]"


def _lines(*lines: str) -> str:
    return "\n".join(lines) + "\n"
