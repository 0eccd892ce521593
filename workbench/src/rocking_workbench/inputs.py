"""Inputs of a user (body, motion, restitution, response, settings) with limits and conversions."""

import re
import sys
import tomllib
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import AfterValidator, ConfigDict, Field, FiniteFloat, model_validator

from rocking.bodies import Body
from rocking.bodies.formats.schema import BODIES, BlockInput, BodyFile, KnownTable
from rocking.conventions import COMPARED_RESTITUTIONS, DEFAULT_RESTITUTION
from rocking.errors import InvalidValueError, located
from rocking.motions.pulse import Motion
from rocking.spec.bodies import body_of
from rocking.spec.construction import motion_of
from rocking.spec.documents.response import ResponseTable, ResponseTables, check_start
from rocking.spec.fields import JobTable, Text
from rocking.spec.motion_tables import OneMotionTable
from rocking.spec.response import ResponseProblem, problem_of
from rocking.spec.restitution_tables import RestitutionTable
from rocking.spec.settings_tables import SettingsTable
from rocking_workbench.errors import Refused, TooLarge
from rocking_workbench.work import Remembered

if TYPE_CHECKING:
    from rocking_workbench.records import RecordStore

_UPLOAD = "the application cannot open files by name; upload the file to /api/body/file"
MOST_REGIONS = 250
MOST_HOLES = 500
MOST_VERTICES = 10_000
MOST_POINTS = 10_000
MOST_STRETCHES = 40
MOST_RESTITUTIONS = 24
MOST_RECORD_SAMPLES = 2_000_000
MOST_DRAWING_BYTES = 4 << 20
MOST_ENTITIES = 20_000
_X_IN_DXF = re.compile(rb"^[ \t]*10[ \t]*\r?$", re.MULTILINE)
_ENTITY_IN_DXF = re.compile(rb"^[ \t]*0[ \t]*\r?$", re.MULTILINE)
_MINISEED = re.compile(rb"\d{6}[DRQM][ \0]")
CAPS = {
    "regions": MOST_REGIONS,
    "holes": MOST_HOLES,
    "vertices": MOST_VERTICES,
    "mass_points": MOST_POINTS,
    "contact_stretches": MOST_STRETCHES,
    "restitutions": MOST_RESTITUTIONS,
    "record_samples": MOST_RECORD_SAMPLES,
    "drawing_bytes": MOST_DRAWING_BYTES,
    "drawing_entities": MOST_ENTITIES,
}
"""Limits of one body and one request."""

Hash = Annotated[str, Field(pattern=r"^[0-9a-f]{64}$", description="SHA-256 of an uploaded record")]
Points = Annotated[int, Field(ge=10, le=2000)]
"""Number of pixels of a curve; each pixel keeps the lowest and the highest value."""

LONGEST = 4 << 20  # largest TOML file [bytes]
_LIGHTEST = 1e-200  # smallest mass or moment; products of smaller values are subnormal numbers
_DEEPEST = 32
_LARGEST = 2**63


class BodyInput(BlockInput, BodyFile, KnownTable):  # type: ignore[misc]  # made of the fields of a block
    """Input of a body: unit of length, and either one body table or width and height."""

    @model_validator(mode="before")
    @classmethod
    def _names_no_file(cls, table: Any) -> Any:
        if isinstance(table, dict) and "file" in table:
            raise InvalidValueError("{parameter}: " + _UPLOAD, parameter="file")
        return table

    @model_validator(mode="after")
    def _one_body(self) -> "BodyInput":
        sized = self.width is not None or self.height is not None
        present = [key for key in BODIES if getattr(self, key) is not None] + ["width and height"] * sized
        if len(present) != 1:
            choice = ", ".join(("width and height", *BODIES))
            raise InvalidValueError(
                "a body has exactly one of {names}, got {keys}", names=choice, keys=" and ".join(present) or "none"
            )
        if sized and (self.width is None or self.height is None):
            raise InvalidValueError("{parameter} is missing", parameter="width" if self.width is None else "height")
        own = ("depth", "density", *KnownTable.model_fields)
        if not sized and (odd := [key for key in own if getattr(self, key) is not None]):
            raise InvalidValueError("move {keys} into the table {table}", keys=" and ".join(odd), table=present[0])
        for k, region in enumerate(self.section.region if self.section else ()):
            for key in ("geojson", "dxf"):
                if getattr(region, key) is not None:
                    raise InvalidValueError("{parameter}: " + _UPLOAD, parameter=f"section.region[{k}].{key}")
        check_size(self)
        _refuse_subnormal(self.table())
        return self

    def table(self) -> dict[str, Any]:
        """Return the body as a table of a body file or job file, without unset keys."""
        return self.model_dump(exclude_none=True, exclude_unset=True)


