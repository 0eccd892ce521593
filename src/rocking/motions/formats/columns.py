"""Columns of numbers, with or without a line of names. A line has one value, or a time and accelerations."""

import math
import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import ClassVar

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import RecordError
from rocking.motions.formats import directions, headers
from rocking.motions.formats.column_text import (
    MARK,
    MOST_NAMED,
    SAMPLING_LINE,
    ColumnName,
    ColumnText,
    NamedColumns,
    names_on,
)
from rocking.motions.formats.column_words import HeaderWords, is_understood
from rocking.motions.formats.header_values import columns_of
from rocking.motions.formats.headers import step_between_samples, step_of_times
from rocking.motions.formats.numbers import number
from rocking.motions.formats.record import Component, Record, RecordFormat, Source, one_line

SKIP = "omit N lines above the numbers with skip=N"
_MOST_COLUMNS = 4
_AXES = "xyz"
_FEWEST_SIGN_CHANGES = 10  # of accelerations; times change their sign once, and a few times if lines are misplaced
_ALL_ACCELERATIONS = (
    "the first column is read as time; if all columns are accelerations, add a header line "
    "`# NS [cm/s2], EW [cm/s2], UD [cm/s2]`"
)
_LOOK = 5
_LONGEST_HEADER = 100


class Columns(RecordFormat):
    """Plain columns of text, for files of no other format.

    Without names, a line contains one acceleration, or a time and one to three accelerations. If the first of two or
    three columns changes its sign repeatedly, all columns are accelerations in the order x, y, z, with a warning. Names
    and numbers are separated by blanks, tabs, commas or semicolons. Lines that begin with ``#`` or ``%`` are comments.

    One line of names is allowed above the numbers: ``time [s], NS [g], EW [g]``, with the unit of a column in brackets
    or parentheses. Allowed units are the keys of `rocking.conventions.ACCELERATION_UNITS`, m/s^2, m/s/s and Gal;
    without a unit, `units` is required. A column named time, or a first column named t, contains the times in seconds.
    Columns in another unit (m/s, m, rad), or named velocity or displacement, are ignored; the metadata list them.
    Without times, `time_step` is required. If the columns are ambiguous, the error lists them and the remedy.

    Text above the numbers is allowed. The reader uses ``Time Step: 0.01``, ``acceleration in g``, ``sampling rate
    200 Hz``, ``NPTS = 600``, ``Component NS``, also in comments; other text about the sampling raises an error.
    Several columns of times with equal steps count as one column. Text after the last number, such as ``END``, gives a
    warning.

    Commas that do not separate columns are decimal commas. Files with decimal commas and decimal points, and files with
    ambiguous commas, raise an error.
    """

    name: ClassVar[str] = "columns"
    title: ClassVar[str] = "Columns of numbers: a, or t a, or t a1 a2 a3, or x y z, or under a line of names"
    suffixes: ClassVar[tuple[str, ...]] = (".txt", ".dat", ".csv")
    unit_is_free: ClassVar[bool] = True
    states_unit: ClassVar[bool] = False
    states_time_step: ClassVar[bool] = False
    notes: ClassVar[str] = (
        "Verified with five real files. Without names such as time [s], acc [g], accelerations and velocities, or g "
        "and m/s2, are not distinguishable: enter the correct unit. A missing first or last line is not detected; "
        "without times, no missing line is detected."
    )

    def recognises(self, source: Source) -> bool:
        """Return True if the first lines contain only 1 to 4 numbers each, or names and one number per name."""
        rows = _first_rows(source)
        if rows is None:
            return False
        try:
            _ = [_value(source, line, cell) for line, cells in rows for cell in cells]
        except RecordError:
            return False
        return True

    def refusal(self, source: Source) -> RecordError | None:
        """Return the error for a NaN or infinity on the first lines of otherwise valid columns."""
        rows = _first_rows(source)
        if rows is None:
            return None
        first_error: RecordError | None = None
        for line, cells in rows:
            for cell in cells:
                try:
                    _value(source, line, cell)
                except RecordError as error:
                    if not _beyond_numbers(cell):
                        return None
                    first_error = first_error or error
        return first_error

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        """Return the record with one component per column of accelerations. Without times, `time_step` is required."""
        # components without a heading are named "acceleration", or "column 2", "column 3", "column 4" after the times
        if not source.is_text:
            raise source.error(None, "not a text file")
        headers.refuse_other(source)
        text = ColumnText.of(source)
        if text.is_empty:
            raise source.error(None, "no line with numbers")
        # check NaN and infinity first, because other errors would hide them
        for line, cells in text.first[:_LOOK]:
            _ = [_value(source, line, cell) for cell in cells if _beyond_numbers(cell)]
        # if all cells are plain numbers, comments are only above the first row
        comments = _comments(source, None if text.at_once is None else text.first[0][0])
        stated = HeaderWords.of(source, [*comments, *text.preamble], len(text.first[0][1]))
        _check_words(source, text)
        names = text.names or stated.names
        wide = names is None and len(text.first[0][1]) > _MOST_COLUMNS
        if wide:
            chosen, values = _row_by_row(source, text.numbers(last_short=True))
        else:
            chosen = _by_position(source, text) if names is None else NamedColumns.of(source, names)
            values = text.numbers()
        if text.preamble and names is None:
            _check_first(source, text, values)
        if names is None:
            chosen = _without_time(source, chosen, values)
        chosen = chosen.with_one_time(source, values)
        known_step = time_step if stated.step is None else step_between_samples(source, stated.step, time_step)
        step, metadata = known_step, {}
        if chosen.time is not None:
            times, index = values[:, chosen.time.index], chosen.time.index
            with _naming_first_column(is_named=names is not None):
                step = step_of_times(source, times, text.column(index), known_step)
            metadata = {"first time": f"{times[0]:g} s"}
        step = step_between_samples(source, None, step)
        if stated.count is not None:
            headers.check_count(source, stated.count, len(values))
        chosen = chosen.with_stated_unit(source, stated.unit, stated.unknown_unit, units)
        if chosen.left_out:
            metadata["left out"] = ", ".join(chosen.left_out)
        accelerations = chosen.with_unit(source, units).accelerations
        about = _direction(stated, accelerations)
        components = tuple(
            Component(_name(column, about), values[:, column.index].copy(), column.unit or "", step, None, about)
            for column in accelerations
        )
        header = [*(text_line for _, text_line in (*comments, *text.preamble)), *filter(None, [text.heading])]
        return Record(self.name, components, "\n".join(header), metadata)

    def write(self, record: Record) -> bytes:
        """Return a file with times and one to three accelerations, separated by commas, with all digits and unit."""
        samples, step = columns_of(record, self.name, None, _MOST_COLUMNS - 1)
        named = [re.sub(r"[\[\](),;=]", " ", one_line(component.name, 40)).strip() for component in record.components]
        unit = record.components[0].unit
        heading = ", ".join(["time [s]", *(f"{name} [{unit}]" for name in named)])
        # the name is not readable in this format
        if len({name.casefold() for name in named}) < len(named) or len(names_on(heading) or ()) != len(named) + 1:
            heading = ", ".join(["time [s]", *(f"column {index + 2} [{unit}]" for index in range(len(named)))])
        lines = [f"# {heading}"]
        for index, sample in enumerate(samples):
            lines.append(",".join([f"{index * step:.9f}", *(repr(float(value)) for value in sample)]))
        return ("\n".join(lines) + "\n").encode("latin-1")


