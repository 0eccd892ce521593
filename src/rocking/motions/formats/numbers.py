"""Reading and writing of numbers in fixed columns or separated by blanks.

Errors contain the line of a damaged number.
"""

import math
import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import RecordError
from rocking.motions.formats.record import Source

# float() also accepts nan, infinity and 1_000; in a record, these are damaged numbers
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d{1,3})?")
_CHARACTERS = b"0123456789+-.eE \t\n"  # characters of plain decimal numbers
_ZEROS = bytes.maketrans(b"123456789E", b"000000000e")

Row = tuple[int, Sequence[str]]  # index of a line, and the numbers of the line as text


def number(source: Source, line: int, word: str, quantity: str = "number") -> float:
    """Return one number."""
    text = word.strip()
    if not _NUMBER.fullmatch(text):
        raise source.error(
            line, "{quantity} expected, found {entry!r}{gap}", quantity=quantity, entry=text[:40], gap=gap_words(text)
        )
    value = float(text.replace("D", "e").replace("d", "e"))
    if not math.isfinite(value):
        raise source.error(line, "{quantity} is too large: {entry!r}", quantity=quantity, entry=text[:40])
    return value


def read_rows(source: Source, rows: Iterable[Row]) -> FloatArray:
    """Return all numbers of rows in one array. If there are several errors, the first is raised."""
    read: list[Row] = []
    refusal = None
    try:
        read.extend(rows)
    except RecordError as error:
        refusal = error
    values = at_once(list(chain.from_iterable(texts for _, texts in read))) if refusal is None else None
    if values is None:
        values = np.array([number(source, line, word) for line, texts in read for word in texts], dtype=np.float64)
    if refusal is not None:
        raise refusal
    return values


def at_once(texts: Sequence[str]) -> FloatArray | None:
    """Return words as numbers, or None unless all words are plain decimal numbers.

    >>> at_once(["1.5", "-2e-3"]), at_once(["1.5", "nan"]), at_once(["1_000", "2"])
    (array([ 1.5  , -0.002]), None, None)
    """
    if not _is_plain("\n".join(texts)):
        return None
    try:
        values = np.array(list(map(float, texts)), dtype=np.float64)
    except ValueError:
        return None
    return values if np.isfinite(values).all() else None


def plain_table(lines: Sequence[str], separator: str | None) -> FloatArray | None:
    """Return lines of numbers, shape (lines, columns), or None unless all are plain decimal numbers.

    >>> plain_table(["0.0, 1.5", "0.1, -2e-3"], ",").tolist(), plain_table(["0.0 1.5", "0.1"], None)
    ([[0.0, 1.5], [0.1, -0.002]], None)
    """
    if not _is_plain("\n".join(lines), separator or ""):
        return None
    try:
        values = np.loadtxt(lines, comments=None, delimiter=separator, ndmin=2)
    except ValueError:
        return None
    return values if np.isfinite(values).all() else None


def _is_plain(text: str, separator: str = "") -> bool:
    """Return True if a text contains only characters and exponents of plain decimal numbers."""
    data = text.encode("utf-8")
    if data.translate(None, _CHARACTERS + separator.encode()):
        return False
    return b"e0000" not in data.translate(_ZEROS, b"+-")


def gap_words(text: str) -> str:
    """Return an explanation of a word that means a missing value; empty for other words."""
    if text.lower().lstrip("+-") not in {"nan", "inf", "infinity", "null", "none", "na", "n/a", "#n/a", "--", "-", "?"}:
        return ""
    return ": a sample has no value; fill the gap, or trim the record before it"


def whole(source: Source, line: int, word: str, quantity: str, minimum: int = 0) -> int:
    """Return one whole number."""
    text = word.strip()
    if not re.fullmatch(r"[+-]?\d{1,9}", text) or int(text) < minimum:
        raise source.error(line, "{quantity} expected, found {entry!r}", quantity=quantity, entry=text[:40])
    return int(text)


def matched(source: Source, line: int, form: str) -> re.Match[str]:
    """Return the match of a pattern on a line."""
    match = re.fullmatch(form, source.lines[line].strip())
    if match is None:
        raise source.error(line, "the line is not understood: {entry!r}", entry=source.lines[line].strip()[:60])
    return match


def free(source: Source, first: int, last: int, columns: int | None = None) -> FloatArray:
    """Return the numbers of lines, separated by blanks, shape (n,) or (lines, columns)."""
    values = read_rows(source, _free_rows(source, first, last, columns))
    return values if columns is None else values.reshape(-1, columns)


