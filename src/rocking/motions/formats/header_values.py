"""Headers that say a key and a value a line, and the samples of all components below them, side by side."""

import re
from collections.abc import Sequence

import numpy as np

from rocking.errors import RecordError
from rocking.motions.formats import headers, numbers
from rocking.motions.formats.record import Component, Record, Source

_MOST_MORE = 5  # rows behind those that are stated, where peaks confirm these
_LONGEST = 200  # characters of a header line that patterns look at


def header_value(source: Source, last: int, key: str, value: str) -> re.Match[str]:
    """Return what the one line above `last` that begins with a key says, of which a pattern must make sense."""
    begins = re.compile(rf"\s*{key}\s*(.*?)\s*", re.IGNORECASE)
    found = [(line, hit) for line, text in enumerate(source.lines[:last]) if (hit := begins.fullmatch(text[:_LONGEST]))]
    plain = _plain(key)
    if len(found) != 1:
        raise source.error(
            None, "one header line that begins with {key!r} expected, found {count}", key=plain, count=len(found)
        )
    line, hit = found[0]
    understood = re.fullmatch(value, hit[1], re.IGNORECASE)
    if understood is None:
        raise source.error(line, "{key} cannot be understood: {entry!r}", key=plain, entry=hit[1][:40])
    return understood


def _plain(pattern: str) -> str:
    """Return a pattern of a key as a user would read it."""
    return re.sub(r"\\s[*+]|\\S[*+]?|\\|\(\?:|\[.*", "", pattern).strip(" :*")


def header_text(source: Source, last: int, key: str) -> str:
    """Return what a line says in words; nothing where there is none or several."""
    try:
        return header_value(source, last, key, ".*")[0]
    except RecordError:
        return ""


def after(source: Source, mark: str, most: int) -> int:
    """Return the line behind the last one near the top that begins with a pattern."""
    form = re.compile(mark, re.IGNORECASE)
    found = [line for line, text in enumerate(source.lines[:most]) if form.match(text[:_LONGEST])]
    if not found or not source.is_text:
        raise source.error(None, "no line that begins with {key!r} near the top", key=_plain(mark))
    return found[-1] + 1


def side_by_side(
    source: Source,
    record: Record,
    first: int,
    count: int,
    peaks: Sequence[str] = (),
    form: tuple[int, int] | None = None,
) -> Record:
    """Return a record with the samples from a line on: by Fortran columns or between blanks, checked by printed peaks.

    Its components come without samples, in their order.
    """
    across = len(record.components)
    if form is None:
        values = numbers.rows(source, first, len(source.lines))
        if peaks and 0 < values.size - count * across <= _MOST_MORE * across:
            _doubt_more(source, count, values.size // across)
            values = values[: count * across]
    else:
        values, behind = numbers.fixed(source, first, count * across, *form)
        more = sum(1 for line in range(behind, source.end) if source.lines[line].strip())
        if peaks and 0 < more <= _MOST_MORE and form[0] == across:
            numbers.fixed(source, behind, more * across, *form)
            _doubt_more(source, count, count + more)
        else:
            headers.check_end(source, behind)
    if values.size != count * across:
        raise source.error(
            None, "the header states {stated} samples, the file holds {read:g}", stated=count, read=values.size / across
        )
    if count < 2:
        raise source.error(None, "at least 2 samples are needed, found {count}", count=count)
    word = next(text.split()[0] for text in source.lines[first:] if text.strip())
    word = word if form is None else source.lines[first][: form[1]]
    parts = []
    for place, part in enumerate(record.components):
        column, stated = values[place::across].copy(), None
        if peaks:
            rounding = headers.half_digit(peaks[place]) + headers.half_digit(word)
            headers.check_peak(source, float(peaks[place]), column, rounding, f"peak of {part.name}")
            stated = abs(float(peaks[place]))
        parts.append(Component(part.name, column, part.unit, part.time_step, stated, part.metadata))
    return Record(record.format, tuple(parts), "\n".join(source.lines[:first]), record.metadata)


def _doubt_more(source: Source, count: int, found: int) -> None:
    source.doubt(
        None, f"the header states {count} samples, the file holds {found}; the last {found - count} are left out"
    )


def columns_of(record: Record, name: str, unit: str | None, most: int) -> tuple[np.ndarray, float]:
    """Return the samples of a record as columns, and their step [s], for writers."""
    samples = headers.in_unit(record, name, unit, most)
    if len({row.size for row in samples}) > 1 or len({part.time_step for part in record.components}) > 1:
        raise RecordError(
            "{format} holds components of the same length and step", format=name, hint="write each to a file of its own"
        )
    return np.column_stack(samples), record.components[0].time_step
