"""Columns of numbers without a header: one value a line, or a time and one to three accelerations."""

import re
from typing import ClassVar

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import RecordError
from rocking.motions.formats.number_lines import one_line
from rocking.motions.formats.numbers import number
from rocking.motions.formats.record import Component, Record
from rocking.motions.formats.record_format import RecordFormat
from rocking.motions.formats.source import Source
from rocking.motions.formats.units_and_steps import acceleration_unit, in_unit, step_between_samples

_MOST_COLUMNS = 4
_LOOK = 5
_LONGEST_HEADER = 100
# a header that states its own sampling is of another format, damaged: not to be passed over as a comment
_OTHER_HEADER = re.compile(r"\s*[#%].*(sample\s*rate|sampling|record\s*length|npts|ndata)", re.IGNORECASE)
_SEPARATOR = re.compile(r"\s*,\s*|\s+")


class Columns(RecordFormat):
    """Plain columns of text; the last resort, since such a file says nothing about itself."""

    name: ClassVar[str] = "columns"
    title: ClassVar[str] = "Columns of numbers: a, or t a, or t a1 a2 a3"
    suffixes: ClassVar[tuple[str, ...]] = (".txt", ".dat", ".csv")
    states_unit: ClassVar[bool] = False
    states_time_step: ClassVar[bool] = False
    notes: ClassVar[str] = (
        "Verified on five real files. Nothing tells an acceleration from a velocity, nor g from m/s2: the unit must "
        "be known from elsewhere. A missing first or last line cannot be noticed, nor any without a time column."
    )

    def recognises(self, source: Source) -> bool:
        """Return whether the first lines hold nothing but 1 to 4 numbers each.

        Parameters
        ----------
        source : Source
            The file.

        Returns
        -------
        bool
            True if so.
        """
        if not source.is_text or any(_OTHER_HEADER.match(text[:200]) for text in source.lines[:_LONGEST_HEADER]):
            return False
        rows = [words for _, words in _rows(source, _LOOK)]
        try:
            for words in rows:
                _ = [number(source, 0, word) for word in words]
        except RecordError:
            return False
        return bool(rows) and len({len(words) for words in rows}) == 1 and len(rows[0]) <= _MOST_COLUMNS

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        """Return the record, with a component for each column of accelerations.

        Parameters
        ----------
        source : Source
            The file.
        units : str, optional
            Unit of the accelerations; must be given.
        time_step : float, optional
            Must be given where there is no column of times; refused where it contradicts one [s].

        Returns
        -------
        Record
            Component "acceleration", or "column 2", "column 3", "column 4" after the times.

        Raises
        ------
        RecordError
            If it is damaged, the times are unevenly spaced, or the unit or step is missing.
        """
        if not source.is_text:
            raise source.error(None, "not a text file")
        comments = [text for text in source.lines if text.lstrip()[:1] in {"#", "%"}]
        values, digit = _table(source)
        if values.shape[1] == 1:
            step = step_between_samples(source, None, time_step)
            names, metadata = ["acceleration"], {}
        else:
            step = uniform_step(source, values[:, 0], digit)
            if time_step is not None and abs(step - time_step) * len(values) <= 2.0 * digit:
                step = time_step
            step = step_between_samples(source, step, time_step)
            names, metadata = (
                [f"column {k}" for k in range(2, values.shape[1] + 1)],
                {"first time": f"{values[0, 0]:g} s"},
            )
        unit = acceleration_unit(source, None, units)
        columns = values[:, -len(names) :].T
        parts = tuple(Component(name, row.copy(), unit, step) for name, row in zip(names, columns, strict=True))
        return Record(self.name, parts, "\n".join(comments), metadata)

    def write(self, record: Record) -> bytes:
        """Return the content of a file with a column of times and one to three of accelerations, to all digits.

        Parameters
        ----------
        record : Record
            One to three components of the same length and step, written in the unit of the first.

        Returns
        -------
        bytes
            The content; a comment names the unit, which readers must still be told.

        Raises
        ------
        RecordError
            If there are more components, or their lengths or steps differ.
        """
        rows = in_unit(record, self.name, None, _MOST_COLUMNS - 1)
        step = record.components[0].time_step
        if len({row.size for row in rows}) > 1 or any(part.time_step != step for part in record.components):
            raise RecordError("columns holds components of the same length and step; write each to a file of its own")
        names = ", ".join(one_line(part.name, 40) for part in record.components)
        lines = [f"# time [s], {names} [{record.components[0].unit}]"]
        for place, sample in enumerate(np.column_stack(rows)):
            lines.append(" ".join([f"{place * step:.9f}", *(repr(float(value)) for value in sample)]))
        return ("\n".join(lines) + "\n").encode("latin-1")


