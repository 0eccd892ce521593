"""Tables of an input file from the arguments of a command."""

import re
import shlex
import tomllib
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking import checks
from rocking.bodies.formats import FORMATS, describes_solid
from rocking.cli.numbers import units_of, value_of
from rocking.cli.spelling import UsageError, typed
from rocking.conventions import ACCELERATION_UNITS, LENGTH_UNITS
from rocking.errors import BodyFileError, InvalidValueError, RecordError, RockingError
from rocking.messages import Message
from rocking.motions.pulses import catalogue
from rocking.spec.motion_tables import OF_FILES
from rocking.spec.reading import is_pattern, tables_in
from rocking.spec.schema import SCHEMA, migrated, renamed_keys

if TYPE_CHECKING:
    import typer
    from pydantic import BaseModel

Tables = dict[str, Any]

_KNOWN = ("mass", "centre", "moment_of_inertia")
_SIZES = ("width", "height"), ("slenderness_angle", "semi_diagonal")
_OF_EVERY_FILE = {"format", "units", "time_step", "skip", "process"}
NO_MOTION = "No ground motion. Give a record file, or a pulse such as sine:amplitude=3,period=0.8"


def is_body(text: str) -> bool:
    """Return True if a name has the extension of a body file."""
    return Path(text).suffix.lower() in FORMATS


def is_file(text: str) -> bool:
    """Return True if the file exists."""
    try:
        return bool(text) and Path(text).exists()
    except (OSError, ValueError):  # a file with such a name cannot exist
        return False


def is_found(pattern: str) -> bool:
    """Return True if a pattern matches a file."""
    from rocking.motions.formats.record_set import paths_of

    try:
        return bool(paths_of(pattern))
    except (RockingError, OSError, ValueError, NotImplementedError):
        return False


_SHORT = re.compile(r"[+-]?(\.\d+|\d+\.)([eE][+-]?\d+)?")  # .01 and 2., which are no numbers in TOML


def parsed_sets(texts: Sequence[str] | None, allowed: Iterable[str]) -> Tables:
    """Return the tables of ``--set table.key=value``.

    >>> parsed_sets(["settings.gravity=9.81", "settings.friction=.5", "body.up=y"], ["settings", "body"])
    {'settings': {'gravity': 9.81, 'friction': 0.5}, 'body': {'up': 'y'}}
    """
    tables: Tables = {}
    present = dict(renamed_keys())  # options accept only the present keys
    for text in texts or ():
        path, equals, value = text.partition("=")
        table, dot, key = path.strip().partition(".")
        if not (equals and dot and key):
            raise UsageError(
                "{parameter} must be table.key=value, such as settings.gravity=9.81, got {value}", parameter="--set",
                value=text,
            )  # fmt: skip
        if table not in allowed:
            near = checks.nearest(table, list(allowed))
            raise UsageError(
                "{parameter}: unknown table {table!r:.60}; tables: {names}", parameter="--set", table=table,
                names=", ".join(allowed), hint=near,
            )  # fmt: skip
        if (new := present.get(f"{table}.{key}")) is not None:
            raise UsageError(
                "{parameter}: unknown key {key!r:.60}", parameter="--set", key=f"{table}.{key}",
                hint=Message("did you mean {name}?", {"name": new}),
            )  # fmt: skip
        if key in tables.setdefault(table, {}):
            raise UsageError("{parameter} {key} is given twice", parameter="--set", key=f"{table}.{key}")
        try:
            tables[table][key] = tomllib.loads(f"value = {value.strip()}")["value"]
        except (tomllib.TOMLDecodeError, ValueError, RecursionError):
            word = value.strip()  # invalid TOML is text, except numbers such as .01
            tables[table][key] = float(word) if _SHORT.fullmatch(word) else word
    return tables


