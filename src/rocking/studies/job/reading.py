"""Job files as text, and what is wrong with them in one sentence."""

import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from rocking.errors import InvalidValueError, MissingExtraError, RockingError

if TYPE_CHECKING:
    from rocking.studies.job.table import JobTable
    from rocking.studies.job.tables import Document

    _Kind = TypeVar("_Kind", bound=JobTable)

LARGEST_JOB = 16 * 2**20
"""Larger job files are refused [byte]."""

_PLAIN = {
    "bool_type": "must be true or false",
    "string_too_short": "must not be empty",
    "string_too_long": "must be shorter than 200 characters",
}


@contextmanager
def located(where: str) -> Iterator[None]:
    """Turn what is refused inside into an error that says where in the job file its cause stands."""
    try:
        yield
    except MissingExtraError:
        raise
    except RockingError as error:
        raise InvalidValueError(f"{where}: {error}") from error


def read_text(path: Path) -> str:
    """Return the text of a job file."""
    try:
        if path.is_dir():
            raise InvalidValueError(f"{path} is a folder; give a job file, or take status, resume and export for it")
        data = path.read_bytes()
    except FileNotFoundError as error:
        raise InvalidValueError(f"{path}: there is no such job file") from error
    except (OSError, ValueError) as error:
        raise InvalidValueError(f"{path}: cannot be opened ({getattr(error, 'strerror', None) or error})") from error
    if len(data) > LARGEST_JOB:
        raise InvalidValueError(f"{path}: has {len(data) / 2**20:.1f} MiB; job files may have up to 16 MiB")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InvalidValueError(f"{path}: is not UTF-8 text (byte {error.start})") from error


def document_of(text: str) -> "Document":
    r"""Return what a job file says.

    >>> document_of('[campaign]\nname = "a"\nkind = "stripe"')
    Traceback (most recent call last):
    rocking.errors.InvalidValueError: campaign.kind must be one of 'overturning-map', ... got 'stripe'; did you mean
    stripes? (and 1 more)
    """
    from rocking.studies.job.tables import Document

    return validated(Document, text)


def validated(kind: "type[_Kind]", text: str) -> "_Kind":
    """Return the tables of a text, checked for themselves."""
    from pydantic import ValidationError

    from rocking.bodies.formats.words import sentence

    try:
        given = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InvalidValueError(f"is not TOML: {error}") from error
    except (ValueError, RecursionError) as error:
        raise InvalidValueError(f"is not TOML that can be read: {str(error).partition(';')[0]}") from error
    try:
        return kind.model_validate(given)
    except ValidationError as error:
        raise InvalidValueError(_nearest(sentence(error, None), error.errors(include_url=False)[0])) from error


def _nearest(words: str, problem: object) -> str:
    """Say it in plain words, and add the nearest known word where one of several was expected."""
    import difflib
    import re

    assert isinstance(problem, dict)
    given, kind = problem.get("input"), problem["type"]
    if kind in _PLAIN:
        return words.replace(f"is refused ({problem['msg']})", _PLAIN[kind])
    if kind != "literal_error" or not isinstance(given, str):
        return words
    known = re.findall(r"'([^']+)'", problem["ctx"]["expected"])
    near = difflib.get_close_matches(given[:60], known, n=1)
    head, mark, tail = words.partition(" (and ")
    return f"{head}; did you mean {near[0]}?{mark}{tail}" if near else words
