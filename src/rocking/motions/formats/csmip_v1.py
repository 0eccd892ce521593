"""CSMIP / CDMG Volume 1: uncorrected accelerograms, pairs of time and acceleration, one channel after another."""

import re
from collections.abc import Sequence
from typing import ClassVar

import numpy as np

from rocking.conventions import ACCELERATION_UNITS, FloatArray, g
from rocking.motions.formats import headers
from rocking.motions.formats.headers import LONGEST_LINE, Channel, check_count, check_peak, check_peak_time
from rocking.motions.formats.numbers import fixed, fortran_form, in_width, number, whole
from rocking.motions.formats.record import Component, Record, RecordFormat, Source, one_line

_TITLE = re.compile(r"\s*UNCORRECTED ACCELEROGRAM DATA\b", re.IGNORECASE)
_TEXT_LINES, _WHOLE_LINES, _REAL_LINES = 13, 7, 7
_EVEN = re.compile(r"\s*(\d+)\s+POINTS\b.*\bEQUALLY SPACED AT\s+(\S+?)\s*SEC\b[.,]?\s*(.*)", re.IGNORECASE)
_UNIT = re.compile(r"(?<![\w/])(G/10|CM/SEC/SEC|CM/SEC2|GALS?|G)(?![\w/*])")
_UNITS = {"G/10": "g/10", "CM/SEC/SEC": "cm/s2", "CM/SEC2": "cm/s2", "GAL": "gal", "GALS": "gal", "G": "g"}
_STATED_MAX = re.compile(r"\bMAX\s*=(?:\s*([+-]?(?:\d+\.?\d*|\.\d+))\s*(G/10|CM/SEC/SEC|CM/SEC2|GALS?|G)(?![\w/*]))?")
_LENGTH, _PEAK, _PEAK_TIME = 2, 6, 7


class CsmipV1(RecordFormat):
    """CSMIP / CDMG Volume 1 files."""

    name: ClassVar[str] = "csmip-v1"
    title: ClassVar[str] = "CSMIP Volume 1 (uncorrected), California Geological Survey"
    suffixes: ClassVar[tuple[str, ...]] = (".v1", ".raw")
    notes: ClassVar[str] = (
        "Written from public documentation; no real file was at hand. Uncorrected: neither baseline nor instrument. "
        "Unevenly spaced times are refused. Count, record length, peak (to 0.001 g) in numbers "
        "and in text, and its time are checked."
    )

    def recognises(self, source: Source) -> bool:
        """Return whether it begins as an uncorrected accelerogram with whole numbers after 13 lines."""
        if not source.is_text or not _TITLE.match(source.lines[0]) or len(source.lines) <= _TEXT_LINES:
            return False
        return re.fullmatch(r"[\s\d-]{5,80}", source.lines[_TEXT_LINES]) is not None

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        """Return the record, a component for each channel, named by its direction, or CHAN 1 where these repeat."""
        channels = headers.read_channels(source, _TITLE.match, lambda line: _channel(source, line, units, time_step))
        return headers.record_of_channels(self.name, channels, headers.names_in(channels[0][0][1:]))

    def write(self, record: Record) -> bytes:
        """Return the content of a CSMIP V1 file, in g/10 with 3 decimals."""
        lines: list[str] = []
        for row, values in enumerate(headers.in_unit(record, self.name, "g/10", 99)):
            lines += _lines(record, row, values.round(3))
        return ("\r\n".join(lines) + "\r\n").encode("latin-1")


