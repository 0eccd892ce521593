"""Free-field records of the Central Weather Administration, Taiwan: a header of ``#`` lines, then time and U, N, E.

Verified with five files of the 2018 Hualien earthquakes.
"""

import re
from typing import ClassVar

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import RecordError
from rocking.motions.formats import headers, numbers
from rocking.motions.formats.record import Component, Record, RecordFormat, Source

_COMPONENTS = ("U", "N", "E")
_WIDTH, _DECIMALS = 10, 3
_SEQUENCE = "#DataSequence: Time U(+); N(+); E(+)"
_AMPLITUDE = r"#AmplitudeMAX\. ([UNE]): *(-?\d+\.\d+) *~ *(-?\d+\.\d+)"


class Cwa(RecordFormat):
    """Files of Taiwan with times and three components."""

    name: ClassVar[str] = "cwa"
    title: ClassVar[str] = "Central Weather Administration (CWA, CWB), Taiwan"
    suffixes: ClassVar[tuple[str, ...]] = (".dat", ".txt")
    notes: ClassVar[str] = (
        "DCoffset(corr) in the header means that the publisher removed the offset of the recorder. Both extremes of "
        "each component are checked."
    )
    marks: ClassVar[tuple[str, ...]] = (
        "#Earthquake Information", r"#RecordLength\(sec\)", r"#SampleRate\(Hz\)", r"#AmplitudeMAX\.", "#DataSequence:",
    )  # fmt: skip
    top: ClassVar[int] = 40

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        first = next((k for k, line in enumerate(source.lines) if line.startswith("#Data:")), None)
        if first is None or not source.is_text:
            raise source.error(None, "the line #Data: is missing")
        if "".join(source.lines[first].split()) != "#Data:4F10.3":
            raise source.error(first, "#Data: 4F10.3 expected, found {entry!r}", entry=source.lines[first].strip()[:40])
        header = _header(source, first)
        if not re.match(r"gal\b", header["AmplitudeUnit"]):
            raise source.error(None, "unit gal expected, found {unit!r}", unit=header["AmplitudeUnit"][:40])
        unit = headers.acceleration_unit(source, "gal", units)
        rate = numbers.number(source, 0, header["SampleRate(Hz)"], "sample rate")
        seconds = numbers.number(source, 0, header["RecordLength(sec)"], "record length")
        step = headers.step_between_samples(source, 1.0 / rate if rate > 0.0 else 0.0, time_step)
        count = headers.samples_of(source, None, rate, seconds, "record length")
        last = len(source.lines)
        while not source.lines[last - 1].strip():
            last -= 1
        headers.check_count(source, count, last - first - 1)
        values, _ = numbers.fixed(source, first + 1, 4 * count, 4, _WIDTH)
        table = values.reshape(-1, 4)
        late = np.flatnonzero(np.abs(table[:, 0] - table[0, 0] - np.arange(len(table)) * step) > 1.02e-3)
        if late.size:
            raise source.error(
                first + 1 + int(late[0]), "time {time:g} s does not match the time step {step:g} s",
                time=float(table[late[0], 0]), step=step,
            )  # fmt: skip
        peaks = _check_amplitudes(source, first, table)
        components = (
            Component(name, table[:, k].copy(), unit, step, peaks[name]) for k, name in enumerate(_COMPONENTS, 1)
        )
        return Record(self.name, tuple(components), "\n".join(source.lines[: first + 1]), header)

    def write(self, record: Record) -> bytes:
        """Return a file of three components."""
        samples = headers.in_unit(record, self.name, "gal", 3)
        rows = dict(zip((component.name for component in record.components), samples, strict=True))
        steps = {component.time_step for component in record.components}
        if set(rows) != set(_COMPONENTS) or len({row.size for row in rows.values()}) != 1 or len(steps) != 1:
            raise RecordError(
                "CWA requires U, N and E with equal length and time step, got {components}",
                components=", ".join(rows)[:60],
            )
        step = steps.pop()
        table = np.round(np.column_stack([rows[name] for name in _COMPONENTS]), _DECIMALS) + 0.0
        if np.abs(table).max() >= 1e5 or len(table) * step >= 1e5:
            raise RecordError("CWA allows accelerations below 1e5 gal and times below 1e5 s; check the unit")
        stated = ("Origin Time(GMT+08)", "Magnitude(Ml)", "StationCode", "StationName")
        lines = ["#Earthquake Information", *(f"#{key}: {record.text(key, 60, '0')}" for key in stated)]
        lines += [f"#RecordLength(sec): {len(table) * step:.12g}", f"#SampleRate(Hz): {1.0 / step:.12g}"]
        lines.append("#AmplitudeUnit:  gal. DCoffset(corr)")
        for name, row in zip(_COMPONENTS, table.T, strict=True):
            lines.append(f"#AmplitudeMAX. {name}: {row.max():8.3f}~ {row.min():8.3f}")
        lines += [_SEQUENCE, "#Data: 4F10.3 "]
        lines += ["".join(f"{value:10.3f}" for value in (k * step, *row)) for k, row in enumerate(table.tolist())]
        return ("\r\n".join(lines) + "\r\n").encode("latin-1")


def _header(source: Source, first: int) -> dict[str, str]:
    values: dict[str, str] = {}
    for line, text in enumerate(source.lines[:first]):
        if text.strip() and not text.startswith("#"):
            raise source.error(line, "header lines begin with #, found {entry!r}", entry=text.strip()[:40])
        key, colon, value = text[1:].partition(": ")
        if colon and not key.startswith("AmplitudeMAX"):
            if key in values:
                raise source.error(line, "{key!r} appears twice", key=key[:40])
            values[key] = value.strip()
    for key in ("RecordLength(sec)", "SampleRate(Hz)", "AmplitudeUnit"):
        if key not in values:
            raise source.error(None, "the header line #{key}: is missing", key=key)
    if not any(line.split() == _SEQUENCE.split() for line in source.lines[:first]):
        raise source.error(None, "the header line {key} is missing", key=_SEQUENCE)
    return values


def _check_amplitudes(source: Source, first: int, table: FloatArray) -> dict[str, float]:
    peaks: dict[str, float] = {}
    for line, text in enumerate(source.lines[:first]):
        if not text.startswith("#AmplitudeMAX"):
            continue
        stated = re.fullmatch(_AMPLITUDE, text.strip())
        if stated is None or stated[1] in peaks:
            raise source.error(
                line, "both extremes of one component expected, found {entry!r}", entry=text.strip()[:60]
            )
        row = table[:, _COMPONENTS.index(stated[1]) + 1]
        high, low = float(stated[2]), float(stated[3])
        headers.check_stated(source, high, float(row.max()), headers.half_digit(stated[2]), f"maximum {stated[1]}")
        headers.check_stated(source, low, float(row.min()), headers.half_digit(stated[3]), f"minimum {stated[1]}")
        peaks[stated[1]] = max(abs(high), abs(low))
    if len(peaks) != len(_COMPONENTS):
        raise source.error(None, "extremes of U, N or E are missing")
    return peaks
