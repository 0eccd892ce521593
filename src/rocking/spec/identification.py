"""A measurement of a body that rocks freely, or a folder of trials: what each says, and all of them together."""

import csv
import hashlib
import json
import math
import os
import re
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cached_property
from multiprocessing import get_context
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.special import stdtrit

from rocking.answers import Answer
from rocking.bodies import Body
from rocking.bodies.formats import FORMATS
from rocking.conventions import FEET, NORMAL_95
from rocking.errors import InvalidValueError, RockingError, located
from rocking.exported import Exported
from rocking.identification import Identification, IntervalEstimate, ModelComparison, identify, read_measurement
from rocking.identification.readers.reader import ENDINGS, SOUNDS, TEXTS
from rocking.identification.results import compared
from rocking.messages import Message, by_key
from rocking.quantities import Quantity
from rocking.spec.bodies import body_of
from rocking.spec.construction import motion_of
from rocking.spec.reading import InputFiles
from rocking.tables import Column, Table, text_array, to_csv
from rocking.tables.table import written_whole
from rocking.version import SOFTWARE

if TYPE_CHECKING:
    from rocking.spec.documents.identification import IdentificationDocument

Row = dict[str, Any]

_NUMBERS = {
    "coefficient": ("1", "coefficient of restitution, geometric mean of both sides"),
    "coefficient_left": ("1", "coefficient of restitution landing left"),
    "coefficient_right": ("1", "coefficient of restitution landing right"),
    "scatter": ("1", "standard deviation of ln r from impact to impact"),
    "frequency_parameter": ("rad/s", "p, mean of both sides"),
    "tilt": ("rad", "tilt of the floor, clockwise"),
}
_ENDS = {"": "", "_low": ", 2.5 % of it", "_high": ", 97.5 % of it"}
_TEXTS = {
    "trial": "file",
    "refused": "why there is no coefficient; empty if there is one",
    "doubts": "what else there is to say against it",
    "question": "hash of the file and of what was asked of it",
}
_FEW, _EVERY = 12, 1.0  # trials for which no process is started; seconds after which the table is written again