def _channel(source: Source, first: int, units: str | None, time_step: float | None) -> tuple[Channel, int]:
    after = first + _TEXT_LINES + _WHOLE_LINES + _REAL_LINES
    if len(source.lines) <= after or not _TITLE.match(source.lines[first]):
        raise source.error(first, f"UNCORRECTED ACCELEROGRAM DATA and {after - first} header lines expected")
    header = source.lines[first:after]
    wholes, line = fixed(source, first + _TEXT_LINES, 100, 16, 5)
    # the last line of the reals is written full or not
    last = -(-len(source.lines[after - 1].rstrip()) // 10)
    figures, line = fixed(source, line, 48 + min(8, max(1, last)), 8, 10)
    # newer files state the number of samples at place 33, older ones at 28
    count = whole(source, first + _TEXT_LINES, f"{wholes[32] or wholes[27]:.0f}", "number of samples", 2)
    unit = headers.acceleration_unit(source, _unit([text[:LONGEST_LINE] for text in header[:_TEXT_LINES]]), units)
    even = _EVEN.fullmatch(source.lines[line][:LONGEST_LINE])
    if even:
        check_count(source, count, whole(source, line, even[1], "number of samples", 2))
        step, zero = number(source, line, even[2], "time step"), 0.0
        form = re.search(r"\(\s*\d+[FE]\d+\.\d+\s*\)", even[3].upper())
        per_line, width = fortran_form(source, line, form[0]) if form else (8, 9)
        values, line = fixed(source, line + 1, count, per_line, width)
    else:
        pairs, line = fixed(source, line, 2 * count, 10, 7)
        step, zero, values = headers.uniform_step(source, pairs[::2], 0.001), float(pairs[0]), pairs[1::2].copy()
    step = headers.step_between_samples(source, step, time_step)
    if not source.begins(line, "/&"):
        raise source.expected(line, "END OF DATA FOR CHANNEL")
    peak = _check_figures(source, figures, values, step, zero, unit)
    told = _check_text(source, first, values * ACCELERATION_UNITS[unit])
    if peak is None and told is not None:
        peak = told / ACCELERATION_UNITS[unit]
    return (header, header[6][:LONGEST_LINE], Component("", values, unit, step, peak)), line + 1


def _unit(texts: Sequence[str]) -> str | None:
    for text in texts:
        # the line goes on with the peak in another unit
        found = _UNIT.search(re.split(r"MAX|\.\s", text.upper())[0]) if "UNIT" in text.upper() else None
        if found:
            return _UNITS[found[1]]
    return None


def _check_figures(
    source: Source, figures: FloatArray, values: FloatArray, step: float, zero: float, unit: str
) -> float | None:
    length, peak, at = (float(figures[place]) for place in (_LENGTH, _PEAK, _PEAK_TIME))
    lasts = zero + (values.size - 1) * step
    if length > 0.0 and abs(length - lasts) > step + 0.06:
        raise source.error(None, f"the header states a record of {length:g} s, the last sample is at {lasts:g} s")
    if peak == 0.0:
        return None
    in_g = ACCELERATION_UNITS[unit] / g
    check_peak(source, peak, values * in_g, 6e-4)
    check_peak_time(source, at - zero, values * in_g, step, 6e-4)
    return abs(peak) / in_g


def _check_text(source: Source, first: int, values: FloatArray) -> float | None:
    """Compare samples in m/s2 with the peak that the text lines state, if they do, and return it in m/s2."""
    for line in range(first, first + _TEXT_LINES):
        found = _STATED_MAX.search(source.lines[line][:LONGEST_LINE].upper())
        if found is None:
            continue
        if found[1] is None:
            raise source.error(line, "MAX = a number and its unit expected; damaged?")
        factor = ACCELERATION_UNITS[_UNITS[found[2]]]
        # the samples are printed to 0.001 g/10, the peak to its last digit
        check_peak(source, float(found[1]), values / factor, headers.half_digit(found[1]) + 1.1e-4 * g / factor, "MAX")
        return abs(float(found[1])) * factor
    return None


def _lines(record: Record, row: int, values: FloatArray) -> list[str]:
    part = record.components[row]
    times = np.arange(values.size) * part.time_step
    largest = int(np.abs(values).argmax())
    figures, wholes = np.zeros(50), np.zeros(100)
    figures[[_LENGTH, _PEAK, _PEAK_TIME]] = times[-1], 0.1 * values[largest], times[largest]
    wholes[27] = values.size
    texts = [""] * _TEXT_LINES
    texts[0] = "UNCORRECTED ACCELEROGRAM DATA"
    texts[1] = record.text("event", 70)
    texts[4] = f"STATION NO. {record.text('station number', 8)}"
    texts[5] = record.text("station", 70)
    texts[6] = f"CHAN {row + 1:2d}: {one_line(part.name, 20)}"
    texts[11] = f"UNITS OF UNCOR ACCEL ARE SEC AND G/10.     MAX  = {figures[_PEAK]:.3f} G"
    lines = texts + in_width(wholes, 16, 5, 0) + in_width(figures, 8, 10, 3)
    lines += in_width(np.column_stack((times, values)).ravel(), 10, 7, 3)
    return [*lines, f"/&  ----------  END OF DATA FOR CHANNEL {row + 1:2d}  ----------"]
