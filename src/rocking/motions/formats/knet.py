"""K-NET and KiK-net ASCII of NIED, Japan: 17 lines of header, then counts of the recorder, 8 on a line.

Counts times the scale factor are accelerations with the recorder's offset. The mean of the whole record is removed:
the header's largest acceleration is after that, and without it peaks come out many times too large. Checked on 48 files
of both networks.
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
        "The mean of the whole record is removed, as for the header's largest acceleration; nothing is filtered or "
        "corrected otherwise. KiK-net directions 1 to 3 are in the borehole, 4 to 6 at the surface."
    )
    marks: ClassVar[tuple[str, ...]] = tuple(re.escape(_KEYS[k]) for k in (0, 10, 13, 14))
    top: ClassVar[int] = len(_KEYS) + 3

    def resembles(self, source: Source) -> bool:
        """Return whether several keys of its header are there."""
        top = source.lines[: self.top] if source.is_text else []
        return sum(any(line.startswith(key) for line in top) for key in _KEYS) > 3

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        """Return the accelerogram without its mean."""
        said = _header(source)
        unit = headers.acceleration_unit(source, "gal", units)
        rate = _stated(source, 10, r"(\d+(?:\.\d+)?) *Hz", said[10])[0]
        seconds = numbers.number(source, 11, said[11], "duration")
        step = headers.step_between_samples(source, 1.0 / rate if rate else 0.0, time_step)
        gal, counts_per_gal = _stated(source, 13, r"(\d+(?:\.\d*)?)\(gal\)/(\d+(?:\.\d*)?)", said[13])
        if not gal or not counts_per_gal:
            raise source.error(13, "scale factor must be above zero, found {entry!r}", entry=said[13][:40])
        counts = _counts(source)
        headers.check_count(source, headers.samples_of(source, 11, rate, seconds, "duration"), counts.size)
        raw = counts * (gal / counts_per_gal)
        values = raw - raw.mean()
        peak = numbers.number(source, 14, said[14], "largest acceleration")
        what = "largest acceleration after removal of the mean"
        headers.check_peak(source, peak, values, headers.half_digit(said[14]), what)
        metadata = {key.strip(". "): text for key, text in zip(_KEYS, said, strict=True) if text}
        metadata |= {"processing": _REMOVED, "mean removed": f"{raw.mean():.6g} gal"}
        number = said[12] if said[12] in _SIDES else ""
        if number:
            metadata["position"] = "borehole" if number < "4" else "surface"
        if number and number < "4":
            source.doubt(12, f"direction {number} is of the instrument in the borehole, below the surface")
        name = _SIDES.get(number, said[12]) or "unnamed"
        # numbers are directions 1 to 6, and no azimuths
        odd = {directions.KEY: directions.UNCLEAR} if not number and re.fullmatch(r"\d\d?", name) else {}
        component = Component(name, values, unit, step, abs(peak), odd)
        return Record(self.name, (component,), "\n".join(source.lines[: len(_KEYS)]), metadata)

    def write(self, record: Record) -> bytes:
        """Return a K-NET file with a scale factor that suits the record's peak."""
        (given,) = headers.in_unit(record, self.name, "gal", 1)
        part = record.components[0]
        rate = round(1.0 / part.time_step)
        if rate < 1 or abs(rate * part.time_step - 1.0) > 1e-9 or given.size % rate:
            raise RecordError(
                "K-NET holds whole seconds at a whole number of samples a second, got {count} samples at {step:g} s",
                count=given.size, step=part.time_step,
            )  # fmt: skip
        largest = float(np.abs(given).max())
        if largest > 1e8:
            raise RecordError(
                "K-NET holds accelerations up to 1e8 gal, got {largest:g}", largest=largest, hint="wrong unit?"
            )
        gal = max(1, math.ceil(2.0 * largest))
        counts = np.rint(given * (_FULL_SCALE / gal))
        if abs(counts.mean()) > 0.5:
            raise RecordError(
                "K-NET records lose their mean when read, got a mean of {mean:g} gal", mean=float(given.mean()),
                hint="remove it",
            )  # fmt: skip
        peak = float(np.abs(counts - counts.mean()).max()) * gal / _FULL_SCALE
        known = {key: record.text(key.strip(". "), 60) for key in _KEYS}
        known |= {"Sampling Freq(Hz)": f"{rate}Hz", "Duration Time(s)": str(given.size // rate)}
        known |= {"Scale Factor": f"{gal}(gal)/{_FULL_SCALE}", "Max. Acc. (gal)": f"{peak:.3f}"}
        known["Dir."] = one_line(part.name, 20)
        lines = [f"{key:<18}{known[key]}" for key in _KEYS]
        lines += numbers.in_columns(counts, _PER_LINE, "{:8.0f} ")
        return ("\n".join(lines) + "\n").encode("latin-1")


def _header(source: Source) -> list[str]:
    if not source.is_text or len(source.lines) <= len(_KEYS):
        raise source.error(
            None, "a K-NET header of {expected} lines expected, found {count} lines", expected=len(_KEYS),
            count=len(source.lines),
        )  # fmt: skip
    for line, key in enumerate(_KEYS):
        if not source.lines[line].startswith(key):
            raise source.error(
                line, "{key!r} expected, found {entry!r}", key=key, entry=source.lines[line].strip()[:40]
            )
    return [source.lines[line][len(key) :].strip() for line, key in enumerate(_KEYS)]


def _stated(source: Source, line: int, form: str, text: str) -> list[float]:
    found = re.fullmatch(form, text)
    if found is None:
        raise source.error(line, "{key} cannot be understood: {entry!r}", key=_KEYS[line], entry=text[:40])
    return [numbers.number(source, line, word) for word in found.groups()]


def _counts(source: Source) -> FloatArray:
    rows = [(line, source.lines[line].split()) for line in range(len(_KEYS), len(source.lines))]
    while rows and not rows[-1][1]:
        rows.pop()
    for (line, words), _ in pairwise(rows):
        if len(words) != _PER_LINE:
            raise source.error(line, "{expected} counts expected, found {count}", expected=_PER_LINE, count=len(words))
    if rows and len(rows[-1][1]) > _PER_LINE:
        raise source.error(
            rows[-1][0], "at most {most} counts expected, found {count}", most=_PER_LINE, count=len(rows[-1][1])
        )
    counts = [
        numbers.whole(source, line, word, "count of the recorder", least=-_LARGEST_COUNT)
        for line, words in rows
        for word in words
    ]
    return np.array(counts, dtype=np.float64)
