"""AFAD, national strong-motion network of Turkey (NSMN): 18 header lines, then three components in columns.

The layout is known from the header of a file of 2017. It agrees with the reader io/nsmn of `gmprocess` (USGS), from
which no code was copied.
"""

import re
from typing import ClassVar

import numpy as np

from rocking.errors import RecordError
from rocking.motions.formats import headers, numbers
from rocking.motions.formats.header_values import after, columns_of, header_text, header_value, side_by_side
from rocking.motions.formats.record import Component, Record, RecordFormat, Source, metadata_of, one_line, readable

_PEAK = r"\(([^()]+)\)\s*([-+]?\d*\.?\d+)"
_KEYS = {"event": "EARTHQUAKE DATE", "station": "PLACE", "station number": "STATION ID", "Record Time": "RECORD TIME"}


class Nsmn(RecordFormat):
    """Text files of AFAD, three components."""

    name: ClassVar[str] = "nsmn"
    title: ClassVar[str] = "AFAD, national strong-motion network of Turkey (NSMN, TR-NSMN)"
    suffixes: ClassVar[tuple[str, ...]] = (".txt",)
    notes: ClassVar[str] = "Verified with one file of 2017, in gal, with its mean removed."
    marks: ClassVar[tuple[str, ...]] = (
        "STRONG GROUND MOTION RECORDS OF", r"NUMBER OF DATA\b", r"SAMPLING INTERVAL\b", r"(RAW |CORRECTED )?PGA VALUES",
        r"STATION ID\b",
    )  # fmt: skip
    top: ClassVar[int] = 25

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        first = after(source, r"\s*N\w*-S\w*\s+E\w*-W\w*\s+U\w*-D\w*\s*$", self.top)
        count = int(header_value(source, first, r"NUMBER OF DATA\s*:", r"\d{1,9}")[0])
        stated = float(header_value(source, first, r"SAMPLING INTERVAL \(sec\)\s*:", r"\d*\.?\d+")[0])
        step = headers.step_between_samples(source, stated, time_step)
        pga = header_value(source, first, r"(?:RAW |CORRECTED )?PGA VALUES", rf"\(gal\)\s*:\s*((?:{_PEAK}\s*){{3}})")
        unit = headers.acceleration_unit(source, "gal", units)
        peaks = re.findall(_PEAK, pga[1])
        names = source.lines[first - 1].split()
        if [name.strip() for name, _ in peaks] != names:
            raise source.error(
                first - 1,
                "the peaks belong to {components}, but the columns have other names",
                components=", ".join(name for name, _ in peaks),
            )
        texts = {key: header_text(source, first, rf"{word}\s*:") for key, word in _KEYS.items()}
        metadata = {key: readable(text, turkish=True) for key, text in texts.items()}
        metadata = metadata_of(**{key.replace(" ", "_"): text for key, text in metadata.items()})
        about = Record(self.name, tuple(Component(name, np.empty(0), unit, step) for name in names), "", metadata)
        return side_by_side(source, about, first, count, [peak for _, peak in peaks])

    def write(self, record: Record) -> bytes:
        """Return a file of three components, in gal with 6 decimals."""
        table, step = columns_of(record, self.name, "gal", 3)
        names = [component.name for component in record.components]
        if len(names) != 3 or not re.fullmatch(r"N\S*-S\S* E\S*-W\S* U\S*-D\S*", " ".join(names)):
            raise RecordError(
                "NSMN requires components such as N-S, E-W, U-D, got {components}", components=", ".join(names)[:60]
            )
        table = table.round(6)
        largest = " ".join(f"({name}) {np.abs(row).max():.6f}" for name, row in zip(names, table.T, strict=True))
        lines = ["STRONG GROUND MOTION RECORDS OF TURKIYE"]
        lines += [f"{word:<24}: {record.text(key, 60, 'unknown')}" for key, word in _KEYS.items()]
        lines += [f"NUMBER OF DATA          : {len(table)}", f"SAMPLING INTERVAL (sec) : {step:.9f}"]
        lines += [f"RAW PGA VALUES (gal)    : {largest}", "".join(f"{one_line(name, 12):>13}" for name in names)]
        return "\n".join([*lines, *numbers.in_width(table.ravel(), 3, 13, 6), ""]).encode("latin-1")
