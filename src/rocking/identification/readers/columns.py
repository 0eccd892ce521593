"""Tables of measurements, columns by name and unit; rotation from displacement or acceleration above the base."""

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
    """Return the rotation of a point that moves to the right, from where it stands at rest.

    The point turns about the foot below, so its distance from the vertical through that foot changes by little:
    sin(theta) = u / height, to the second order in theta times the half width over the height.
    """
    most = float(np.abs(displacement).max())
    if most > _STEEPEST * height:
        raise MeasurementError(
            "a displacement of {displacement:g} m at a height of {height:g} m is no rocking", displacement=most,
            height=height, hint="wrong unit?",
        )  # fmt: skip
    return np.asarray(np.arcsin(displacement / height))


def rotation_of_acceleration(
    time: FloatArray, acceleration: FloatArray, height: float
) -> tuple[FloatArray, tuple[str, ...]]:
    """Return the rotation of a sensor that turns with the body, and what there is to say against it.

    Such a sensor feels h theta'' - g theta to the right, for it tilts. That is solved for theta by frequency,
    theta = -f / (h omega^2 + g): no drift is integrated, since gravity shows which way is up.
    """
    steps = np.diff(time)
    step = float(np.median(steps))
    even = np.arange(time[0], time[-1] + 0.5 * step, step)
    felt = np.interp(even, time, acceleration)
    rest = felt.size
    # the ends are held for as long as a solution takes to forget them: sqrt(h / g) times ten
    held = int(np.ceil(10.0 * np.sqrt(height / g) / step))
    size = next_fast_len(rest + 2 * held, real=True)
    padded = np.concatenate((np.full(held, felt[0]), felt, np.full(size - rest - held, felt[-1])))
    omega = 2.0 * np.pi * rfftfreq(size, step)
    rotation = -irfft(rfft(padded) / (height * omega**2 + g), size)[held : held + rest]
    doubts = [
        "a rotation from an acceleration leaves out the centripetal part, of the half width times its speed squared"
    ]
    if np.abs(steps - step).max() > _EVEN * step:
        doubts.append("its time stamps are uneven: the acceleration was interpolated")
    return np.interp(time, even, rotation), tuple(doubts)


_ANGLES = {"rad": 1.0, "mrad": 1e-3, "deg": math.pi / 180.0, "\N{DEGREE SIGN}": math.pi / 180.0}
UNITS = {
    "rotation": _ANGLES,
    "angular velocity": {f"{unit}/s": factor for unit, factor in _ANGLES.items()} | {"dps": math.pi / 180.0},
    "displacement": LENGTH_UNITS,
    "acceleration": ACCELERATION_UNITS,
}
"""Units by kind of sensor; no unit stands twice, so that it says which kind it is."""

TIME_UNITS = {"s": 1.0, "ms": 1e-3, "us": 1e-6}

_NEEDS_HEIGHT = ("displacement", "acceleration")
_NAMED_TIME = re.compile(r"time|t|zeit|temps|tiempo|tempo|timestamp", re.IGNORECASE)
_BRACKETS = re.compile(r"(.*?)\s*[\[(]\s*([^\[\]()]*?)\s*[\])]")
_JITTER, _DROPPED = 0.02, 1.5


@dataclass(frozen=True)
class ReaderOptions:
    """What was asked for beside a file."""

    kind: str | None = None
    column: str | None = None
    unit: str | None = None
    time_column: str | None = None
    time_unit: str | None = None
    height: float | None = None
    region: Sequence[float] | None = None
    frame_rate: float | None = None

    def names(self, *beside: str) -> str:
        """Return which were given, the kind and others apart, in words."""
        given = (one.name for one in fields(self) if getattr(self, one.name) is not None)
        return ", ".join(name for name in given if name not in ("kind", *beside))


@dataclass(frozen=True, eq=False)
class MeasuredTable:
    """Columns by name."""

    source: Source
    names: tuple[str, ...]  # without units
    units: tuple[str | None, ...]  # as they stand in brackets
    values: FloatArray

    @classmethod
    def of(cls, source: Source) -> "MeasuredTable":
        """Read a table, text or a sheet of a workbook."""
        sheet = source.name.lower().endswith(".xlsx")
        texts, values = _sheet(source) if sheet else _text(source)
        if values.shape[0] < 2:
            raise source.error(None, "at least 2 rows of numbers are needed, found {count}", count=values.shape[0])
        found = [_BRACKETS.fullmatch(text) for text in texts]
        names = tuple(one[1] if one else text for one, text in zip(found, texts, strict=True))
        return cls(source, names, tuple(one[2] or None if one else None for one in found), values)

    def place(self, what: str, name: str) -> int:
        """Return where a named column is."""
        called = [place for place, own in enumerate(self.names) if own.casefold() == name.strip().casefold()]
        if len(called) != 1:
            raise self.source.error(
                None, "{argument}={column!r:.60} names {count} of {columns}", argument=what, column=name,
                count=len(called), columns=self.listed(),
            )  # fmt: skip
        return called[0]

    def times(self, options: ReaderOptions) -> int | None:
        """Return where the times are, by their name."""
        if options.time_column is not None:
            return self.place("time_column", options.time_column)
        called = [place for place, name in enumerate(self.names) if _NAMED_TIME.fullmatch(name.strip())]
        if len(called) > 1:
            raise self.source.error(None, "several columns are called a time", hint=self.to_state("time_column"))
        return called[0] if called else None

    def unit(self, place: int, given: str | None, argument: str) -> str:
        """Return the unit of a column, from the table or as given; the two must not contradict each other."""
        stated = self.units[place]
        if stated is None and given is None:
            name = self.names[place]
            hint = Message(f"write {name} [unit], or give {{option}}", {"option": Option(f"measurement.{argument}")})
            raise self.source.error(None, "column {column!r} states no unit", column=name, hint=hint)
        if None not in (stated, given) and stated != given:
            raise self.source.error(
                None, "column {column!r} is in {stated}, {argument}={requested!r} was given", column=self.names[place],
                stated=stated, argument=argument, requested=given,
            )  # fmt: skip
        return str(stated if given is None else given)

    def to_state(self, argument: str) -> Message:
        """Return the hint that the name of a column has to be stated."""
        return Message(
            "say {option} one of {names}", {"option": Option(f"measurement.{argument}"), "names": self.listed()}
        )

    def listed(self) -> str:
        """Return the names of all columns."""
        return ", ".join(map(repr, self.names))