@dataclass(frozen=True)
class IdentificationProblem:
    """What was measured, of which body, and what else is known."""

    path: Path  # a file, or a folder of trials
    body: Body | None
    reading: dict[str, Any]  # as `read_measurement` takes it
    options: dict[str, Any]  # as `identify` takes it

    @classmethod
    def of(cls, document: "IdentificationDocument", inputs: InputFiles) -> "IdentificationProblem":
        """Return what a file describes; inputs: files that it may name."""
        body = None
        if document.body is not None:
            with located("body"):
                body = body_of(document.body, inputs)
        reading = document.measurement.model_dump(exclude_none=True, exclude={"file"})
        path = inputs.folder / document.measurement.file
        options = document.identify.model_dump(exclude_none=True)
        if document.motion is not None:
            with located("motion"):
                options["motion"] = motion_of(document.motion, inputs).scaled(document.motion.scale)
        return cls(path, body, reading, options)

    @property
    def trials(self) -> list[Path]:
        """The recordings of the folder."""
        return self._sorted_out[0]

    @property
    def passed_over(self) -> dict[str, str]:
        """The other files of the folder, and the reason why each is no recording; hidden and body files apart."""
        return self._sorted_out[1]

    @cached_property
    def _sorted_out(self) -> tuple[list[Path], dict[str, str]]:
        try:
            there = sorted(self.path.iterdir())
        except OSError as error:
            raise InvalidValueError(error.strerror or str(error)).at(str(self.path)) from error
        trials, others = [], {}
        for path in there:
            if path.name[:1] == "." or (path.suffix.lower() in FORMATS and path.is_file()):
                continue
            reason = _no_recording(path)
            if reason:
                others[path.name] = reason
            else:
                trials.append(path)
        if not trials:
            found = f"; passed over: {passed_over_words(others)}" if others else ""
            raise InvalidValueError(
                "no trials; their names end in {endings}, and tables hold numbers{files}", endings=", ".join(ENDINGS),
                files=found,
            ).at(str(self.path))  # fmt: skip
        return trials, others

    def answer(self, path: Path | None = None) -> Identification:
        """Return what one measurement says."""
        # in a folder, what is said of tables is not of sounds
        reading = {} if path is not None and path.suffix.lower() in SOUNDS else self.reading
        return identify(read_measurement(path or self.path, **reading), self.body, **self.options)

    def answers(
        self, keep: Path | None = None, workers: int | None = None, progress: Callable[[int], None] | None = None
    ) -> "IdentifiedTrials":
        """Return what every trial of the folder says; keep: a table, gone on with, and written on the way."""
        trials = self.trials
        hashes = {path: self._question(path) for path in trials}
        known = {row["question"]: row for row in _rows_in(keep) if not row["refused"]} if keep is not None else {}
        rows = {path: known[each] | {"trial": path.name} for path, each in hashes.items() if each in known}
        if progress is not None:
            progress(len(rows))
        missing = [path for path in trials if path not in rows]
        with _kept(keep, rows):
            written = time.monotonic()
            for path, row in self._each(missing, workers):
                rows[path] = row | {"trial": path.name, "question": hashes[path]}
                if keep is not None and time.monotonic() - written > _EVERY:
                    _write(rows, keep)
                    written = time.monotonic()
                if progress is not None:
                    progress(1)
        every = tuple(rows[path] for path in trials)
        return IdentifiedTrials(self.path.name, self.body, every, len(missing), self.passed_over)

    def _each(self, paths: list[Path], workers: int | None) -> Iterator[tuple[Path, Row]]:
        count = min(workers or os.cpu_count() or 1, len(paths))
        if count < 2 or len(paths) <= _FEW:
            yield from ((path, self._row(path)) for path in paths)
            return
        with ProcessPoolExecutor(count, get_context("spawn")) as pool:
            waiting = {pool.submit(self._row, path): path for path in paths}
            try:
                for done in as_completed(waiting):
                    yield waiting[done], done.result()
            finally:
                pool.shutdown(cancel_futures=True)

    def _row(self, path: Path) -> Row:
        """Return what one trial says; one that cannot be read touches no other."""
        try:
            found = self.answer(path)
        except RockingError as error:
            return _row_of(_by_key(error.without_file(path.name)), ())
        if found.refused:
            return _row_of("; ".join(map(_by_key, found.refused)), found.doubts)
        numbers = {"coefficient": found.mean, **{f"coefficient_{foot}": found.coefficients[foot] for foot in FEET}}
        numbers |= {name: getattr(found, name) for name in ("scatter", "frequency_parameter", "tilt")}
        return _row_of("", found.doubts, len(found.impacts), found._common, numbers)

    def _question(self, path: Path) -> str:
        """Return a hash of everything that a row hangs on."""
        sides = [self.body.side(foot) for foot in FEET] if self.body is not None else []
        body = [(each.slenderness_angle, each.frequency_parameter) for each in sides]
        asked = json.dumps([SOFTWARE, body, self.reading, self.options], sort_keys=True, default=_digest)
        return hashlib.sha256(asked.encode() + path.suffix.lower().encode() + path.read_bytes()).hexdigest()[:32]


