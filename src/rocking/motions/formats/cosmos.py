"""COSMOS v1.20: headers of text, whole numbers, reals and comments, and the samples, one channel after another."""

import re
from typing import ClassVar

import numpy as np

from rocking.conventions import FloatArray
from rocking.motions.formats import directions, headers
from rocking.motions.formats.headers import (
    LONGEST_LINE,
    Channel,
    check_count,
    check_duration,
    check_peak,
    check_peak_time,
)
from rocking.motions.formats.numbers import fixed, fortran_form, in_width, whole, word
from rocking.motions.formats.record import Component, Record, RecordFormat, Source, metadata_of, one_line

_TITLE = re.compile(r".*\(Format v\s*0*1\.[12]0? with\s+(\d+) text lines\).*", re.IGNORECASE)
_TABLE = re.compile(
    r"\s*(\d+)\s+(Integer|Real)-header values follow on\s+(\d+) lines,\s*Format\s*=\s*(\(.*?\))\s*", re.I
)
_COMMENTS = re.compile(r"\s*(\d+)\s+Comment line\(?s?\)? follow.*", re.IGNORECASE)
_DATA = re.compile(
    r"\s*(\d+)\s+(\w[\w .]*?)\s+pts,\s*approx\s+(\S+)\s+secs?,\s*units\s*=\s*([^,(]+)\(\s*(\d+)\s*\)\s*,?\s*"
    r"Format\s*=\s*(\(.*?\))\s*",
    re.IGNORECASE,
)
_END = re.compile(r"/&|\s*End-of-data\b", re.IGNORECASE)
_CODE = re.compile(r"\|\s*<SCNL>\s*[\w-]+\.(\w{3})\.", re.IGNORECASE)
_UNKNOWN = -999.0
_MOST_TEXT = 200
# places in the headers, counted from 0: what is measured, its unit, azimuth, count; step [ms], length, peak, its time
_QUANTITY, _UNIT, _CHANNEL, _AZIMUTH, _COUNT = 1, 2, 49, 53, 69
_STEP, _LENGTH, _PEAK, _PEAK_TIME = 61, 62, 63, 64
# codes of the units that are accelerations; what the line before the data may call them
_UNITS = {2: ("g", {"g"}), 4: ("cm/s2", {"cm/sec2", "cm/sec/sec", "cm/s2", "cm/s/s", "cm/sec^2", "gal"})}
_SENSES = {400: "UP", 401: "DOWN", 500: "RADL", 501: "TRAN", 600: "LONG", 601: "TANG", 700: "H1", 701: "H2"}
"""Codes that stand for an azimuth, COSMOS tables: 402 is a vertical of unknown sense, and stays a number."""

_LEAST_DECIMALS = 3  # of a peak that is written in fewer digits than its columns have room for


class Cosmos(RecordFormat):
    """COSMOS files, volumes 0 to 2, of acceleration."""

    name: ClassVar[str] = "cosmos"
    title: ClassVar[str] = "COSMOS v1.20, Consortium of Organizations for Strong Motion Observation Systems"
    suffixes: ClassVar[tuple[str, ...]] = (".v1", ".v2", ".v0c", ".v1c", ".v2c")
    notes: ClassVar[str] = (
        "Layout: COSMOS Strong Motion Data Format, Ver. 1.20 (15 August 2001). Verified on the published test file and "
        "on one of 2018 of the U.S. Geological Survey, each of one channel in cm/sec2; several channels and data in g "
        "follow the description. Only units 02 (g) and 04 (cm/sec2) are read; counts and volts are refused."
    )

    def recognises(self, source: Source) -> bool:
        """Return whether the first line states the format and its number of text lines."""
        return source.is_text and _title(source.lines[0]) is not None

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        """Return the record, with a component for each channel, named by its azimuth, or CHAN 1 where these repeat."""
        channels = headers.read_channels(source, _title, lambda line: _channel(source, line, units, time_step))
        texts = channels[0][0]
        station = re.match(r"Statn No:\s*(\S+)\s+Code:\s*(\S+)\s+(.*)", texts[4])
        number, code, name = station.groups() if station else ("", "", "")
        metadata = metadata_of(
            event=texts[1][:39], date=texts[1][39:], station_number=number, station_code=code, station=name
        )
        return headers.record_of_channels(self.name, channels, metadata)

    def write(self, record: Record) -> bytes:
        """Return the content of a COSMOS file, in cm/sec2 with 5 decimals."""
        lines: list[str] = []
        for row, values in enumerate(headers.in_unit(record, self.name, "cm/s2", 99)):
            lines += _lines(record, row, values.round(5))
        return ("\n".join(lines) + "\n").encode("latin-1")


