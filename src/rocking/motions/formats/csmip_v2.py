"""CSMIP Volume 2: corrected accelerograms by channel, with velocity and displacement."""

import re
from typing import ClassVar

import numpy as np

from rocking.conventions import FloatArray
from rocking.messages import Message
from rocking.motions.formats import headers
from rocking.motions.formats.headers import Channel, check_count, check_peak, check_peak_time
from rocking.motions.formats.numbers import fixed, fortran_form, in_width, number, whole, word
from rocking.motions.formats.record import Component, Record, RecordFormat, Source, one_line

_TITLE = re.compile(r"\s*CORRECTED ACCELEROGRAM\b", re.IGNORECASE)
_BLOCK = re.compile(
    r"\s*(\d+)\s+POINTS OF (ACCEL|VELOC|DISPL) DATA EQUALLY SPACED AT\s+(\S+?)\s*SEC[.,]?\s*(.*)", re.IGNORECASE
)
_PEAK = re.compile(r"\s*PEAK\s+ACCELERATION\s*=\s*(\S+)\s+CM/SEC/SEC\s+AT\s+(\S+)\s+SEC\b.*", re.IGNORECASE)
_PEAK_MARK = re.compile(r"\s*PEAK\s+ACCELERATION\s*=", re.IGNORECASE)
_POINTS = re.compile(r"\s*(\d+)\s+POINTS OF INSTRUMENT", re.IGNORECASE)
_TEXT_LINES, _HEADER_LINES = 25, 45
_STEP, _PEAKS = 60, {"ACCEL": (64, 65), "VELOC": (66, 67), "DISPL": (68, 69)}
_COUNTS = {"ACCEL": 52, "VELOC": 63, "DISPL": 65}
_MIN_DECIMALS = 2  # older files round the peak and add a zero


class CsmipV2(RecordFormat):
    """CSMIP / CDMG Volume 2, also published by CESMD and the COSMOS data centre."""

    name: ClassVar[str] = "csmip-v2"
    title: ClassVar[str] = "CSMIP Volume 2 (corrected), California Geological Survey"
    suffixes: ClassVar[tuple[str, ...]] = (".v2",)
    notes: ClassVar[str] = (
        "Layout: standard tape format of CSMIP, report OSMS 85-03. Verified with a file of 1983 with three channels of "
        "unequal length and a file of 1979. Count, step and peak of the acceleration are checked; contradictions of "
        "velocity and displacement give warnings. Newer files with a format such as (8f10.6) follow the public "
        "documentation; no real file was available."
    )

    def recognises(self, source: Source) -> bool:
        """Return True if the file begins as a corrected accelerogram with blocks of acceleration."""
        if not source.is_text or not _TITLE.match(source.lines[0]):
            return False
        return any(_BLOCK.fullmatch(text) for text in source.lines[:100])

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        """Return the record with one component per channel. Names are directions, or CHAN 1 for repeated directions."""
        unit = headers.acceleration_unit(source, "cm/s2", units)
        channels = headers.read_channels(source, _TITLE.match, lambda line: _channel(source, line, unit, time_step))
        return headers.record_of_channels(self.name, channels, headers.names_in(channels[0][0][2:]))

    def write(self, record: Record) -> bytes:
        """Return a CSMIP V2 file in cm/s2 with 3 decimals. Velocity and displacement are integrated from rest."""
        lines: list[str] = []
        for row, values in enumerate(headers.in_unit(record, self.name, "cm/s2", 99)):
            lines += _lines(record, row, values.round(3))
        return ("\r\n".join(lines) + "\r\n").encode("latin-1")


def _channel(source: Source, first: int, unit: str, time_step: float | None) -> tuple[Channel, int]:
    header = source.lines[first : first + _HEADER_LINES]
    if len(header) < _HEADER_LINES or not _TITLE.match(header[0]):
        raise source.error(first, "CORRECTED ACCELEROGRAM and {count} header lines expected", count=_HEADER_LINES)
    wholes, reals = fixed(source, first + _TEXT_LINES, 100, 16, 5)
    figures, line = fixed(source, reals, 100, 8, 10)
    component: Component | None = None
    while line < len(source.lines) and (block := _BLOCK.fullmatch(source.lines[line])):
        if block[2].upper() == "ACCEL":
            if component is not None:
                raise source.error(line, "ACCEL appears twice")
            values, own, rounding, line = _checked_block(source, line, wholes, figures, reals)
            step = headers.step_between_samples(source, own, time_step)
            _check_texts(source, first, header[:_TEXT_LINES], values, step, rounding)
            component = Component("", values, unit, step, abs(float(figures[_PEAKS["ACCEL"][1]])))
            continue
        # velocity and displacement are not used, so that contradictions only give warnings
        with source.doubting():
            _checked_block(source, line, wholes, figures, reals)
        line += 1
        while line < len(source.lines) and not source.begins(line, "/&") and not _BLOCK.fullmatch(source.lines[line]):
            line += 1
    if component is None:
        raise source.error(line, "POINTS OF ACCEL DATA EQUALLY SPACED AT ... SEC expected")
    if not source.begins(line, "/&"):
        raise source.expected(line, "END OF DATA FOR CHANNEL")
    return (header, header[7][:200], component), line + 1


