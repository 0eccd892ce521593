"""What all formats share: limits, reading a file, and saying which file an error is about."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TypedDict

from rocking.errors import BodyFileError, MissingExtraError, RockingError

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
