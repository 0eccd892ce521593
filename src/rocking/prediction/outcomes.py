"""A table of what was seen: one row a trial, with the motion, its scale, and whether the body overturned."""

import csv
import difflib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.studies.inventory.cells import DecimalMark
from rocking.studies.inventory.sheets import MOST_BYTES, rows_of

EVENTS = {"overturned": "overturning", "rocked": "uplift", "slid": "sliding"}
"""Columns of what was seen, and what a prediction calls it."""

AXES = ("x", "y", "z")
COLUMNS = ("motion", *AXES, "scale", *EVENTS)
"""Columns that are read: motion, or x with y and z where there are several components."""

_SEEN = {"1": 1.0, "yes": 1.0, "true": 1.0, "0": 0.0, "no": 0.0, "false": 0.0, "": float("nan")}
_HOW = (
    "a table of outcomes is a .csv file whose first line names the columns motion (or x, y, z) and overturned, and if "
    "known scale, rocked, slid, with commas, semicolons or tabs between"
)


@dataclass(frozen=True)
class Trial:
    """One row: which motion, how strong, and what was seen."""

    line: int
    files: tuple[tuple[str, str], ...]  # axis and record file of each component
    scale: float  # factor on the acceleration [-]
    seen: dict[str, float]  # 1, 0, or NaN where nobody knows, by event

    @property
    def motion(self) -> str:
        """The files, by which trials are counted as of one motion whatever their scale."""
        return " ".join(word if len(self.files) == 1 else f"{axis}={word}" for axis, word in self.files)


@dataclass(frozen=True)
class UntakenRow:
    """A row that could not be taken, and why."""

    line: int
    reason: str


@dataclass(frozen=True)
class Outcomes:
    """What a table says."""

    source: str
    trials: tuple[Trial, ...]
    refused: tuple[UntakenRow, ...]
    ignored: tuple[str, ...]  # columns that were not read

    @classmethod
    def read(cls, path: Path) -> "Outcomes":
        """Return what a file says, each row checked by itself."""
        if path.stat().st_size > MOST_BYTES:
            raise InvalidValueError(f"{path.name}: a table must be below {MOST_BYTES >> 20} MiB; another kind of file?")
        try:
            text = path.read_bytes().decode("utf-8-sig")
        except UnicodeDecodeError as error:
            raise InvalidValueError(f'{path.name} is not UTF-8 text: save it as "CSV UTF-8"') from error
        return cls.parsed(text, path.name)

    @classmethod
    def parsed(cls, text: str, source: str) -> "Outcomes":
        r"""Return what a text says.

        >>> found = Outcomes.parsed("motion;scale;overturned\na.at2;1,5;yes\nb.at2;2;perhaps", "seen.csv")
        >>> found.trials[0].scale, found.refused[0].reason
        (1.5, "overturned must be 1, 0, yes, no, true, false or empty, got 'perhaps'")
        """
        delimiter = _delimiter(text)
        if delimiter is None:
            raise InvalidValueError(f"{source}: {_HOW}")
        (_, head), *rows = rows_of(text, delimiter, source)
        titles = [title.strip().casefold() for title in head]
        _check_titles(titles, source)
        rows = [(line, cells) for line, cells in rows if any(cell.strip() for cell in cells)]
        numbers = (dict(zip(titles, cells, strict=False)).get("scale", "") for _, cells in rows)
        mark = DecimalMark(numbers, comma_delimited=delimiter == ",")
        trials, refused = [], []
        for line, cells in rows:
            try:
                trials.append(_trial(line, cells, titles, mark))
            except InvalidValueError as error:
                refused.append(UntakenRow(line, str(error)))
        ignored = (raw.strip() for raw, title in zip(head, titles, strict=True) if title and title not in COLUMNS)
        return cls(source, tuple(trials), tuple(refused), tuple(ignored))


def is_outcomes(path: Path) -> bool:
    """Return whether the first line of a file names what was seen. Never raises."""
    try:
        with path.open("rb") as file:
            return _delimiter(file.read(10_000).decode("utf-8-sig", "replace")) is not None
    except OSError:
        return False


def _delimiter(text: str) -> str | None:
    first = next((line for line in text.splitlines() if line.strip()), "")
    for mark in ",;\t":
        if "overturned" in (title.strip().casefold() for title in next(csv.reader([first], delimiter=mark), [])):
            return mark
    return None


def _check_titles(titles: Sequence[str], source: str) -> None:
    if twice := next((title for title in titles if title and titles.count(title) > 1), None):
        raise InvalidValueError(f"{source}: column {twice!r:.60} stands twice; leave one")
    if ("motion" in titles) == ("x" in titles):
        raise InvalidValueError(f"{source}: give the column motion, or x with y and z, and not both; {_HOW}")
    if "motion" in titles and (odd := [axis for axis in AXES if axis in titles]):
        raise InvalidValueError(f"{source}: column {odd[0]!r} goes with x: name the column motion x")
    for title in titles:
        words = set(title.replace("_", " ").replace("-", " ").split())
        near = [*(words & set(COLUMNS)), *difflib.get_close_matches(title, COLUMNS, n=1, cutoff=0.75)]
        if title not in COLUMNS and near:  # what it says would change the answer, so it must not be passed over
            raise InvalidValueError(f"{source}: column {title!r:.60} is not known; did you mean {near[0]!r}? Rename it")


def _trial(line: int, cells: Sequence[str], titles: Sequence[str], mark: DecimalMark) -> Trial:
    if len(cells) != len(titles):
        hint = "a decimal comma between commas?" if len(cells) > len(titles) else "a separator missing?"
        raise InvalidValueError(f"it has {len(cells)} fields, the first line {len(titles)}; {hint}")
    row = {title: cell.strip() for title, cell in zip(titles, cells, strict=True)}
    files = tuple((axis, row[key]) for axis, key in (("x", "motion"), *((a, a) for a in AXES)) if row.get(key))
    if not files or files[0][0] != "x":
        raise InvalidValueError(f"{'motion' if 'motion' in row else 'x'} is empty: the name of a record file")
    scale = mark.number("scale", row["scale"]) if row.get("scale") else 1.0
    if scale == 0.0:
        raise InvalidValueError("scale must not be 0: nothing would move")
    seen = {}
    for column, event in EVENTS.items():
        word = row.get(column, "").casefold()
        if word not in _SEEN:
            raise InvalidValueError(f"{column} must be 1, 0, yes, no, true, false or empty, got {row[column]!r:.60}")
        seen[event] = _SEEN[word]
    return Trial(line, files, scale, seen)


def column(trials: Sequence[Trial], event: str) -> FloatArray:
    """Return what was seen of an event, one entry a trial."""
    return np.array([trial.seen[event] for trial in trials], dtype=np.float64)