@dataclass(frozen=True, eq=False)
class IdentifiedTrials(Exported):
    """What the trials of a folder say."""

    name: str  # of the folder
    body: Body | None
    rows: tuple[Row, ...]  # by the names of the columns
    computed: int  # how many were, and not taken from a table
    # other files of the folder, and the reason why each is no recording
    passed_over: Mapping[str, str] = field(default_factory=dict)

    @property
    def good_rows(self) -> list[Row]:
        """Trials that have a coefficient."""
        return [row for row in self.rows if not row["refused"]]

    @property
    def good(self) -> int:
        """How many have a coefficient."""
        return len(self.good_rows)

    @cached_property
    def mean(self) -> IntervalEstimate | None:
        """Geometric mean of all trials and its interval; None of fewer than two.

        It is from how trials differ, by Student's t, or from their own intervals where these say more; the error of the
        size of the body, common to all, is added.
        """
        good = self.good_rows
        if len(good) < 2:
            return None
        ln, common = np.log([row["coefficient"] for row in good]), np.array([row["common"] for row in good])
        within = np.log([row["coefficient_high"] / row["coefficient_low"] for row in good]) / (2.0 * NORMAL_95)
        between = float(stdtrit(ln.size - 1, 0.975)) * float(ln.std(ddof=1))
        own = NORMAL_95 * math.sqrt(float(np.mean(np.maximum(within**2 - common**2, 0.0))))
        reach = math.hypot(max(between, own) / math.sqrt(ln.size), NORMAL_95 * math.sqrt(float(np.mean(common**2))))
        middle = float(ln.mean())
        return IntervalEstimate(*(math.exp(middle + each) for each in (0.0, -reach, reach)))

    @cached_property
    def models(self) -> tuple[ModelComparison, ...]:
        """Models of restitution beside the mean."""
        return compared(self.body, self.mean) if self.body is not None and self.mean is not None else ()

    @property
    def doubts(self) -> tuple[str, ...]:
        """Trials that say the same to nine digits: two files of one event, which counts twice."""
        seen: dict[tuple[Any, ...], list[str]] = {}
        for row in self.rows:
            if not row["refused"]:
                same = (
                    row["impacts"],
                    *(f"{row[name]:.9g}" for name in ("coefficient", "coefficient_low", "coefficient_high", "scatter")),
                )
                seen.setdefault(same, []).append(row["trial"])
        return tuple(
            f"{' and '.join(names)} say the same: perhaps they are of one event, which counts {len(names)} times."
            for names in seen.values() if len(names) > 1
        )  # fmt: skip

    @property
    def passed_over_verdict(self) -> str:
        """Number of files that are no recordings, with their names and reasons; empty without any."""
        count = len(self.passed_over)
        what = "1 file that is no recording" if count == 1 else f"{count} files that are no recordings"
        return f"Passed over {what}: {passed_over_words(self.passed_over)}." if count else ""

    @property
    def verdict(self) -> str:
        """What was found, in a sentence."""
        count = f"{self.good} of {len(self.rows)} trials"
        if self.mean is None:
            return f"{count} have a coefficient of restitution; the mean needs two or more."
        spread = float(np.log([row["coefficient"] for row in self.good_rows]).std(ddof=1))
        return (
            f"The coefficient of restitution is {self.mean}, the mean of {count}; from trial to trial it scatters by "
            f"{100.0 * spread:.2g} %."
        )

    def answer(self) -> Answer:
        """Return everything that is shown."""
        return Answer({
            "verdict": self.verdict,
            "doubts": self.doubts,
            "mean": None if self.mean is None else vars(self.mean),
            "models": [vars(each) for each in self.models],
            "trials": self.rows,
            "passed_over": dict(self.passed_over),
        }, {"mean": Quantity("mean", "1", "mean coefficient of restitution")})  # fmt: skip

    def exported(self) -> Table:
        """Return what files of it hold: one row a trial."""
        return _table(self.rows, {"verdict": self.verdict, "software": SOFTWARE})


def passed_over_words(others: Mapping[str, str]) -> str:
    """Return files and the reasons why they are no recordings, those of one reason together.

    >>> passed_over_words({"a.jpg": "another kind of file", "b.doc": "another kind of file", "c.csv": "no row"})
    'a.jpg, b.doc (another kind of file); c.csv (no row)'
    """
    names = {reason: [name for name, each in others.items() if each == reason] for reason in others.values()}
    return "; ".join(f"{', '.join(each)} ({reason})" for reason, each in names.items())


def _no_recording(path: Path) -> str:
    """Return why a file is no recording, whatever its content may be worth; empty if it is one."""
    if not path.is_file():
        return "a folder" if path.is_dir() else "not a file"
    if path.suffix.lower() not in ENDINGS:
        return "another kind of file"
    if is_table(path):
        return "a table of results of trials"
    if path.suffix.lower() in TEXTS and not _has_numbers(path):
        return "no row of numbers"
    return ""


_CELLS = re.compile(r"[;,\t ]+")
_CELL = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)?|nan", re.IGNORECASE)


