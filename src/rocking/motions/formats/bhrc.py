"""Volume 1 files of Iran's strong-motion network (BHRC, ISMN): uncorrected accelerations in g/10.

A component has 13 lines of text, 7 lines of 14 integers of width 5, 7 lines of real numbers of width 13, the samples
(10 per line, width 13), and a line ``/&``. Tested with six files of the 2012 Ahar earthquake (SSA-2
recorders). Corrected files (Volume 2 and higher) raise an error, because they have another layout and no test file is
available.
"""

import re
from collections.abc import Sequence
from typing import ClassVar

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import RecordError
from rocking.motions.formats import headers, numbers
from rocking.motions.formats.record import Component, Record, RecordFormat, Source, metadata_of, one_line

_TEXTS, _WHOLES, _REALS = 13, 7, 7
_PER_LINE, _WIDTH = 10, 13
_END = "/&"
_VOLUME = r"\* VOL(\d)DS FILE:.*"
_POINTS = r"NO\. OF POINTS = +(\d{1,9}) +DURATION = +(\d*\.\d+)"


class Bhrc(RecordFormat):
    """Volume 1 of Iran, uncorrected."""

    name: ClassVar[str] = "bhrc"
    title: ClassVar[str] = "BHRC (ISMN), Iran, Volume 1"
    suffixes: ClassVar[tuple[str, ...]] = (".v1",)
    notes: ClassVar[str] = (
        "Accelerations are in g/10 and uncorrected: remove their mean and correct the baseline. The file contains no "
        "peak, so a damaged sample is not detected. Volume 2 raises an error: its layout is not verified."
    )
    marks: ClassVar[tuple[str, ...]] = (
        r"\* VOL\dDS FILE", "COMP [LVT]", r"NO\. OF POINTS =", "UNITS ARE SECONDS AND G/10", "INSTR PERIOD =",
    )  # fmt: skip
    top: ClassVar[int] = _TEXTS + 3

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        """Return up to three components: L, V and T."""
        components: list[Component] = []
        line = 0
        last = len(source.lines)
        while last and not source.lines[last - 1].strip():
            last -= 1
        while not components or line < last:
            component, line = _component(source, line, units, time_step)
            if component.name in {other.name for other in components}:
                raise source.error(None, "component {component} appears twice", component=component.name)
            components.append(component)
        lines = source.lines[:_TEXTS]
        metadata = metadata_of(
            file=lines[0].partition(":")[2],
            instrument=lines[1].partition("=")[2],
            event=" ".join([lines[2].strip(), *lines[8].split()]),
            station=lines[7].partition("Station")[0],
            processing="uncorrected (Volume 1)",
        )
        header = "\n".join(source.lines[: _TEXTS + _WHOLES + _REALS])
        return Record(self.name, tuple(components), header, metadata)

    def write(self, record: Record) -> bytes:
        rows = headers.in_unit(record, self.name, "g/10", 3)
        names = [component.name for component in record.components]
        if len(set(names)) != len(names) or not set(names) <= {"L", "V", "T"}:
            raise RecordError(
                "BHRC requires the components L, V and T, got {components}", components=", ".join(names)[:60]
            )
        lines: list[str] = []
        for component, values in zip(record.components, rows, strict=True):
            lines += _written(record, component, values)
        return ("\r\n".join(lines) + "\r\n").encode("latin-1")


def _component(source: Source, top: int, units: str | None, requested_step: float | None) -> tuple[Component, int]:
    if len(source.lines) < top + _TEXTS + _WHOLES + _REALS:
        lines = _TEXTS + _WHOLES + _REALS
        raise source.error(
            None, "the header of a component has {lines} lines, but the file ends before the last one", lines=lines
        )
    volume = numbers.matched(source, top, _VOLUME)
    if volume[1] != "1":
        raise source.error(top, "Volume {volume} is not supported, only Volume 1", volume=volume[1])
    numbers.matched(source, top + 11, "UNITS ARE SECONDS AND G/10")
    unit = headers.acceleration_unit(source, "g/10", units)
    name = numbers.matched(source, top + 6, r"COMP ([LVT])\d?")[1]
    points = numbers.matched(source, top + 10, _POINTS)
    count, duration = int(points[1]), float(points[2])
    if count < 2:
        raise source.error(top + 10, "at least 2 points expected, found {count}", count=count)
    repeated = source.lines[top + _TEXTS + 1][55:60]
    headers.check_count(source, numbers.whole(source, top + _TEXTS + 1, repeated, "number of points"), count)
    reals = top + _TEXTS + _WHOLES
    rate = numbers.number(source, reals + 1, source.lines[reals + 1][:13], "sampling rate")
    step = headers.step_between_samples(source, 1.0 / rate if rate > 0.0 else 0.0, requested_step)
    headers.check_duration(source, duration, count, step, headers.half_digit(points[2]))
    repeated_duration = numbers.number(source, reals, source.lines[reals][26:39], "duration")
    with source.doubting():
        headers.check_stated(source, repeated_duration, duration, 1e-5 * duration, "duration")
    values, line = numbers.fixed(source, reals + _REALS, count, _PER_LINE, _WIDTH)
    if line >= len(source.lines) or source.lines[line].strip() != _END:
        raise source.error(
            min(line, len(source.lines) - 1), "{mark} expected after {count} samples", mark=_END, count=count
        )
    azimuth = re.search(rf"Azimuth.*\b{name} +(\d+)", source.lines[top + 7])
    return Component(name, values, unit, step, None, {"azimuth": azimuth[1]} if azimuth else {}), line + 1


def _written(record: Record, component: Component, values: FloatArray) -> list[str]:
    count = values.size
    if count > 99_999 or np.abs(values).max() >= 1e9:
        raise RecordError("BHRC allows at most 99999 samples below 1e9 g/10, got {count}", count=count)
    file, instrument, station = (record.text(key, 40) for key in ("file", "instrument", "station"))
    azimuth = one_line(component.metadata.get("azimuth", "0"), 3)
    duration = count * component.time_step
    lines = [
        f"* VOL1DS FILE:  {file}",
        f"Inst Type = {instrument}",
        "",
        "",
        component.name,
        "",
        f"COMP {component.name}1",
    ]
    lines += [f"{station}  Station   Azimuth {component.name} {azimuth}", "Epicenter"]
    lines += ["INSTR PERIOD =  .000 SEC   DAMPING =  .000"]
    lines += [f"NO. OF POINTS = {count:6d}      DURATION = {duration:9.4f}", "UNITS ARE SECONDS AND G/10", ""]
    wholes, reals = [0] * 88, [0.0] * 38
    wholes[25], reals[2], reals[6] = count, duration, 1.0 / component.time_step
    lines += numbers.in_columns(wholes, 14, "{:5d}")
    lines += [text[:70] for text in _in_lines(reals, 6)]
    return [*lines, *_in_lines(values.tolist(), _PER_LINE), _END]


def _in_lines(values: Sequence[float], per_line: int) -> list[str]:
    # exponents have two digits
    texts = [numbers.fortran_e(value if abs(value) >= 1e-90 else 0.0, 6, _WIDTH) for value in values]
    return ["".join(texts[k : k + per_line]) for k in range(0, len(texts), per_line)]
