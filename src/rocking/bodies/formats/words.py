"""What all formats share: limits, reading a file, saying which file an error is about, and words for errors."""

import difflib
import math
import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypedDict, TypeVar

from rocking.checks import number_hint
from rocking.conventions import LENGTH_UNITS
from rocking.errors import BodyFileError, InvalidValueError, RockingError
from rocking.messages import Message, Option, Place, Range

if TYPE_CHECKING:
    from pydantic import BaseModel
    from pydantic_core import ErrorDetails

T = TypeVar("T", bound="BaseModel")
E = TypeVar("E", bound=RockingError)

_KINDS = {
    "float_type": "a number",
    "float_parsing": "a number",
    "finite_number": "a finite number",
    "int_type": "a whole number",
    "int_parsing": "a whole number",
    "int_from_float": "a whole number",
    "string_type": "text",
    "list_type": "a list",
    "dict_type": "a table",
    "model_type": "a table",
    "bool_type": "true or false",
}
_BOUNDS = {"greater_than": "gt", "greater_than_equal": "ge", "less_than": "lt", "less_than_equal": "le"}
_TEXTS = {
    "missing": "{parameter} is missing",
    "too_short": "{parameter} must have at least {min_length} entries, got {actual_length}",
    "too_long": "{parameter} must have at most {max_length} entries, got {actual_length}",
    "string_too_short": "{parameter} must not be empty, got {value}",
    "string_too_long": "{parameter} must have at most {max_length} characters, got {value}",
}
_UNITS = {
    **dict.fromkeys(("density", "layers"), "kg/m3"),
    **dict.fromkeys(("mass", "masses"), "kg"),
    **dict.fromkeys(("moment_of_inertia", "inertia"), "kg m2"),
    **dict.fromkeys(("sides", "axis"), ""),
    "degrees": "degree",
}


def suggestion(word: str, known: Iterable[str]) -> str:
    """Return the hint about an unknown word: the nearest known one and all that are allowed.

    >>> suggestion("heigth", ["height", "width"])
    'did you mean height? Allowed: height, width'
    """
    known = list(known)
    near = difflib.get_close_matches(word[:60], known, n=1)
    allowed = ", ".join(known[:30])
    return f"did you mean {near[0]}? Allowed: {allowed}" if near else f"allowed: {allowed}"


def from_pydantic(problems: "Sequence[ErrorDetails]", units: Any = None, kind: type[E] = InvalidValueError) -> E:  # type: ignore[assignment]
    """Return the first error of a validation by pydantic as one of ours, with the number of the others."""
    # units: unit of the lengths among the values
    path, own = _path(problems[0]["loc"]), problems[0].get("ctx", {}).get("error")
    if isinstance(own, RockingError):
        made = own.copied(kind)
        made.places = (*([Place(path, "key")] if path else []), *own.places)
    else:
        made = kind(**_stated(problems[0], path, units))
    made.more = len(problems) - 1
    return made


def _stated(problem: "ErrorDetails", path: str, units: Any) -> dict[str, Any]:
    """Return what `RockingError` takes, of an error of pydantic."""
    kind, value, context, unit = problem["type"], problem["input"], problem.get("ctx", {}), _unit(problem["loc"], units)
    stated = {"parameter": path, "value": value}
    if kind in _TEXTS:
        hint = UNITS_FIRST if (kind, path) == ("missing", "units") else ""
        return {**stated, **context, "text": _TEXTS[kind], "hint": hint}
    if kind in _KINDS:
        number = "number" in _KINDS[kind]
        words = f"{_KINDS[kind]} [{unit}]" if unit and number else _KINDS[kind]
        hint = number_hint(value) if number and "whole" not in _KINDS[kind] and isinstance(value, str) else ""
        return {**stated, "allowed": words, "hint": hint}
    if kind in _BOUNDS:
        bound = float(context[_BOUNDS[kind]])
        low, high = (bound, math.inf) if kind in {"greater_than", "greater_than_equal"} else (-math.inf, bound)
        allowed = Range(low, high, unit, kind == "greater_than", kind == "less_than")
        return {**stated, "allowed": allowed, "text": "{parameter} must be a number {allowed}, got {value}"}
    if kind == "literal_error":
        near = difflib.get_close_matches(str(value)[:60], re.findall(r"'([^']+)'", context["expected"]), n=1)
        hint = Message("did you mean {name}?", {"name": near[0]}) if near else ""
        return {**stated, "allowed": f"one of {context['expected']}", "hint": hint}
    return {**stated, "text": "{parameter} is refused ({reason}), got {value}", "reason": problem["msg"]}