def _has_numbers(path: Path) -> bool:
    """Return whether a line of a text holds numbers alone."""
    with path.open(encoding="utf-8", errors="replace") as lines:
        cells = ([cell for cell in _CELLS.split(line.strip()) if cell] for line in lines)
        return any(row and all(map(_CELL.fullmatch, row)) for row in cells)


def is_table(path: Path) -> bool:
    """Return whether a file is a table of trials. Never raises."""
    return path.suffix.lower() == ".csv" and _header_of(path) == _table(()).header


def bodies_in(folder: Path) -> list[Path]:
    """Return the files of a folder that hold a body, or seem to."""
    return sorted(path for path in folder.iterdir() if path.suffix.lower() in FORMATS and path.is_file())


def _by_key(reason: RockingError | Message | str) -> str:
    return reason.spelt(by_key) if isinstance(reason, (Message, RockingError)) else reason


def _row_of(
    refused: str,
    doubts: Iterable[str | Message],
    impacts: int = 0,
    common: float = math.nan,
    numbers: Mapping[str, IntervalEstimate] = MappingProxyType({}),
) -> Row:
    none = IntervalEstimate(math.nan, math.nan, math.nan)
    row: Row = {"refused": refused, "doubts": " ".join(map(_by_key, doubts)), "impacts": impacts, "common": common}
    for name in _NUMBERS:
        each = numbers.get(name, none)
        row |= {name: each.value, f"{name}_low": each.low, f"{name}_high": each.high}
    return row


def _table(rows: Iterable[Row], provenance: Mapping[str, Any] | None = None) -> Table:
    listed = list(rows)
    columns = {"trial": Column(text_array([row["trial"] for row in listed]), "", _TEXTS["trial"])}
    columns["impacts"] = Column(np.array([row["impacts"] for row in listed], dtype=np.int64), "1", "that count")
    for name, (unit, meaning) in _NUMBERS.items():
        for end, more in _ENDS.items():
            values = np.array([row[f"{name}{end}"] for row in listed], dtype=np.float64)
            columns[f"{name}{end}"] = Column(values, unit, f"{meaning}{more}")
    common = np.array([row["common"] for row in listed], dtype=np.float64)
    columns["common"] = Column(common, "1", "standard deviation of ln r from the size of the body, common to all")
    for name in ("refused", "doubts", "question"):
        columns[name] = Column(text_array([row[name] for row in listed]), "", _TEXTS[name])
    return Table("trial", columns, provenance or {})


def _digest(motion: Any) -> str:
    """Return what tells a motion from others."""
    values = getattr(motion, "acceleration", np.zeros(0))
    return f"{motion!r} {hashlib.sha256(np.ascontiguousarray(values).tobytes()).hexdigest()}"


def _header_of(path: Path) -> list[str]:
    try:
        with path.open(newline="", encoding="utf-8") as file:
            return next(csv.reader(file), [])
    except (OSError, UnicodeDecodeError, csv.Error):
        return []


def _rows_in(path: Path) -> list[Row]:
    """Return the rows of a table of trials, none of a file that is not such a table or of a line that was cut off."""
    table = _table(())
    if not is_table(path):
        return []
    rows = []
    with path.open(newline="", encoding="utf-8") as file:
        for cells in list(csv.reader(file))[1:]:
            try:
                row: Row = dict(zip(table.columns, cells, strict=True))
                row["impacts"] = int(row["impacts"])
                numbers = (name for name, each in table.columns.items() if each.values.dtype == np.float64)
                rows.append(row | {name: float(row[name] or "nan") for name in numbers})
            except ValueError:
                continue
    return rows


@contextmanager
def _kept(path: Path | None, rows: dict[Path, Row]) -> Iterator[None]:
    """Write what there is, however it ends."""
    try:
        yield
    finally:
        if path is not None:
            _write(rows, path)


def _write(rows: dict[Path, Row], path: Path) -> None:
    """Write a table in one go, so that it is whole at any instant."""
    with written_whole(path) as part:
        to_csv(_table(rows[each] for each in sorted(rows)), part)
