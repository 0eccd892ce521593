"""Uncorrected accelerograms by channel: CSMIP / CDMG Volume 1, and the older Volume 1 of Caltech and USC."""

import re
from collections.abc import Sequence
from typing import ClassVar

import numpy as np

from rocking.conventions import ACCELERATION_UNITS, FloatArray, g
from rocking.motions.formats import headers
from rocking.motions.formats.headers import LONGEST_LINE, Channel, check_count, check_peak
from rocking.motions.formats.numbers import fixed, fortran_form, in_width, number, whole, word
from rocking.motions.formats.record import Component, Record, RecordFormat, Source, one_line

_TEXT_LINES, _WHOLE_LINES, _REAL_LINES = 13, 7, 7
_HEADER_LINES = _TEXT_LINES + _WHOLE_LINES + _REAL_LINES
_SPACED = re.compile(r"\s*(\d+)\s+POINTS\b.*\bEQUALLY SPACED AT\s+(\S+?)\s*SEC\b[.,]?\s*(.*)", re.IGNORECASE)
_RATED = re.compile(r"\s*(\d+)\s+(?:\w+\s+)?(?:POINTS|PTS)\s+AT\s+(\S+)\s+(?:PTS|POINTS|SAMPLES)/SEC\b[.,]?(.*)", re.I)
_POINTS = re.compile(r"NO\. OF POINTS\s*=\s*(\d{1,9})\b", re.IGNORECASE)
_UNIT = re.compile(r"(?<![\w/])(G/10|CM/SEC/SEC|CM/SEC2|GALS?|G)(?![\w/*])")
_UNITS = {"G/10": "g/10", "CM/SEC/SEC": "cm/s2", "CM/SEC2": "cm/s2", "GAL": "gal", "GALS": "gal", "G": "g"}
_STATED_MAX = re.compile(r"\bMAX\s*=(?:\s*([+-]?(?:\d+\.?\d*|\.\d+))\s*(G/10|CM/SEC/SEC|CM/SEC2|GALS?|G)(?![\w/*]))?")
_LENGTH, _PEAK, _PEAK_TIME = 2, 6, 7
_UNKNOWN = -999.0  # unknown value in newer files
_PAIRS = 10, 7  # columns of pairs of time and sample, and their width


