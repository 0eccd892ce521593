"""COSMOS v1.20: headers of text, whole numbers, reals and comments, and the samples, one channel after another."""

import re
from typing import ClassVar, NamedTuple

import numpy as np

from rocking.conventions import FloatArray
from rocking.motions.formats.agreement import check_count, check_duration, check_end, check_peak, check_peak_time
from rocking.motions.formats.csmip_v1 import Channel, distinct_names
from rocking.motions.formats.number_lines import in_width, one_line
from rocking.motions.formats.numbers import fixed, fortran_form, whole
from rocking.motions.formats.record import Component, Record
from rocking.motions.formats.record_format import RecordFormat
from rocking.motions.formats.source import Source
from rocking.motions.formats.units_and_steps import acceleration_unit, in_unit, step_between_samples

_TITLE = re.compile(r".*\(Format v\s*0*1\.[12]0? with\s+(\d+) text lines\).*", re.IGNORECASE)
_TABLE = re.compile(
    r"\s*(\d+)\s+(Integer|Real)-header values follow on\s+(\d+) lines,\s*Format\s*=\s*(\(.*?\))\s*", re.I
)
_COMMENTS = re.compile(r"\s*(\d+)\s+Comment line\(?s?\)? follow.*", re.IGNORECASE)
_DATA = re.compile(
    r"\s*(\d+)\s+(\w+)\s+pts,\s*approx\s+(\S+)\s+secs?,\s*units\s*=\s*([^,(]+)\(\s*(\d+)\s*\),\s*Format\s*=\s*(\(.*?\))\s*",
    re.IGNORECASE,
)
_UNKNOWN = -999.0
_MOST_TEXT = 200
# places in the headers, counted from 0: what is measured, its unit, azimuth, count; step [ms], length, peak, its time
_QUANTITY, _UNIT, _CHANNEL, _AZIMUTH, _COUNT = 1, 2, 49, 53, 69
_STEP, _LENGTH, _PEAK, _PEAK_TIME = 61, 62, 63, 64
# codes of the units that are accelerations; what the line before the data may call them
_UNITS = {2: ("g", {"g"}), 4: ("cm/s2", {"cm/sec2", "cm/sec/sec", "cm/s2", "cm/s/s", "cm/sec^2", "gal"})}
# header and data round apart: the peak is written in fewer digits than the samples
_ROUNDING = {"cm/s2": 6e-4, "g": 1e-5}


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
        """Return whether the first line states the format and its number of text lines.

        Parameters
        ----------
        source : Source
            The file.

        Returns
        -------
        bool
            True if so.
        """
        return source.is_text and _TITLE.fullmatch(source.lines[0][:200]) is not None

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        """Return the record, with a component for each channel.

        Parameters
        ----------
        source : Source
            The file.
        units : str, optional
            Refused unless it is the header's.
        time_step : float, optional
            Refused unless it is the header's [s].

        Returns
        -------
        Record
            Components named by their azimuth, or CHAN 1 where azimuths repeat.

        Raises
        ------
        RecordError
            If it is damaged, at odds with its own header, or not acceleration.
        """
        first = 0
        channels: list[Channel] = []
        while not channels or (first < len(source.lines) and _TITLE.fullmatch(source.lines[first][:200])):
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
        """Return the content of a COSMOS file, in cm/sec2 with 5 decimals.

        Parameters
        ----------
        record : Record
            Up to 99 components.

        Returns
        -------
        bytes
            The content.

        Raises
        ------
        RecordError
            If there are more components or a number does not fit into its column.
        """
        lines: list[str] = []
        for row, values in enumerate(in_unit(record, self.name, "cm/s2", 99)):
            lines += _lines(record, row, values.round(5))
        return ("\n".join(lines) + "\n").encode("latin-1")


class _Data(NamedTuple):
    samples: int
    seconds: str
    unit: str
    code: int
    per_line: int
    width: int


def _channel(source: Source, first: int, units: str | None, time_step: float | None) -> tuple[Channel, int]:
    title = _TITLE.fullmatch(source.lines[first][:200])
    texts = whole(source, first, title[1], "number of text lines") if title else 0
    if not 12 <= texts <= _MOST_TEXT or first + texts + 1 >= len(source.lines):
        raise source.error(first, f"12 to {_MOST_TEXT} text lines expected, and as many lines after this one")
    wholes, line = _table(source, first + texts, "integer", 100)
    figures, line = _table(source, line, "real", 100)
    comments = _COMMENTS.fullmatch(source.lines[line]) if line < len(source.lines) else None
    if comments:
        until = line + 1 + whole(source, line, comments[1], "number of comment lines")
        for at in range(line + 1, min(until, len(source.lines))):
            if not source.lines[at].lstrip().startswith("|"):
                raise source.error(at, "a comment line that starts with | expected")
        line = until
    data = _data_line(source, line)
    header = source.lines[first : line + 1]
    unit = acceleration_unit(source, data.unit, units)
    if (int(wholes[_QUANTITY]), int(wholes[_UNIT])) != (1, data.code):
        raise source.error(line, "the header of whole numbers must state acceleration (1) and the unit of this line")
    step = step_between_samples(source, _known(figures[_STEP] / 1000.0, _UNKNOWN / 1000.0), time_step)
    values, after = fixed(source, line + 1, data.samples, data.per_line, data.width)
    peak = _check(source, data, wholes, figures, values, step)
    if after >= len(source.lines) or not source.lines[after].startswith("/&"):
        raise source.error(min(after, len(source.lines) - 1), "End of data for channel expected")
    label = next((text[:200] for text in header[:texts] if text.startswith("Sta Cha")), "")
    chan = re.match(r"Sta Cha\w*\s*:?\s*(\d+)", label)
    azimuth = "" if wholes[_AZIMUTH] == _UNKNOWN else f"{wholes[_AZIMUTH]:.0f}"
    named = f"CHAN {chan[1] if chan else 1}: {_direction(label, azimuth)}"
    return (header, named, Component("", values, unit, step, peak)), after + 1


def _direction(label: str, azimuth: str) -> str:
    found = re.search(r":\s*([\w-]+)(?:\s+deg\b|\s+\()", label)
    return found[1] if found and not azimuth else azimuth


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


def _data_line(source: Source, line: int) -> _Data:
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
    return _Data(whole(source, line, found[1], "count", 2), found[3], unit, code, *fortran_form(source, line, found[6]))


def _known(value: float, unknown: float = _UNKNOWN) -> float | None:
    return None if value == unknown else float(value)


def _check(
    source: Source, data: _Data, wholes: FloatArray, figures: FloatArray, values: FloatArray, step: float
) -> float | None:
    if wholes[_COUNT] != _UNKNOWN:
        check_count(source, int(wholes[_COUNT]), values.size)
    length, peak, at = (_known(figures[place]) for place in (_LENGTH, _PEAK, _PEAK_TIME))
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
    wholes, figures = np.full(100, _UNKNOWN), np.full(100, _UNKNOWN)
    wholes[[_QUANTITY, _UNIT, _CHANNEL, _COUNT]] = 1, 4, row + 1, values.size
    azimuth = re.fullmatch(r"\d{1,3}", part.name)
    wholes[_AZIMUTH] = int(part.name) if azimuth else _UNKNOWN
    figures[[_STEP, _LENGTH, _PEAK, _PEAK_TIME]] = 1000.0 * step, values.size * step, values[largest], largest * step
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
