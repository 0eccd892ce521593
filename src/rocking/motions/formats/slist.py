"""Text formats SLIST and TSPAIR of ObsPy and IRIS: per channel a line TIMESERIES, then samples, or times and samples.

The layout is in the documentation of `obspy.io.ascii` and in IRIS DMC, "ASCII time series formats".
"""

import re
from typing import ClassVar

import numpy as np

from rocking.errors import RecordError
from rocking.motions.formats import headers, numbers
from rocking.motions.formats.column_text import unit_named
from rocking.motions.formats.record import Component, Record, RecordFormat, Source, one_line

_HEAD = re.compile(
    r"TIMESERIES ([^\W_]*)_([^\W_]*)_([^\W_]*)_([^\W_]*)_\w?, (\d{1,9}) samples, (\d+\.?\d*) sps, ([\d\-T:.]+)Z?, "
    r"(SLIST|TSPAIR), (INTEGER|FLOAT|ASCII), *(.*?) *(?:,.*)?"
)


class Slist(RecordFormat):
    """SLIST and TSPAIR."""

    name: ClassVar[str] = "slist"
    title: ClassVar[str] = "SLIST and TSPAIR, text of ObsPy and IRIS"
    suffixes: ClassVar[tuple[str, ...]] = (".ascii", ".slist", ".tspair")
    notes: ClassVar[str] = "Counts raise an error; units= is required unless the unit is an acceleration."

    def recognises(self, source: Source) -> bool:
        """Return True if the first line begins with TIMESERIES."""
        return source.is_text and source.lines[0].startswith("TIMESERIES ")

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        """Return the record with one component per channel.

        Gaps appear as channels with equal names and raise an error.
        """
        starts = [line for line, text in enumerate(source.lines) if text.startswith("TIMESERIES")]
        if not starts or starts[0] != 0:
            raise source.error(0, "line that begins with TIMESERIES expected")
        components = []
        for first, last in zip(starts, [*starts[1:], len(source.lines)], strict=True):
            components.append(_channel(source, first, last, units, time_step))
        names = [component.name for component in components]
        if len(set(names)) != len(names):
            raise source.error(
                None,
                "a channel of {channels} has a gap or an overlap; remove this section first",
                channels=", ".join(sorted(set(names))),
            )
        metadata = {key: text for key, text in components[0].metadata.items() if text}
        return Record(self.name, tuple(components), "\n".join(source.lines[line] for line in starts), metadata)

    def write(self, record: Record) -> bytes:
        """Return an SLIST file in m/s2."""
        lines: list[str] = []
        station = re.sub(r"\W|_", "", record.text("station", 5)) or "XXXXX"
        codes = [re.sub(r"\W|_", "", one_line(component.name, 20)) or "X" for component in record.components]
        if len(set(codes)) != len(codes):
            raise RecordError("components require different channel codes, got {codes}", codes=", ".join(codes)[:60])
        for component, code, values in zip(
            record.components, codes, headers.in_unit(record, self.name, "m/s2", 99), strict=True
        ):
            size = f"{values.size} samples, {1.0 / component.time_step:.12g} sps, 1970-01-01T00:00:00.000000"
            lines += [
                f"TIMESERIES XX_{station}__{code}_D, {size}, SLIST, FLOAT, m/s**2",
                *numbers.in_columns(values, 6, "{:+.10e}  "),
            ]
        return "\n".join([*lines, ""]).encode("latin-1")


def _channel(source: Source, first: int, last: int, units: str | None, time_step: float | None) -> Component:
    match = _HEAD.fullmatch(source.lines[first][:300])
    if match is None:
        raise source.error(first, "TIMESERIES code, ... samples, ... sps, time, SLIST or TSPAIR, kind, unit expected")
    network, station, _, code, count, rate, start, layout, kind, word = match.groups()
    if kind == "ASCII":
        raise source.error(first, "the file contains text, not accelerations")
    unit = headers.acceleration_unit(source, unit_named(source, first, word), units)
    step = headers.step_between_samples(source, 1.0 / float(rate) if float(rate) > 0.0 else 0.0, time_step)
    if layout == "SLIST":
        values = numbers.rows(source, first + 1, last)
    else:
        rows = [(line, source.lines[line].split()) for line in range(first + 1, last) if source.lines[line].strip()]
        values = np.array([_value(source, line, fields) for line, fields in rows])
        times = [np.datetime64(fields[0].rstrip("Z"), "ns") for _, fields in rows]
        late = np.array([float((time - times[0]) / np.timedelta64(1, "ns")) * 1e-9 for time in times])
        if np.abs(late - step * np.arange(late.size)).max(initial=0.0) > 0.01 * step + 1e-6:
            raise source.error(first, "the times are not evenly spaced at {step:g} s; a line may be missing", step=step)
    headers.check_count(source, int(count), values.size)
    if values.size < 2:
        raise source.error(first, "at least 2 samples required, found {count}", count=values.size)
    headers.doubt_channel(source, code)
    return Component(
        code or "unnamed", values, unit, step, None, {"network": network, "station": station, "starttime": start}
    )


def _value(source: Source, line: int, fields: list[str]) -> float:
    if len(fields) != 2 or not re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d{1,9})?Z?", fields[0]):
        raise source.error(line, "time and sample expected, found {entry!r}", entry=" ".join(fields)[:60])
    return numbers.number(source, line, fields[1])
