"""What all formats share: limits, reading a file, saying which file an error is about, and words for errors."""

import difflib
import reprlib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypedDict, TypeVar

from rocking.conventions import LENGTH_UNITS
from rocking.errors import BodyFileError, MissingExtraError, RockingError

if TYPE_CHECKING:
    from pydantic import BaseModel, ValidationError
    from pydantic_core import ErrorDetails

T = TypeVar("T", bound="BaseModel")

_MUST_BE = {
    "float_type": "must be a number",
    "finite_number": "must be a finite number",
    "greater_than": "must be a number > {gt:g}",
    "greater_than_equal": "must be a number >= {ge:g}",
    "less_than_equal": "must be a number <= {le:g}",
    "int_type": "must be a whole number",
    "int_from_float": "must be a whole number",
    "string_type": "must be text",
    "list_type": "must be a list",
    "dict_type": "must be a table",
    "model_type": "must be a table",
    "literal_error": "must be one of {expected}",
}
_UNITS = {
    **dict.fromkeys(("density", "layers"), "kg/m3"),
    **dict.fromkeys(("mass", "masses"), "kg"),
    **dict.fromkeys(("moment_of_inertia", "inertia"), "kg m2"),
    **dict.fromkeys(("sides", "axis"), ""),
    "degrees": "degree",
}
_SHOWN = reprlib.Repr()
_SHOWN.maxstring = _SHOWN.maxother = 60


def suggestion(word: str, known: Iterable[str]) -> str:
    """Return what to say after an unknown word: the nearest known one and all that are allowed.

    >>> suggestion("heigth", ["height", "width"])
    '; did you mean height? Allowed: height, width'
    """
    known = list(known)
    near = difflib.get_close_matches(word[:60], known, n=1)
    allowed = ", ".join(known[:30])
    return f"; did you mean {near[0]}? Allowed: {allowed}" if near else f"; allowed: {allowed}"


def sentence(error: "ValidationError", units: Any) -> str:
    """Return a validation error as one sentence with key path, value and allowed range."""
    problems = error.errors(include_url=False)
    more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
    return _first(problems[0], units) + more


def validated(kind: type[T], given: dict[str, Any]) -> T:
    """Return the tables of a file as a model of pydantic, or refuse them in one sentence."""
    from pydantic import ValidationError

    try:
        return kind.model_validate(given)
    except ValidationError as error:
        raise BodyFileError(sentence(error, given.get("units"))) from error


def _first(problem: "ErrorDetails", units: Any) -> str:
    path, kind, context = _path(problem["loc"]), problem["type"], problem.get("ctx", {})
    if kind == "missing":
        return _missing(path)
    if kind in {"unknown_key", "contradiction"}:
        return f"{path}: {problem['msg']}" if path else problem["msg"]
    if kind in {"too_short", "too_long"}:
        bound = f"at least {context['min_length']}" if kind == "too_short" else f"at most {context['max_length']}"
        return f"{path} must have {bound} entries, got {context['actual_length']}"
    words = _MUST_BE[kind].format(**context) if kind in _MUST_BE else f"is refused ({problem['msg']})"
    unit = _unit(problem["loc"], units) if "number" in words else ""
    return f"{path} {words}{unit}, got {_SHOWN.repr(problem['input'])}"


def _missing(path: str) -> str:
    if path == "units":
        return f'units is missing: add units = "m" or another of {", ".join(LENGTH_UNITS)}; units are never guessed'
    return f"{path} is missing"


def _path(loc: tuple[int | str, ...]) -> str:
    return "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in loc).lstrip(".")


def _unit(loc: tuple[int | str, ...], units: Any) -> str:
    unit = next((_UNITS[part] for part in loc if isinstance(part, str) and part in _UNITS), units)
    return f" [{unit}]" if isinstance(unit, str) and unit in {*LENGTH_UNITS, *_UNITS.values()} - {""} else ""


LARGEST_FILE = 64 * 2**20  # larger files are refused [byte]
MOST_VERTICES = 1_000_000  # bodies with more vertices are refused [-]


class Placement(TypedDict, total=False):
    """How a drawn section stands: what `Section` takes beside its regions."""

    feet: tuple[float, float] | None
    depth: float
    ground: float


@contextmanager
def blamed(where: str) -> Iterator[None]:
    """Put a place in front of every refusal that is raised inside.

    >>> with blamed("pier.toml"):
    ...     raise BodyFileError("no [section]")
    Traceback (most recent call last):
    rocking.errors.BodyFileError: pier.toml: no [section]
    """
    try:
        yield
    except RockingError as error:
        if isinstance(error, MissingExtraError):
            raise
        raise type(error)(f"{where}: {error}") from error


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
        what = f"{path.name}: cannot be read ({type(error).__name__}: {str(error)[:120]}); damaged?"
        raise BodyFileError(what) from error


def checked_file(path: Path, limit: int = LARGEST_FILE) -> Path:
    """Return the path of a regular file of acceptable size."""
    try:
        found, size = path.is_file(), path.stat().st_size
    except FileNotFoundError as error:
        raise BodyFileError("there is no such file") from error
    except (OSError, ValueError) as error:  # ValueError: a NUL in the name
        raise BodyFileError(f"cannot be opened ({_why(error)})") from error
    if not found:
        raise BodyFileError("is not a file")
    if size > limit:
        raise BodyFileError(f"has {size / 2**20:.1f} MiB; body files may have up to {limit / 2**20:g} MiB")
    return path


def read_text(path: Path, limit: int = LARGEST_FILE) -> str:
    """Return the text of a UTF-8 file."""
    try:
        return checked_file(path, limit).read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise BodyFileError(f"is not UTF-8 text (byte {error.start})") from error
    except OSError as error:
        raise BodyFileError(f"cannot be opened ({_why(error)})") from error


def check_count(vertices: int) -> None:
    """Refuse a body of more vertices than the limit."""
    if vertices > MOST_VERTICES:
        raise BodyFileError(f"has {vertices} vertices; a body may have up to {MOST_VERTICES}; simplify the outline")


def _why(error: Exception) -> str:
    return str(getattr(error, "strerror", None) or error)
