"""GeoNet of GNS Science, New Zealand: 3 components, as recorded (Volume 1), or corrected and integrated (Volume 2).

A component has 16 lines of text, 4 lines of 10 integers and 6 lines of 10 real numbers of width 8. The acceleration
[mm/s2], velocity [mm/s] and displacement [mm] follow, with 10 numbers of width 8 per line. Counts, step, duration and
all nine peaks were verified with four files (2016 Kaikoura and 2018 earthquakes, Cusp and Basalt recorders). The origin
of the times of the peaks is after the first sample, by the real number 22 (5 s in all four files). Volume 1 has the
same header and only the acceleration. It was verified with one file of 2016 (Basalt recorder). Older layouts are not
verified.
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
_POINTS = r"Number of points +(\d{1,9}) +Duration +(\d+\.\d*) +s(?:ec)?"
_PEAK = r"{}: +[Pp]eak +(-?\d+\.\d+|-?\.\d+) +{} +at +(\d+\.\d*) +s(?:ec)?\b.*"
# quantity, unit and decimals
_SERIES = (("Acceleration", "mm/s/s", 1), ("Velocity", "mm/s", 2), ("Displacement", "mm", 3))


class GeonetV2A(RecordFormat):
    """GeoNet Volume 2, corrected."""

    name: ClassVar[str] = "geonet-v2a"
    title: ClassVar[str] = "GeoNet Volume 2 (V2A) of GNS Science, New Zealand"
    suffixes: ClassVar[tuple[str, ...]] = (".v2a",)
    notes: ClassVar[str] = "In mm/s2. Velocities and displacements are not used; their contradictions give warnings."
    marks: ClassVar[tuple[str, ...]] = (
        "Corrected accelerogram", "Number of points", "Instrument corrected data at", "Acceleration:", "Displacement:",
    )  # fmt: skip
    top: ClassVar[int] = _TEXTS + 3
    begins: ClassVar[str] = "Corrected accelerogram"
    step: ClassVar[str] = r"Instrument corrected data at +(\d*\.\d+) +sec intervals"
    step_text: ClassVar[str] = "Instrument corrected data at {} sec intervals"
    counts: ClassVar[tuple[int, ...]] = (33, 34, 35)  # indices of the number of samples in the integers

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        unit = headers.acceleration_unit(source, "mm/s2", units)
        components: list[Component] = []
        line = 0
        while len(components) < 3:
            component, line = self._component(source, line, unit, time_step)
            if component.name in {other.name for other in components}:
                raise source.error(None, "component {component!r} appears twice", component=component.name[:20])
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
        """Return a file of three components. Velocity and displacement are trapezoidal sums."""
        rows = headers.in_unit(record, self.name, "mm/s2", 3)
        names = [one_line(component.name, 8).partition(" ")[0] or "?" for component in record.components]
        if len(rows) != 3 or len(set(names)) != 3:
            raise RecordError(
                "GeoNet requires three components with different names, got {components}", components=", ".join(names)
            )
        lines: list[str] = []
        for component, name, values in zip(record.components, names, rows, strict=True):
            lines += self._written(record, name, values, component.time_step)
        return ("\n".join(lines) + "\n").encode("latin-1")

    def _component(self, source: Source, top: int, unit: str, requested_step: float | None) -> tuple[Component, int]:
        text = source.lines[top : top + _TEXTS]
        if len(text) < _TEXTS or not text[0].startswith(self.begins):
            raise source.error(
                top,
                "component that begins with {mark!r} expected",
                mark=self.begins,
                hint="one of three components may be missing",
            )
        points = numbers.matched(source, top + 9, _POINTS)
        count, duration = int(points[1]), float(points[2])
        step = headers.step_between_samples(
            source, float(numbers.matched(source, top + 10, self.step)[1]), requested_step
        )
        name = numbers.matched(source, top + 12, r"Component +(\S+).*")[1]
        wholes, line = numbers.fixed(source, top + _TEXTS, _WHOLES * _PER_LINE, _PER_LINE, _WIDTH)
        reals, line = numbers.fixed(source, line, _REALS * _PER_LINE, _PER_LINE, _WIDTH)
        for index in self.counts:
            headers.check_count(source, int(wholes[index]), count)
        if count < 2:
            raise source.error(top + 9, "at least 2 points expected, found {count}", count=count)
        headers.check_duration(source, duration, count, step, headers.half_digit(points[2]))

        def series(k: int, line: int) -> tuple[FloatArray, float, int]:
            quantity, unit, _ = _SERIES[k]
            first = source.lines[line][:_WIDTH] if line < len(source.lines) else ""
            values, behind = numbers.fixed(source, line, count, _PER_LINE, _WIDTH)
            peak = numbers.matched(source, top + 13 + k, _PEAK.format(quantity, unit))
            # series of large numbers have fewer decimals than their peak
            rounding = max(headers.half_digit(peak[1]), headers.half_digit(first))
            headers.check_peak(source, float(peak[1]), values, rounding, f"peak of {quantity.lower()}, {name}")
            headers.check_peak_time(source, float(peak[2]) + float(reals[21]), values, step, rounding)
            return values, abs(float(peak[1])), behind

        values, peak, line = series(0, line)
        if len(self.counts) > 1:
            # velocity and displacement are not used, so that contradictions only give warnings
            with source.doubting():
                series(2, series(1, line)[2])
            after = range(line, len(source.lines))
            line = next((index for index in after if source.begins(index, self.begins)), len(source.lines))
        about = metadata_of(axis=" ".join(text[12].split()[2:]), filter=text[11])
        return Component(name, values, unit, step, peak, about), line

    def _written(self, record: Record, name: str, values: FloatArray, step: float) -> list[str]:
        count = values.size
        station, event, filtered = (record.text(key, 60, "unknown") for key in ("station", "event", "filter"))
        lines = [
            *[f"{self.begins} unknown", f"Site {station.partition(' ')[0]}", "unknown", "Instrument unknown"],
            *["Resolution: unknown", "Accelerogram unknown", "unknown", event, "Epicentre unknown"],
            f"Number of points {count:5d}    Duration {(count - 1) * step:.4f} sec",
            self.step_text.format(f"{step:.9g}").replace(" 1 s", " 1.0 s"),
            *[filtered, f"Component {name}"],
        ]
        blocks: list[str] = []
        for k, (quantity, unit, decimals) in enumerate(_SERIES):
            if k:
                values = np.concatenate([[0.0], np.cumsum(0.5 * step * (values[1:] + values[:-1]))])
            if k and len(self.counts) == 1:
                lines.append(f"{quantity} record unevaluated")
                continue
            rounded = np.round(values, decimals)
            texts = [f"{value:{_WIDTH}.{decimals}f}" for value in rounded.tolist()]
            if max(map(len, texts)) > _WIDTH:
                raise RecordError(
                    "{quantity} of {largest:g} {unit} does not fit into {width} columns", quantity=quantity.lower(),
                    largest=float(np.abs(values).max()), unit=unit, width=_WIDTH,
                )  # fmt: skip
            top = int(np.abs(rounded).argmax())
            lines.append(f"{quantity + ':':<14} peak {rounded[top]:8.{decimals}f} {unit:<6} at {top * step:.4f} sec")
            blocks += ["".join(texts[k : k + _PER_LINE]) for k in range(0, count, _PER_LINE)]
        wholes = numbers.in_columns([count if k in self.counts else 0 for k in range(40)], _PER_LINE, "{:8d}")
        return [*lines, *wholes, *numbers.in_columns([0.0] * 60, _PER_LINE, "{:8.2f}"), *blocks]


class GeonetV1A(GeonetV2A):
    """GeoNet Volume 1, as recorded."""

    name: ClassVar[str] = "geonet-v1a"
    title: ClassVar[str] = "GeoNet Volume 1 (V1A) of GNS Science, New Zealand"
    suffixes: ClassVar[tuple[str, ...]] = (".v1a",)
    notes: ClassVar[str] = "In mm/s2, neither filtered nor corrected: remove the mean and correct the baseline."
    marks: ClassVar[tuple[str, ...]] = (
        "Uncorrected accelerogram", "Number of points", "Raw readings in units of", "Acceleration:", "Component",
    )  # fmt: skip
    begins: ClassVar[str] = "Uncorrected accelerogram"
    step: ClassVar[str] = r"Raw readings in units of +1\.0+ +mm/s/s +at intervals of +(\d*\.\d+) +s(?:ec)?"
    step_text: ClassVar[str] = "Raw readings in units of 1.00 mm/s/s at intervals of {} s"
    counts: ClassVar[tuple[int, ...]] = (33,)
