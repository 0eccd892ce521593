"""The body in space of a command: its file, and what a mesh leaves open."""

import re
from pathlib import Path
from typing import Any

from rocking.bodies.formats import SolidFile, describes_solid, read_solid
from rocking.checks import length_unit
from rocking.errors import RockingError

_WORDS = (
    (re.compile(r"\bunits="), "--units"),
    (re.compile(r"\bfill_holes\b(=True)?"), "--fill-holes"),
    (re.compile(r"\bbase_tolerance\b=?"), "--base-tolerance"),
    (re.compile(r"\bup must be"), "--up must be"),
)


def is_solid(word: str | Path | None) -> bool:
    """Return whether the first word of a command names a body in space.

    Returns whether it is a mesh, or a TOML file with [solid].
    """
    return word is not None and describes_solid(word)


def is_body(word: str | Path) -> bool:
    """Return whether a word names a body, plane or in space, by how it ends.

    Returns whether a body file is named so.
    """
    from rocking.bodies.formats.reader import FORMATS

    return Path(word).suffix.lower() in FORMATS or is_solid(word)


def solid_from(
    path: Path,
    *,
    unit: str | None,
    density: float | None,
    up: str | None,
    fill_holes: bool,
    base_tolerance: float | None,
) -> SolidFile:
    """Return the body in space that a command was given.

    density: density of the mesh [kg/m3]. Returns the body, and what was done to get it.
    """
    try:
        scale = length_unit(unit or "m")
        reach = None if base_tolerance is None else base_tolerance * scale
        return read_solid(path, units=unit, density=density, up=up, fill_holes=fill_holes, base_tolerance=reach)
    except RockingError as error:
        raise type(error)(_in_options(str(error))) from error


def refuse(reason: str, options: dict[str, Any]) -> None:
    """Refuse options that have no meaning for a kind of body."""
    given = [name for name, value in options.items() if value is not None and value is not False]
    if given:
        raise RockingError(f"{reason}, so it takes no {', '.join(given)}")


def spelt(options: dict[str, Any]) -> dict[str, Any]:
    """Return options under the names that a user types.

    >>> spelt({"semi_diagonal": None})
    {'--semi-diagonal': None}
    """
    return {"--units" if name == "unit" else f"--{name.replace('_', '-')}": value for name, value in options.items()}


def _in_options(words: str) -> str:
    for pattern, option in _WORDS:
        words = pattern.sub(option, words)
    return words
