"""Older accelerations of ITACA, also distributed by GEM: ten header lines, then five columns.

The layout is known from the header of a file of 2009 (processed, DPC network). Numbers have 14 characters without
separators.
"""

from typing import ClassVar

import numpy as np

from rocking.motions.formats import headers, numbers
from rocking.motions.formats.header_values import after, header_text, header_value, side_by_side
from rocking.motions.formats.record import Component, Record, RecordFormat, Source, metadata_of, one_line

_KEYS = {
    "event": "Event Date & Time",
    "station": "Station Code / Name",
    "network": "Network",
    "processing": "Processing Info",
    "filter": r"Filter Cut-off Frequency \(Hz\)",
}
_PER_LINE, _WIDTH = 5, 14


class Itaca(RecordFormat):
    """ITACA / GEM files of one component."""

    name: ClassVar[str] = "itaca"
    title: ClassVar[str] = "ITACA / GEM (.acc), Italy"
    suffixes: ClassVar[tuple[str, ...]] = (".acc",)
    notes: ClassVar[str] = "Verified with one file of 2009, in m/s2. The DYNA files of ITACA have the format esm."
    marks: ClassVar[tuple[str, ...]] = (
        r"Orientation\s*:", r"Time Increment \(s\)\s*:", r"Number of Data\s*:", r"PGA \(m/s/s\)\s*:",
        r"Acc\w+ time series in",
    )  # fmt: skip
    top: ClassVar[int] = 20

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        first = after(source, r"Acc\w+ time series in\b", self.top)
        header_value(source, first, r"Acc\w+ time series in", "m/s/s")
        unit = headers.acceleration_unit(source, "m/s2", units)
        step = float(header_value(source, first, r"Time Increment \(s\)\s*:", r"\d*\.?\d+")[0])
        step = headers.step_between_samples(source, step, time_step)
        count = int(header_value(source, first, r"Number of Data\s*:", r"\d{1,9}")[0])
        peak = header_value(source, first, r"PGA \(m/s/s\)\s*:", r"[-+]?\d*\.?\d+(?:E[-+]\d+)?")[0]
        name = header_text(source, first, r"Orientation\s*:") or "acceleration"
        metadata = metadata_of(**{key: header_text(source, first, rf"{word}\s*:") for key, word in _KEYS.items()})
        about = Record(self.name, (Component(name, np.empty(0), unit, step),), "", metadata)
        return side_by_side(source, about, first, count, (peak,), (_PER_LINE, _WIDTH))

    def write(self, record: Record) -> bytes:
        """Return a file of one component, in m/s2 with 8 digits."""
        (values,) = headers.in_unit(record, self.name, "m/s2", 1)
        component = record.components[0]
        texts = {word.replace("\\", ""): record.text(key, 100) for key, word in _KEYS.items()}
        texts |= {
            "Orientation": one_line(component.name, 20),
            "Time Increment (s)": f"{component.time_step:.9f}",
            "Number of Data": str(values.size),
            "PGA (m/s/s)": f"{np.abs(values).max():.7E}",
        }
        lines = [*(f"{key:<30}: {text}" for key, text in texts.items()), "Accelaration time series in m/s/s"]
        lines += numbers.in_columns(values, _PER_LINE, "{:14.7E}")
        return "\n".join([*lines, ""]).encode("latin-1")
