"""Identification from one measurement, or from a folder of trials with a common mean."""

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
from rocking.messages import Message, by_key, listed
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
_ENDS = {"": "", "_low": ", 2.5 % quantile", "_high": ", 97.5 % quantile"}
_TEXTS = {
    "trial": "file",
    "refused": "reason for the missing coefficient; empty if there is one",
    "doubts": "doubts about the coefficient",
    "question": "hash of the file and of the options",
}
_FEW, _EVERY = 12, 1.0  # largest number of trials without parallel processes; interval between writes of the table [s]


@dataclass(frozen=True)
class IdentificationProblem:
    """Measurement, body and options of an identification."""

    path: Path  # a file, or a folder of trials
    body: Body | None
    reading: dict[str, Any]  # keywords of `read_measurement`
    options: dict[str, Any]  # keywords of `identify`

    @classmethod
    def of(cls, document: "IdentificationDocument", inputs: InputFiles) -> "IdentificationProblem":
        """Return the identification problem of an input file. `inputs` records the files named in the input file."""
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
        """Recordings of the folder."""
        return self._sorted_out[0]

    @property
    def passed_over(self) -> dict[str, str]:
        """Reasons why the other files of the folder are no trials, by file name; without hidden and body files."""
        return self._sorted_out[1]

    @cached_property
    def _sorted_out(self) -> tuple[list[Path], dict[str, str]]:
        try:
            paths = sorted(self.path.iterdir())
        except OSError as error:
            raise InvalidValueError(error.strerror or str(error)).at(str(self.path)) from error
        trials, others = [], {}
        for path in paths:
            if path.name[:1] == "." or (path.suffix.lower() in FORMATS and path.is_file()):
                continue
            reason = _no_recording(path)
            if reason:
                others[path.name] = reason
            else:
                trials.append(path)
        if not trials:
            ignored = f" Ignored: {passed_over_words(others)}." if others else ""
            raise InvalidValueError(
                "No trials. Use files with {endings}, and tables with numbers.{files}", endings=", ".join(ENDINGS),
                files=ignored,
            ).at(str(self.path))  # fmt: skip
        return trials, others

    def answer(self, path: Path | None = None) -> Identification:
        """Return the identification of one measurement."""
        # in a folder, the options for tables do not apply to sound files
        reading = {} if path is not None and path.suffix.lower() in SOUNDS else self.reading
        return identify(read_measurement(path or self.path, **reading), self.body, **self.options)

    def answers(
        self, keep: Path | None = None, workers: int | None = None, progress: Callable[[int], None] | None = None
    ) -> "IdentifiedTrials":
        """Return the identification of every trial. `keep` is a table of results, which is continued and saved."""
        trials = self.trials
        hashes = {path: self._question(path) for path in trials}
        kept_rows = {row["question"]: row for row in _rows_in(keep) if not row["refused"]} if keep is not None else {}
        rows = {path: kept_rows[key] | {"trial": path.name} for path, key in hashes.items() if key in kept_rows}
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
        all_rows = tuple(rows[path] for path in trials)
        return IdentifiedTrials(self.path.name, self.body, all_rows, len(missing), self.passed_over)

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
        """Return the row of one trial; an unreadable trial does not affect the others."""
        try:
            identification = self.answer(path)
        except RockingError as error:
            return _row_of(_by_key(error.without_file(path.name)), ())
        if identification.refused:
            return _row_of(listed(map(_by_key, identification.refused)), identification.doubts)
        numbers = {f"coefficient_{foot}": identification.coefficients[foot] for foot in FEET}
        numbers |= {"coefficient": identification.mean}
        numbers |= {name: getattr(identification, name) for name in ("scatter", "frequency_parameter", "tilt")}
        return _row_of("", identification.doubts, len(identification.impacts), identification._common, numbers)

    def _question(self, path: Path) -> str:
        """Return a hash of all inputs of a row."""
        sides = [self.body.side(foot) for foot in FEET] if self.body is not None else []
        body = [(side.slenderness_angle, side.frequency_parameter) for side in sides]
        question = json.dumps([SOFTWARE, body, self.reading, self.options], sort_keys=True, default=_digest)
        return hashlib.sha256(question.encode() + path.suffix.lower().encode() + path.read_bytes()).hexdigest()[:32]


