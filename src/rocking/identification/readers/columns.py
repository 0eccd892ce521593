"""Tables of measurements with columns by name and unit, and rotation from a displacement or an acceleration."""

import io
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from scipy.fft import irfft, next_fast_len, rfft, rfftfreq

from rocking import checks
from rocking.conventions import ACCELERATION_UNITS, LENGTH_UNITS, FloatArray, g
from rocking.errors import MeasurementError, extra
from rocking.identification.measurement import ImpactTimes, RotationSeries
from rocking.messages import Message, Option
from rocking.motions.formats.column_text import ColumnText
from rocking.motions.formats.numbers import gap_words
from rocking.motions.formats.record import Source

_EVEN = 0.5
_STEEPEST = 0.95


def rotation_of_displacement(displacement: FloatArray, height: float) -> FloatArray:
    """Return the rotation from the displacement of a point to the right, zero at rest.

    The point rotates about the foot below, so sin(theta) = u / height. The error is of second order in theta, times
    half width / height.
    """
    most = float(np.abs(displacement).max())
    if most > _STEEPEST * height:
        raise MeasurementError(
            "a displacement of {displacement:g} m at a height of {height:g} m is too large for rocking",
            displacement=most, height=height, hint="check the unit",
        )  # fmt: skip
    return np.asarray(np.arcsin(displacement / height))


def rotation_of_acceleration(
    time: FloatArray, acceleration: FloatArray, height: float
) -> tuple[FloatArray, tuple[str, ...]]:
    """Return the rotation from the acceleration of a sensor on the body, and doubts.

    The sensor tilts, so it measures h theta'' - g theta to the right. The equation is solved for theta at each
    frequency: theta = -f / (h omega^2 + g). Gravity defines the vertical, so that no drift is integrated.
    """
    steps = np.diff(time)
    step = float(np.median(steps))
    even = np.arange(time[0], time[-1] + 0.5 * step, step)
    felt = np.interp(even, time, acceleration)
    count = felt.size
    # constant values are added at both ends for ten time constants sqrt(h / g), until their influence decays
    padding = int(np.ceil(10.0 * np.sqrt(height / g) / step))
    size = next_fast_len(count + 2 * padding, real=True)
    padded = np.concatenate((np.full(padding, felt[0]), felt, np.full(size - count - padding, felt[-1])))
    omega = 2.0 * np.pi * rfftfreq(size, step)
    rotation = -irfft(rfft(padded) / (height * omega**2 + g), size)[padding : padding + count]
    doubts = [
        "a rotation from an acceleration excludes the centripetal part, the half width times the squared angular "
        "velocity"
    ]
    if np.abs(steps - step).max() > _EVEN * step:
        doubts.append("the time stamps are uneven: the acceleration was interpolated")
    return np.interp(time, even, rotation), tuple(doubts)


_ANGLES = {"rad": 1.0, "mrad": 1e-3, "deg": math.pi / 180.0, "\N{DEGREE SIGN}": math.pi / 180.0}
UNITS = {
    "rotation": _ANGLES,
    "angular velocity": {f"{unit}/s": factor for unit, factor in _ANGLES.items()} | {"dps": math.pi / 180.0},
    "displacement": LENGTH_UNITS,
    "acceleration": ACCELERATION_UNITS,
}
"""Units by kind of sensor. Each unit belongs to one kind."""

TIME_UNITS = {"s": 1.0, "ms": 1e-3, "us": 1e-6}

_NEEDS_HEIGHT = ("displacement", "acceleration")
_NAMED_TIME = re.compile(r"time|t|zeit|temps|tiempo|tempo|timestamp", re.IGNORECASE)
_BRACKETS = re.compile(r"(.*?)\s*[\[(]\s*([^\[\]()]*?)\s*[\])]")
_JITTER, _DROPPED = 0.02, 1.5


@dataclass(frozen=True)
class ReaderOptions:
    """Options of the user for one file."""

    kind: str | None = None
    column: str | None = None
    unit: str | None = None
    time_column: str | None = None
    time_unit: str | None = None
    height: float | None = None
    region: Sequence[float] | None = None
    frame_rate: float | None = None

    def names(self, *excluded: str) -> str:
        """Return the names of the stated options as text, without the kind and the excluded options."""
        stated = (option.name for option in fields(self) if getattr(self, option.name) is not None)
        return ", ".join(name for name in stated if name not in ("kind", *excluded))