def _title(text: str) -> re.Match[str] | None:
    return _TITLE.fullmatch(text[:LONGEST_LINE])


def _table(source: Source, line: int, kind: str, least: int) -> tuple[FloatArray, int, tuple[int, int]]:
    found = _TABLE.fullmatch(source.lines[line][:LONGEST_LINE]) if line < len(source.lines) else None
    if found is None or found[2].lower() != kind:
        raise source.expected(line, f"{kind.title()}-header values follow on ... lines")
    count, lines = whole(source, line, found[1], "count", least), whole(source, line, found[3], "number of lines")
    per_line, width = fortran_form(source, line, found[4])
    if lines != -(-count // per_line):
        raise source.error(
            line, "{count} values, {per_line} a line, do not make {lines} lines", count=count, per_line=per_line,
            lines=lines,
        )  # fmt: skip
    values, after = fixed(source, line + 1, count, per_line, width)
    if kind == "integer" and (values != values.round()).any():
        raise source.error(line, "whole numbers expected in this header")
    return values, after, (per_line, width)


def _channel(source: Source, first: int, units: str | None, time_step: float | None) -> tuple[Channel, int]:
    title = _title(source.lines[first])
    if "spectr" in source.lines[first][:LONGEST_LINE].lower():
        raise source.error(first, "the file holds spectra, and accelerations over time are needed")
    texts = whole(source, first, title[1], "number of text lines") if title else 0
    if not 12 <= texts <= _MOST_TEXT or first + texts + 1 >= len(source.lines):
        raise source.error(first, "12 to {most} text lines expected, and as many lines after this one", most=_MOST_TEXT)
    wholes, reals, _ = _table(source, first + texts, "integer", 100)
    figures, comments, layout = _table(source, reals, "real", 100)
    line = _after_comments(source, comments)
    data, code = _data_line(source, line)
    if (int(wholes[_QUANTITY]), int(wholes[_UNIT])) != (1, code):
        raise source.error(line, "the header of whole numbers must state acceleration (1) and the unit of this line")
    unit = headers.acceleration_unit(source, _UNITS[code][0], units)
    known = None if figures[_STEP] == _UNKNOWN else float(figures[_STEP] / 1000.0)
    step = headers.step_between_samples(source, known, time_step)
    form = fortran_form(source, line, data[6])
    values, after = fixed(source, line + 1, whole(source, line, data[1], "count", 2), *form)
    largest = word(source, line + 1, int(np.abs(values).argmax()), *form)
    rounding = headers.printed_rounding(word(source, reals + 1, _PEAK, *layout), largest, _LEAST_DECIMALS)
    peak = _check(source, wholes, figures, values, step, rounding)
    if re.fullmatch(r"\d{1,6}\.?\d{0,6}", data[3]):
        check_duration(source, float(data[3]), values.size, step, 1.0)
    if after >= len(source.lines) or not _END.match(source.lines[after]):
        raise source.expected(after, "End of data for channel")
    header = source.lines[first : line + 1]
    label = _label(header, texts, wholes[_AZIMUTH])
    return (header, label, Component("", values, unit, step, peak, _contradicted(header, texts, label))), after + 1


def _contradicted(header: list[str], texts: int, label: str) -> dict[str, str]:
    """Return that the direction is unclear, where a code or text of the channel is vertical and its azimuth is not."""
    side = directions.orientation(label.partition(": ")[2])
    for said in (_code(header), _said(header, texts)):
        if directions.both(directions.orientation(said), side) == directions.UNCLEAR:
            return {directions.KEY: directions.UNCLEAR}
    return {}


def _code(header: list[str]) -> str:
    return next((code[1] for text in header if (code := _CODE.match(text[:LONGEST_LINE]))), "")


def _said(header: list[str], texts: int) -> str:
    label = next((text[:LONGEST_LINE] for text in header[:texts] if text.startswith("Sta Cha")), "")
    found = re.search(r":\s*([\w-]+)(?:\s+deg\b|\s+\()", label, re.IGNORECASE)
    return found[1] if found else ""


def _label(header: list[str], texts: int, azimuth: float) -> str:
    """Return number and direction, as ``CHAN 1: 90``: the azimuth if it is known, else what the text or a code says."""
    label = next((text[:LONGEST_LINE] for text in header[:texts] if text.startswith("Sta Cha")), "")
    number = re.match(r"Sta Cha\w*\s*:?\s*(\d+)", label)
    code = _code(header)
    # an azimuth of 0 may stand for none where the text gives no degrees
    known = azimuth > 0.0 or (azimuth == 0.0 and not code) or re.search(r"\bdeg\b", label, re.IGNORECASE)
    direction = f"{azimuth:.0f}" if azimuth != _UNKNOWN and known else code or _said(header, texts)
    return f"CHAN {number[1] if number else 1}: {_SENSES.get(int(azimuth), direction)}"


def _data_line(source: Source, line: int) -> tuple[re.Match[str], int]:
    """Return the line before the samples, and the code of its unit."""
    found = _DATA.fullmatch(source.lines[line][:LONGEST_LINE]) if line < len(source.lines) else None
    if found is None:
        raise source.expected(line, "... pts, approx ... secs, units=...,Format=...")
    code = int(found[5][:4])
    if "count" in found[4].lower() or "count" in found[2].lower():
        raise source.error(line, "the file holds counts of the recorder, no accelerations; take its V1 or V2 file")
    if not re.search(r"\baccel", found[2], re.IGNORECASE) or code not in _UNITS:
        raise source.error(
            line, "acceleration in g (02) or cm/sec2 (04) expected, found {quantity} in {unit}", quantity=found[2],
            unit=found[4].strip(),
        )  # fmt: skip
    if found[4].strip(" .\t").lower() not in _UNITS[code][1]:
        raise source.error(line, "unit {unit!r} contradicts its code {code:02d}", unit=found[4].strip(), code=code)
    return found, code


def _check(
    source: Source, wholes: FloatArray, figures: FloatArray, values: FloatArray, step: float, rounding: float
) -> float | None:
    if wholes[_COUNT] != _UNKNOWN:
        check_count(source, int(wholes[_COUNT]), values.size)
    length, peak, at = (float(figures[place]) for place in (_LENGTH, _PEAK, _PEAK_TIME))
    if length != _UNKNOWN:
        check_duration(source, length, values.size, step, 0.005)
    if peak == _UNKNOWN:
        return None
    check_peak(source, peak, values, rounding)
    if at != _UNKNOWN:
        check_peak_time(source, at, values, step, rounding)
    return abs(peak)


def _after_comments(source: Source, line: int) -> int:
    comments = _COMMENTS.fullmatch(source.lines[line]) if line < len(source.lines) else None
    if comments is None:
        return line
    until = line + 1 + whole(source, line, comments[1], "number of comment lines")
    for at in range(line + 1, min(until, len(source.lines))):
        if not source.lines[at].lstrip().startswith("|"):
            raise source.error(at, "a comment line that starts with | expected")
    return until


def _lines(record: Record, row: int, values: FloatArray) -> list[str]:
    part = record.components[row]
    step, largest = part.time_step, int(np.abs(values).argmax())
    wholes, figures = np.full(100, _UNKNOWN), np.full(100, _UNKNOWN)
    wholes[[_QUANTITY, _UNIT, _CHANNEL, _COUNT]] = 1, 4, row + 1, values.size
    azimuth = re.fullmatch(r"\d{1,3}", part.name)
    senses = {name: code for code, name in _SENSES.items()}
    wholes[_AZIMUTH] = int(part.name) if azimuth else senses.get(part.name.upper(), _UNKNOWN)
    figures[[_STEP, _LENGTH, _PEAK, _PEAK_TIME]] = 1000.0 * step, values.size * step, values[largest], largest * step
    event, date, station = (record.text(key, 40) for key in ("event", "date", "station"))
    texts = [
        "Corrected acceleration    (Format v01.20 with 13 text lines)",
        f"{event[:39]:<39} {date}",
        *["", ""],
        f"Statn No: {record.text('station number', 8, 'unknown')}  Code:unknown  {station}",
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