def _checked_block(
    source: Source, line: int, wholes: FloatArray, figures: FloatArray, reals: int
) -> tuple[FloatArray, float, float, int]:
    """Return samples, time step, tolerance of the peak, and the index of the line after the samples."""
    kind, values, step, form, after = _block(source, line)
    check_count(source, int(wholes[_COUNTS[kind]]), values.size)
    # the step in the header has three decimals
    if abs(figures[_STEP] - step) > 5.1e-4:
        stated = f"the time step is {figures[_STEP]:g} s in the header and {step:g} s in the {kind} data"
        raise source.error(None, stated)
    at, peak = (float(figures[index]) for index in _PEAKS[kind])
    largest = word(source, line + 1, int(np.abs(values).argmax()), *form)
    rounding = headers.printed_rounding(word(source, reals, _PEAKS[kind][1], 8, 10), largest, _MIN_DECIMALS)
    check_peak(source, peak, values, rounding, f"{kind} peak")
    check_peak_time(source, at, values, step, rounding)
    return values, step, rounding, after


def _block(source: Source, line: int) -> tuple[str, FloatArray, float, tuple[int, int], int]:
    match = _BLOCK.fullmatch(source.lines[line])
    if match is None:
        raise source.error(line, "POINTS OF ... DATA EQUALLY SPACED AT ... SEC expected")
    count, kind, tail = whole(source, line, match[1], "number of points", 2), match[2].upper(), match[4].upper()
    powers = {"ACCEL": ("CM/SEC/SEC", "CM/SEC2"), "VELOC": ("CM/SEC",), "DISPL": ("CM",)}[kind]
    stated = re.search(r"(?:UNITS?:|\bIN)\s*(CM[^\s).,]*)", tail)
    if stated is None or stated[1] not in powers:
        raise source.error(
            line,
            Message(
                "{kind} data must be in {unit}, got {words}",
                {"kind": kind, "unit": powers[0], "words": f"{tail.strip()[:40]!r}"},
            ),
        )
    form = re.search(r"\(\s*(\d+[FE]\d+\.\d+)\s*\)", tail)
    per_line, width = fortran_form(source, line, form[1]) if form else (8, 10)
    step = number(source, line, match[3], "time step")
    values, after = fixed(source, line + 1, count, per_line, width)
    return kind, values, step, (per_line, width), after


def _check_texts(
    source: Source, first: int, texts: list[str], values: FloatArray, step: float, rounding: float
) -> None:
    for line, text in enumerate(texts, first):
        peak, points = _PEAK.fullmatch(text), _POINTS.match(text)
        if _PEAK_MARK.match(text) and not peak:
            raise source.error(
                line, "PEAK ACCELERATION = ... CM/SEC/SEC AT ... SEC expected, got {entry!r}", entry=text[:60]
            )
        if peak:
            slack = max(rounding, headers.half_digit(peak[1]))
            stated = number(source, line, peak[1], "peak")
            headers.check_said_peak(source, stated, values, slack, "peak in words", confirmed=True)
            check_peak_time(source, number(source, line, peak[2], "time"), values, step, slack)
        if points:
            check_count(source, int(points[1][:9]), values.size)


def _lines(record: Record, row: int, values: FloatArray) -> list[str]:
    component = record.components[row]
    step, chan = component.time_step, f"CHAN {row + 1:2d}: {one_line(component.name, 20)}"
    moves = {"ACCEL": values}
    moves["VELOC"] = (np.concatenate(([0.0], np.cumsum(0.5 * (values[1:] + values[:-1])))) * step).round(3)
    speed = moves["VELOC"]
    moves["DISPL"] = (np.concatenate(([0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1])))) * step).round(3)
    wholes, figures = np.zeros(100), np.zeros(100)
    figures[_STEP] = step
    for kind, data in moves.items():
        largest = int(np.abs(data).argmax())
        figures[list(_PEAKS[kind])] = largest * step, data[largest]
        wholes[_COUNTS[kind]] = data.size
    at, peak = figures[list(_PEAKS["ACCEL"])]
    texts = [""] * _TEXT_LINES
    texts[0] = f"CORRECTED ACCELEROGRAM                            {chan}"
    texts[1] = "UNCORRECTED ACCELEROGRAM DATA"
    texts[2] = record.text("event", 70)
    texts[5] = f"STATION NO. {record.text('station number', 8)}"
    texts[6] = record.text("station", 70)
    texts[7] = chan
    texts[17] = f"PEAK ACCELERATION = {peak:.3f} CM/SEC/SEC AT {at:.3f} SEC."
    lines = texts + in_width(wholes, 16, 5, 0) + in_width(figures, 8, 10, 3)
    for (kind, data), unit in zip(moves.items(), ("CM/SEC/SEC", "CM/SEC", "CM"), strict=True):
        lines.append(f" {data.size} POINTS OF {kind} DATA EQUALLY SPACED AT {step:.9g} SEC.  (UNITS: {unit})")
        lines += in_width(data, 8, 10, 3)
    return [*lines, f"/&  ----------  END OF DATA FOR CHANNEL {row + 1:2d}  ----------"]
