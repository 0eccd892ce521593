"""K-NET and KiK-net ASCII of NIED, Japan: 17 header lines, then counts of the recorder, 8 per line.

Counts times the scale factor are accelerations, including the offset of the recorder. The mean of the record is
removed, as for the largest acceleration in the header. With the mean, peaks would be many times too large. The reader
was verified with 48 files of both networks.
"""

import math
import re
from itertools import pairwise
from typing import ClassVar

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import RecordError
from rocking.motions.formats import directions, headers, numbers
from rocking.motions.formats.record import Component, Record, RecordFormat, Source, one_line

_KEYS = (
    *("Origin Time", "Lat.", "Long.", "Depth. (km)", "Mag.", "Station Code", "Station Lat.", "Station Long."),
    *("Station Height(m)", "Record Time", "Sampling Freq(Hz)", "Duration Time(s)", "Dir.", "Scale Factor"),
    *("Max. Acc. (gal)", "Last Correction", "Memo."),
)
_PER_LINE = 8
_FULL_SCALE = 8_388_608  # counts of a 24-bit recorder
_LARGEST_COUNT = 2**31
_SIDES = {"1": "N-S", "2": "E-W", "3": "U-D", "4": "N-S", "5": "E-W", "6": "U-D"}
"""Directions of KiK-net by number: 1 to 3 in the borehole, 4 to 6 at the surface."""

_REMOVED = "mean of the whole record removed"


