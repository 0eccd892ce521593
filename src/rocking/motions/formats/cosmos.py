"""COSMOS v1.20: headers of text, whole numbers, reals and comments, and the samples, one channel after another."""

import re
from typing import ClassVar

import numpy as np

from rocking.conventions import FloatArray
from rocking.motions.formats.agreement import check_count, check_duration, check_end, check_peak, check_peak_time
from rocking.motions.formats.channels import Channel, distinct_names
from rocking.motions.formats.cosmos_header import (
    AZIMUTH,
    CHANNEL,
    COUNT,
    LENGTH,
    PEAK,
    PEAK_TIME,
    QUANTITY,
    STEP,
    UNIT,
    UNKNOWN,
    Header,
    begins_channel,
    known,
    read_header,
)
from rocking.motions.formats.number_lines import in_width, one_line
from rocking.motions.formats.numbers import fixed
from rocking.motions.formats.record import Component, Record
from rocking.motions.formats.record_format import RecordFormat
from rocking.motions.formats.source import Source
from rocking.motions.formats.units_and_steps import acceleration_unit, in_unit, step_between_samples

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
        """Return whether the first line states the format and its number of text lines."""
        return source.is_text and begins_channel(source, 0)

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        """Return the record, with a component for each channel.

        time_step: refused unless it is the header's [s]. Returns components named by their azimuth, or CHAN 1 where
        azimuths repeat.
        """
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