def _free_rows(source: Source, first: int, last: int, columns: int | None) -> Iterator[Row]:
    for line in range(first, last):
        texts = source.lines[line].split()
        if columns is not None and texts and len(texts) != columns:
            raise source.error(line, "{expected} numbers expected, found {count}", expected=columns, count=len(texts))
        yield line, texts


def rows(source: Source, first: int, last: int) -> FloatArray:
    """Return the numbers on lines of equal length. The last line may be shorter, and blank lines are ignored."""
    columns, short = 0, False
    last = min(last, source.end) if last == len(source.lines) else last
    for line in range(first, last):
        count = len(source.lines[line].split())
        columns = columns or count
        if count and (short or count > columns):
            raise source.error(
                line,
                "{columns} numbers per line expected, except on the last line",
                columns=columns,
                hint="check the line",
            )
        short = short or 0 < count < columns
    if not columns:
        raise source.error(None, "the file has no sample after the header")
    return free(source, first, last)


def word(source: Source, first: int, index: int, per_line: int, width: int) -> str:
    """Return the printed text of the number with a given index, in columns of fixed width."""
    line, column = divmod(index, per_line)
    return source.lines[first + line].rstrip()[column * width : (column + 1) * width].strip()


def fixed(source: Source, first: int, count: int, per_line: int, width: int, skip: int = 0) -> tuple[FloatArray, int]:
    """Return `count` numbers in columns of fixed width, with or without blanks, and the line after the numbers.

    Every line begins with `skip` blanks before the first column.
    """
    values = read_rows(source, _fixed_rows(source, first, count, per_line, width, skip))
    return values, first + math.ceil(count / per_line)


def _fixed_rows(source: Source, first: int, count: int, per_line: int, width: int, skip: int) -> Iterator[Row]:
    for read in range(0, count, per_line):
        line = first + read // per_line
        if line >= len(source.lines):
            raise source.error(None, "{count} samples expected, but the file ends after {read}", count=count, read=read)
        text = source.lines[line].rstrip()
        text = text[skip:] if not text[:skip].strip() else text
        columns = min(per_line, count - read)
        if len(text) > columns * width or len(text) <= (columns - 1) * width:
            raise source.error(
                line, "{columns} columns of {width} characters expected, found {count} characters", columns=columns,
                width=width, count=len(text),
            )  # fmt: skip
        yield line, [text[k * width : (k + 1) * width] for k in range(columns)]


def fortran_form(source: Source, line: int, word: str) -> tuple[int, int]:
    """Return the number of columns and the width of a column from a Fortran format.

    >>> fortran_form(Source("a.v1", b"x"), 0, "(8F10.5)")
    (8, 10)
    """
    match = re.fullmatch(r"\(?(?:1P,?)?(\d{1,3})[FEGI](\d{1,2})(?:\.\d{1,2})?\)?", word.strip().upper())
    if match is None or not int(match[1]) or not int(match[2]):
        raise source.error(line, "format such as (8F10.5) expected, found {entry!r}", entry=word.strip()[:40])
    return int(match[1]), int(match[2])


def in_columns(values: Sequence[float] | FloatArray, per_line: int, form: str) -> list[str]:
    """Return lines of numbers, for writers."""
    texts = [form.format(value) for value in values]
    return ["".join(texts[start : start + per_line]) for start in range(0, len(texts), per_line)]


def in_width(values: Sequence[float] | FloatArray, per_line: int, width: int, decimals: int) -> list[str]:
    """Return lines of numbers in columns of fixed width, for writers.

    >>> in_width([1.0, -2.5, 3.0], 2, 6, 2)
    ['  1.00 -2.50', '  3.00']
    """
    lines = in_columns(values, per_line, f"{{:{width}.{decimals}f}}")
    full = [per_line] * (len(lines) - 1) + [len(values) - per_line * (len(lines) - 1)]
    for text, count in zip(lines, full, strict=True):
        if len(text) != count * width:
            raise RecordError(
                "a number does not fit into {width} characters with {decimals} decimals", width=width,
                decimals=decimals, hint="check the unit",
            )  # fmt: skip
    return lines


def fortran_e(value: float, digits: int, width: int, before: str = "") -> str:
    """Return a number in the E format of Fortran, with optional text before the point, for writers.

    >>> fortran_e(-0.0123, 4, 11), fortran_e(12.5, 4, 11, "0")
    (' -.1230E-01', ' 0.1250E+02')
    """
    mantissa, exponent = f"{abs(value):.{digits - 1}E}".split("E")
    power = int(exponent) + 1 if value else 0
    return f"{'-' if value < 0.0 else ''}{before}.{mantissa.replace('.', '')}E{power:+03d}".rjust(width)
