"""From what was typed to the document that a file would hold: one way into every question."""

import re
import shlex
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rocking import checks
from rocking.bodies.formats import FORMATS, describes_solid
from rocking.cli.numbers import units_of
from rocking.conventions import ACCELERATION_UNITS, LENGTH_UNITS
from rocking.errors import BodyFileError, InvalidValueError, RecordError, RockingError
from rocking.motions.pulses import catalogue

if TYPE_CHECKING:
    import typer

Tables = dict[str, Any]

_AS_TYPED = (
    (re.compile(r"\bunits="), "--units"),
    (re.compile(r"\b(format|time_step)="), r"--set motion.\1="),
    (re.compile(r"\bfill_holes\b(=True)?"), "--set body.fill_holes=true"),
    (re.compile(r"\bbase_tolerance="), "--set body.base_tolerance="),
    (re.compile(r"\b(up|base_tolerance) must be"), r"body.\1 must be"),
    (re.compile(r"^threads must be"), "--threads must be"),
    (re.compile(r"\b(response|motion)\.(friction|free|bounce|scale)\b"), r"--\2"),
    (re.compile(r"\brestitution\.model\b"), "--restitution"),
    (re.compile(r"\bblock\.(width|height|depth|density)\b"), r"--\1"),
)
_OF_FILES = ("format", "units", "time_step")
NO_MOTION = "what moves the ground? Give a record file, or a pulse such as sine:amplitude=3,period=0.8"


_PLACE = re.compile(
    r"(body|motion(\.[xyz])?|motions(\[\d+\])?|records: .*|restitution|settings|map|map\.[xy]|fragility)"
)


@contextmanager
def as_typed() -> Iterator[None]:
    """Say what is refused as the command line calls things, without where it would stand in a file."""
    try:
        yield
    except RockingError as error:
        inner: RockingError = error
        while isinstance(cause := inner.__cause__, RockingError) and _is_located(inner, cause):
            inner = cause
        text = str(inner)
        for pattern, option in _AS_TYPED:
            text = pattern.sub(option, text)
        raise type(inner)(text) from error


def _is_located(error: RockingError, cause: RockingError) -> bool:
    """Return whether an error is another one with its place in a document before it."""
    place, text = str(error), f": {cause}"
    return place.endswith(text) and _PLACE.fullmatch(place.removesuffix(text)) is not None


def is_body(text: str) -> bool:
    """Return whether a name is that of a body file, by how it ends."""
    return Path(text).suffix.lower() in FORMATS


def is_file(text: str) -> bool:
    """Return whether there is a file of a name."""
    try:
        return bool(text) and Path(text).exists()
    except (OSError, ValueError):  # no file can have such a name
        return False


def parsed_sets(texts: Sequence[str] | None, known: Iterable[str]) -> Tables:
    """Return the tables of ``--set table.key=value``.

    >>> parsed_sets(["settings.gravity=9.81", "body.up=y"], ["settings", "body"])
    {'settings': {'gravity': 9.81}, 'body': {'up': 'y'}}
    """
    tables: Tables = {}
    for text in texts or ():
        path, equals, value = text.partition("=")
        table, dot, key = path.strip().partition(".")
        if not (equals and dot and key):
            raise InvalidValueError(f"--set must be table.key=value, such as settings.gravity=9.81, got {text!r:.60}")
        if table not in known:
            near = checks.nearest(table, list(known))
            raise InvalidValueError(f"--set: no table named {table!r:.60} here; there are {', '.join(known)}{near}")
        if key in tables.setdefault(table, {}):
            raise InvalidValueError(f"--set {table}.{key} is given twice")
        tables[table][key] = _value(value.strip())
    return tables