@dataclass(frozen=True, eq=False)
class MeasuredTable:
    """Columns by name."""

    source: Source
    names: tuple[str, ...]  # names without units
    units: tuple[str | None, ...]  # units from the brackets
    values: FloatArray

    @classmethod
    def read(cls, source: Source) -> "MeasuredTable":
        """Read a table from text or from a sheet of a workbook."""
        sheet = source.name.lower().endswith(".xlsx")
        texts, values = _sheet(source) if sheet else _text(source)
        if values.shape[0] < 2:
            raise source.error(None, "at least 2 rows of numbers are needed, found {count}", count=values.shape[0])
        matches = [_BRACKETS.fullmatch(text) for text in texts]
        names = tuple(match[1] if match else text for match, text in zip(matches, texts, strict=True))
        return cls(source, names, tuple(match[2] or None if match else None for match in matches), values)

    def index_of(self, argument: str, name: str) -> int:
        """Return the index of a named column."""
        matches = [index for index, own in enumerate(self.names) if own.casefold() == name.strip().casefold()]
        if len(matches) != 1:
            raise self.source.error(
                None, "{argument}={column!r:.60} names {count} of {columns}", argument=argument, column=name,
                count=len(matches), columns=self.list_names(),
            )  # fmt: skip
        return matches[0]

    def times(self, options: ReaderOptions) -> int | None:
        """Return the index of the column of times, from its name."""
        if options.time_column is not None:
            return self.index_of("time_column", options.time_column)
        matches = [index for index, name in enumerate(self.names) if _NAMED_TIME.fullmatch(name.strip())]
        if len(matches) > 1:
            raise self.source.error(None, "several columns are named time", hint=self.hint_to_state("time_column"))
        return matches[0] if matches else None

    def unit(self, index: int, requested: str | None, argument: str) -> str:
        """Return the unit of a column from the table or from the options, which must agree."""
        stated = self.units[index]
        if stated is None and requested is None:
            name = self.names[index]
            hint = Message(f"write {name} [unit], or use {{option}}", {"option": Option(f"measurement.{argument}")})
            raise self.source.error(None, "column {column!r} states no unit", column=name, hint=hint)
        if None not in (stated, requested) and stated != requested:
            raise self.source.error(
                None, "column {column!r} is in {stated}, but {argument}={requested!r}", column=self.names[index],
                stated=stated, argument=argument, requested=requested,
            )  # fmt: skip
        return str(stated if requested is None else requested)

    def hint_to_state(self, argument: str) -> Message:
        """Return the hint to state the name of a column."""
        return Message(
            "add {option} with one of {names}",
            {"option": Option(f"measurement.{argument}"), "names": self.list_names()},
        )

    def list_names(self) -> str:
        """Return the names of all columns."""
        return ", ".join(map(repr, self.names))


def impact_list(source: Source, options: ReaderOptions) -> ImpactTimes:
    """Return the times of impacts from a column."""
    if options.height is not None:
        raise source.error(None, "{option} does not apply to a list of times", option=Option("measurement.height"))
    table = MeasuredTable.read(source)
    name = options.column if options.column is not None else options.time_column
    index = table.index_of("column", name) if name is not None else table.times(options)
    if index is None:
        if len(table.names) > 1:
            raise source.error(
                None, "several columns: the column of the impact times is unknown", hint=table.hint_to_state("column")
            )
        index = 0
    unit = table.unit(index, options.unit if options.unit is not None else options.time_unit, "unit")
    factor = TIME_UNITS[checks.one_of("unit of the times", unit, TIME_UNITS)]
    return ImpactTimes(_increasing(table, index, factor), source=source.name)


