"""Where a header states the number of samples, the peak, its time or the duration, the data must agree."""

import math

import numpy as np

from rocking.conventions import FloatArray
from rocking.motions.formats.source import Source


def check_count(source: Source, stated: int, found: int) -> None:
    """Refuse a file that holds another number of samples than its header states."""
    if stated != found:
        raise source.error(None, f"the header states {stated} samples, the file holds {found}")


def check_peak(source: Source, stated: float, values: FloatArray, rounding: float, what: str = "peak") -> None:
    """Refuse a file whose largest value is not the one that its header states."""
    found = float(np.abs(values).max())
    if not abs(abs(stated) - found) <= rounding:
        raise source.error(None, f"the header states a {what} of {abs(stated):g}, the data have {found:g}")


def check_end(source: Source, first: int) -> None:
    """Refuse anything but blank lines from some line to the end of the file."""
    for line in range(first, len(source.lines)):
        # Ctrl-Z padded files to whole blocks under CP/M and DOS
        if source.lines[line].strip(" \t\r\x1a"):
            raise source.error(line, "nothing may follow the last sample, found more; wrong count in the header?")


def check_peak_time(source: Source, stated: float, values: FloatArray, step: float, rounding: float) -> None:
    """Refuse a file whose largest value is not where its header states it.

    stated: time of the peak by the header, within one step [s]; step: step between samples [s].
    """
    largest = np.abs(values)
    at = stated / step
    near = largest[max(0, math.ceil(at - 1.01)) : max(0, math.floor(at + 1.01) + 1)] if 0.0 <= at < 1e9 else largest[:0]
    if not near.size or near.max() < largest.max() - rounding:
        found = float(largest.argmax()) * step
        raise source.error(None, f"the header states the peak at {stated:g} s, the data have it at {found:g} s")


def check_duration(source: Source, stated: float, count: int, step: float, rounding: float) -> None:
    """Refuse a file whose stated duration is not that of its samples.

    stated: duration by the header: of all steps, or from the first sample to the last [s]; step: step between samples
    [s]; rounding: half a unit of the last digit of `stated` [s].
    """
    off = min(abs(stated - samples * step) for samples in (count - 1, count))
    if not off <= 1.001 * rounding + 1e-9:
        raise source.error(
            None, f"the header states a duration of {stated:g} s, {count} samples at {step:g} s last {count * step:g} s"
        )


def half_digit(word: str) -> float:
    """Return the largest error that rounding can have left in a printed number: half a unit of its last digit.

    Returns the error, with a millionth to spare for arithmetic in the last place.

    >>> f"{half_digit('4.954'):.3g}", f"{half_digit('4.136E+1'):.3g}", f"{half_digit('-12'):.3g}"
    ('0.0005', '0.005', '0.5')
    """
    mantissa, _, exponent = word.strip().upper().replace("D", "E").partition("E")
    return 0.500001 * 10.0 ** min(int(exponent or "0") - len(mantissa.partition(".")[2]), 300)


def check_stated(source: Source, stated: float, found: float, rounding: float, what: str) -> None:
    """Refuse a file whose header states another number than its data give; signs count."""
    if not abs(stated - found) <= rounding:
        raise source.error(None, f"the header states a {what} of {stated:g}, the data have {found:g}")