def with_sets(tables: Mapping[str, Any], sets: Mapping[str, Tables], *, lists: bool = False) -> Tables:
    """Return the tables of a file with the keys of ``--set``; with `lists`, a list of one table counts as a table."""
    tables = {"schema": SCHEMA, **migrated(dict(tables))}  # the options use the keys of the current schema
    changed = dict(tables)
    for table, keys in sets.items():
        name = "motions" if lists and table == "motion" else table
        stated = tables.get(name, {})
        if lists and isinstance(stated, list) and len(stated) == 1:
            (stated,) = stated
        if not isinstance(stated, dict):
            reason = f"it has several [[{name}]]" if isinstance(stated, list) else f"its {name} is no table"
            raise UsageError(
                "{parameter} {key}: {reason}", parameter="--set", key=f"{table}.{next(iter(keys))}", reason=reason,
                hint="change the file",
            )  # fmt: skip
        changed[name] = {**stated, **keys}
    return changed


def document_file(
    context: "typer.Context", word: str | None, tables: Collection[str], allowed: Collection[str] = (), has: str = ""
) -> Path | None:
    """Return the input file (TOML with [body] or another table) or None; `allowed` are options accepted with it."""
    if word is None or not {*tables, "body"} & set(tables_in(Path(word)) or ()):
        return None
    allowed = {"body", "objects", "motions", "threads", "output", "as_json", "sets", "details", *allowed}
    if stated := typed(context, *(name for name in context.params if name not in allowed)):
        raise UsageError(
            "{file} {content}contains the whole input; {options} cannot be combined with it", file=word, content=has,
            options=", ".join(stated), hint="use --set to change a key",
        )  # fmt: skip
    return Path(word)