def motion_series(source: Source, options: ReaderOptions) -> RotationSeries | ImpactTimes:
    """Return the rotation from one column and the times, or the impacts from a single column of times."""
    table = MeasuredTable.read(source)
    at = table.times(options)
    if len(table.names) == 1 and options.kind is None and (at is not None or table.units[0] in TIME_UNITS):
        return impact_list(source, options)
    if at is None:
        hint = table.hint_to_state("time_column")
        raise source.error(None, "no column is named time [s]", hint=hint)
    factor = TIME_UNITS[checks.one_of("unit of the times", table.unit(at, options.time_unit, "time_unit"), TIME_UNITS)]
    others = [index for index in range(len(table.names)) if index != at]
    if options.column is None and len(others) != 1:
        raise source.error(None, "several columns: the measured column is unknown", hint=table.hint_to_state("column"))
    index = others[0] if options.column is None else table.index_of("column", options.column)
    unit = table.unit(index, options.unit, "unit")
    kind = _kind(table, unit, options.kind)
    if (kind in _NEEDS_HEIGHT) != (options.height is not None):
        raise source.error(
            None,
            "{quantity}: {option} of the sensor [m] is missing" if options.height is None
            else "{quantity}: {option} of the sensor does not apply",
            quantity=kind, option=Option("measurement.height"),
        )  # fmt: skip
    time = _increasing(table, at, factor)
    values = table.values[:, index] * UNITS[kind][unit]
    doubts = clock_doubts(time)
    if kind == "angular velocity":
        return RotationSeries(time, angular_velocity=values, source=source.name, doubts=doubts)
    if kind == "displacement":
        values = rotation_of_displacement(values, checks.length("height", options.height))
    elif kind == "acceleration":
        values, more_doubts = rotation_of_acceleration(time, values, checks.length("height", options.height))
        doubts += more_doubts
    felt = kind == "acceleration"
    return RotationSeries(time, rotation=values, source=source.name, doubts=doubts, from_acceleration=felt)


def clock_doubts(time: FloatArray) -> tuple[str, ...]:
    """Return doubts about the times: scatter of the time step and missing samples."""
    steps = np.diff(time)
    step = float(np.median(steps))
    doubts = []
    gaps = np.flatnonzero(steps > _DROPPED * step)
    if gaps.size:
        lost = int(np.rint(steps[gaps] / step - 1.0).sum())
        doubts.append(f"about {lost} samples are missing in {gaps.size} gaps, the first after {time[gaps[0]]:.4g} s")
    kept = steps[steps <= _DROPPED * step]
    jitter = float(kept.std())
    if jitter > _JITTER * step:
        doubts.append(f"time stamps scatter by {1e3 * jitter:.3g} ms about steps of {1e3 * step:.3g} ms")
    return tuple(doubts)


def _kind(table: MeasuredTable, unit: str, options: str | None) -> str:
    kinds = [kind for kind, units in UNITS.items() if unit in units]
    if not kinds:
        known_units = ", ".join(unit for units in UNITS.values() for unit in units)
        raise table.source.error(None, "unknown unit {unit!r}; allowed: {units}", unit=unit, units=known_units)
    if options not in (None, kinds[0]):
        raise table.source.error(
            None, "{unit} is a unit of {quantity}, but kind={kind!r}", unit=unit, quantity=kinds[0],
            kind=options,
        )  # fmt: skip
    return kinds[0]


def _increasing(table: MeasuredTable, index: int, factor: float) -> FloatArray:
    times = table.values[:, index] * factor
    wrong = np.flatnonzero(np.diff(times) <= 0.0)
    if wrong.size:
        row = int(wrong[0]) + 1
        raise table.source.error(
            None, "times must increase [s], got {time:g} after {before:g} in row {row} of numbers",
            time=float(times[row]), before=float(times[row - 1]), row=row + 1,
        )  # fmt: skip
    return np.asarray(times)


def _text(source: Source) -> tuple[tuple[str, ...], FloatArray]:
    if not source.is_text:
        raise source.error(None, "not a text file")
    text = ColumnText.of(source)
    if text.is_empty or text.names is None:
        raise source.error(
            0, "the names of the columns are missing; write them with units, such as: time [s], rotation [rad]"
        )
    return text.names, text.numbers()


def _sheet(source: Source) -> tuple[tuple[str, ...], FloatArray]:
    book = extra("openpyxl", "reading a workbook").load_workbook(
        io.BytesIO(source.content), read_only=True, data_only=True
    )
    rows = [row for row in book.worksheets[0].iter_rows(values_only=True) if any(cell is not None for cell in row)]
    if not rows or not all(isinstance(cell, str) for cell in rows[0]):
        raise source.error(0, "the first row of the first sheet must contain the names of the columns, with units")
    values = np.empty((len(rows) - 1, len(rows[0])))
    for line, row in enumerate(rows[1:], 1):
        for column, cell in enumerate(row):
            if isinstance(cell, bool) or not isinstance(cell, int | float) or not math.isfinite(cell):
                raise source.error(
                    None, "row {row}: number expected, found {cell}{gap}", row=line + 1, cell=f"{cell!r:.40}",
                    gap=gap_words(str(cell)),
                )  # fmt: skip
            values[line - 1, column] = cell
    return tuple(str(cell).strip() for cell in rows[0]), values