def impact_list(source: Source, options: ReaderOptions) -> ImpactTimes:
    """Return the times of impacts that a column lists."""
    if options.height is not None:
        raise source.error(None, "a list of times takes no {option}", option=Option("measurement.height"))
    table = MeasuredTable.of(source)
    name = options.column if options.column is not None else options.time_column
    place = table.place("column", name) if name is not None else table.times(options)
    if place is None:
        if len(table.names) > 1:
            raise source.error(None, "which column has the times of impacts?", hint=table.to_state("column"))
        place = 0
    unit = table.unit(place, options.unit if options.unit is not None else options.time_unit, "unit")
    factor = TIME_UNITS[checks.one_of("unit of the times", unit, TIME_UNITS)]
    return ImpactTimes(_increasing(table, place, factor), source=source.name)


def motion_series(source: Source, options: ReaderOptions) -> RotationSeries | ImpactTimes:
    """Return how a body turned, by one column against the times; times alone can be those of impacts only."""
    table = MeasuredTable.of(source)
    at = table.times(options)
    if len(table.names) == 1 and options.kind is None and (at is not None or table.units[0] in TIME_UNITS):
        return impact_list(source, options)
    if at is None:
        hint = table.to_state("time_column")
        raise source.error(None, "which column is the time? One that is called time [s] is taken", hint=hint)
    factor = TIME_UNITS[checks.one_of("unit of the times", table.unit(at, options.time_unit, "time_unit"), TIME_UNITS)]
    others = [place for place in range(len(table.names)) if place != at]
    if options.column is None and len(others) != 1:
        raise source.error(None, "which column was measured?", hint=table.to_state("column"))
    place = others[0] if options.column is None else table.place("column", options.column)
    unit = table.unit(place, options.unit, "unit")
    kind = _kind(table, unit, options.kind)
    if (kind in _NEEDS_HEIGHT) != (options.height is not None):
        raise source.error(
            None,
            "{quantity}: give {option} of the sensor [m]" if options.height is None
            else "{quantity}: takes no {option} of the sensor [m]",
            quantity=kind, option=Option("measurement.height"),
        )  # fmt: skip
    time = _increasing(table, at, factor)
    values = table.values[:, place] * UNITS[kind][unit]
    doubts = clock_doubts(time)
    if kind == "angular velocity":
        return RotationSeries(time, angular_velocity=values, source=source.name, doubts=doubts)
    if kind == "displacement":
        values = rotation_of_displacement(values, checks.length("height", options.height))
    elif kind == "acceleration":
        values, said = rotation_of_acceleration(time, values, checks.length("height", options.height))
        doubts += said
    felt = kind == "acceleration"
    return RotationSeries(time, rotation=values, source=source.name, doubts=doubts, from_acceleration=felt)


def clock_doubts(time: FloatArray) -> tuple[str, ...]:
    """Return what the times say against their clock: how far they scatter, and where samples are missing."""
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
        known = ", ".join(unit for units in UNITS.values() for unit in units)
        raise table.source.error(None, "unit {unit!r} is none of {units}", unit=unit, units=known)
    if options not in (None, kinds[0]):
        raise table.source.error(
            None, "{unit} is a unit of {quantity}, kind={kind!r} was asked for", unit=unit, quantity=kinds[0],
            kind=options,
        )  # fmt: skip
    return kinds[0]


def _increasing(table: MeasuredTable, place: int, factor: float) -> FloatArray:
    times = table.values[:, place] * factor
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
        raise source.error(0, "names of the columns expected, with their units, such as: time [s], rotation [rad]")
    return text.names, text.numbers()


def _sheet(source: Source) -> tuple[tuple[str, ...], FloatArray]:
    book = extra("openpyxl", "reading a workbook").load_workbook(
        io.BytesIO(source.content), read_only=True, data_only=True
    )
    rows = [row for row in book.worksheets[0].iter_rows(values_only=True) if any(cell is not None for cell in row)]
    if not rows or not all(isinstance(cell, str) for cell in rows[0]):
        raise source.error(0, "the first row of the first sheet must hold the names of the columns, with their units")
    values = np.empty((len(rows) - 1, len(rows[0])))
    for line, row in enumerate(rows[1:], 1):
        for place, cell in enumerate(row):
            if isinstance(cell, bool) or not isinstance(cell, int | float) or not math.isfinite(cell):
                raise source.error(
                    None, "row {row}: number expected, found {cell}{gap}", row=line + 1, cell=f"{cell!r:.40}",
                    gap=gap_words(str(cell)),
                )  # fmt: skip
            values[line - 1, place] = cell
    return tuple(str(cell).strip() for cell in rows[0]), values