class Arguments:
    """Arguments of a command, and the tables of its input; --set can change the tables in `tables`."""

    def __init__(self, context: "typer.Context", *tables: str) -> None:
        self.context, self.options = context, context.params
        self.sets = parsed_sets(self.options.get("sets"), tables)
        kinds = [LENGTH_UNITS if "body" in tables else {}, ACCELERATION_UNITS if "motion" in tables else {}]
        self.length, self.acceleration = units_of(self.options.get("units"), *kinds)

    @property
    def solid(self) -> bool:
        body = self.options.get("body")
        return body is not None and describes_solid(body)

    def spelt(self, option: str) -> str:
        """Return an option as typed, such as --units; empty if the option was not typed."""
        return next(iter(typed(self.context, option)), "")

    def table(
        self,
        name: str,
        values: Mapping[str, Any],
        spelt: Mapping[str, str] | None = None,
        keys: Collection[str] | None = None,
    ) -> Tables:
        """Return a table with the values of options and of `--set`; `--set` replaces defaults only."""
        # spelt: typed text by key, for options with another name than their key; empty if not typed
        # keys: included keys of `--set`, by default all
        sets = {key: value for key, value in self.sets.get(name, {}).items() if keys is None or key in keys}
        for key in sets:
            option = (spelt or {}).get(key, self.spelt(key))
            if option and values.get(key) is not None:
                raise UsageError(
                    "{parameter} and --set {key} set the same key; remove one", parameter=option[:100],
                    key=f"{name}.{key}",
                )  # fmt: skip
        return {**{key: value for key, value in values.items() if value is not None}, **sets}

    def values(self, table: "type[BaseModel]") -> Tables:
        """Return the values of those keys of a table that have an option."""
        return {
            name: value_of(field, f"--{name.replace('_', '-')}", self.options[name])
            for name, field in table.model_fields.items() if self.options.get(name) is not None
        }  # fmt: skip

    @property
    def sizes(self) -> dict[str, str]:
        """The options of the size of a block as typed, by key."""
        by_sets = {key: f"--set body.{key}" for pair in _SIZES for key in pair if key in self.sets.get("body", {})}
        return {name: f"--{name}" for name in _SIZES[0] if self.options.get(name) is not None} | by_sets

    def body_and_motions(self) -> tuple[str | None, list[str]]:
        """Return the body file, None for a block of given size, and the arguments of motions."""
        body, record, motions = (self.options.get(name) for name in ("body", "record", "motion"))
        positional = [] if record is None else [record] if isinstance(record, str) else list(record)
        if self.sizes and body is not None and not (positional and is_body(body)):
            body, positional = None, [body, *positional]
        for word in positional:
            if body is not None and is_body(word) and not is_body(body):
                raise UsageError(
                    "the body file must precede the motion: {motion} {body}", motion=word[:100], body=body[:100],
                )  # fmt: skip
        return body, [*positional, *(motions or ())]

    @property
    def several(self) -> list[str]:
        """The arguments of several motions: two arguments, a folder, a pattern or a list of records; else empty."""
        from rocking.spec.reading import CommandFiles
        from rocking.spec.record_sets import is_set

        _, motions = self.body_and_motions()
        several = len(motions) > 1 or any(is_set(word, CommandFiles(Path())) for word in motions)
        return motions if several and not any(word[:2] in {"x=", "y=", "z="} for word in motions) else []

    def hinted(self) -> AbstractContextManager[None]:
        """Add a hint to an error of the body file or of the first motion."""
        body, motions = self.body_and_motions()
        axis, _, source = motions[0].partition("=") if motions else ("", "", "")
        return hinted(body, source if axis in {"x", "y", "z"} else next(iter(motions), None))

    def restitution(self, usual: Tables | None = None) -> Tables:
        """Return the table [restitution]: that of `--set`, or the default, or that of the option, or an empty table."""
        keys: Tables = self.sets.get("restitution", {})
        if keys and (option := self.spelt("restitution")):
            raise UsageError(
                "{parameter} and --set {key} set the same key; remove one", parameter=option,
                key=f"restitution.{next(iter(keys))}",
            )  # fmt: skip
        model = self.options.get("restitution")
        return keys or ({"model": model} if usual is None and model is not None else usual or {})

    def body_table(self, file: str | None) -> Tables:
        from rocking.bodies.formats.schema import BlockTable

        values = self.values(BlockTable)
        if file is not None:
            in_toml = Path(file).suffix.lower() == ".toml"
            stated = not {"density", *_KNOWN}.isdisjoint(values)
            if self.sizes or "depth" in values or (stated and in_toml):
                raise UsageError("Give a body file or dimensions, not both")
            return self.table("body", {"file": file, "units": self.length, **values}, {"file": file})
        if set(self.sizes) not in map(set, _SIZES):
            if "width" not in self.options:
                raise UsageError("No body. Give a body file")
            if "depth" in values and "width" not in self.sizes:
                raise UsageError(
                    "No width. --depth is across the motion. Give the dimension along the motion as --width"
                )
            raise UsageError(
                "No complete body: got {options}. Give a body file, --width and --height, or --set "
                "body.slenderness_angle and body.semi_diagonal", options=" ".join(self.sizes.values()) or "no option",
            )  # fmt: skip
        return {"units": "m", **self.table("body", {"units": self.length, **values})}

    def motion_table(self, word: str, keys: Collection[str] | None = None) -> Tables:
        """Return the table of one motion; `keys` are the included keys of `--set motion`, by default all."""
        source = _place(word)
        units = self.acceleration if keys is None or "units" in keys else None
        table = self.table("motion", {**source, "units": units}, dict.fromkeys(source, word), keys)
        spelt = ["--units" if key == "units" and units is not None else f"motion.{key}" for key in table]
        if "pulse" in source and (odd := [origin for key, origin in zip(table, spelt, strict=True) if key in OF_FILES]):
            raise UsageError(
                "{options} is for record files, not for the pulse {pulse!r}", options=", ".join(odd), pulse=word[:200],
            )  # fmt: skip
        return table

    def one_motion(self, motions: Sequence[str]) -> Tables:
        """Return the table [motion] of a plane body: one motion, with the vertical component of z=."""
        along = _along(motions)
        if "y" in along:
            raise UsageError("a plane body accepts motions along x (horizontal) and z (vertical), not along y")
        if "x" not in along:
            raise UsageError("No motion along x. Give --motion x=FILE --motion z=FILE")
        table = self.motion_table(along["x"])
        if "z" not in along:
            return table
        vertical = _place(along["z"])
        if "record" not in table or "record" not in vertical:
            raise UsageError("for a plane body with vertical motion, x and z must be record files")
        if odd := sorted({"vertical", "vertical_file"} & set(table)):
            raise UsageError(
                "z={file} and --set {key} set the same key; remove one", file=along["z"][:100], key=f"motion.{odd[0]}"
            )
        component = {"vertical": vertical["component"]} if "component" in vertical else {}
        same = Path(vertical["record"]) == Path(table["record"]) and component
        return {**table, **component, **({} if same else {"vertical_file": vertical["record"]})}

    def components(self, motions: Sequence[str]) -> Tables:
        """Return the tables of the motions of a 3D body by axis."""
        # keys in _OF_EVERY_FILE apply to every record file; other keys apply to the motion along x or the first motion
        along = _along(motions)
        if not along:
            raise UsageError(NO_MOTION + ", along y and z with --motion y=FILE and --motion z=FILE")
        if list(along) == ["x"]:
            return self.motion_table(along["x"])
        records = [axis for axis, word in along.items() if "record" in _place(word)]
        if len(records) > 1 and "component" in self.sets.get("motion", {}):
            raise UsageError(
                "motion.component accepts one record file, got {count}: use FILE#COMPONENT", count=len(records)
            )
        first = next((axis for axis in ("x", *records, *along) if axis in (records or along)), "x")
        stated = {*self.sets.get("motion", {}), "units"} - {"scale"}  # scale applies to all motions
        keys = {axis: _OF_EVERY_FILE if axis in records else set() for axis in along} | {first: stated}
        return {axis: self.motion_table(word, keys[axis]) for axis, word in along.items()}

    def of_body(self, motions: Sequence[str]) -> Tables:
        """Return the table [motion] of the body; a solid, or a body with a motion along y, has components by axis."""
        return self.components(motions) if self.solid or "y" in _along(motions) else self.one_motion(motions)

    @staticmethod
    def each(motions: Sequence[str], table: Callable[[Sequence[str]], Tables]) -> list[Tables]:
        """Return the tables of several motions; a repeated axis begins the next motion."""
        groups: list[list[str]] = []
        for word in motions:
            if not groups or set(_along([word])) & set(_along(groups[-1])):
                groups.append([])
            groups[-1].append(word)
        return [table(group) for group in groups]


