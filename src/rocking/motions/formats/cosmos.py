"""COSMOS v1.20: headers of text, whole numbers, reals and comments, and the samples, one channel after another."""

import re
from typing import ClassVar, NamedTuple

import numpy as np

from rocking.conventions import FloatArray
from rocking.motions.formats.headers import (
    Channel,
    acceleration_unit,
    check_count,
    check_duration,
    check_end,
    check_peak,
    check_peak_time,
    distinct_names,
    in_unit,
    step_between_samples,
)
from rocking.motions.formats.numbers import fixed, fortran_form, in_width, one_line, whole
from rocking.motions.formats.record import Component, Record, RecordFormat, Source

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
# header and data round apart: the peak is written in fewer digits than the samples
_ROUNDING = {"cm/s2": 6e-4, "g": 1e-5}


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


class Cosmos(RecordFormat):
    """COSMOS files, volumes 0 to 2, of acceleration."""

    name: ClassVar[str] = "cosmos"
    title: ClassVar[str] = "COSMOS v1.20, Consortium of Organizations for Strong Motion Observation Systems"
    suffixes: ClassVar[tuple[str, ...]] = (".v1", ".v2", ".v1c", ".v2c")
    notes: ClassVar[str] = (
        "Verified on the published test file: one channel, cm/sec2. Several channels in one file and data in g follow "
        "the description of the format. Only units 02 (g) and 04 (cm/sec2) are read; counts and volts are refused."
    )

    def recognises(self, source: Source) -> bool:
        """Return whether the first line states the format and its number of text lines."""
        return source.is_text and begins_channel(source, 0)

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        """Return the record, with a component for each channel, named by its azimuth, or CHAN 1 where these repeat."""
        first = 0
        channels: list[Channel] = []
        while not channels or begins_channel(source, first):
            channel, first = _channel(source, first, units, time_step)
            channels.append(channel)
        check_end(source, first)
        header = "\n".join("\n".join(lines) for lines, _, _ in channels)
        texts = channels[0][0]
        station = re.match(r"Statn No:\s*(\S+)\s+Code:\s*(\S+)\s+(.*)", texts[4])
        metadata = {"event": texts[1][:39].strip(), "date": texts[1][39:].strip()}
        if station:
            metadata |= {"station number": station[1], "station code": station[2], "station": station[3].strip()}
        return Record(self.name, distinct_names(channels), header, {k: v for k, v in metadata.items() if v})

    def write(self, record: Record) -> bytes:
        """Return the content of a COSMOS file, in cm/sec2 with 5 decimals."""
        lines: list[str] = []
        for row, values in enumerate(in_unit(record, self.name, "cm/s2", 99)):
            lines += _lines(record, row, values.round(5))
        return ("\n".join(lines) + "\n").encode("latin-1")


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


def _channel(source: Source, first: int, units: str | None, time_step: float | None) -> tuple[Channel, int]:
    header = read_header(source, first)
    data = header.data
    unit = acceleration_unit(source, data.unit, units)
    step = step_between_samples(source, known(header.figures[STEP] / 1000.0, UNKNOWN / 1000.0), time_step)
    values, after = fixed(source, header.first_sample, data.samples, data.per_line, data.width)
    peak = _check(source, header, values, step)
    if after >= len(source.lines) or not source.lines[after].startswith("/&"):
        raise source.error(min(after, len(source.lines) - 1), "End of data for channel expected")
    return (header.lines, header.channel, Component("", values, unit, step, peak)), after + 1


def _check(source: Source, header: Header, values: FloatArray, step: float) -> float | None:
    wholes, figures, data = header.wholes, header.figures, header.data
    if wholes[COUNT] != UNKNOWN:
        check_count(source, int(wholes[COUNT]), values.size)
    length, peak, at = (known(figures[place]) for place in (LENGTH, PEAK, PEAK_TIME))
    if length is not None:
        check_duration(source, length, values.size, step, 0.005)
    if re.fullmatch(r"\d{1,6}\.?\d{0,6}", data.seconds):
        check_duration(source, float(data.seconds), values.size, step, 1.0)
    if peak is None:
        return None
    check_peak(source, peak, values, _ROUNDING[data.unit])
    if at is not None:
        check_peak_time(source, at, values, step, _ROUNDING[data.unit])
    return abs(peak)


def _lines(record: Record, row: int, values: FloatArray) -> list[str]:
    part = record.components[row]
    step, largest = part.time_step, int(np.abs(values).argmax())
    wholes, figures = np.full(100, UNKNOWN), np.full(100, UNKNOWN)
    wholes[[QUANTITY, UNIT, CHANNEL, COUNT]] = 1, 4, row + 1, values.size
    azimuth = re.fullmatch(r"\d{1,3}", part.name)
    wholes[AZIMUTH] = int(part.name) if azimuth else UNKNOWN
    figures[[STEP, LENGTH, PEAK, PEAK_TIME]] = 1000.0 * step, values.size * step, values[largest], largest * step
    known = {key: one_line(record.metadata.get(key, ""), 40) for key in ("event", "date", "station")}
    texts = [
        "Corrected acceleration    (Format v01.20 with 13 text lines)",
        f"{known['event'][:39]:<39} {known['date']}",
        *["", ""],
        f"Statn No: {one_line(record.metadata.get('station number', 'unknown'), 8)}  Code:unknown  {known['station']}",
        *["", "", ""],
        f"Sta Cha: {row + 1:2d}: {one_line(part.name, 20)} deg",
        *["", "", ""],
        "Values used when parameter or data value is unknown/unspecified:   -999, -999.0",
        " 100 Integer-header values follow on  10 lines, Format= (10I8)",
        *in_width(wholes, 10, 8, 0),
        " 100 Real-header values follow on  17 lines, Format= (6F13.6)",
        *in_width(figures, 6, 13, 6),
        '   0 Comment line(s) follow, each starting with a "|":',
    ]
    seconds = f"{values.size * step:.0f}"
    texts.append(f"{values.size:8d} acceleration pts, approx {seconds} secs, units=cm/sec2(04),Format=(8F12.5)")
    return [*texts, *in_width(values, 8, 12, 5), f"/&  ----------  End of data for channel {row + 1:2d}  ----------"]