UNITS_FIRST = f'add units = "m" or another of {", ".join(LENGTH_UNITS)}; units are never guessed'


def unit_to_state() -> Message:
    """Return the hint that a unit of length has to be stated."""
    return Message("give {option}, one of {units}", {"option": Option("body.units"), "units": ", ".join(LENGTH_UNITS)})


def validated(kind: type[T], given: dict[str, Any]) -> T:
    """Return the tables of a file as a model of pydantic, or refuse them in one sentence."""
    from pydantic import ValidationError

    try:
        return kind.model_validate(given)
    except ValidationError as error:
        raise from_pydantic(error.errors(include_url=False), given.get("units"), BodyFileError) from error


def _path(loc: tuple[int | str, ...]) -> str:
    return "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in loc).lstrip(".")


def _unit(loc: tuple[int | str, ...], units: Any) -> str:
    unit = next((_UNITS[part] for part in loc if isinstance(part, str) and part in _UNITS), units)
    return unit if isinstance(unit, str) and unit in {*LENGTH_UNITS, *_UNITS.values()} else ""


LARGEST_FILE = 64 * 2**20  # larger files are refused [byte]
MOST_VERTICES = 1_000_000  # bodies with more vertices are refused [-]


class Placement(TypedDict, total=False):
    """How a drawn section stands: what `Section` takes beside its regions."""

    feet: tuple[float, float] | None
    depth: float
    ground: float


@contextmanager
def readable(path: Path) -> Iterator[None]:
    """Make a refusal of whatever else a body file provokes; where it came from stays chained.

    >>> with readable(Path("drum.ply")):
    ...     raise IndexError("list index out of range")
    Traceback (most recent call last):
    rocking.errors.BodyFileError: drum.ply: cannot be read (IndexError: list index out of range); damaged?
    """
    try:
        yield
    except RockingError:
        raise
    except Exception as error:
        raise BodyFileError(
            "cannot be read ({type}: {reason:.120})", type=type(error).__name__, reason=str(error), hint="damaged?"
        ).at(path.name) from error


def checked_file(path: Path, limit: int = LARGEST_FILE) -> Path:
    """Return the path of a regular file of acceptable size."""
    try:
        found, size = path.is_file(), path.stat().st_size
    except FileNotFoundError as error:
        raise BodyFileError("there is no such file") from error
    except (OSError, ValueError) as error:  # ValueError: a NUL in the name
        raise BodyFileError("cannot be opened ({reason})", reason=_why(error)) from error
    if not found:
        raise BodyFileError("is not a file")
    if size > limit:
        raise BodyFileError(
            "has {size:.1f} MiB; body files may have up to {limit:g} MiB", size=size / 2**20, limit=limit / 2**20
        )
    return path


def read_text(path: Path, limit: int = LARGEST_FILE) -> str:
    """Return the text of a UTF-8 file."""
    try:
        return checked_file(path, limit).read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise BodyFileError("is not UTF-8 text (byte {byte})", byte=error.start) from error
    except OSError as error:
        raise BodyFileError("cannot be opened ({reason})", reason=_why(error)) from error


def check_count(vertices: int) -> None:
    """Refuse a body of more vertices than the limit."""
    if vertices > MOST_VERTICES:
        raise BodyFileError(
            "has {count} vertices; a body may have up to {limit}", count=vertices, limit=MOST_VERTICES,
            hint="simplify the outline",
        )  # fmt: skip


def _why(error: Exception) -> str:
    return str(getattr(error, "strerror", None) or error)