@dataclass(frozen=True, eq=False)
class IdentifiedTrials(Exported):
    """Results of the trials of a folder."""

    name: str  # name of the folder
    body: Body | None
    rows: tuple[Row, ...]  # values by column name
    computed: int  # number of trials that were not read from a table
    # reasons why other files of the folder are no trials, by file name
    passed_over: Mapping[str, str] = field(default_factory=dict)

    @property
    def good_rows(self) -> list[Row]:
        """Rows of the trials with a coefficient."""
        return [row for row in self.rows if not row["refused"]]

    @property
    def good(self) -> int:
        """Number of trials with a coefficient."""
        return len(self.good_rows)

    @cached_property
    def mean(self) -> IntervalEstimate | None:
        """Geometric mean of all trials and its 95 % interval; None for fewer than two trials.

        The interval follows from the scatter of the trials (Student's t), or from the intervals of the trials if these
        are wider. The interval includes the common error of the body dimensions.
        """
        good_rows = self.good_rows
        if len(good_rows) < 2:
            return None
        ln, common = np.log([row["coefficient"] for row in good_rows]), np.array([row["common"] for row in good_rows])
        within = np.log([row["coefficient_high"] / row["coefficient_low"] for row in good_rows]) / (2.0 * NORMAL_95)
        between = float(stdtrit(ln.size - 1, 0.975)) * float(ln.std(ddof=1))
        own = NORMAL_95 * math.sqrt(float(np.mean(np.maximum(within**2 - common**2, 0.0))))
        half_width = math.hypot(
            max(between, own) / math.sqrt(ln.size), NORMAL_95 * math.sqrt(float(np.mean(common**2)))
        )
        mean_ln = float(ln.mean())
        return IntervalEstimate(*(math.exp(mean_ln + offset) for offset in (0.0, -half_width, half_width)))

    @cached_property
    def models(self) -> tuple[ModelComparison, ...]:
        """Comparison of the restitution models with the mean."""
        return compared(self.body, self.mean) if self.body is not None and self.mean is not None else ()

    @property
    def doubts(self) -> tuple[str, ...]:
        """Warnings about trials whose results agree to nine digits. They may be two files of one event."""
        trials_by_result: dict[tuple[Any, ...], list[str]] = {}
        for row in self.rows:
            if not row["refused"]:
                result = (
                    row["impacts"],
                    *(f"{row[name]:.9g}" for name in ("coefficient", "coefficient_low", "coefficient_high", "scatter")),
                )
                trials_by_result.setdefault(result, []).append(row["trial"])
        return tuple(
            f"{' and '.join(names)} have equal results. If they record one event, remove the duplicates."
            for names in trials_by_result.values() if len(names) > 1
        )  # fmt: skip

    @property
    def passed_over_verdict(self) -> str:
        """Number, names and reasons of the files without a recording; empty if there are none."""
        count = len(self.passed_over)
        files = "1 file" if count == 1 else f"{count} files"
        return f"Ignored {files} without a recording: {passed_over_words(self.passed_over)}." if count else ""

    @property
    def verdict(self) -> str:
        """Mean coefficient of restitution and scatter, as a sentence."""
        count = f"{self.good} of {len(self.rows)} trials"
        if self.mean is None:
            return f"{count} have a coefficient of restitution; the mean needs two or more."
        spread = float(np.log([row["coefficient"] for row in self.good_rows]).std(ddof=1))
        return (
            f"The coefficient of restitution is {self.mean}, the mean of {count}. The scatter between trials is "
            f"{100.0 * spread:.2g} %."
        )

    def answer(self) -> Answer:
        """Return all results."""
        return Answer({
            "verdict": self.verdict,
            "doubts": self.doubts,
            "mean": None if self.mean is None else vars(self.mean),
            "models": [vars(model) for model in self.models],
            "trials": self.rows,
            "passed_over": dict(self.passed_over),
        }, {"mean": Quantity("mean", "1", "mean coefficient of restitution")})  # fmt: skip

    def exported(self) -> Table:
        """Return the exported table with one row per trial."""
        return _table(self.rows, {"verdict": self.verdict, "software": SOFTWARE})


