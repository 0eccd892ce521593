"""Tables, files and pages that several commands write."""

import math
import re
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from rocking import checks
from rocking.bodies import Body
from rocking.cli.inputs import body_words
from rocking.conventions import ACCELERATION_UNITS, LENGTH_UNITS, FloatArray, g
from rocking.dynamics.response import Motion
from rocking.errors import InvalidValueError

UNITS: dict[str, dict[str, float]] = {
    "m/s2": ACCELERATION_UNITS,
    "m/s": {"m/s": 1.0, "cm/s": 0.01, "mm/s": 0.001},
    "m": LENGTH_UNITS,
    "s": {"s": 1.0, "ms": 0.001},
    "rad": {"rad": 1.0, "deg": math.pi / 180.0},
    "1": {},
}
"""By the unit in which a value is computed: the units in which it may be written."""

MOST_VALUES = 100_000
"""No row of values has more."""

_NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([A-Za-z/][A-Za-z0-9/]*)?")
_SPACINGS = ("linear", "log")
Progress = Callable[[int], None]


def check_files(picture: Path | None, *others: Path | None) -> None:
    """Refuse, before anything is computed, files that could not be written."""
    if picture is not None and picture.suffix not in {".png", ".svg", ".pdf"}:
        raise InvalidValueError(f"a picture is .png, .svg or .pdf, got {picture.name!r}")
    for path in (picture, *others):
        if path is not None and not path.parent.is_dir():
            raise InvalidValueError(f"no folder {str(path.parent)!r} to write {path.name!r} into")


def write_csv(path: Path, columns: dict[str, tuple[Any, str]]) -> None:
    """Write values with their units as comma-separated values, all digits kept."""
    import numpy as np

    from rocking.quantities import QUANTITIES
    from rocking.tables import Column, Table, to_csv

    codes = {name: QUANTITIES[name].codes if name in QUANTITIES else {} for name in columns}
    table = {name: Column(np.asarray(v), unit, codes=codes[name]) for name, (v, unit) in columns.items()}
    to_csv(Table("row", table, no_unit="1"), path, blank=False)


def plain(values: Any) -> Any:
    """Return an array as nested lists for JSON, with null where there is no number.

    >>> plain([[1.0, float("nan")]])
    [[1.0, None]]
    """
    import numpy as np

    array = np.asarray(values)
    made = array.astype(object)
    made[~np.isfinite(array)] = None
    return made.tolist()


def quantity(name: str, word: str, unit: str) -> tuple[float, str]:
    """Return one number, written with a unit or without.

    Returns value: the number [unit]; written: the unit that was written, empty if none.

    >>> quantity("semi_diagonal", "40cm", "m"), quantity("scale", "2", "1")
    ((0.4, 'cm'), (2.0, ''))
    """
    found, known = _NUMBER.fullmatch(word.strip()), UNITS[unit]
    if found is None or (found[2] and found[2] not in known):
        allowed = f", alone or with one of {', '.join(known)}" if known else " without a unit"
        raise InvalidValueError(f"{name} must be a number{allowed}, got {word!r:.60}{checks.decimal_comma(word)}")
    value = float(found[1]) * (known[found[2]] if found[2] else 1.0)
    if not math.isfinite(value):
        raise InvalidValueError(f"{name} must be a finite number, got {word!r:.60}")
    return value, found[2] or ""


def row(name: str, word: str, unit: str, spacing: str = "linear") -> tuple[FloatArray, str]:
    """Return a row of values: some numbers with commas between, or FIRST:LAST:COUNT, or that with :log or :linear.

    Returns values: the values [unit]; written: the unit that all were written in, empty if none.

    >>> values, _ = row("pga", "0.1g:0.3g:3", "m/s2")
    >>> (values / 9.80665).round(12).tolist()
    [0.1, 0.2, 0.3]
    >>> row("periods", "1,2,4", "s")[0].tolist()
    [1.0, 2.0, 4.0]
    """
    import numpy as np

    parts = word.split(":")
    if len(parts) == 1:
        values, written = _quantities(name, word.split(","), unit)
        return np.array(values), written
    if len(parts) not in {3, 4} or (len(parts) == 4 and parts[3].strip() not in _SPACINGS):
        raise InvalidValueError(f"{name} must be FIRST:LAST:COUNT, or that with :log, or A,B,C, got {word!r:.60}")
    (first, last), written = _quantities(name, parts[:2], unit)
    count = _count(name, parts[2])
    if (parts[3].strip() if len(parts) == 4 else spacing) == "linear":
        return np.linspace(first, last, count), written
    if min(first, last) <= 0.0:
        raise InvalidValueError(f"{name} must be above 0 to be spaced by equal ratios, got {word!r:.60}")
    return np.geomspace(first, last, count), written