class Knet(RecordFormat):
    """K-NET and KiK-net ASCII."""

    name: ClassVar[str] = "knet"
    title: ClassVar[str] = "K-NET and KiK-net ASCII of NIED, Japan"
    suffixes: ClassVar[tuple[str, ...]] = (".ns", ".ew", ".ud", ".ns1", ".ew1", ".ud1", ".ns2", ".ew2", ".ud2")
    notes: ClassVar[str] = (
        "The mean of the record is removed, as for the largest acceleration in the header; there is no filter or other "
        "correction. KiK-net directions 1 to 3 are in the borehole, 4 to 6 at the surface."
    )
    marks: ClassVar[tuple[str, ...]] = tuple(re.escape(_KEYS[k]) for k in (0, 10, 13, 14))
    top: ClassVar[int] = len(_KEYS) + 3

    def resembles(self, source: Source) -> bool:
        """Return True if the file has several header keys of this format."""
        top = source.lines[: self.top] if source.is_text else []
        return sum(any(line.startswith(key) for line in top) for key in _KEYS) > 3

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        """Return the record without its mean."""
        fields = _header(source)
        unit = headers.acceleration_unit(source, "gal", units)
        rate = _stated(source, 10, r"(\d+(?:\.\d+)?) *Hz", fields[10])[0]
        seconds = numbers.number(source, 11, fields[11], "duration")
        step = headers.step_between_samples(source, 1.0 / rate if rate else 0.0, time_step)
        gal, counts_per_gal = _stated(source, 13, r"(\d+(?:\.\d*)?)\(gal\)/(\d+(?:\.\d*)?)", fields[13])
        if not gal or not counts_per_gal:
            raise source.error(13, "scale factor must be above zero, found {entry!r}", entry=fields[13][:40])
        counts = _counts(source)
        headers.check_count(source, headers.samples_of(source, 11, rate, seconds, "duration"), counts.size)
        raw = counts * (gal / counts_per_gal)
        values = raw - raw.mean()
        peak = numbers.number(source, 14, fields[14], "largest acceleration")
        quantity = "largest acceleration after removal of the mean"
        headers.check_peak(source, peak, values, headers.half_digit(fields[14]), quantity)
        metadata = {key.strip(". "): text for key, text in zip(_KEYS, fields, strict=True) if text}
        metadata |= {"processing": _REMOVED, "mean removed": f"{raw.mean():.6g} gal"}
        number = fields[12] if fields[12] in _SIDES else ""
        if number:
            metadata["position"] = "borehole" if number < "4" else "surface"
        if number and number < "4":
            source.doubt(12, f"direction {number} belongs to the instrument in the borehole, below the surface")
        name = _SIDES.get(number, fields[12]) or "unnamed"
        # numbers are direction codes from 1 to 6, not azimuths
        odd = {directions.KEY: directions.UNCLEAR} if not number and re.fullmatch(r"\d\d?", name) else {}
        component = Component(name, values, unit, step, abs(peak), odd)
        return Record(self.name, (component,), "\n".join(source.lines[: len(_KEYS)]), metadata)

    def write(self, record: Record) -> bytes:
        """Return a K-NET file with a scale factor for the peak of the record."""
        (samples,) = headers.in_unit(record, self.name, "gal", 1)
        component = record.components[0]
        rate = round(1.0 / component.time_step)
        if rate < 1 or abs(rate * component.time_step - 1.0) > 1e-9 or samples.size % rate:
            raise RecordError(
                "K-NET requires whole seconds and whole samples per second, got {count} samples at {step:g} s",
                count=samples.size, step=component.time_step,
            )  # fmt: skip
        largest = float(np.abs(samples).max())
        if largest > 1e8:
            raise RecordError(
                "K-NET allows accelerations up to 1e8 gal, got {largest:g}", largest=largest, hint="check the unit"
            )
        gal = max(1, math.ceil(2.0 * largest))
        counts = np.rint(samples * (_FULL_SCALE / gal))
        if abs(counts.mean()) > 0.5:
            raise RecordError(
                "K-NET requires a zero mean, got {mean:g} gal", mean=float(samples.mean()),
                hint="remove the mean",
            )  # fmt: skip
        peak = float(np.abs(counts - counts.mean()).max()) * gal / _FULL_SCALE
        values = {key: record.text(key.strip(". "), 60) for key in _KEYS}
        values |= {"Sampling Freq(Hz)": f"{rate}Hz", "Duration Time(s)": str(samples.size // rate)}
        values |= {"Scale Factor": f"{gal}(gal)/{_FULL_SCALE}", "Max. Acc. (gal)": f"{peak:.3f}"}
        values["Dir."] = one_line(component.name, 20)
        lines = [f"{key:<18}{values[key]}" for key in _KEYS]
        lines += numbers.in_columns(counts, _PER_LINE, "{:8.0f} ")
        return ("\n".join(lines) + "\n").encode("latin-1")


def _header(source: Source) -> list[str]:
    if not source.is_text or len(source.lines) <= len(_KEYS):
        raise source.error(
            None, "K-NET header of {expected} lines expected, found {count} lines", expected=len(_KEYS),
            count=len(source.lines),
        )  # fmt: skip
    for line, key in enumerate(_KEYS):
        if not source.lines[line].startswith(key):
            raise source.error(
                line, "{key!r} expected, found {entry!r}", key=key, entry=source.lines[line].strip()[:40]
            )
    return [source.lines[line][len(key) :].strip() for line, key in enumerate(_KEYS)]


def _stated(source: Source, line: int, form: str, text: str) -> list[float]:
    match = re.fullmatch(form, text)
    if match is None:
        raise source.error(line, "{key} cannot be understood: {entry!r}", key=_KEYS[line], entry=text[:40])
    return [numbers.number(source, line, word) for word in match.groups()]


def _counts(source: Source) -> FloatArray:
    rows = [(line, source.lines[line].split()) for line in range(len(_KEYS), len(source.lines))]
    while rows and not rows[-1][1]:
        rows.pop()
    for (line, fields), _ in pairwise(rows):
        if len(fields) != _PER_LINE:
            raise source.error(line, "{expected} counts expected, found {count}", expected=_PER_LINE, count=len(fields))
    if rows and len(rows[-1][1]) > _PER_LINE:
        raise source.error(
            rows[-1][0], "at most {most} counts expected, found {count}", most=_PER_LINE, count=len(rows[-1][1])
        )
    counts = [
        numbers.whole(source, line, word, "count of the recorder", minimum=-_LARGEST_COUNT)
        for line, fields in rows
        for word in fields
    ]
    return np.array(counts, dtype=np.float64)
