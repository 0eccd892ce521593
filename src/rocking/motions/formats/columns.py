"""Columns of numbers, with or without a line of names: one value a line, or a time and accelerations."""

import math
import re
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

SKIP = "pass over the lines above the numbers with skip=N"
_MOST_COLUMNS = 4
_LOOK = 5
_LONGEST_HEADER = 100


class Columns(RecordFormat):
    """Plain columns of text; the last resort, since such a file says little about itself.

    Without names, a line holds one acceleration, or a time and one to three of them; blanks, tabs or commas part
    them, or semicolons. Lines that begin with ``#`` or ``%`` are comments, and stay so.

    One line of names may stand above the numbers, ``time [s], NS [g], EW [g]``, with the unit of a column in brackets
    or parentheses. A key of `rocking.conventions.ACCELERATION_UNITS` is taken, m/s^2, m/s/s and Gal as well; any
    other unit, or none, is asked for. A column that is called time, or t where it stands first, is the time, in
    seconds; one in another unit (m/s, m, rad), or called a velocity or displacement, is left out, and the metadata
    say so. Without a time the step is asked for, if the rest is clear: otherwise the error names the columns and says
    what to write or remove. Semicolons, tabs, commas or blanks part names and numbers alike.

    Words may stand above the numbers without a mark. What they and the comments state is used: ``Time Step: 0.01``,
    ``acceleration in g``, ``sampling rate 200 Hz``, ``NPTS = 600``, ``Component NS``; what states a sampling in other
    words is refused. Several columns of equal times are one. A word behind the last number, such as ``END``, is
    passed over with a doubt.

    Where commas part nothing they are decimal points, as a spreadsheet of much of Europe writes them; a file with
    both, or one where commas may be either, is refused.
    """

    name: ClassVar[str] = "columns"
    title: ClassVar[str] = "Columns of numbers: a, or t a, or t a1 a2 a3, or under a line of names"
    suffixes: ClassVar[tuple[str, ...]] = (".txt", ".dat", ".csv")
    states_unit: ClassVar[bool] = False
    states_time_step: ClassVar[bool] = False
    notes: ClassVar[str] = (
        "Verified on five real files. Without names, as time [s], acc [g], nothing tells an acceleration from a "
        "velocity, nor g from m/s2: the unit must be known from elsewhere. A missing first or last line cannot be "
        "noticed, nor any without a time column."
    )

    def recognises(self, source: Source) -> bool:
        """Return whether the first lines hold nothing but 1 to 4 numbers each, or names and as many numbers."""
        looked = _looked_at(source)
        if looked is None:
            return False
        try:
            _ = [_value(source, line, cell) for line, cells in looked for cell in cells]
        except RecordError:
            return False
        return True

    def refusal(self, source: Source) -> RecordError | None:
        """Return the error for a NaN or infinity on the first lines of what would be columns without it."""
        looked = _looked_at(source)
        if looked is None:
            return None
        found: RecordError | None = None
        for line, cells in looked:
            for cell in cells:
                try:
                    _value(source, line, cell)
                except RecordError as error:
                    if not _beyond_numbers(cell):
                        return None
                    found = found or error
        return found

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        """Return the record, a component for each column of accelerations; without times it needs the step."""
        # without names they are "acceleration", or "column 2", "column 3", "column 4" after the times
        if not source.is_text:
            raise source.error(None, "not a text file")
        headers.refuse_other(source)
        text = ColumnText.of(source)
        if text.is_empty:
            raise source.error(None, "no line with numbers")
        # such a number comes first: what it does to names, commas and widths would only hide it
        for line, cells in text.first[:_LOOK]:
            _ = [_value(source, line, cell) for cell in cells if _beyond_numbers(cell)]
        comments = _comments(source, None if text.at_once is None else text.first[0][0])  # none among plain numbers
        stated = HeaderWords.of(source, [*comments, *text.words], len(text.first[0][1]))
        _check_words(source, text)
        names = text.names or stated.names
        wide = names is None and len(text.first[0][1]) > _MOST_COLUMNS
        if wide:
            chosen, values = _row_by_row(source, text.numbers(last_short=True))
        else:
            chosen = _by_place(source, text) if names is None else NamedColumns.of(source, names)
            values = text.numbers()
        if text.words and names is None:
            _check_first(source, text, values)
        chosen = chosen.with_one_time(source, values)
        known = time_step if stated.step is None else step_between_samples(source, stated.step, time_step)
        step, metadata = known, {}
        if chosen.time is not None:
            times, place = values[:, chosen.time.place], chosen.time.place
            step = step_of_times(source, times, text.column(place), known)
            metadata = {"first time": f"{times[0]:g} s"}
        step = step_between_samples(source, None, step)
        if stated.count is not None:
            headers.check_count(source, stated.count, len(values))
        chosen = chosen.with_stated_unit(source, stated.unit, stated.unknown_unit, units)
        if chosen.left_out:
            metadata["left out"] = ", ".join(chosen.left_out)
        accelerations = chosen.with_unit(source, units).accelerations
        about = _direction(stated, accelerations)
        parts = tuple(
            Component(_name(one, about), values[:, one.place].copy(), one.unit or "", step, None, about)
            for one in accelerations
        )
        header = [*(words for _, words in (*comments, *text.words)), *filter(None, [text.heading])]
        return Record(self.name, parts, "\n".join(header), metadata)

    def write(self, record: Record) -> bytes:
        """Return a file with a column of times and one to three of accelerations, to all digits and with the unit."""
        samples, step = columns_of(record, self.name, None, _MOST_COLUMNS - 1)
        named = [re.sub(r"[\[\](),;=]", " ", one_line(part.name, 40)).strip() for part in record.components]
        unit = record.components[0].unit
        heading = ", ".join(["time [s]", *(f"{name} [{unit}]" for name in named)])
        # a name that could not be read as one
        if len({name.casefold() for name in named}) < len(named) or len(names_on(heading) or ()) != len(named) + 1:
            heading = ", ".join(["time [s]", *(f"column {place + 2} [{unit}]" for place in range(len(named)))])
        lines = [f"# {heading}"]
        for place, sample in enumerate(samples):
            lines.append(" ".join([f"{place * step:.9f}", *(repr(float(value)) for value in sample)]))
        return ("\n".join(lines) + "\n").encode("latin-1")


