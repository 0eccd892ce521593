"""The header of a channel in COSMOS files: text lines, whole numbers, reals, comments, and the line before the data."""

import re
from typing import NamedTuple

from rocking.conventions import FloatArray
from rocking.motions.formats.numbers import fixed, fortran_form, whole
from rocking.motions.formats.source import Source

_TITLE = re.compile(r".*\(Format v\s*0*1\.[12]0? with\s+(\d+) text lines\).*", re.IGNORECASE)
_TABLE = re.compile(
    r"\s*(\d+)\s+(Integer|Real)-header values follow on\s+(\d+) lines,\s*Format\s*=\s*(\(.*?\))\s*", re.I
)
_COMMENTS = re.compile(r"\s*(\d+)\s+Comment line\(?s?\)? follow.*", re.IGNORECASE)
_DATA = re.compile(
    r"\s*(\d+)\s+(\w+)\s+pts,\s*approx\s+(\S+)\s+secs?,\s*units\s*=\s*([^,(]+)\(\s*(\d+)\s*\),\s*Format\s*=\s*(\(.*?\))\s*",
    re.IGNORECASE,
)
UNKNOWN = -999.0
_MOST_TEXT = 200
# places in the headers, counted from 0: what is measured, its unit, azimuth, count; step [ms], length, peak, its time
QUANTITY, UNIT, CHANNEL, AZIMUTH, COUNT = 1, 2, 49, 53, 69
STEP, LENGTH, PEAK, PEAK_TIME = 61, 62, 63, 64
# codes of the units that are accelerations; what the line before the data may call them
_UNITS = {2: ("g", {"g"}), 4: ("cm/s2", {"cm/sec2", "cm/sec/sec", "cm/s2", "cm/s/s", "cm/sec^2", "gal"})}


class DataLine(NamedTuple):
    """What the line before the samples states."""

    samples: int  # number of samples
    seconds: str  # duration as it is printed there [s]
    unit: str  # A key of `rocking.conventions.ACCELERATION_UNITS`
    code: int  # code of the unit
    per_line: int  # per_line, width: numbers on a line and characters of each
    width: int


class Header(NamedTuple):
    """The header of one channel."""

    lines: list[str]  # all its lines, as they stand
    texts: int  # how many of them are text
    wholes: FloatArray  # wholes, figures: the whole numbers and the reals
    figures: FloatArray
    data: DataLine  # the line before the samples
    first_sample: int  # line of the first sample

    @property
    def channel(self) -> str:
        """Number and direction, as ``CHAN 1: 90``: the azimuth if it is known, else what the text says."""
        label = next((text[:200] for text in self.lines[: self.texts] if text.startswith("Sta Cha")), "")
        number = re.match(r"Sta Cha\w*\s*:?\s*(\d+)", label)
        said = re.search(r":\s*([\w-]+)(?:\s+deg\b|\s+\()", label)
        azimuth = self.wholes[AZIMUTH]
        direction = (said[1] if said else "") if azimuth == UNKNOWN else f"{azimuth:.0f}"
        return f"CHAN {number[1] if number else 1}: {direction}"


def begins_channel(source: Source, line: int) -> bool:
    """Return whether a line states the format and the number of text lines."""
    return line < len(source.lines) and _TITLE.fullmatch(source.lines[line][:200]) is not None


def read_header(source: Source, first: int) -> Header:
    """Return the header of the channel that begins at a line."""
    title = _TITLE.fullmatch(source.lines[first][:200])
    texts = whole(source, first, title[1], "number of text lines") if title else 0
    if not 12 <= texts <= _MOST_TEXT or first + texts + 1 >= len(source.lines):
        raise source.error(first, f"12 to {_MOST_TEXT} text lines expected, and as many lines after this one")
    wholes, line = _table(source, first + texts, "integer", 100)
    figures, line = _table(source, line, "real", 100)
    line = _after_comments(source, line)
    data = _data_line(source, line)
    if (int(wholes[QUANTITY]), int(wholes[UNIT])) != (1, data.code):
        raise source.error(line, "the header of whole numbers must state acceleration (1) and the unit of this line")
    return Header(source.lines[first : line + 1], texts, wholes, figures, data, line + 1)


def known(value: float, unknown: float = UNKNOWN) -> float | None:
    """Return a number of the header, or none where it is the one that means unknown."""
    return None if value == unknown else float(value)


def _after_comments(source: Source, line: int) -> int:
    comments = _COMMENTS.fullmatch(source.lines[line]) if line < len(source.lines) else None
    if comments is None:
        return line
    until = line + 1 + whole(source, line, comments[1], "number of comment lines")
    for at in range(line + 1, min(until, len(source.lines))):
        if not source.lines[at].lstrip().startswith("|"):
            raise source.error(at, "a comment line that starts with | expected")
    return until


def _table(source: Source, line: int, kind: str, least: int) -> tuple[FloatArray, int]:
    found = _TABLE.fullmatch(source.lines[line][:200]) if line < len(source.lines) else None
    if found is None or found[2].lower() != kind:
        raise source.error(
            min(line, len(source.lines) - 1), f"{kind.title()}-header values follow on ... lines expected"
        )
    count, lines = whole(source, line, found[1], "count", least), whole(source, line, found[3], "number of lines")
    per_line, width = fortran_form(source, line, found[4])
    if lines != -(-count // per_line):
        raise source.error(line, f"{count} values, {per_line} a line, do not make {lines} lines")
    values, after = fixed(source, line + 1, count, per_line, width)
    if kind == "integer" and (values != values.round()).any():
        raise source.error(line, "whole numbers expected in this header")
    return values, after


def _data_line(source: Source, line: int) -> DataLine:
    found = _DATA.fullmatch(source.lines[line][:200]) if line < len(source.lines) else None
    if found is None:
        raise source.error(min(line, len(source.lines) - 1), "... pts, approx ... secs, units=...,Format=... expected")
    code = int(found[5][:4])
    if not found[2].lower().startswith("accel") or code not in _UNITS:
        raise source.error(
            line, f"acceleration in g (02) or cm/sec2 (04) expected, found {found[2]} in {found[4].strip()}"
        )
    unit, words = _UNITS[code]
    if found[4].strip().lower() not in words:
        raise source.error(line, f"unit {found[4].strip()!r} contradicts its code {code:02d}")
    return DataLine(
        whole(source, line, found[1], "count", 2), found[3], unit, code, *fortran_form(source, line, found[6])
    )
