"""CSMNC, strong-motion network of China: 16 header lines, then one component with 8 numbers per line.

The layout is known from the headers of two files of 2012 (ETNA recorders).
"""

import re
from typing import ClassVar

import numpy as np

from rocking.motions.formats import headers, numbers
from rocking.motions.formats.column_text import unit_named
from rocking.motions.formats.header_values import after, header_text, header_value, side_by_side
from rocking.motions.formats.record import Component, Record, RecordFormat, Source, metadata_of, one_line

_HEADER = 16


class Csmnc(RecordFormat):
    """Accelerations of the China Strong Motion Networks Center."""

    name: ClassVar[str] = "csmnc"
    title: ClassVar[str] = "China Strong Motion Networks Center (CSMNC)"
    suffixes: ClassVar[tuple[str, ...]] = (".dat",)
    notes: ClassVar[str] = "Verified with two files of 2012. No correction of baseline or instrument."
    marks: ClassVar[tuple[str, ...]] = (
        r"COMP\. ", r"(UN)?CORRECTED \w+ +UNIT:", r"NO\. OF POINTS:", "PEAK VALUE:", "PRE-EVENT TIME:",
    )  # fmt: skip
    top: ClassVar[int] = _HEADER + 2

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        first = after(source, "PRE-EVENT TIME:", self.top)
        while first < len(source.lines) and not re.search(r"\d", source.lines[first]):
            first += 1
        stated = header_value(source, first, "(?:UN)?CORRECTED", r"\w+\s+UNIT:\s*(\S+)")[1]
        unit = unit_named(source, None, stated)
        if unit is None:
            raise source.error(None, "unit CM/SEC/SEC expected, found {unit!r}", unit=stated[:20])
        unit = headers.acceleration_unit(source, unit, units)
        points = header_value(
            source, first, r"NO\. OF POINTS:", r"(\d{1,9})\s+EQUALLY SPACED INTERVALS OF:\s*(\d*\.?\d+)\s*SEC"
        )
        step = headers.step_between_samples(source, float(points[2]), time_step)
        peak = header_value(
            source, first, "PEAK VALUE:", r"([-+]?\d*\.?\d+)\s+AT\s+(\d*\.?\d+)\s*SEC\s+DURATION:\s*(\d*\.?\d+)\s*SEC"
        )
        name = header_text(source, first, r"COMP\.") or "acceleration"
        texts = {"date": source.lines[1], "event": source.lines[2], "station": header_text(source, first, "STATION:")}
        about = Record(self.name, (Component(name, np.empty(0), unit, step),), "", metadata_of(**texts))
        record = side_by_side(source, about, first, int(points[1]), (peak[1],))
        (component,) = record.components
        # the time is truncated after its last digit, not rounded
        slack = 2.0 * headers.half_digit(peak[1])
        headers.check_peak_time(source, float(peak[2]), component.acceleration, step, slack)
        headers.check_duration(source, float(peak[3]), int(points[1]), step, headers.half_digit(peak[3]))
        return record

    def write(self, record: Record) -> bytes:
        """Return a file of one component, in cm/s2."""
        (values,) = headers.in_unit(record, self.name, "cm/s2", 1)
        component, top = record.components[0], int(np.abs(values).argmax())
        event, station, date = (record.text(key, 60, "unknown") for key in ("event", "station", "date"))
        lines = [
            *[
                "unknown",
                date,
                event,
                "EPICENTER unknown",
                "MAGNITUDE unknown",
                f"STATION: {station}",
                "SITE CONDITION:",
            ],
            *["INSTRUMENT TYPE:", "OBSERVING POINT:", f"COMP. {one_line(component.name, 20)}"],
            "UNCORRECTED ACCELERATION          UNIT: CM/SEC/SEC",
            f"NO. OF POINTS:  {values.size}  EQUALLY SPACED INTERVALS OF:  {component.time_step:.9f}  SEC",
            f"PEAK VALUE: {values[top]:.3f}   AT   {top * component.time_step:.2f} SEC    DURATION:  "
            f"{values.size * component.time_step:.2f} SEC",
            *["PRE-EVENT TIME:  0  SEC", "CSMNC", ""],
            *numbers.in_columns(values, 8, "{: .6E} "),
        ]
        return ("\n".join(lines) + "\n").encode("latin-1")
