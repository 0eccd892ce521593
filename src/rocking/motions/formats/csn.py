"""CSN, national seismological centre of Chile: comments in Spanish, then one sample of one component per line.

The layout is that of the programs of the strong-motion database SIBER-RISK of Chile, in m/s2. No file of the centre was
available for a test.
"""

import re
from typing import ClassVar

import numpy as np

from rocking.motions.formats import headers
from rocking.motions.formats.header_values import after, header_text, header_value, side_by_side
from rocking.motions.formats.record import Component, Record, RecordFormat, Source, metadata_of, one_line


class Csn(RecordFormat):
    """Text files of the Centro Sismologico Nacional."""

    name: ClassVar[str] = "csn"
    title: ClassVar[str] = "Centro Sismologico Nacional (CSN), Chile"
    suffixes: ClassVar[tuple[str, ...]] = (".txt",)
    notes: ClassVar[str] = (
        "In m/s2 by its description; not verified with a real file. The files contain no peak. Without the number of "
        "samples, a damaged end is not detected."
    )
    marks: ClassVar[tuple[str, ...]] = (r"# *Tiempo", r"# *Tasa de muestreo", r"# *Esta")
    top: ClassVar[int] = 20

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        first = after(source, "#", self.top)
        for line, text in enumerate(source.lines[:first]):
            if not text.startswith("#"):
                raise source.error(line, "comment expected before the first sample")
        unit = headers.acceleration_unit(source, "m/s2", units)
        rate = float(
            header_value(source, first, r"# *Tasa de muestreo[^:\d]*:?", r"(\d+\.?\d*)\s*(?:muestras|Hz|sps)\S*.*")[1]
        )
        step = headers.step_between_samples(source, 1.0 / rate if rate > 0.0 else 0.0, time_step)
        count = sum(1 for text in source.lines[first:] if text.strip())
        # the description does not contain this line; a line about samples must match
        if any(re.search(r"\bmuestras\b", text) and "Tasa" not in text for text in source.lines[:first]):
            stated = header_value(source, first, r"# *N\S*mero de muestras\s*:?", r"\d{1,9}")[0]
            headers.check_count(source, int(stated), count)
        fields = header_text(source, first, r"# *Esta\S*").split()
        name = fields[-1] if len(fields) > 1 else "acceleration"
        metadata = metadata_of(
            station=fields[0].strip(",") if fields else "",
            starttime=header_text(source, first, r"# *Tiempo[^:]*:").rstrip("Z"),
        )
        about = Record(self.name, (Component(name, np.empty(0), unit, step),), "", metadata)
        return side_by_side(source, about, first, count)

    def write(self, record: Record) -> bytes:
        """Return a file of one component, in m/s2."""
        (values,) = headers.in_unit(record, self.name, "m/s2", 1)
        component = record.components[0]
        lines = [
            f"# Tiempo de inicio: {record.text('starttime', 40, '1970-01-01T00:00:00')}Z",
            f"# Tasa de muestreo: {1.0 / component.time_step:.12g} muestras/segundo",
            f"# Numero de muestras: {values.size}",
            f"# Estacion: {record.text('station', 10, 'unknown').replace(' ', '_')} Componente: "
            f"{one_line(component.name, 20).replace(' ', '_')}",
            *(f"{value:.9E}" for value in values.tolist()),
        ]
        return "\n".join([*lines, ""]).encode("latin-1")