def _direction(stated: HeaderWords, accelerations: tuple[ColumnName, ...]) -> dict[str, str]:
    """Return the direction of a single column from the header. It is unclear if a vertical is only mentioned."""
    if stated.direction:
        return {"direction": stated.direction} if len(accelerations) == 1 else {}
    is_unstated = all(directions.orientation(column.name) is None for column in accelerations)
    return {directions.KEY: directions.UNCLEAR} if stated.perhaps_upright and is_unstated else {}


def _name(column: ColumnName, about: dict[str, str]) -> str:
    """Return the name of a component: the column name, or the direction from the header."""
    return about["direction"] if "direction" in about and column.name in {"acceleration", "column 2"} else column.name


def _check_words(source: Source, text: ColumnText) -> None:
    """Raise an error for header text with an unknown description of the sampling."""
    for line, text_line in text.preamble:
        if not is_understood(text_line):
            raise source.error(line, "{entry!r} is not understood", entry=text_line.strip()[:60], hint=SKIP)


def _check_first(source: Source, text: ColumnText, values: FloatArray) -> None:
    """Raise an error if the first number after header text equals the number of samples that follow."""
    first, line = values[0], text.first[0][0]
    if first.size == 1 and first[0] >= 10.0 and first[0] in {len(values) - 1, len(values) - 2}:
        raise source.error(
            line, "{count:g} may be the number of samples, not a sample", count=float(first[0]), hint=SKIP
        )