def _refuse_subnormal(value: Any, key: str = "") -> None:
    """Refuse subnormal numbers, which have fewer digits."""
    match value:
        case float() if 0.0 < abs(value) < sys.float_info.min:
            smallest = f"{sys.float_info.min:.3g}"
            raise InvalidValueError(
                "{parameter} is {number!r}, below the smallest normal number ({limit})", parameter=key,
                number=value, limit=smallest, hint="Check the unit.",
            )  # fmt: skip
        case dict():
            for name, item in value.items():
                _refuse_subnormal(item, f"{key}.{name}" if key else name)
        case list() | tuple():
            for index, item in enumerate(value):
                _refuse_subnormal(item, f"{key}[{index}]")


def refuse_more(count: int, most: int, text: str, hint: str = "") -> None:
    """Refuse a count above a limit."""
    if count > most:
        raise TooLarge(text + ", got {count}", most=most, count=count, hint=hint)


def check_size(table: BodyFile) -> None:
    """Refuse a body that is too large, before the body is built."""
    regions, holes, vertices = _polygons(table)
    refuse_more(regions, MOST_REGIONS, "a section holds up to {most} regions", "merge regions of equal density")
    refuse_more(holes, MOST_HOLES, "a section holds up to {most} holes", "remove small holes")
    refuse_more(vertices, MOST_VERTICES, "outlines and holes hold up to {most} vertices", "simplify the outline")
    points = table.mass_points
    held = 0 if points is None else max(len(points.points), len(points.masses), len(points.contact or ()))
    refuse_more(held, MOST_POINTS, "a body holds up to {most} points with mass")


def check_file(content: bytes, name: str) -> None:
    """Refuse a body file that is much too large, before the file is read."""
    drawing = name.lower().endswith(".dxf")
    if drawing:
        way_out = "save the outline alone in a separate drawing"
        refuse_more(len(content), MOST_DRAWING_BYTES, "a drawing has up to {most} bytes", way_out)
        refuse_more(len(_ENTITY_IN_DXF.findall(content)), MOST_ENTITIES, "a drawing has up to {most} parts", way_out)
    # a drawing can contain other entities; in a text, a comma or a bracket precedes each point
    points = len(_X_IN_DXF.findall(content)) // 4 if drawing else max(content.count(b","), content.count(b"[")) // 3
    refuse_more(points, MOST_VERTICES, "a body file may describe up to {most} vertices", "simplify the outlines")


def check_record(content: bytes) -> None:
    """Refuse a record file with too many numbers, before the file is read."""
    if _MINISEED.match(content):
        # number of samples in the headers; no further samples are decoded
        check_samples(
            sum(_announced(content[head.start() : head.start() + 48]) for head in _MINISEED.finditer(content))
        )
        return
    if len(content) <= MOST_RECORD_SAMPLES or b"\0" in content:
        return
    octets = np.frombuffer(content, dtype=np.uint8)
    between = (octets <= 32) | np.isin(octets, (44, 59))  # white space, comma, semicolon
    check_samples(int(np.count_nonzero(between[:-1] & ~between[1:])) + int(not between[0]))


def _announced(record: bytes) -> int:
    """Return the number of samples in the header of a miniSEED record."""
    order: Literal["big", "little"] = "big" if 1900 <= int.from_bytes(record[20:22], "big") <= 2200 else "little"
    return int.from_bytes(record[30:32], order)


def check_samples(count: int) -> None:
    """Refuse a record of too many samples."""
    limit = "a record holds up to {most} numbers"
    refuse_more(count, MOST_RECORD_SAMPLES, limit, "cut the record or remove columns; Python reads longer records")


