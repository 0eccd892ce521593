"""Headers with one key and value per line, followed by the samples of all components in columns."""

import re
from collections.abc import Sequence

import numpy as np

from rocking.errors import RecordError
from rocking.motions.formats import headers, numbers
from rocking.motions.formats.record import Component, Record, Source

_MAX_EXTRA = 5  # largest number of rows after the stated count, if the peaks confirm the other rows
_LONGEST = 200  # largest number of characters of a header line that patterns search


def header_value(source: Source, last: int, key: str, value: str) -> re.Match[str]:
    """Return the match of a value pattern in the only line before `last` that begins with a key."""
    begins = re.compile(rf"\s*{key}\s*(.*?)\s*", re.IGNORECASE)
    matches = [
        (line, hit) for line, text in enumerate(source.lines[:last]) if (hit := begins.fullmatch(text[:_LONGEST]))
    ]
    plain = _plain(key)
    if len(matches) != 1:
        raise source.error(
            None, "one header line that begins with {key!r} expected, found {count}", key=plain, count=len(matches)
        )
    line, hit = matches[0]
    match = re.fullmatch(value, hit[1], re.IGNORECASE)
    if match is None:
        raise source.error(line, "{key} cannot be understood: {entry!r}", key=plain, entry=hit[1][:40])
    return match


def _plain(pattern: str) -> str:
    """Return a key pattern as plain text."""
    return re.sub(r"\\s[*+]|\\S[*+]?|\\|\(\?:|\[.*", "", pattern).strip(" :*")


def header_text(source: Source, last: int, key: str) -> str:
    """Return the text after a key; empty unless exactly one line has the key."""
    try:
        return header_value(source, last, key, ".*")[0]
    except RecordError:
        return ""


def after(source: Source, mark: str, most: int) -> int:
    """Return the index of the line after the last line near the top that begins with a pattern."""
    form = re.compile(mark, re.IGNORECASE)
    lines = [line for line, text in enumerate(source.lines[:most]) if form.match(text[:_LONGEST])]
    if not lines or not source.is_text:
        raise source.error(None, "no line that begins with {key!r} near the top", key=_plain(mark))
    return lines[-1] + 1


def side_by_side(
    source: Source,
    record: Record,
    first: int,
    count: int,
    peaks: Sequence[str] = (),
    form: tuple[int, int] | None = None,
) -> Record:
    """Return a record with the samples that begin at a line, in Fortran columns or separated by blanks.

    The samples are checked against the peaks. The components of the input record are in order and have no samples.
    """
    columns = len(record.components)
    if form is None:
        values = numbers.rows(source, first, len(source.lines))
        if peaks and 0 < values.size - count * columns <= _MAX_EXTRA * columns:
            _doubt_extra(source, count, values.size // columns)
            values = values[: count * columns]
    else:
        values, behind = numbers.fixed(source, first, count * columns, *form)
        extra_rows = sum(1 for line in range(behind, source.end) if source.lines[line].strip())
        if peaks and 0 < extra_rows <= _MAX_EXTRA and form[0] == columns:
            numbers.fixed(source, behind, extra_rows * columns, *form)
            _doubt_extra(source, count, count + extra_rows)
        else:
            headers.check_end(source, behind)
    if values.size != count * columns:
        raise source.error(
            None,
            "the header states {stated} samples, but the file contains {read:g}",
            stated=count,
            read=values.size / columns,
        )
    if count < 2:
        raise source.error(None, "at least 2 samples required, found {count}", count=count)
    word = next(text.split()[0] for text in source.lines[first:] if text.strip())
    word = word if form is None else source.lines[first][: form[1]]
    components = []
    for index, component in enumerate(record.components):
        column, stated = values[index::columns].copy(), None
        if peaks:
            rounding = headers.half_digit(peaks[index]) + headers.half_digit(word)
            headers.check_peak(source, float(peaks[index]), column, rounding, f"peak of {component.name}")
            stated = abs(float(peaks[index]))
        components.append(
            Component(component.name, column, component.unit, component.time_step, stated, component.metadata)
        )
    return Record(record.format, tuple(components), "\n".join(source.lines[:first]), record.metadata)


def _doubt_extra(source: Source, count: int, read: int) -> None:
    source.doubt(
        None, f"the header states {count} samples, but the file contains {read}; the last {read - count} are ignored"
    )


def columns_of(record: Record, name: str, unit: str | None, most: int) -> tuple[np.ndarray, float]:
    """Return the samples of a record as columns, and their time step [s], for writers."""
    samples = headers.in_unit(record, name, unit, most)
    if len({row.size for row in samples}) > 1 or len({component.time_step for component in record.components}) > 1:
        raise RecordError(
            "{format} requires components of equal length and time step",
            format=name,
            hint="write one file per component",
        )
    return np.column_stack(samples), record.components[0].time_step