class CsmipV1(RecordFormat):
    """CSMIP / CDMG Volume 1 files, and files of RENADIC, Chile."""

    name: ClassVar[str] = "csmip-v1"
    title: ClassVar[str] = "CSMIP Volume 1 (uncorrected), California Geological Survey; RENADIC, Chile"
    suffixes: ClassVar[tuple[str, ...]] = (".v1", ".raw")
    notes: ClassVar[str] = (
        "Layout: standard tape format of CSMIP, report OSMS 85-03. Verified with files of 1992, 2012 and 2019, and "
        "three files of RENADIC, with the time of the peak from the trigger. No correction of baseline or instrument. "
        "Samples at uneven times are resampled. The count and peak of numbers and text are checked."
    )
    begins: ClassVar[re.Pattern[str]] = re.compile(r"\s*UNCORRECTED ACCELEROGRAM DATA\b", re.IGNORECASE)
    _skip: ClassVar[int] = 0  # blanks before the pairs of a line
    _counts: ClassVar[tuple[int, ...]] = (32, 27)  # indices of the number of samples in newer and older files
    _has_peak: ClassVar[bool] = True  # True if the header numbers end with the peak and its time
    _end: ClassVar[str] = "/&"  # start of the line after the samples

    def recognises(self, source: Source) -> bool:
        """Return True if the file begins as an uncorrected accelerogram with integers after 13 lines."""
        if not source.is_text or not self.begins.match(source.lines[0]) or len(source.lines) <= _TEXT_LINES:
            return False
        return re.fullmatch(r"[\s\d-]{5,80}", source.lines[_TEXT_LINES]) is not None

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        """Return the record with one component per channel. Names are directions, or CHAN 1 for repeated directions."""
        channels = headers.read_channels(
            source, self.begins.match, lambda line: self._channel(source, line, units, time_step)
        )
        return headers.record_of_channels(self.name, channels, headers.names_in(channels[0][0][1:]))

    def write(self, record: Record) -> bytes:
        """Return the content of a CSMIP V1 file, in g/10 with 3 decimals."""
        lines: list[str] = []
        for row, values in enumerate(headers.in_unit(record, self.name, "g/10", 99)):
            lines += _lines(record, row, values.round(3))
        return ("\r\n".join(lines) + "\r\n").encode("latin-1")

    def _channel(self, source: Source, first: int, units: str | None, time_step: float | None) -> tuple[Channel, int]:
        after = first + _HEADER_LINES
        if len(source.lines) <= after or not self.begins.match(source.lines[first]):
            raise source.error(
                first, "UNCORRECTED ACCELEROGRAM DATA and {count} header lines expected", count=after - first
            )
        header = source.lines[first:after]
        wholes, reals = fixed(source, first + _TEXT_LINES, 100, 16, 5)
        # the last line of the reals may be shorter
        figures, line = fixed(
            source, reals, 48 + min(8, max(1, -(-len(source.lines[after - 1].rstrip()) // 10))), 8, 10
        )
        stated = next((wholes[index] for index in self._counts if wholes[index]), 0.0)
        count = whole(source, first + _TEXT_LINES, f"{stated:.0f}", "number of samples", 2)
        for text in header[:_TEXT_LINES]:
            if points := _POINTS.search(text[:LONGEST_LINE]):
                check_count(source, int(points[1]), count)
        unit = headers.acceleration_unit(source, _unit([text[:LONGEST_LINE] for text in header[:_TEXT_LINES]]), units)
        even, processing = _even(source, line, count, unit), dict[str, str]()
        if even:
            step, form = even
            raw, behind = fixed(source, line + 1, count, *form)
            values, zero = raw, 0.0
            printed = word(source, line + 1, int(np.abs(raw).argmax()), *form)
        else:
            pairs, behind = fixed(source, line, 2 * count, *_PAIRS, self._skip)
            raw, top = pairs[1::2].copy(), int(np.abs(pairs[1::2]).argmax())
            values, step, processing = headers.at_even_steps(source, pairs[::2], raw, 0.001)
            zero = float(pairs[2 * top]) - int(np.abs(values).argmax()) * step
            printed = f"{raw[top]:.3f}"
        step = headers.step_between_samples(source, step, time_step)
        if self._end and not source.begins(behind, self._end):
            raise source.expected(behind, "END OF DATA FOR CHANNEL")
        length, end = figures[_LENGTH], zero + (values.size - 1) * step
        if length > 0.0 and abs(length - end) > step + 0.06:
            source.doubt(None, f"the duration in the header is {length:g} s, but the last sample is at {end:g} s")
        in_g = ACCELERATION_UNITS[unit] / g
        peak, at = (float(figures[index]) for index in (_PEAK, _PEAK_TIME))
        in_numbers = self._has_peak and peak not in {0.0, _UNKNOWN}
        digit = headers.half_digit(printed) * in_g
        peak_size = _check_text(source, first, raw * ACCELERATION_UNITS[unit], digit * g, confirmed=in_numbers)
        if in_numbers:
            rounding = headers.half_digit(word(source, reals, _PEAK, 8, 10)) + digit
            check_peak(source, peak, raw * in_g, rounding)
            headers.check_peak_time(source, at - zero, values * in_g, step, rounding)
            peak_size = abs(peak) * g
        component = Component("", values, unit, step, peak_size and peak_size / ACCELERATION_UNITS[unit], processing)
        return (header, header[6][:LONGEST_LINE], component), behind + bool(self._end)


class Usc(CsmipV1):
    """Volume 1 of Caltech and USC, the model for CSMIP."""

    name: ClassVar[str] = "usc"
    title: ClassVar[str] = "Volume I (uncorrected) of Caltech and the University of Southern California"
    suffixes: ClassVar[tuple[str, ...]] = (".v1", ".s0a", ".raw")
    notes: ClassVar[str] = (
        "Layout: Trifunac and Lee 1973, Caltech report EERL 73-03, and a file of 1994, which verified it. "
        "Pairs of time and acceleration, resampled for uneven times. Without a peak, a damaged sample is not detected. "
        "No correction of baseline or instrument."
    )
    begins: ClassVar[re.Pattern[str]] = re.compile(
        r"\s*FILE\s+\d+ OF UNCORRECTED ACCELEROGRAM DATA OF VOL", re.IGNORECASE
    )
    _skip: ClassVar[int] = 1
    _counts: ClassVar[tuple[int, ...]] = (27,)
    _has_peak: ClassVar[bool] = False
    _end: ClassVar[str] = ""

    def write(self, record: Record) -> bytes:
        """Return a file of Volume I, in g/10 with 3 decimals."""
        lines: list[str] = []
        for row, values in enumerate(headers.in_unit(record, self.name, "g/10", 99)):
            channel_lines = _lines(record, row, values.round(3))[:-1]
            channel_lines[0] = f"FILE {row + 1:5d} OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I:"
            channel_lines[6] = f"COMP {one_line(record.components[row].name, 20)}"
            header = _TEXT_LINES + _WHOLE_LINES + _REAL_LINES
            lines += [*channel_lines[:header], *(f" {text}" for text in channel_lines[header:])]
        return ("\r\n".join(lines) + "\r\n").encode("latin-1")


def _even(source: Source, line: int, count: int, unit: str) -> tuple[float, tuple[int, int]] | None:
    """Return time step and columns of samples at even times, from the line before the samples; None for pairs."""
    text = source.lines[line][:LONGEST_LINE]
    spaced, rated = _SPACED.fullmatch(text), _RATED.fullmatch(text)
    match = spaced or rated
    if match is None:
        return None
    check_count(source, count, whole(source, line, match[1], "number of samples", 2))
    tail = match[3].upper()
    if "COUNT" in tail:
        raise source.error(line, "the file contains counts of the recorder; use a file with accelerations")
    headers.acceleration_unit(source, _unit([tail]), unit)
    amount = number(source, line, match[2], "time step" if spaced else "sampling rate")
    form = re.search(r"\(\s*\d+[FE]\d+\.\d+\s*\)", tail)
    step = amount if spaced else 1.0 / amount if amount > 0.0 else 0.0
    return step, fortran_form(source, line, form[0]) if form else (8, 9)


def _unit(texts: Sequence[str]) -> str | None:
    for text in texts:
        # the line may also contain the peak in another unit
        match = _UNIT.search(re.split(r"MAX|\.\s", text.upper())[0]) if "UNIT" in text.upper() else None
        if match:
            return _UNITS[match[1]]
    return None


def _check_text(source: Source, first: int, values: FloatArray, rounding: float, *, confirmed: bool) -> float | None:
    """Compare samples [m/s2] with the peak in the text lines, and return the peak, or None."""
    for line in range(first, first + _TEXT_LINES):
        match = _STATED_MAX.search(source.lines[line][:LONGEST_LINE].upper())
        if match is None:
            continue
        if match[1] is None:
            raise source.error(line, "number and unit after MAX = expected; the file may be damaged")
        factor = ACCELERATION_UNITS[_UNITS[match[2]]]
        slack = headers.half_digit(match[1]) + rounding / factor
        headers.check_said_peak(source, float(match[1]), values / factor, slack, "MAX", confirmed=confirmed)
        return abs(float(match[1])) * factor
    return None


def _lines(record: Record, row: int, values: FloatArray) -> list[str]:
    component = record.components[row]
    times = np.arange(values.size) * component.time_step
    largest = int(np.abs(values).argmax())
    figures, wholes = np.zeros(50), np.zeros(100)
    figures[[_LENGTH, _PEAK, _PEAK_TIME]] = times[-1], 0.1 * values[largest], times[largest]
    wholes[27] = values.size
    texts = [""] * _TEXT_LINES
    texts[0] = "UNCORRECTED ACCELEROGRAM DATA"
    texts[1] = record.text("event", 70)
    texts[4] = f"STATION NO. {record.text('station number', 8)}"
    texts[5] = record.text("station", 70)
    texts[6] = f"CHAN {row + 1:2d}: {one_line(component.name, 20)}"
    texts[10] = f"NO. OF POINTS = {values.size:6d}"
    texts[11] = f"UNITS OF UNCOR ACCEL ARE SEC AND G/10.     MAX  = {figures[_PEAK]:.3f} G"
    lines = texts + in_width(wholes, 16, 5, 0) + in_width(figures, 8, 10, 3)
    lines += in_width(np.column_stack((times, values)).ravel(), *_PAIRS, 3)
    return [*lines, f"/&  ----------  END OF DATA FOR CHANNEL {row + 1:2d}  ----------"]
