"""SMC: accelerations in the layout of the U.S. Geological Survey, or in the high-precision layout of Boore."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from rocking.conventions import FloatArray
from rocking.errors import RecordError
from rocking.messages import Message
from rocking.motions.formats import directions, headers, numbers
from rocking.motions.formats.record import Component, Record, RecordFormat, Source, metadata_of, one_line

TEXTS, WHOLES, REALS = 11, 6, 10
_NO_REAL = 1.7e38
_NO_WHOLE = -32768
_HIGH_PRECISION = 8
_WHOLES, _REALS = r"[ \d-]{80}", r"( *[+-]?\d*\.\d+E[+-]\d\d){5}"
_UPRIGHT: dict[int | None, str] = {0: "up", 180: "down"}
_KINDS = {0: "unknown", 1: "uncorrected accelerogram", 2: "corrected accelerogram"}
_OTHER = {3: "velocity", 4: "displacement", 5: "response spectra", 6: "Fourier amplitude spectra"}


@dataclass(frozen=True)
class _Header:
    """Numbers before the samples; None if missing."""

    kind: int
    integers: list[int | None]
    reals: list[float | None]
    first: int  # line of the first sample


class SmcUsgs(RecordFormat):
    """SMC with 8 columns of 10 characters."""

    name: ClassVar[str] = "smc-usgs"
    title: ClassVar[str] = "SMC of the U.S. Geological Survey, 8 columns of 10 characters"
    suffixes: ClassVar[tuple[str, ...]] = (".smc",)
    notes: ClassVar[str] = (
        "Layout: USGS, smcfmt.txt. Accelerations are in cm/s2 by the definition of the format. Samples at uneven "
        "times, without a rate, are resampled. Velocities, displacements and spectra raise an error."
    )
    _per_line: ClassVar[int] = 8
    _width: ClassVar[int] = 10
    _decimals: ClassVar[int] = 4
    _precision: ClassVar[int] = _NO_WHOLE

    def recognises(self, source: Source) -> bool:
        """Return True if the file has the lines of numbers of SMC, with the precision of this variant."""
        if not source.is_text or not re.match(r" ?\d [A-Z]", source.lines[0]):
            return False
        # a header with a missing line is still SMC; read() reports the error
        top = [line.rstrip() for line in source.lines[1 : TEXTS + WHOLES + REALS + 3]]
        wholes = [row for row in top if re.fullmatch(_WHOLES, row)]
        if len(wholes) < WHOLES - 1 or sum(re.fullmatch(_REALS, row) is not None for row in top) < REALS - 1:
            return False
        return (wholes[-1][60:70].strip() == str(_HIGH_PRECISION)) == (self._precision == _HIGH_PRECISION)

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        if not self.recognises(source):
            raise source.error(
                None, "not a {format} file: 16 lines of numbers expected after 11 lines of text", format=self.name
            )
        header = _header(source)
        rate, count = header.reals[1], header.integers[16]
        if count is None or count < 2:
            raise source.error(
                TEXTS + 2, Message("number of samples must be at least 2, got {count}", {"count": count})
            )
        if rate is not None and not rate > 0.0:
            raise source.error(TEXTS + WHOLES, "sampling rate must be above zero, found {rate:g}", rate=rate)
        unit = headers.acceleration_unit(source, "cm/s2", units)
        values, after = numbers.fixed(source, header.first, count, self._per_line, self._width)
        about: dict[str, str] = {}
        if rate is not None:
            headers.check_end(source, after)
            step = 1.0 / rate
            stated = self._check_peaks(source, header, values, np.arange(count, dtype=np.float64) * step)
        else:
            # if there is no rate, the count includes times and samples
            if count % 2:
                raise source.error(
                    TEXTS + 2, "the count of pairs of time and sample must be even, found {count}", count=count
                )
            with source.doubting():
                headers.check_end(source, after)
            times, values = values[::2], values[1::2].copy()
            stated = self._check_peaks(source, header, values, times)
            digit = 10.0**-self._decimals * max(1.0, float(times[-1]))
            values, step, about = headers.at_even_steps(source, times, values, digit)
        step = headers.step_between_samples(source, step, time_step)
        upwards, azimuth = header.integers[12:14]
        printed = re.search(r"component= *(\S+)", source.lines[5])
        level = str(azimuth) if azimuth is not None else printed[1] if printed else "unnamed"
        name = _UPRIGHT.get(upwards) or level
        side = directions.orientation(printed[1]) if printed else directions.orientation(name)
        if upwards is not None:  # angle from the upward vertical
            upright = side if isinstance(side, str) else None
            side = directions.both(upright, directions.of_angles(azimuth, float(upwards)))
        about[directions.KEY] = directions.as_text(side)
        texts = {
            "kind": _KINDS[header.kind],
            "event": source.lines[3],
            "station": re.sub(r"component=.*", "", source.lines[5]),
            "instrument": source.lines[7],
            "azimuth": "" if azimuth is None else str(azimuth),
        }
        metadata = metadata_of(**{key: " ".join(text.split()) for key, text in texts.items() if text.strip(" *")})
        raw = "\n".join(source.lines[: header.first])
        return Record(self.name, (Component(name, values, unit, step, stated, about),), raw, metadata)

    def write(self, record: Record) -> bytes:
        (samples,) = headers.in_unit(record, self.name, "cm/s2", 1)
        component = record.components[0]
        texts = [self._word(value) for value in samples.tolist()]
        values = np.array([float(word) for word in texts])
        integers, reals = [_NO_WHOLE] * 48, [_NO_REAL] * 50
        integers[15], integers[16], integers[46] = 1, len(texts), self._precision
        if re.fullmatch(r"\d{1,3}", component.name):
            integers[13] = int(component.name)
        rate = 1.0 / component.time_step
        reals[1] = rate
        reals[28:32] = [values.argmax() / rate, values.max(), values.argmin() / rate, values.min()]
        text = ["*"] * TEXTS
        kind = next((code for code, name in _KINDS.items() if name == record.metadata.get("kind")), 2)
        text[0] = f"{kind} {_KINDS[kind].upper()}"
        text[3] = record.text("event", 79) or "*"
        station = record.text("station", 50, "station = unknown")
        text[5] = f"{station} component= {one_line(component.name, 15).replace(' ', '_')}"
        lines = [line.ljust(80) for line in text]
        lines += numbers.in_columns(integers, 8, "{:10d}")
        real_texts = [numbers.fortran_e(value, 7, 15, "0") for value in reals]
        lines += ["".join(real_texts[k : k + 5]) for k in range(0, 50, 5)]
        lines.append("|")
        lines += ["".join(texts[k : k + self._per_line]) for k in range(0, len(texts), self._per_line)]
        return ("\n".join(lines) + "\n").encode("ascii", "replace")

    def _check_peaks(self, source: Source, header: _Header, values: FloatArray, times: FloatArray) -> float | None:
        extremes = [header.reals[29], header.reals[31]]
        for quantity, when, stated, computed in (
            ("maximum", header.reals[28], extremes[0], float(values.max())),
            ("minimum", header.reals[30], extremes[1], float(values.min())),
        ):
            if stated is None:
                continue
            # half a unit of the last digit of the samples and of the header
            rounding = abs(stated) * (0.51 * 10.0**-self._decimals + 6e-7)
            headers.check_stated(source, stated, computed, rounding, quantity)
            if when is None:
                continue
            here = np.abs(times - when) <= 0.51 * (times[1] - times[0]) + 1e-4 * abs(when)
            if not (np.abs(values[here] - stated) <= rounding).any():
                source.doubt(
                    None, f"the header states a {quantity} of {stated:g} at {when:g} s, which the data do not have"
                )
        printed = re.search(r"pk[a-z ]*=\s*([+-]?\d+\.?\d*(?:E[+-]\d+)?)", source.lines[6])
        if printed:
            rounding, confirmed = headers.half_digit(printed[1]), None not in extremes
            headers.check_said_peak(source, float(printed[1]), values, rounding, "pk", confirmed=confirmed)
        magnitudes = [abs(value) for value in extremes if value is not None]
        if len(magnitudes) == 1:
            raise source.error(None, "the header states only one extreme; check the order of its lines")
        return max(magnitudes) if magnitudes else None

    def _word(self, value: float) -> str:
        if abs(value) <= 1e-9:
            value = 0.0
        mantissa, exponent = f"{value:.{self._decimals}E}".split("E")
        if not -9 <= int(exponent) <= 9:
            raise RecordError(
                "SMC allows accelerations below 1e10 cm/s2, got {acceleration:g}",
                acceleration=value,
                hint="check the unit",
            )
        return f"{mantissa}E{int(exponent):+d}".rjust(self._width)


def _header(source: Source) -> _Header:
    kind = int(source.lines[0].split()[0])
    if kind not in _KINDS:
        raise source.error(
            0, "the file contains {content}; accelerations required", content=_OTHER.get(kind, f"kind {kind}")
        )
    for line in range(TEXTS, TEXTS + WHOLES + REALS):
        row = source.lines[line].rstrip() if line < len(source.lines) else ""
        if not re.fullmatch(_WHOLES, row) if line < TEXTS + WHOLES else len(row) != 75 or not re.fullmatch(_REALS, row):
            raise source.error(line, "full line of header numbers expected; the line may be missing or damaged")
    wholes = _grid(source.lines[TEXTS : TEXTS + WHOLES], 8, 10)
    integers: list[int | None] = []
    for index, word in enumerate(wholes):
        integer = numbers.whole(source, TEXTS + index // 8, word, "whole number", minimum=-999_999_999)
        integers.append(None if integer == _NO_WHOLE else integer)
    first_real = TEXTS + WHOLES
    reals: list[float | None] = []
    for index, word in enumerate(_grid(source.lines[first_real : first_real + REALS], 5, 15)):
        amount = numbers.number(source, first_real + index // 5, word)
        reals.append(None if math.isclose(amount, _NO_REAL, rel_tol=1e-6) else amount)
    comments, after = integers[15] or 0, first_real + REALS
    for line in range(after, after + max(comments, 0)):
        if line >= len(source.lines) or not source.lines[line].startswith("|"):
            raise source.error(
                None, "the header states {count} comment lines, but one of them is missing", count=comments
            )
    return _Header(kind, integers, reals, after + max(comments, 0))


def _grid(lines: Sequence[str], per_line: int, width: int) -> list[str]:
    return [line[k * width : (k + 1) * width] for line in lines for k in range(per_line)]


class SmcBoore(SmcUsgs):
    """SMC in high precision. It differs from `SmcUsgs` only in the columns of the samples."""

    name: ClassVar[str] = "smc-boore"
    title: ClassVar[str] = "SMC of Boore's TSPP programs in high precision, 5 columns of 14 characters"
    notes: ClassVar[str] = (
        "Accelerations are in cm/s2 by the definition of the format. If the first line contains UNKNOWN, check that "
        "the file contains no velocities. Units in comment lines refer to the source of the file."
    )
    _per_line: ClassVar[int] = 5
    _width: ClassVar[int] = 14
    _decimals: ClassVar[int] = 7
    _precision: ClassVar[int] = 8