def _first_rows(source: Source) -> list[tuple[int, list[str]]] | None:
    """Return the first lines of cells for the detection of the format; None if the lines are not columns."""
    comments = [text for _, text in _comments(source, _LONGEST_HEADER)]
    if not source.is_text or not all(map(is_understood, comments)):
        return None
    text = ColumnText.of(source, _LOOK)
    if text.preamble and (
        len(text.first) < _LOOK or not all(is_understood(text_line) for _, text_line in text.preamble)
    ):
        return None
    # with names, the reader reports damage in later lines, with the line number
    rows = text.first if text.names is None else text.first[:1]
    # if rows contain one acceleration, the last row may be shorter
    if 1 < len(rows) < _LOOK and len(rows[0][1]) > _MOST_COLUMNS:
        rows = rows[:-1]
    counts = {len(cells) for _, cells in rows}
    if len(counts) != 1:
        return None
    if text.names is None:
        return rows if max(counts) <= MOST_NAMED else None
    # if the separator is clear, the reader also reports a wrong number of names
    clear = counts == {len(text.names)} or text.separator in {";", "\t", ","}
    return rows if clear and max(counts) <= MOST_NAMED else None


def _beyond_numbers(cell: str) -> bool:
    """Return True if a cell is NaN or infinity, as text or by its exponent."""
    try:
        return not math.isfinite(float(cell.replace(",", ".").lower().replace("d", "e")))
    except ValueError:
        return False


def _comments(source: Source, most: int | None = None) -> list[tuple[int, str]]:
    lines = source.lines[:most]
    first = [(0, lines[0].removeprefix(MARK))] if lines else []
    return [(line, text) for line, text in (*first, *enumerate(lines[1:], 1)) if _is_comment(text)]


def _is_comment(text: str) -> bool:
    start = text.lstrip()[:1]
    return start in {"#", "%"} or (start in {"N", "n"} and SAMPLING_LINE.fullmatch(text.strip()) is not None)


def _by_position(source: Source, text: ColumnText) -> NamedColumns:
    """Return unnamed columns as one acceleration, or as a time and one to three accelerations."""
    line, cells = text.first[0]
    if not 1 <= len(cells) <= _MOST_COLUMNS:
        raise source.error(
            line, "1 to {most} columns expected, found {count}; check the format", most=_MOST_COLUMNS,
            count=len(cells),
        )  # fmt: skip
    if len(cells) == 1:
        return NamedColumns(None, (ColumnName(0, "", "acceleration"),), ())
    named = [ColumnName(index, "", f"column {index + 1}") for index in range(len(cells))]
    return NamedColumns(named[0], tuple(named[1:]), ())


def _without_time(source: Source, chosen: NamedColumns, values: FloatArray) -> NamedColumns:
    """Return two or three unnamed columns as accelerations if the first one repeatedly changes its sign."""
    count = values.shape[1]
    if chosen.time is None or count > len(_AXES):
        return chosen
    signs = np.sign(values[:, 0])
    changes = int(np.count_nonzero(np.diff(signs[signs != 0.0])))
    if changes < _FEWEST_SIGN_CHANGES:
        return chosen
    axes = _AXES[:count]
    source.doubt(
        None,
        f"the first column changes its sign {changes} times and is not a time; the columns are read as the "
        f"accelerations {', '.join(axes)}" + (" (z is upward)" if "z" in axes else ""),
    )
    return NamedColumns(None, tuple(ColumnName(index, "", axis) for index, axis in enumerate(axes)), ())


@contextmanager
def _naming_first_column(*, is_named: bool) -> Iterator[None]:
    """Add the remedy for columns of accelerations to errors about times without a name."""
    try:
        yield
    except RecordError as error:
        if not is_named:
            error.add_hint(_ALL_ACCELERATIONS)
        raise


def _row_by_row(source: Source, values: FloatArray) -> tuple[NamedColumns, FloatArray]:
    """Return many unnamed columns as times and accelerations, or as one acceleration that continues over all rows."""
    accelerations = tuple(ColumnName(index, "", f"column {index + 1}") for index in range(1, values.shape[1]))
    first = values[:, 0][np.isfinite(values[:, 0])]
    rises = np.diff(first)
    if first.size > 2 and (rises > 0.0).all() and np.ptp(rises) <= 0.5 * rises.mean():
        if not np.isfinite(values).all():
            raise source.error(
                None, "the last line must have {count} numbers, like the first line", count=values.shape[1]
            )
        return NamedColumns(ColumnName(0, "", "column 1"), accelerations, ()), values
    single = NamedColumns(None, (ColumnName(0, "", "acceleration"),), ())
    return single, values[np.isfinite(values)].reshape(-1, 1)


def _value(source: Source, line: int, cell: str) -> float:
    return number(source, line, cell.replace(",", "."))
