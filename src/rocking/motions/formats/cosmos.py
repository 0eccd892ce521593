"""COSMOS v1.20: channels with headers of text, integers, reals and comments, followed by the samples."""

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
# indices in the integers: quantity, unit, azimuth, count; in the reals: step [ms], length, peak, time of the peak
_QUANTITY, _UNIT, _CHANNEL, _AZIMUTH, _COUNT = 1, 2, 49, 53, 69
_STEP, _LENGTH, _PEAK, _PEAK_TIME = 61, 62, 63, 64
# codes of acceleration units, and their names in the line before the data
_UNITS = {2: ("g", {"g"}), 4: ("cm/s2", {"cm/sec2", "cm/sec/sec", "cm/s2", "cm/s/s", "cm/sec^2", "gal"})}
_SENSES = {400: "UP", 401: "DOWN", 500: "RADL", 501: "TRAN", 600: "LONG", 601: "TANG", 700: "H1", 701: "H2"}
"""Directions by azimuth code of the COSMOS tables. Code 402, a vertical of unknown sense, remains a number."""

_MIN_DECIMALS = 3  # minimum number of decimals of a peak with fewer digits than its field


class Cosmos(RecordFormat):
    """COSMOS files, volumes 0 to 2, of acceleration."""

    name: ClassVar[str] = "cosmos"
    title: ClassVar[str] = "COSMOS v1.20, Consortium of Organizations for Strong Motion Observation Systems"
    suffixes: ClassVar[tuple[str, ...]] = (".v1", ".v2", ".v0c", ".v1c", ".v2c")
    notes: ClassVar[str] = (
        "Layout: COSMOS Strong Motion Data Format, Ver. 1.20 (15 August 2001). Verified with the published test "
        "file and a file of 2018 of the U.S. Geological Survey, each with one channel in cm/sec2; several channels and "
        "data in g follow the description. Only units 02 (g) and 04 (cm/sec2) are allowed, not counts and volts."
    )

    def recognises(self, source: Source) -> bool:
        """Return True if the first line contains the format and its number of text lines."""
        return source.is_text and _title(source.lines[0]) is not None

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        """Return the record with one component per channel. Names are azimuths, or CHAN 1 for repeated azimuths."""
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


