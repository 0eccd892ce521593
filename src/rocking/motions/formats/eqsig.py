"""Files of eqsig and OpenSees: optional names, a line with number of samples and time step, then accelerations.

The layout is in the documentation of `load_values_and_dt` in eqsig (a name, "npts dt", one value per line). Files for
OpenSees have the same line "npts dt" and any number of values per line.
"""

import re
from typing import ClassVar

from rocking.motions.formats import headers, numbers
from rocking.motions.formats.column_text import unit_named
from rocking.motions.formats.record import Component, Record, RecordFormat, Source, metadata_of, one_line

_SIZE = re.compile(r"\s*(\d{1,9})[\s,]+(\d*\.\d+(?:[eE][-+]?\d+)?)[\s,]*")
_NUMBERS = re.compile(r"[\s,]*[-+]?\.?\d[-+.\deEdD\s,]*")
_MOST_NAMES = 3


class Eqsig(RecordFormat):
    """Accelerations after a line with their number and time step."""

    name: ClassVar[str] = "eqsig"
    title: ClassVar[str] = "eqsig and OpenSees: a line `npts dt`, with or without a name above, then accelerations"
    suffixes: ClassVar[tuple[str, ...]] = (".txt", ".dat", ".acc")
    unit_is_free: ClassVar[bool] = True
    states_unit: ClassVar[bool] = False
    notes: ClassVar[str] = (
        "Verified with one file of eqsig. Accelerations and velocities, or g and m/s2, are not distinguishable."
    )

    def recognises(self, source: Source) -> bool:
        """Return True if numbers follow a line with only count and time step."""
        line = _size_line(source)
        if line is None:
            return False
        follow = [text for text in source.lines[line + 1 :] if text.strip()][:3]
        if not follow or not all(_NUMBERS.fullmatch(text[:400]) for text in follow):
            return False
        # two numbers per line may be times and samples; the first line of such files looks the same
        pairs = all(len(text.replace(",", " ").split()) == 2 for text in follow)
        if not pairs:
            return True
        stated = _SIZE.fullmatch(source.lines[line][:80])
        count = 0 if stated is None else int(stated[1])
        return line > 0 and count == sum(len(text.replace(",", " ").split()) for text in source.lines[line + 1 :])

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        line = _size_line(source)
        if line is None:
            raise source.error(None, "line with the number of samples and the time step expected near the top")
        size = _SIZE.fullmatch(source.lines[line])
        assert size is not None
        step = headers.step_between_samples(source, float(size[2]), time_step)
        names = " ".join(text.strip() for text in source.lines[:line])
        headers.refuse_other(source, names)
        unit_text = re.search(r"\[([^\[\]]+)\]", names)
        unit = headers.acceleration_unit(source, unit_named(source, None, unit_text[1]) if unit_text else None, units)
        values = numbers.rows(source, line + 1, len(source.lines))
        headers.check_count(source, int(size[1]), values.size)
        if values.size < 2:
            raise source.error(line, "at least 2 samples required, found {count}", count=values.size)
        component = Component("acceleration", values, unit, step)
        return Record(self.name, (component,), "\n".join(source.lines[: line + 1]), metadata_of(event=names))

    def write(self, record: Record) -> bytes:
        """Return a file of one component, with its unit after the name."""
        (values,) = headers.in_unit(record, self.name, None, 1)
        component = record.components[0]
        name = re.sub(r"[\[\]]", " ", record.text("event", 60) or one_line(component.name, 20))
        step = f"{component.time_step:.9f}"
        lines = [
            f"motion {name} [{component.unit}]",
            f"{values.size} {step}",
            *(repr(value) for value in values.tolist()),
        ]
        return "\n".join([*lines, ""]).encode("latin-1")


def _size_line(source: Source) -> int | None:
    """Return the line with count and time step. Only lines with words are allowed before this line."""
    for line, text in enumerate(source.lines[: _MOST_NAMES + 1] if source.is_text else []):
        if _SIZE.fullmatch(text[:80]):
            return line
        if len(text) > 200 or not re.search(r"[^\W\d_]", text) or re.match(r"\s*[#%]", text):
            return None
    return None
