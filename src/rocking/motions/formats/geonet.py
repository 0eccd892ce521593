"""GeoNet Volume 2 of GNS Science, New Zealand: corrected accelerations, velocities and displacements of 3 components.

Each component: 16 lines of text, 4 lines of 10 whole numbers and 6 of 10 real ones of width 8, then the acceleration
[mm/s2], velocity [mm/s] and displacement [mm], each 10 numbers of width 8 a line and on a new line. Checked on four
files (2016 Kaikoura and 2018 earthquakes, Cusp and Basalt recorders): counts, step, duration and all nine peaks with
their times, which count from real number 22 (5 s in all four) after the first sample. Not checked: older layouts, and
Volume 1 (raw readings), which is refused.
"""

import re
from typing import ClassVar

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import RecordError
from rocking.motions.formats import headers, numbers
from rocking.motions.formats.record import Component, Record, RecordFormat, Source, metadata_of, one_line

_TEXTS, _WHOLES, _REALS = 16, 4, 6
_PER_LINE, _WIDTH = 10, 8
_TITLE = "Corrected accelerogram"
_POINTS = r"Number of points +(\d{1,9}) +Duration +(\d+\.\d*) +sec"
_STEP = r"Instrument corrected data at +(\d*\.\d+) +sec intervals"
_PEAK = r"{}: +peak +(-?\d+\.\d+|-?\.\d+) +{} +at +(\d+\.\d*) +sec.*"
# what the file gives, its unit and decimals
_SERIES = (("Acceleration", "mm/s/s", 1), ("Velocity", "mm/s", 2), ("Displacement", "mm", 3))


class GeonetV2A(RecordFormat):
    """GeoNet Volume 2, corrected."""

    name: ClassVar[str] = "geonet-v2a"
    title: ClassVar[str] = "GeoNet Volume 2 (V2A) of GNS Science, New Zealand"
    suffixes: ClassVar[tuple[str, ...]] = (".v2a",)
    notes: ClassVar[str] = (
        "In mm/s2. Velocities and displacements are not kept, but their counts and peaks are checked. "
        "Volume 1 is refused."
    )
    marks: ClassVar[tuple[str, ...]] = (
        _TITLE, "Number of points", "Instrument corrected data at", "Acceleration:", "Displacement:",
    )  # fmt: skip
    top: ClassVar[int] = _TEXTS + 3

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        unit = headers.acceleration_unit(source, "mm/s2", units)
        components: list[Component] = []
        line = 0
        while len(components) < 3:
            component, line = _component(source, line, unit, time_step)
            if component.name in {other.name for other in components}:
                raise source.error(None, f"component {component.name[:20]!r} is there twice")
            components.append(component)
        headers.check_end(source, line)
        header = "\n".join(source.lines[: _TEXTS + _WHOLES + _REALS])
        station = re.match(r"Site +(\S+)", source.lines[1])
        metadata = metadata_of(
            station=station[1] if station else "",
            event=source.lines[7],
            epicentre=source.lines[8],
            filter=source.lines[11],
        )
        return Record(self.name, tuple(components), header, metadata)

    def write(self, record: Record) -> bytes:
        """Return a file of three components; velocity and displacement are sums of trapezia, as text only."""
        rows = headers.in_unit(record, self.name, "mm/s2", 3)
        names = [one_line(part.name, 8).partition(" ")[0] or "?" for part in record.components]
        if len(rows) != 3 or len(set(names)) != 3:
            raise RecordError(f"GeoNet holds three components of different names, got {', '.join(names)}")
        lines: list[str] = []
        for part, name, values in zip(record.components, names, rows, strict=True):
            lines += _written(record, name, values, part.time_step)
        return ("\n".join(lines) + "\n").encode("latin-1")