def uniform_step(source: Source, times: FloatArray, unit: float) -> float:
    """Return the step of a time column that is uniform to the rounding of its digits.

    Parameters
    ----------
    source : Source
        The file, for the error.
    times : ndarray, shape (n,)
        Times as printed [s].
    unit : float
        One unit of the last printed digit [s].

    Returns
    -------
    float
        The step; the shortest decimal number that fits the column [s].

    Raises
    ------
    RecordError
        If there are fewer than two times, they are unevenly spaced, or they have too few digits to tell.
    """
    if times.size < 2:
        raise source.error(None, f"at least 2 samples are needed, found {times.size}")
    steps = times.size - 1
    mean = float(times[-1] - times[0]) / steps
    if not 1e-6 <= mean <= 10.0:
        raise source.error(None, f"time step must be in [1e-6, 10] s, got {mean:g}; is the first column a time?")
    # beyond rounding or cutting at the last digit, times that went through single precision are accepted
    slack = unit + 1.2e-7 * float(np.abs(times).max())
    rounded = (round(mean, digits) for digits in range(1, 10))
    step = next((step for step in rounded if step > 0.0 and abs(step - mean) * steps <= slack), mean)
    even = mean
    if slack > 0.26 * mean:
        # so few digits could hide a missing line: the times must lie on the decimal step itself
        even, slack = step, 0.501 * unit
    if slack > 0.51 * mean:
        raise source.error(None, f"the times have too few digits to tell their step of about {mean:g} s")
    off = np.abs(times - times[0] - even * np.arange(times.size))
    worst = int(off.argmax())
    if off[worst] > slack:
        raise source.error(
            None,
            f"the times are not evenly spaced: sample {worst + 1} at {times[worst]:g} s is {off[worst]:.3g} s off the "
            f"even step of {even:g} s; resample it first, or a line is missing",
        )
    return step


def _rows(source: Source, most: int | None = None) -> list[tuple[int, list[str]]]:
    rows: list[tuple[int, list[str]]] = []
    for line, text in enumerate(source.lines):
        bare = text.strip(" \t\x1a")
        if bare and bare[0] not in "#%":
            rows.append((line, _SEPARATOR.split(bare.rstrip(",").rstrip())))
            if len(rows) == most:
                break
    return rows


def _table(source: Source) -> tuple[FloatArray, float]:
    """Return the numbers, and one unit of the last digit printed in the first column."""
    rows = _rows(source)
    if not rows:
        raise source.error(None, "no line with numbers")
    columns = len(rows[0][1])
    if columns > _MOST_COLUMNS:
        raise source.error(rows[0][0], f"1 to {_MOST_COLUMNS} columns expected, found {columns}; which format is it?")
    _refuse_decimal_commas(source, rows)
    values = np.empty((len(rows), columns))
    for row, (line, words) in enumerate(rows):
        if len(words) != columns:
            raise source.error(line, f"{columns} numbers expected as on the first line, found {len(words)}")
        values[row] = [number(source, line, word) for word in words]
    if len(rows) < 2:
        raise source.error(None, "at least 2 samples are needed, found 1")
    return values, _last_digit([words[0] for _, words in rows])


def _refuse_decimal_commas(source: Source, rows: list[tuple[int, list[str]]]) -> None:
    commas = [line for line, _ in rows if "," in source.lines[line]]
    if commas and not any("." in word for _, words in rows for word in words):
        raise source.error(commas[0], "commas but no decimal point: write decimal commas as points")


def _last_digit(words: list[str]) -> float:
    plain: list[int] = []
    powers: list[int] = []
    for word in words:
        digits, _, power = word.lower().replace("d", "e").partition("e")
        (powers if power else plain).append(len(digits.partition(".")[2]) - int(power or 0))
    # plain numbers may have lost zeros at their end, numbers with an exponent lose digits as they grow
    places = min(powers) if powers else max(plain)
    return float(10.0 ** -min(15, max(-3, places)))
