"""Options of single record files in a set, by file name: unit, time step, format, number of lines to skip."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from rocking import checks
from rocking.conventions import ACCELERATION_UNITS
from rocking.errors import InvalidValueError, located
from rocking.motions.formats.reader import format_named

KEYS = ("units", "time_step", "format", "skip")
"""Allowed options of a single file in a set."""

Options = tuple[tuple[str, Any], ...]
"""Options of one file, sorted by key."""

FileOptions = Mapping[Any, Mapping[str, Any]]
"""Options by file name (path-like). To be unique, the name may include folders."""


def by_path(files: FileOptions | None, paths: Iterable[Path]) -> dict[Path, dict[str, Any]]:
    """Return the options of the files of a set by path. A name must match exactly one file.

    >>> by_path({"b.txt": {"units": "g"}}, [Path("set/a.txt"), Path("set/b.txt")])[Path("set/b.txt")]
    {'units': 'g'}
    """
    by_name: dict[str, list[Path]] = {}
    for path in dict.fromkeys(paths) if files else ():
        by_name.setdefault(path.name, []).append(path)
    options: dict[Path, dict[str, Any]] = {}
    for name, stated in (files or {}).items():
        parts = Path(name).parts
        matches = [path for path in by_name.get(Path(name).name, []) if path.parts[-len(parts) :] == parts]
        if not matches:
            near = checks.nearest(str(name), list(by_name))
            raise InvalidValueError(
                "files: this set does not contain the file {file}", file=f"{str(name)!r:.80}", hint=near
            )
        if len(matches) > 1 or matches[0] in options:
            both = ", ".join(map(str, matches)) if len(matches) > 1 else f"two entries for {matches[0]}"
            raise InvalidValueError(
                "files: {file!r:.80} must match one file of this set, got {matches:.300}", file=str(name), matches=both
            )
        with located("files"), located(name, "file"):
            options[matches[0]] = _checked(stated)
    return options


def together(path: Path, listed: Mapping[str, Any], stated: Mapping[str, Any], source: str) -> Options:
    """Return the options of a file from its row in a list and from its own options.

    Raise an error for a repeated key.
    """
    if twice := sorted(set(listed) & set(stated)):
        raise InvalidValueError(
            "{key} of {file} is given twice: in its row of the list and in the table files; remove one of them",
            file=path.name,
            key=twice[0],
        ).at(source)
    return tuple(sorted({**listed, **stated}.items()))


def _checked(stated: Mapping[str, Any]) -> dict[str, Any]:
    """Return the validated options of one file."""
    options = {key: value for key, value in stated.items() if value is not None}
    for key, value in options.items():
        match checks.one_of("key", key, KEYS):
            case "units":
                options[key] = checks.one_of("units", value, ACCELERATION_UNITS)
            case "time_step":
                options[key] = checks.positive("time_step", value, "s")
            case "skip":
                options[key] = checks.whole("skip", value)
            case _:
                options[key] = format_named(value).name
    return options