def _value(text: str) -> Any:
    """Return a value as TOML says it; what TOML does not know is text."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except (tomllib.TOMLDecodeError, ValueError, RecursionError):
        return text


def typed(context: "typer.Context", names: Iterable[str] = ()) -> list[str]:
    """Return which parameters were typed, as they are spelt."""
    sources = {name: context.get_parameter_source(name) for name in names or context.params}
    spelt = {"record": "a second word", "motions": "a second word", "sets": "--set", "motion": "--motion"}
    return [
        spelt.get(name, f"--{name.replace('_', '-')}")
        for name, source in sources.items()
        if source is not None and source.name == "COMMANDLINE"
    ]


class Words:
    """The words and options that name body and motion."""

    def __init__(self, options: Mapping[str, Any], known: Iterable[str]) -> None:
        self.options = options
        self.sets = parsed_sets(options.get("sets"), known)
        kinds = [LENGTH_UNITS if "body" in known else {}, ACCELERATION_UNITS if "motion" in known else {}]
        self.length, self.acceleration = units_of(options.get("units"), *kinds)
        sized = [name for name in ("width", "height") if options.get(name) is not None]
        self.sized = [f"--{name}" for name in sized]
        self.sized += [
            f"--set body.{n}" for n in ("slenderness_angle", "semi_diagonal") if n in self.sets.get("body", {})
        ]

    @property
    def solid(self) -> bool:
        """Whether the body is one in space."""
        body = self.options.get("body")
        return body is not None and describes_solid(body)

    def body_and_motions(self) -> tuple[str | None, list[str]]:
        """Return the file of the body, none if it is given by its size, and the words of motions."""
        body, record, motions = (self.options.get(name) for name in ("body", "record", "motion"))
        positional = [] if record is None else [record] if isinstance(record, str) else list(record)
        if self.sized and body is not None and not (positional and is_body(body)):
            body, positional = None, [body, *positional]
        for word in positional:
            if body is not None and is_body(word) and not is_body(body):
                raise InvalidValueError(
                    f"the body comes first, then the motion: {word[:100]} {body[:100]}, not the reverse"
                )
        return body, [*positional, *(motions or ())]

    def body_table(self, file: str | None) -> Tables:
        """Return the table [body]."""
        sizes = {name: self.options.get(name) for name in ("width", "height", "depth", "density")}
        sizes = {name: value for name, value in sizes.items() if value is not None}
        extra = self.sets.get("body", {})
        if file is not None:
            if self.sized or "depth" in sizes or (sizes and Path(file).suffix.lower() == ".toml"):
                raise InvalidValueError("give a body file or dimensions, not both")
            units = {} if self.length is None else {"units": self.length}
            return {"file": file, **units, **sizes, **extra}
        pairs = {"--width", "--height"}, {"--set body.slenderness_angle", "--set body.semi_diagonal"}
        if set(self.sized) not in pairs and not ({"width", "height"} <= {*sizes, *extra}):
            raise InvalidValueError(
                "a body is a file, or --width and --height, or --set body.slenderness_angle and body.semi_diagonal; "
                f"got {' '.join(self.sized) if self.sized else 'none of them'}"
            )
        return {"units": self.length or "m", **sizes, **extra}

    def motion_table(self, word: str, *, also: Mapping[str, Any] | None = None) -> Tables:
        """Return the table of one motion: a file that is there, or a pulse."""
        stated = {key: value for key, value in self.sets.get("motion", {}).items() if also is None or key in _OF_FILES}
        spelt = [f"motion.{key}" for key in stated]
        if self.acceleration is not None:
            stated["units"] = self.acceleration
            spelt.append("--units")
        path, mark, component = word.rpartition("#")
        if is_file(word) or not (mark and is_file(path)):
            path, component = word, ""
        if is_file(path):
            return {"record": path, **({"component": component} if component else {}), **stated, **(also or {})}
        name, colon, _ = word.partition(":")
        if (not colon and name not in catalogue()) or "/" in name or "\\" in word:
            raise RecordError(
                f"{word[:200]}: no such file; a pulse is written as sine:amplitude=3,period=0.8, "
                f"with one of {', '.join(sorted(catalogue()))}"
            )
        if spelt and also is None:
            raise InvalidValueError(f"a pulse takes no {', '.join(spelt)}: these are for files; got {word[:200]!r}")
        return {"pulse": word}

    def one_motion(self, words: Sequence[str]) -> Tables:
        """Return the table [motion] of a plane body: one motion, and its vertical part where z= names it."""
        along = self._along(words)
        if "y" in along:
            raise InvalidValueError("a plane body has one horizontal motion, along x, and a vertical one, along z")
        if "x" not in along:
            raise InvalidValueError("give the motion along x too: --motion x=FILE --motion z=FILE")
        table = self.motion_table(along["x"])
        if "z" not in along:
            return table
        upright = self.motion_table(along["z"], also={})
        if "record" not in table or "record" not in upright:
            raise InvalidValueError("the vertical motion of a plane body stands in a record file, as the one along x")
        component = {"vertical": upright["component"]} if "component" in upright else {}
        same = Path(upright["record"]) == Path(table["record"]) and component
        return {**table, **component, **({} if same else {"vertical_file": upright["record"]})}

    def components(self, words: Sequence[str]) -> Tables:
        """Return the table [motion] of a body in space: a motion along each axis that was named."""
        along = self._along(words)
        if not along:
            raise InvalidValueError(f"{NO_MOTION}, along y and z with --motion y=FILE and --motion z=FILE")
        files = any(is_file(word.partition("#")[0]) or is_file(word) for word in along.values())
        made = {}
        for axis, word in along.items():
            is_record = is_file(word) or is_file(word.rpartition("#")[0])
            shared = axis != "x" or (files and not is_record)
            made[axis] = self.motion_table(word, also={} if shared else None)
        return made

    def _along(self, words: Sequence[str]) -> dict[str, str]:
        along: dict[str, str] = {}
        for word in words:
            axis, equals, rest = word.partition("=")
            axis, rest = (axis, rest) if equals and axis in {"x", "y", "z"} else ("x", word)
            if axis in along:
                raise InvalidValueError(
                    f"one motion along {axis}, please: got {along[axis][:100]!r} and {rest[:100]!r}"
                )
            along[axis] = rest
        return along


@contextmanager
def hinted(body: str | None, word: str | None, upright: str = "") -> Iterator[None]:
    """Say what to type, or what a file may be, where a file was refused; upright: its vertical component."""
    try:
        with as_typed():
            yield
    except BodyFileError as error:
        if body is None or is_body(body) or not is_file(body):
            raise
        raise BodyFileError(f"{error}; perhaps a record: see rocking motion {body}") from error
    except RecordError as error:
        if word is None or not is_file(word) or not is_body(word):
            raise
        raise RecordError(f"{error}; perhaps a body: see rocking cor {word}") from error
    except InvalidValueError as error:
        match = re.search(r"the file has the components (.*); say (component|vertical)= one of these", str(error))
        if match is None or word is None:
            raise
        file = word.rpartition("#")[0] or word
        names = " or ".join(shlex.quote(f"{file}#{name}") for name in match[1].split(", ") if name != upright)
        raise InvalidValueError(f"the file has the components {match[1]}; say which one: {names}") from error
