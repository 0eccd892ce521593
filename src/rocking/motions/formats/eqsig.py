"""Number of samples and step on a line, often under a name, then the accelerations: eqsig, and inputs of OpenSees.

Layout: eqsig's documentation of `load_values_and_dt` (a name, "npts dt", one value a line); OpenSees users keep the
same line above any number of values a line.
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
    """Accelerations under their number and step."""

    name: ClassVar[str] = "eqsig"
    title: ClassVar[str] = "eqsig and OpenSees: a line `npts dt`, with or without a name above, then accelerations"
    suffixes: ClassVar[tuple[str, ...]] = (".txt", ".dat", ".acc")
    states_unit: ClassVar[bool] = False
    notes: ClassVar[str] = (
        "Verified on one file of eqsig. Nothing tells an acceleration from a velocity, nor g from m/s2."
    )

    def recognises(self, source: Source) -> bool:
        """Return whether a count and a step stand on a line of their own, under words, and numbers follow."""
        line = _size_line(source)
        if line is None:
            return False
        follow = [text for text in source.lines[line + 1 :] if text.strip()][:3]
        if not follow or not all(_NUMBERS.fullmatch(text[:400]) for text in follow):
            return False
        # two numbers a line may be times and samples, of which the first looks the same
        pairs = all(len(text.replace(",", " ").split()) == 2 for text in follow)
        if not pairs:
            return True
        stated = _SIZE.fullmatch(source.lines[line][:80])
        count = 0 if stated is None else int(stated[1])
        return line > 0 and count == sum(len(text.replace(",", " ").split()) for text in source.lines[line + 1 :])

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        line = _size_line(source)
        if line is None:
            raise source.error(None, "no line with the number of samples and the step near the top")
        found = _SIZE.fullmatch(source.lines[line])
        assert found is not None
        step = headers.step_between_samples(source, float(found[2]), time_step)
        names = " ".join(text.strip() for text in source.lines[:line])
        headers.refuse_other(source, names)
        said = re.search(r"\[([^\[\]]+)\]", names)
        unit = headers.acceleration_unit(source, unit_named(source, None, said[1]) if said else None, units)
        values = numbers.rows(source, line + 1, len(source.lines))
        headers.check_count(source, int(found[1]), values.size)
        if values.size < 2:
            raise source.error(line, "at least 2 samples are needed, found {count}", count=values.size)
        part = Component("acceleration", values, unit, step)
        return Record(self.name, (part,), "\n".join(source.lines[: line + 1]), metadata_of(event=names))

    def write(self, record: Record) -> bytes:
        """Return a file of one component, with its unit behind the name."""
        (values,) = headers.in_unit(record, self.name, None, 1)
        part = record.components[0]
        name = re.sub(r"[\[\]]", " ", record.text("event", 60) or one_line(part.name, 20))
        step = f"{part.time_step:.9f}"
        lines = [f"motion {name} [{part.unit}]", f"{values.size} {step}", *(repr(value) for value in values.tolist())]
        return "\n".join([*lines, ""]).encode("latin-1")


def _size_line(source: Source) -> int | None:
    """Return the line of count and step; words may stand above it, numbers may not."""
    for line, text in enumerate(source.lines[: _MOST_NAMES + 1] if source.is_text else []):
        if _SIZE.fullmatch(text[:80]):
            return line
        if len(text) > 200 or not re.search(r"[^\W\d_]", text) or re.match(r"\s*[#%]", text):
            return None
    return None