def _place(word: str) -> Tables:
    """Return the source of a motion: an existing file, with the component after #, or a pulse."""
    path, mark, component = word.rpartition("#")
    if is_file(word) or (is_pattern(word) and is_found(word)):
        return {"record": word}
    if mark and is_file(path):
        return {"record": path, **({"component": component} if component else {})}
    name, colon, _ = word.partition(":")
    if (not colon and name not in catalogue()) or "/" in name or "\\" in word:
        raise RecordError(
            "{file}: no such file. A pulse has the form sine:amplitude=3,period=0.8; pulses: {names}",
            file=word[:200], names=", ".join(sorted(catalogue())),
        )  # fmt: skip
    return {"pulse": word}


def _along(motions: Sequence[str]) -> dict[str, str]:
    along: dict[str, str] = {}
    for word in motions:
        axis, equals, source = word.partition("=")
        axis, source = (axis, source) if equals and axis in {"x", "y", "z"} else ("x", word)
        if axis in along:
            raise UsageError(
                "Several motions along {axis}: {first!r} and {second!r}. Remove one", axis=axis,
                first=along[axis][:100], second=source[:100],
            )  # fmt: skip
        along[axis] = source
    return along


@contextmanager
def hinted(body: str | None, word: str | None, vertical_component: str = "") -> Iterator[None]:
    """Add a hint to the error of a body file or a record; `vertical_component` is a name in the record."""
    try:
        yield
    except BodyFileError as error:
        if body is not None and not is_body(body) and is_file(body):
            error.add_hint(f"perhaps a record: see rocking record show {body}")
        raise
    except RecordError as error:
        if word is not None and is_file(word) and is_body(word):
            error.add_hint(f"perhaps a body: see rocking restitution {word}")
        raise
    except InvalidValueError as error:
        if word is not None and (components := error.facts.get("components")):
            file = word.rpartition("#")[0] or word
            names = " or ".join(shlex.quote(f"{file}#{name}") for name in components if name != vertical_component)
            error.hint = f"use {names}"
        raise