def _table(source: Source, line: int, kind: str, minimum: int) -> tuple[FloatArray, int, tuple[int, int]]:
    match = _TABLE.fullmatch(source.lines[line][:LONGEST_LINE]) if line < len(source.lines) else None
    if match is None or match[2].lower() != kind:
        raise source.expected(line, f"{kind.title()}-header values follow on ... lines")
    count, lines = whole(source, line, match[1], "count", minimum), whole(source, line, match[3], "number of lines")
    per_line, width = fortran_form(source, line, match[4])
    if lines != -(-count // per_line):
        raise source.error(
            line, "{count} values with {per_line} per line contradict {lines} lines", count=count, per_line=per_line,
            lines=lines,
        )  # fmt: skip
    values, after = fixed(source, line + 1, count, per_line, width)
    if kind == "integer" and (values != values.round()).any():
        raise source.error(line, "whole numbers expected in this header")
    return values, after, (per_line, width)


def _channel(source: Source, first: int, units: str | None, time_step: float | None) -> tuple[Channel, int]:
    title = _title(source.lines[first])
    if "spectr" in source.lines[first][:LONGEST_LINE].lower():
        raise source.error(first, "the file contains spectra; accelerations over time are required")
    texts = whole(source, first, title[1], "number of text lines") if title else 0
    if not 12 <= texts <= _MOST_TEXT or first + texts + 1 >= len(source.lines):
        raise source.error(first, "12 to {most} text lines expected after this line", most=_MOST_TEXT)
    wholes, reals, _ = _table(source, first + texts, "integer", 100)
    figures, comments, layout = _table(source, reals, "real", 100)
    line = _after_comments(source, comments)
    data, code = _data_line(source, line)
    if (int(wholes[_QUANTITY]), int(wholes[_UNIT])) != (1, code):
        raise source.error(line, "the integer header must contain acceleration (1) and the unit of this line")
    unit = headers.acceleration_unit(source, _UNITS[code][0], units)
    stated_step = None if figures[_STEP] == _UNKNOWN else float(figures[_STEP] / 1000.0)
    step = headers.step_between_samples(source, stated_step, time_step)
    form = fortran_form(source, line, data[6])
    values, after = fixed(source, line + 1, whole(source, line, data[1], "count", 2), *form)
    largest = word(source, line + 1, int(np.abs(values).argmax()), *form)
    rounding = headers.printed_rounding(word(source, reals + 1, _PEAK, *layout), largest, _MIN_DECIMALS)
    peak = _check(source, wholes, figures, values, step, rounding)
    if re.fullmatch(r"\d{1,6}\.?\d{0,6}", data[3]):
        check_duration(source, float(data[3]), values.size, step, 1.0)
    if after >= len(source.lines) or not _END.match(source.lines[after]):
        raise source.expected(after, "End of data for channel")
    header = source.lines[first : line + 1]
    label = _label(header, texts, wholes[_AZIMUTH])
    return (header, label, Component("", values, unit, step, peak, _contradicted(header, texts, label))), after + 1


def _contradicted(header: list[str], texts: int, label: str) -> dict[str, str]:
    """Return an unclear direction if code or text of the channel are vertical, but the azimuth is not."""
    side = directions.orientation(label.partition(": ")[2])
    for text in (_code(header), _stated_direction(header, texts)):
        if directions.both(directions.orientation(text), side) == directions.UNCLEAR:
            return {directions.KEY: directions.UNCLEAR}
    return {}


def _code(header: list[str]) -> str:
    return next((code[1] for text in header if (code := _CODE.match(text[:LONGEST_LINE]))), "")


def _stated_direction(header: list[str], texts: int) -> str:
    label = next((text[:LONGEST_LINE] for text in header[:texts] if text.startswith("Sta Cha")), "")
    match = re.search(r":\s*([\w-]+)(?:\s+deg\b|\s+\()", label, re.IGNORECASE)
    return match[1] if match else ""


def _label(header: list[str], texts: int, azimuth: float) -> str:
    """Return number and direction such as ``CHAN 1: 90``, from the azimuth, or otherwise from text or code."""
    label = next((text[:LONGEST_LINE] for text in header[:texts] if text.startswith("Sta Cha")), "")
    number = re.match(r"Sta Cha\w*\s*:?\s*(\d+)", label)
    code = _code(header)
    # an azimuth of 0 may mean a missing azimuth if the text contains no degrees
    is_stated = azimuth > 0.0 or (azimuth == 0.0 and not code) or re.search(r"\bdeg\b", label, re.IGNORECASE)
    direction = f"{azimuth:.0f}" if azimuth != _UNKNOWN and is_stated else code or _stated_direction(header, texts)
    return f"CHAN {number[1] if number else 1}: {_SENSES.get(int(azimuth), direction)}"


def _data_line(source: Source, line: int) -> tuple[re.Match[str], int]:
    """Return the line before the samples, and the unit code in this line."""
    match = _DATA.fullmatch(source.lines[line][:LONGEST_LINE]) if line < len(source.lines) else None
    if match is None:
        raise source.expected(line, "... pts, approx ... secs, units=...,Format=...")
    code = int(match[5][:4])
    if "count" in match[4].lower() or "count" in match[2].lower():
        raise source.error(line, "the file contains counts of the recorder; use the V1 or V2 file with accelerations")
    if not re.search(r"\baccel", match[2], re.IGNORECASE) or code not in _UNITS:
        raise source.error(
            line, "acceleration in g (02) or cm/sec2 (04) expected, found {quantity} in {unit}", quantity=match[2],
            unit=match[4].strip(),
        )  # fmt: skip
    if match[4].strip(" .\t").lower() not in _UNITS[code][1]:
        raise source.error(line, "unit {unit!r} contradicts its code {code:02d}", unit=match[4].strip(), code=code)
    return match, code


def _check(
    source: Source, wholes: FloatArray, figures: FloatArray, values: FloatArray, step: float, rounding: float
) -> float | None:
    if wholes[_COUNT] != _UNKNOWN:
        check_count(source, int(wholes[_COUNT]), values.size)
    length, peak, peak_time = (float(figures[index]) for index in (_LENGTH, _PEAK, _PEAK_TIME))
    if length != _UNKNOWN:
        check_duration(source, length, values.size, step, 0.005)
    if peak == _UNKNOWN:
        return None
    check_peak(source, peak, values, rounding)
    if peak_time != _UNKNOWN:
        check_peak_time(source, peak_time, values, step, rounding)
    return abs(peak)


def _after_comments(source: Source, line: int) -> int:
    comments = _COMMENTS.fullmatch(source.lines[line]) if line < len(source.lines) else None
    if comments is None:
        return line
    until = line + 1 + whole(source, line, comments[1], "number of comment lines")
    for index in range(line + 1, min(until, len(source.lines))):
        if not source.lines[index].lstrip().startswith("|"):
            raise source.error(index, "comment line that begins with | expected")
    return until


def _lines(record: Record, row: int, values: FloatArray) -> list[str]:
    component = record.components[row]
    step, largest = component.time_step, int(np.abs(values).argmax())
    wholes, figures = np.full(100, _UNKNOWN), np.full(100, _UNKNOWN)
    wholes[[_QUANTITY, _UNIT, _CHANNEL, _COUNT]] = 1, 4, row + 1, values.size
    azimuth = re.fullmatch(r"\d{1,3}", component.name)
    senses = {name: code for code, name in _SENSES.items()}
    wholes[_AZIMUTH] = int(component.name) if azimuth else senses.get(component.name.upper(), _UNKNOWN)
    figures[[_STEP, _LENGTH, _PEAK, _PEAK_TIME]] = 1000.0 * step, values.size * step, values[largest], largest * step
    event, date, station = (record.text(key, 40) for key in ("event", "date", "station"))
    texts = [
        "Corrected acceleration    (Format v01.20 with 13 text lines)",
        f"{event[:39]:<39} {date}",
        *["", ""],
        f"Statn No: {record.text('station number', 8, 'unknown')}  Code:unknown  {station}",
        *["", "", ""],
        f"Sta Cha: {row + 1:2d}: {one_line(component.name, 20)} deg",
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
