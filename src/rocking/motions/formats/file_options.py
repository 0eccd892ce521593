"""Options of single record files within a set: unit, time step, format, lines to skip, by the names of the files."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from rocking import checks
from rocking.conventions import ACCELERATION_UNITS
from rocking.errors import InvalidValueError, located
from rocking.motions.formats.reader import format_named

KEYS = ("units", "time_step", "format", "skip")
"""Options that one file of a set may have of its own."""

Options = tuple[tuple[str, Any], ...]
"""Options of one file, sorted by key."""

FileOptions = Mapping[Any, Mapping[str, Any]]
"""Options by file name, a path-like; the name may include folders, as many as are needed to name one file."""


def by_path(files: FileOptions | None, paths: Iterable[Path]) -> dict[Path, dict[str, Any]]:
    """Return the options of the files of a set by path; refuse a name that is not that of exactly one file.

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
            raise InvalidValueError("files: {file} is no file of this set", file=f"{str(name)!r:.80}", hint=near)
        if len(matches) > 1 or matches[0] in options:
            both = ", ".join(map(str, matches)) if len(matches) > 1 else f"{matches[0]} has two entries"
            raise InvalidValueError(
                "files: {file!r:.80} must name one file of this set, got {matches:.300}", file=str(name), matches=both
            )
        with located("files"), located(name, "file"):
            options[matches[0]] = _checked(stated)
    return options


def together(path: Path, listed: Mapping[str, Any], stated: Mapping[str, Any], source: str) -> Options:
    """Return the options of a file in a list: those of its row and those stated for the file, which may not clash."""
    if twice := sorted(set(listed) & set(stated)):
        raise InvalidValueError(
            "{file} has {key} in its row and in files: remove one", file=path.name, key=twice[0]
        ).at(source)
    return tuple(sorted({**listed, **stated}.items()))


def _checked(stated: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options of one file, of known keys and values."""
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