def size_of(table: BodyFile) -> int:
    """Return the number of vertices and mass points."""
    return _polygons(table)[-1] + (len(table.mass_points.points) if table.mass_points else 0)


def _polygons(table: BodyFile) -> tuple[int, int, int]:
    regions = holes = vertices = 0
    for region in table.section.region if table.section else ():
        text = region.wkt or ""
        # in a text, each polygon begins with two brackets, and commas separate its points
        polygons = 1 if region.outline is not None else max(1, text.count("(("))
        regions += polygons
        holes += len(region.holes or ()) + max(0, text.count(",(") + text.count(", (") - polygons + 1)
        rings = [region.outline or [], *(region.holes or ())]
        vertices += sum(map(len, rings)) + (text.count(",") + 1 if text else 0)
    for shape in (table.ellipse, table.regular_polygon):
        vertices += shape.sides if shape is not None else 0
    return regions, holes, vertices


def _forward(window: tuple[float, float]) -> tuple[float, float]:
    if window[0] >= window[1]:
        raise ValueError(f"window must have increasing times, got {list(window)}")
    return window


Window = Annotated[tuple[FiniteFloat, FiniteFloat], Field(strict=False), AfterValidator(_forward)]
"""Time window of the curves [s]."""


_BODY: dict[str, Any] = {"units": "cm", "width": 50, "height": 200}

_MOTION: dict[str, Any] = {"pulse": "sine:amplitude=3,period=0.8"}

_MODELS = [DEFAULT_RESTITUTION, *COMPARED_RESTITUTIONS]

_INPUTS: dict[str, Any] = {"body": _BODY, "motion": _MOTION, "restitution": {"models": _MODELS}}


def _shown(example: dict[str, Any]) -> ConfigDict:
    """Return a configuration with an example for the schema."""
    return ConfigDict(json_schema_extra={"examples": [example]}, defer_build=False)


MOTION_KEYS = frozenset({
    "pulse", "synthetic", "count", "member", "format", "units", "time_step", "component", "vertical", "scale", "seed",
    "pga", "pgv", "skip",
})  # fmt: skip
"""Keys of a motion that a request may use. No key names a file of the server; records are hashes."""


class MotionInput(OneMotionTable):
    """One pulse, one uploaded record by its hash, or one motion of a synthetic family."""

    record: Hash | None = None
    file_name: Text | None = None

    @model_validator(mode="after")
    def _named_record(self) -> "MotionInput":
        if self.file_name is not None and self.record is None:
            raise InvalidValueError("file_name is allowed with record only")
        other = self.model_fields_set - MOTION_KEYS - {"record", "file_name"}
        if odd := sorted(key for key in other if getattr(self, key) is not None):
            raise InvalidValueError(
                "{parameter}: the application cannot open files by name", parameter=odd[0],
                hint="upload one file with both components",
            )  # fmt: skip
        return self


class Inputs(ResponseTables):
    """Inputs of a user: a body and optional tables."""

    model_config = _shown(_INPUTS)

    # repeated, because the schema omits defaults of factories
    restitution: RestitutionTable = RestitutionTable(models=_MODELS)
    response: ResponseTable = ResponseTable()
    settings: SettingsTable = SettingsTable()
    body: BodyInput
    motion: MotionInput | None = None

    @model_validator(mode="after")
    def _few_restitutions(self) -> "Inputs":
        chosen = len(self.restitution.models or ()) + len(self.restitution.values or ())
        refuse_more(chosen, MOST_RESTITUTIONS, "up to {most} restitutions can be compared")
        if self.response.friction:  # a friction of 0 is omitted from the table
            raise InvalidValueError(
                "response.friction: this analysis is without sliding. Use response.assumed_friction, or `rocking "
                "simulate` for sliding"
            )
        return self


class ResponseInputs(Inputs):
    """Inputs with a motion or a free start."""

    @model_validator(mode="after")
    def _moves(self) -> "ResponseInputs":
        check_start(self.motion is not None, self.response)
        return self


class ResponseRequest(ResponseInputs):
    """Inputs with a motion or a free start, and the resolution of the curves."""

    model_config = _shown(_INPUTS)

    points: Points = 1000
    window: Window | None = None


