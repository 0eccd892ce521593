"""Common limits, file access and error texts of all formats."""

import difflib
import math
import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypedDict, TypeVar

from rocking.checks import number_hint
from rocking.conventions import LENGTH_UNITS
from rocking.errors import BodyFileError, InvalidValueError, RockingError, reason_of
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
    **dict.fromkeys(("mass", "masses", "base_mass", "beam_mass"), "kg"),
    **dict.fromkeys(("moment_of_inertia", "inertia"), "kg m2"),
    **dict.fromkeys(("sides", "axis", "loss", "hardening", "exponent", "columns", "friction", "damping_ratio"), ""),
    **dict.fromkeys(("prestress", "yield_force", "slip_force"), "N"),
    "stiffness": "N/m",
    "damping": "N s/m",
    "period": "s",
    "floor_slope": "rad",
    "area": "m2",
    "modulus": "Pa",
    "coefficient": "N (s/m)^a",
    "degrees": "degree",
}


def suggestion(word: str, names: Iterable[str]) -> str:
    """Return the hint for an unknown name: the nearest allowed name, and all allowed names.

    >>> suggestion("heigth", ["height", "width"])
    'did you mean height? Allowed: height, width'
    """
    names = list(names)
    near = difflib.get_close_matches(word[:60], names, n=1)
    allowed = ", ".join(names[:30])
    return f"did you mean {near[0]}? Allowed: {allowed}" if near else f"allowed: {allowed}"


def from_pydantic(problems: "Sequence[ErrorDetails]", units: Any = None, kind: type[E] = InvalidValueError) -> E:  # type: ignore[assignment]
    """Return the first error of a pydantic validation as a `RockingError`, with the number of further errors."""
    # `units` is the unit of the lengths
    path, cause = _path(problems[0]["loc"]), problems[0].get("ctx", {}).get("error")
    if isinstance(cause, RockingError):
        refusal = cause.copied(kind)
        refusal.places = (*([Place(path, "key")] if path else []), *cause.places)
    else:
        refusal = kind(**_stated(problems[0], path, units))
    refusal.more = len(problems) - 1
    return refusal


def _stated(problem: "ErrorDetails", path: str, units: Any) -> dict[str, Any]:
    """Return the keywords of `RockingError` for an error of pydantic."""
    kind, value, context, unit = problem["type"], problem["input"], problem.get("ctx", {}), _unit(problem["loc"], units)
    stated = {"parameter": path, "value": value}
    if kind in _TEXTS:
        hint = UNITS_FIRST if (kind, path) == ("missing", "units") else ""
        return {**stated, **context, "text": _TEXTS[kind], "hint": hint}
    if kind in _KINDS:
        number = "number" in _KINDS[kind]
        allowed_type = f"{_KINDS[kind]} [{unit}]" if unit and number else _KINDS[kind]
        hint = number_hint(value) if number and "whole" not in _KINDS[kind] and isinstance(value, str) else ""
        return {**stated, "allowed": allowed_type, "hint": hint}
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


UNITS_FIRST = f'add units = "m", or one of {", ".join(LENGTH_UNITS)}'


def unit_to_state() -> Message:
    """Return the hint for a missing length unit."""
    return Message("add {option}, one of {units}", {"option": Option("body.units"), "units": ", ".join(LENGTH_UNITS)})


def validated(kind: type[T], tables: dict[str, Any]) -> T:
    """Return the tables of a file as a pydantic model, or raise an error with one sentence."""
    from pydantic import ValidationError

    try:
        return kind.model_validate(tables)
    except ValidationError as error:
        raise from_pydantic(error.errors(include_url=False), tables.get("units"), BodyFileError) from error


def _path(loc: tuple[int | str, ...]) -> str:
    return "".join(f"[{key}]" if isinstance(key, int) else f".{key}" for key in loc).lstrip(".")


def _unit(loc: tuple[int | str, ...], units: Any) -> str:
    unit = next((_UNITS[key] for key in loc if isinstance(key, str) and key in _UNITS), units)
    return unit if isinstance(unit, str) and unit in {*LENGTH_UNITS, *_UNITS.values()} else ""


LARGEST_FILE = 64 * 2**20  # largest size of a body file [byte]
MOST_VERTICES = 1_000_000  # largest number of vertices of a body [-]


class Placement(TypedDict, total=False):
    """Feet, depth and ground of a section from a drawing, as in `Section`."""

    feet: tuple[float, float] | None
    depth: float
    ground: float


@contextmanager
def readable(path: Path) -> Iterator[None]:
    """Convert any other exception during the reading of a body file into a BodyFileError, with its cause.

    >>> with readable(Path("drum.ply")):
    ...     raise IndexError("list index out of range")
    Traceback (most recent call last):
    rocking.errors.BodyFileError: drum.ply: The file is unreadable (IndexError: list index out of range); repair it
    """
    try:
        yield
    except RockingError:
        raise
    except Exception as error:
        raise BodyFileError(
            "The file is unreadable ({type}: {reason:.120})",
            type=type(error).__name__,
            reason=str(error),
            hint="repair it",
        ).at(path.name) from error


def checked_file(path: Path, limit: int = LARGEST_FILE) -> Path:
    """Return the path after a check of the file and its size."""
    try:
        is_file, size = path.is_file(), path.stat().st_size
    except FileNotFoundError as error:
        raise BodyFileError("no such file") from error
    except (OSError, ValueError) as error:  # ValueError is raised for a NUL in the name
        raise BodyFileError("The file cannot be opened ({reason}).", reason=reason_of(error)) from error
    if not is_file:
        raise BodyFileError("This is not a file.")
    if size > limit:
        raise BodyFileError(
            "A body file has at most {limit:g} MiB, got {size:.1f} MiB.", size=size / 2**20, limit=limit / 2**20
        )
    return path


def read_text(path: Path, limit: int = LARGEST_FILE) -> str:
    """Return the text of a UTF-8 file."""
    try:
        return checked_file(path, limit).read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise BodyFileError("The file is not UTF-8 text (byte {byte}).", byte=error.start) from error
    except OSError as error:
        raise BodyFileError("The file cannot be opened ({reason}).", reason=reason_of(error)) from error


def check_count(vertices: int) -> None:
    """Raise an error for too many vertices."""
    if vertices > MOST_VERTICES:
        raise BodyFileError(
            "The body has {count} vertices; at most {limit} are allowed", count=vertices, limit=MOST_VERTICES,
            hint="simplify the outline",
        )  # fmt: skip