def passed_over_words(others: Mapping[str, str]) -> str:
    """Return ignored files with their reasons, grouped by reason.

    >>> passed_over_words({"a.jpg": "another kind of file", "b.doc": "another kind of file", "c.csv": "no row"})
    'a.jpg, b.doc (another kind of file); c.csv (no row)'
    """
    groups = {reason: [name for name, other in others.items() if other == reason] for reason in others.values()}
    return "; ".join(f"{', '.join(names)} ({reason})" for reason, names in groups.items())


def _no_recording(path: Path) -> str:
    """Return the reason why a file is not a recording; empty if it is a recording."""
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
    """Return True if a line of the text contains only numbers."""
    with path.open(encoding="utf-8", errors="replace") as lines:
        cells = ([cell for cell in _CELLS.split(line.strip()) if cell] for line in lines)
        return any(row and all(map(_CELL.fullmatch, row)) for row in cells)


def is_table(path: Path) -> bool:
    """Return True if a file is a table of trials. This function never raises an error."""
    return path.suffix.lower() == ".csv" and _header_of(path) == _table(()).header


def bodies_in(folder: Path) -> list[Path]:
    """Return the files of a folder with the extension of a body file."""
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
        estimate = numbers.get(name, none)
        row |= {name: estimate.value, f"{name}_low": estimate.low, f"{name}_high": estimate.high}
    return row


def _table(rows: Iterable[Row], provenance: Mapping[str, Any] | None = None) -> Table:
    listed = list(rows)
    columns = {"trial": Column(text_array([row["trial"] for row in listed]), "", _TEXTS["trial"])}
    columns["impacts"] = Column(
        np.array([row["impacts"] for row in listed], dtype=np.int64), "1", "number of impacts in the fit"
    )
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
    """Return a text with a hash that identifies a motion."""
    values = getattr(motion, "acceleration", np.zeros(0))
    return f"{motion!r} {hashlib.sha256(np.ascontiguousarray(values).tobytes()).hexdigest()}"


def _header_of(path: Path) -> list[str]:
    try:
        with path.open(newline="", encoding="utf-8") as file:
            return next(csv.reader(file), [])
    except (OSError, UnicodeDecodeError, csv.Error):
        return []


def _rows_in(path: Path) -> list[Row]:
    """Return the complete rows of a table of trials; empty for other files."""
    table = _table(())
    if not is_table(path):
        return []
    rows = []
    with path.open(newline="", encoding="utf-8") as file:
        for cells in list(csv.reader(file))[1:]:
            try:
                row: Row = dict(zip(table.columns, cells, strict=True))
                row["impacts"] = int(row["impacts"])
                numbers = (name for name, column in table.columns.items() if column.values.dtype == np.float64)
                rows.append(row | {name: float(row[name] or "nan") for name in numbers})
            except ValueError:
                continue
    return rows


@contextmanager
def _kept(path: Path | None, rows: dict[Path, Row]) -> Iterator[None]:
    """Write the finished rows to `path` at the end of the context, also after an error."""
    try:
        yield
    finally:
        if path is not None:
            _write(rows, path)


def _write(rows: dict[Path, Row], path: Path) -> None:
    """Write a table atomically."""
    with written_whole(path) as temporary:
        to_csv(_table(rows[trial] for trial in sorted(rows)), temporary)