class BodyRequest(JobTable):
    """A body and gravity."""

    model_config = _shown({"body": _BODY})

    body: BodyInput
    settings: SettingsTable = SettingsTable()


class ImpactRequest(BodyRequest):
    """A body and the impact foot."""

    model_config = _shown({"body": _BODY, "foot": "both"})

    foot: Literal["left", "right", "both"] = "both"


class MotionRequest(JobTable):
    """A motion, and the resolution and window of its curves."""

    model_config = _shown({"motion": _MOTION})

    motion: MotionInput
    settings: SettingsTable = SettingsTable()
    points: Points = 1000
    window: Window | None = None
    spectrum: bool = True


def parsed_toml(text: str) -> dict[str, Any]:
    """Return the tables of a TOML text; integers above 64 bits are errors."""
    if len(text) > LONGEST:
        raise Refused(
            "a TOML file may have up to {limit} MiB, got {size:.1f}", limit=LONGEST >> 20, size=len(text) / 2**20
        )
    try:
        tables = tomllib.loads(text.removeprefix("\ufeff"))
    except tomllib.TOMLDecodeError as error:
        raise Refused("the TOML is not readable: {reason}", reason=" ".join(str(error).split())[:200]) from error
    except (ValueError, RecursionError) as error:
        raise Refused("the TOML is not readable: nesting too deep or number too long") from error
    for depth, level in enumerate(levels(tables)):
        if depth >= _DEEPEST:
            raise Refused("the TOML is nested deeper than {limit}", limit=_DEEPEST)
        for value in level:
            if type(value) is int and not -_LARGEST <= value < _LARGEST:  # too long for a message
                raise Refused("an integer in the TOML has {count} bits, 64 are allowed", count=value.bit_length())
            texts = [item for item in (value if isinstance(value, dict) else [value]) if isinstance(item, str)]
            if any("\0" in text for text in texts):
                raise Refused("a text in the TOML contains a NUL character")
    return tables


def levels(value: Any) -> Iterator[list[Any]]:
    """Yield the values of nested tables and lists by level, without recursion."""
    level = [value]
    while level:
        yield level
        level = [item for child in level for item in _inside(child)]


def _inside(value: Any) -> list[Any]:
    if isinstance(value, dict):
        return list(value.values())
    return value if isinstance(value, list) else []


_BODIES: Remembered[Body] = Remembered(32)
_SYNTHETIC: Remembered[Motion] = Remembered(16)


def problem_from(inputs: Inputs, records: "RecordStore") -> ResponseProblem:
    """Return the response problem of inputs, with the content of its files."""
    motion = None if inputs.motion is None else motion_from(inputs.motion, records)
    return problem_of(inputs, body_from(inputs.body), motion)


def body_from(table: BodyInput) -> Body:
    """Return a body; recent bodies are cached."""
    return _BODIES.get(table.model_dump_json(exclude_none=True, exclude_unset=True), lambda: _body(table))


def motion_from(table: MotionInput, records: "RecordStore") -> Motion:
    """Return an unscaled motion; recent motions are cached."""
    if table.record is not None:
        how = (table.format, table.units, table.time_step, table.component, table.vertical)
        return records.motion(table.record, *how, skip=table.skip or 0)
    with located("motion"):
        if table.synthetic is None:
            return motion_of(table)
        alone = table.model_copy(update={"scale": 1.0})
        return _SYNTHETIC.get(alone.model_dump_json(exclude_none=True), lambda: motion_of(table))


def _body(table: BodyInput) -> Body:
    with located("body"):
        body = body_of(table.table(), None)
        limit = "a base can have up to {most} separate contact segments"
        refuse_more(len(body.local_contact), MOST_STRETCHES, limit, "remove segments that are not feet")
        mass, inertia = body.mass, body.moment_of_inertia
        if min(mass, inertia or mass) < _LIGHTEST:
            raise InvalidValueError(
                "mass {mass:.3g} kg and moment of inertia {moment_of_inertia:.3g} kg m2 must be > {limit:g}",
                mass=mass, moment_of_inertia=inertia, limit=_LIGHTEST,
                hint="Check the units of density and mass.",
            )  # fmt: skip
        return body