def _component(source: Source, top: int, unit: str, asked: float | None) -> tuple[Component, int]:
    text = source.lines[top : top + _TEXTS]
    if len(text) < _TEXTS or not text[0].startswith(_TITLE):
        raise source.error(top, f"a component beginning with {_TITLE!r} expected; one of three missing?")
    points = numbers.matched(source, top + 9, _POINTS)
    count, duration = int(points[1]), float(points[2])
    stated = numbers.matched(source, top + 10, _STEP)
    step = headers.step_between_samples(source, float(stated[1]), asked)
    name = numbers.matched(source, top + 12, r"Component +(\S+).*")[1]
    wholes, line = numbers.fixed(source, top + _TEXTS, _WHOLES * _PER_LINE, _PER_LINE, _WIDTH)
    reals, line = numbers.fixed(source, line, _REALS * _PER_LINE, _PER_LINE, _WIDTH)
    for stated_count in wholes[33:36]:
        headers.check_count(source, int(stated_count), count)
    if count < 2:
        raise source.error(top + 9, f"at least 2 points expected, found {count}")
    headers.check_duration(source, duration, count, step, headers.half_digit(points[2]))
    series: list[FloatArray] = []
    peaks: list[float] = []
    for k, (what, of, _) in enumerate(_SERIES):
        first = source.lines[line][:_WIDTH] if line < len(source.lines) else ""
        values, line = numbers.fixed(source, line, count, _PER_LINE, _WIDTH)
        peak = numbers.matched(source, top + 13 + k, _PEAK.format(what, of))
        # series of large numbers are printed with fewer decimals than their peak
        rounding = max(headers.half_digit(peak[1]), headers.half_digit(first))
        series.append(values)
        headers.check_peak(source, float(peak[1]), values, rounding, f"peak of {what.lower()}, {name}")
        headers.check_peak_time(source, float(peak[2]) + float(reals[21]), values, step, rounding)
        peaks.append(abs(float(peak[1])))
    about = metadata_of(axis=" ".join(text[12].split()[2:]), filter=text[11])
    return Component(name, series[0], unit, step, peaks[0], about), line


def _written(record: Record, name: str, values: FloatArray, step: float) -> list[str]:
    velocity = np.concatenate([[0.0], np.cumsum(0.5 * step * (values[1:] + values[:-1]))])
    displacement = np.concatenate([[0.0], np.cumsum(0.5 * step * (velocity[1:] + velocity[:-1]))])
    count = values.size
    station, event, filtered = (record.text(key, 60, "unknown") for key in ("station", "event", "filter"))
    lines = [
        *[f"{_TITLE} unknown", f"Site {station.partition(' ')[0]}", "unknown", "Instrument unknown"],
        *["Resolution: unknown", "Accelerogram unknown", "unknown", event, "Epicentre unknown"],
        f"Number of points {count:5d}    Duration {(count - 1) * step:.4f} sec",
        f"Instrument corrected data at {step:.9g} sec intervals".replace(" 1 sec", " 1.0 sec"),
        *[filtered, f"Component {name}"],
    ]
    blocks: list[str] = []
    for (what, of, decimals), row in zip(_SERIES, (values, velocity, displacement), strict=True):
        rounded = np.round(row, decimals)
        words = [f"{value:{_WIDTH}.{decimals}f}" for value in rounded.tolist()]
        if max(map(len, words)) > _WIDTH:
            raise RecordError(f"{what.lower()} of {np.abs(row).max():g} {of} does not fit into {_WIDTH} columns")
        at = int(np.abs(rounded).argmax())
        lines.append(f"{what + ':':<14} peak {rounded[at]:8.{decimals}f} {of:<6} at {at * step:.4f} sec")
        blocks += ["".join(words[k : k + _PER_LINE]) for k in range(0, count, _PER_LINE)]
    wholes = numbers.in_columns([0] * 33 + [count] * 3 + [0] * 4, _PER_LINE, "{:8d}")
    return [*lines, *wholes, *numbers.in_columns([0.0] * 60, _PER_LINE, "{:8.2f}"), *blocks]