def _quantities(name: str, words: list[str], unit: str) -> tuple[list[float], str]:
    if len(words) > MOST_VALUES:
        raise InvalidValueError(f"{name} must have at most {MOST_VALUES} values, got {len(words)}")
    found = [quantity(name, word, unit) for word in words]
    written = [one for _, one in found]
    if "" in written and any(written):
        # 0.1:1g could mean either
        why = checks.decimal_comma(",".join(words))
        raise InvalidValueError(f"{name} must have a unit at every number or at none, got {':'.join(words)!r:.60}{why}")
    return [value for value, _ in found], written[0]


def _count(name: str, word: str) -> int:
    if not re.fullmatch(r"\s*[0-9]{1,9}\s*", word) or not 2 <= int(word) <= MOST_VALUES:
        raise InvalidValueError(f"{name} must have a COUNT from 2 to {MOST_VALUES}, got {word!r:.60}")
    return int(word)


def body_and_motion_of(
    words: tuple[str | None, str | None, str | None], size: dict[str, Any], told: dict[str, Any]
) -> tuple[Body, Motion]:
    """Return the body and the motion that a command was given."""
    from rocking.cli.inputs import body_from, motion_from
    from rocking.cli.simulate_question import body_and_motion

    body, record, motion = words
    sized = any(size[name] is not None for name in ("width", "height", "angle", "semi_diagonal"))
    if motion is None and record is None and not (sized and body is not None):
        raise InvalidValueError(
            "what moves the ground? Give a record file, or a pulse such as sine:amplitude=3,period=0.8"
        )
    file, word = body_and_motion(body, record, motion, sized=sized, free=False)
    return body_from(file, **size), motion_from(str(word), **told)


def body_lines(body: Body, gravity: float, length: str = "m") -> list[tuple[str, str]]:
    """Return what is printed of the body of a study.

    gravity: acceleration of gravity [m/s2].
    """
    words = body_words(body, gravity, length)
    return [("body", words), *(("density", each.removeprefix("density ")) for each in body.assumed)]


def motion_facts(motion: Motion) -> dict[str, Any]:
    """Return a motion as plain values for JSON."""
    from rocking.motions.pulse import Pulse

    kind = "pulse" if isinstance(motion, Pulse) else "record"
    facts = {"duration_s": motion.duration, "peak_acceleration_m_s2": motion.peak}
    return {"kind": kind, "name": motion.name, **facts, "warnings": list(motion.doubts)}


@contextmanager
def bar(what: str, total: int | None = None, *, quiet: bool = False) -> Iterator[Progress]:
    """Show on a terminal how far it is.

    Returns takes the number of histories done since it was last called.
    """
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    hidden = quiet or not sys.stderr.isatty()
    with Bar(*columns, console=Console(stderr=True), transient=True, disable=hidden) as shown:
        task = shown.add_task(what, total=total)
        yield lambda done: shown.update(task, advance=done)


def settings_from(gravity: float | None, engine: str, linear: bool, threads: int | None) -> dict[str, Any]:
    """Return how to compute, as studies take it.

    gravity: acceleration of gravity; the standard one if not given [m/s2].
    """
    pull = g if gravity is None else checks.positive("--gravity", gravity, "m/s2")
    engine = checks.one_of("--engine", engine, ("auto", "fast", "reference"))
    if threads is not None and not 1 <= threads <= 4096:
        raise InvalidValueError(f"--threads must be in [1, 4096], got {threads}")
    return {"gravity": pull, "engine": engine, "linear": linear, "threads": threads}


def table(head: tuple[str, ...], rows: list[tuple[str, ...]], left: int = 1) -> Any:
    """Return a table without lines."""
    from rich.table import Table
    from rich.text import Text

    made = Table(box=None, pad_edge=False, header_style="bold")
    for k, word in enumerate(head):
        made.add_column(Text(word), justify="left" if k < left else "right", overflow="fold")
    for row in rows:
        made.add_row(*map(Text, row))
    return made
