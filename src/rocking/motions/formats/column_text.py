"""Columns as text: which line holds their names, what parts them, and whether a comma is a decimal point."""

import csv
import re
from dataclasses import dataclass

from rocking.motions.formats.source import Source

MOST_NAMED = 20
"""Columns of a file that names them."""

_FIRST_ROWS = 50
MARK = "\xef\xbb\xbf"
"""The three bytes with which some programs begin a file in UTF-8."""

_BLANKS = " \t\x1a"
_MIXED = re.compile(r"\s*,\s*|\s+")
_QUOTED = re.compile(r'"[^"]*"')
_UNIT_BEHIND = re.compile(r"[^\s\[(]+(?:\s*\[[^\]]*\]|\s*\([^)]*\))?")
_DECIMAL_COMMAS = re.compile(r"(?:[^\s,]+|[^\s,]*\d,\d[^\s,]*)(?:\s+(?:[^\s,]+|[^\s,]*\d,\d[^\s,]*))+")
# a letter first, or the digits of an azimuth with a unit behind them; what has an equals sign states something else
_NAME = re.compile(r"(?:[^\W\d_]|\d+\s*[\[(])[^=\x00-\x1f]{0,79}")
_NO_NAME = re.compile(r"nan|inf(inity)?|null|none|n/?a|true|false", re.IGNORECASE)
_DAMAGED_NUMBER = re.compile(r"[^\W\d_][+-]?[\d.,]+([eEdD][+-]?\d*)?")
# what states its own sampling is a header of another format, damaged: not to be passed over as a comment or as names
_OTHER_FORMAT = re.compile(r"sample\s*rate|sampling|record\s*length|npts|ndata", re.IGNORECASE)


@dataclass(frozen=True)
class ColumnText:
    """The cells of a file of columns, none of them read as a number yet."""

    names: tuple[str, ...] | None  # what the columns are called, with their units; None if the file begins with numbers
    heading: str  # the line of the names; empty if there is none
    rows: list[tuple[int, list[str]]]  # index of each line of numbers, and its cells
    separator: str  # ``;``, a tab, ``,``, a blank for white space, or nothing if blanks and commas both part

    @classmethod
    def of(cls, source: Source, most: int | None = None) -> "ColumnText":
        """Part a file into cells."""
        lines = _lines(source, None if most is None else max(most, _FIRST_ROWS) + 1)
        if not lines:
            return cls(None, "", [], "")
        first = lines[0][1]
        separator = _separator(first)
        names = _names(first, separator)
        body = lines if names is None else lines[1:]
        if names is None or separator == " ":
            separator = " " if names and len(names) == 1 else _separator_of_numbers([text for _, text in body])
        rows = [(line, _cells(text, separator, names)) for line, text in body[:most]]
        return cls(names, readable(first) if names else "", rows, separator)


def readable(text: str) -> str:
    """Return a line in the alphabet in which it was written: UTF-8 where it is that, Latin-1 otherwise."""
    try:
        return text.encode("latin-1").decode("utf-8")
    except UnicodeError:
        return text


def states_sampling(text: str) -> bool:
    """Return whether a line speaks of a sampling, as headers of other formats do."""
    return _OTHER_FORMAT.search(text[:200]) is not None


def _lines(source: Source, most: int | None) -> list[tuple[int, str]]:
    lines: list[tuple[int, str]] = []
    for line, text in enumerate(source.lines):
        bare = (text if line else text.removeprefix(MARK)).strip(_BLANKS)
        if bare and bare[0] not in "#%":
            lines.append((line, bare))
            if len(lines) == most:
                break
    while lines and not lines[-1][1].strip(",; \t"):  # empty rows of a spreadsheet
        lines.pop()
    return lines


def _separator(text: str) -> str:
    bare = _QUOTED.sub("", text)
    return next((mark for mark in (";", "\t", ",") if mark in bare), " ")


def _names(text: str, separator: str) -> tuple[str, ...] | None:
    """Return the names that a line holds; None if it holds anything else, such as numbers or a damaged one."""
    if "=" in text or states_sampling(text) or len(text) > 100 * MOST_NAMED:
        return None
    text = readable(text)
    if separator == " " and '"' not in text:
        cells = _UNIT_BEHIND.findall(text)
    else:
        cells = next(csv.reader([text], delimiter=separator, skipinitialspace=True), [])
    names = tuple(" ".join(cell.split()) for cell in cells)
    while names and not names[-1]:
        names = names[:-1]
    told = [name for name in names if name]
    good = all(_NAME.fullmatch(name) and not _NO_NAME.fullmatch(name) for name in told)
    # alone on its line, a letter with a number is rather a damaged number than a name
    damaged = len(told) == 1 and _DAMAGED_NUMBER.fullmatch(told[0])
    return names if told and good and not damaged else None


def _separator_of_numbers(rows: list[str]) -> str:
    """Return what parts rows of numbers; nothing where it may be blanks as well as commas."""
    looked = rows[:_FIRST_ROWS]
    if looked and ";" in looked[0]:
        return ";"
    commas, points = ("".join(looked).count(mark) for mark in ",.")
    if commas and not points and all(map(_DECIMAL_COMMAS.fullmatch, looked)):
        return "\t" if "\t" in looked[0] else " "
    return ""


def _cells(text: str, separator: str, names: tuple[str, ...] | None) -> list[str]:
    if separator == "":
        return _MIXED.split(text.rstrip(",").rstrip())
    if separator == " ":
        return text.split()
    cells = [cell.strip() for cell in text.split(separator)]
    while cells and not cells[-1] and (names is None or len(cells) > len(names)):
        cells.pop()
    return cells