def _direction(stated: HeaderWords, accelerations: tuple[ColumnName, ...]) -> dict[str, str]:
    """Return the direction that words state for a lone column; unclear where only the words name the vertical."""
    if stated.direction:
        return {"direction": stated.direction} if len(accelerations) == 1 else {}
    is_unstated = all(directions.orientation(column.name) is None for column in accelerations)
    return {directions.KEY: directions.UNCLEAR} if stated.perhaps_upright and is_unstated else {}


def _name(column: ColumnName, about: dict[str, str]) -> str:
    """Return the name of a component: that of its column, or the direction that words above it state."""
    return about["direction"] if "direction" in about and column.name in {"acceleration", "column 2"} else column.name


def _check_words(source: Source, text: ColumnText) -> None:
    """Refuse words that state a sampling in a way that is not read."""
    for line, words in text.words:
        if not is_understood(words):
            raise source.error(line, "{entry!r} is not understood", entry=words.strip()[:60], hint=SKIP)


def _check_first(source: Source, text: ColumnText, values: FloatArray) -> None:
    """Refuse a first number below words that is the number of the samples behind it."""
    first, line = values[0], text.first[0][0]
    if first.size == 1 and first[0] >= 10.0 and first[0] in {len(values) - 1, len(values) - 2}:
        raise source.error(line, "{count:g} may be the number of samples, no sample", count=float(first[0]), hint=SKIP)


def _looked_at(source: Source) -> list[tuple[int, list[str]]] | None:
    """Return the first lines of cells, not yet numbers, that decide whether these are columns; None if they are not."""
    comments = [text for _, text in _comments(source, _LONGEST_HEADER)]
    if not source.is_text or not all(map(is_understood, comments)):
        return None
    text = ColumnText.of(source, _LOOK)
    if text.words and (len(text.first) < _LOOK or not all(is_understood(words) for _, words in text.words)):
        return None
    # damage further down is told by the reader, with its line, where names say that these are columns
    looked = text.first if text.names is None else text.first[:1]
    # an acceleration that goes on row after row ends where it ends
    if 1 < len(looked) < _LOOK and len(looked[0][1]) > _MOST_COLUMNS:
        looked = looked[:-1]
    counts = {len(cells) for _, cells in looked}
    if len(counts) != 1:
        return None
    if text.names is None:
        return looked if max(counts) <= MOST_NAMED else None
    # so is one name more or less, where the separator is clear
    clear = counts == {len(text.names)} or text.separator in {";", "\t", ","}
    return looked if clear and max(counts) <= MOST_NAMED else None


def _beyond_numbers(cell: str) -> bool:
    """Return whether a cell is a NaN or an infinity, in letters or by its exponent."""
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


def _by_place(source: Source, text: ColumnText) -> NamedColumns:
    """Return what columns without names are: a lone acceleration, or a time and one to three of them."""
    line, cells = text.first[0]
    if not 1 <= len(cells) <= _MOST_COLUMNS:
        raise source.error(
            line, "1 to {most} columns expected, found {count}; which format is it?", most=_MOST_COLUMNS,
            count=len(cells),
        )  # fmt: skip
    if len(cells) == 1:
        return NamedColumns(None, (ColumnName(0, "", "acceleration"),), ())
    named = [ColumnName(place, "", f"column {place + 1}") for place in range(len(cells))]
    return NamedColumns(named[0], tuple(named[1:]), ())


def _row_by_row(source: Source, values: FloatArray) -> tuple[NamedColumns, FloatArray]:
    """Return what many columns without names are: times and accelerations, or one acceleration that goes on and on."""
    accelerations = tuple(ColumnName(place, "", f"column {place + 1}") for place in range(1, values.shape[1]))
    first = values[:, 0][np.isfinite(values[:, 0])]
    rises = np.diff(first)
    if first.size > 2 and (rises > 0.0).all() and np.ptp(rises) <= 0.5 * rises.mean():
        if not np.isfinite(values).all():
            raise source.error(None, "the last line must have {count} numbers, as the first", count=values.shape[1])
        return NamedColumns(ColumnName(0, "", "column 1"), accelerations, ()), values
    one = NamedColumns(None, (ColumnName(0, "", "acceleration"),), ())
    return one, values[np.isfinite(values)].reshape(-1, 1)


def _value(source: Source, line: int, cell: str) -> float:
    return number(source, line, cell.replace(",", "."))
