"""Where a header states the number of samples, the peak, the unit or the step, the data must agree."""

import math

import numpy as np

from rocking.conventions import ACCELERATION_UNITS, FloatArray
from rocking.errors import InvalidValueError, RecordError
from rocking.motions.formats.record import Record
from rocking.motions.formats.source import Source


def check_count(source: Source, stated: int, found: int) -> None:
    """Refuse a file that holds another number of samples than its header states.

    Parameters
    ----------
    source : Source
        The file, for the error.
    stated, found : int
        Numbers of samples.

    Raises
    ------
    RecordError
        If they differ.
    """
    if stated != found:
        raise source.error(None, f"the header states {stated} samples, the file holds {found}")


def check_peak(source: Source, stated: float, values: FloatArray, rounding: float, what: str = "peak") -> None:
    """Refuse a file whose largest value is not the one that its header states.

    Parameters
    ----------
    source : Source
        The file, for the error.
    stated : float
        Peak by the header; its sign is not compared.
    values : ndarray
        The samples, in the same unit.
    rounding : float
        Largest difference that rounding in the file explains.
    what : str
        What the header calls it.

    Raises
    ------
    RecordError
        If they differ by more.
    """
    found = float(np.abs(values).max())
    if not abs(abs(stated) - found) <= rounding:
        raise source.error(None, f"the header states a {what} of {abs(stated):g}, the data have {found:g}")


def acceleration_unit(source: Source, stated: str | None, asked: str | None) -> str:
    """Return the unit of a file's accelerations: what it states, or what the user says where it states nothing.

    Parameters
    ----------
    source : Source
        The file, for the error.
    stated : str, optional
        Unit by the file.
    asked : str, optional
        Unit by the user.

    Returns
    -------
    str
        A key of `rocking.conventions.ACCELERATION_UNITS`.

    Raises
    ------
    InvalidValueError
        If the user's word is no unit of acceleration.
    RecordError
        If neither says, or both do and differ.
    """
    if asked is not None and asked not in ACCELERATION_UNITS:
        raise InvalidValueError(f"units must be one of {', '.join(ACCELERATION_UNITS)}, got {asked!r:.60}")
    if stated is None and asked is None:
        raise source.error(None, f"the file does not state its unit; say units= one of {', '.join(ACCELERATION_UNITS)}")
    if stated is not None and asked is not None and ACCELERATION_UNITS[stated] != ACCELERATION_UNITS[asked]:
        raise source.error(None, f"the file states the unit {stated}, you say {asked}")
    return stated or asked or ""


def step_between_samples(source: Source, stated: float | None, asked: float | None) -> float:
    """Return the step of a file: what it states, or what the user says where it states nothing.

    Parameters
    ----------
    source : Source
        The file, for the error.
    stated : float, optional
        Step by the file [s].
    asked : float, optional
        Step by the user [s].

    Returns
    -------
    float
        The step, between 1e-6 and 10 s [s].

    Raises
    ------
    RecordError
        If neither says, both do and differ, or it is outside that range.
    """
    step = stated if stated is not None else asked
    if step is None:
        raise source.error(None, "the file does not state its time step; say time_step= in seconds")
    if stated is not None and asked is not None and abs(stated - asked) > 1e-9 * stated:
        raise source.error(None, f"the file states a time step of {stated:g} s, you say {asked:g}")
    if not 1e-6 <= step <= 10.0:
        raise source.error(None, f"time step must be in [1e-6, 10] s, got {step:g}")
    return float(step)


def check_end(source: Source, first: int) -> None:
    """Refuse anything but blank lines from some line to the end of the file.

    Parameters
    ----------
    source : Source
        The file.
    first : int
        Line from which on nothing may follow.

    Raises
    ------
    RecordError
        If something does; its line is named.
    """
    for line in range(first, len(source.lines)):
        # Ctrl-Z padded files to whole blocks under CP/M and DOS
        if source.lines[line].strip(" \t\r\x1a"):
            raise source.error(line, "nothing may follow the last sample, found more; wrong count in the header?")


def check_peak_time(source: Source, stated: float, values: FloatArray, step: float, rounding: float) -> None:
    """Refuse a file whose largest value is not where its header states it.

    Parameters
    ----------
    source : Source
        The file, for the error.
    stated : float
        Time of the peak by the header, within one step [s].
    values : ndarray
        The samples, the first one at time zero.
    step : float
        Step between samples [s].
    rounding : float
        Largest difference between equal peaks that rounding in the file explains.

    Raises
    ------
    RecordError
        If the values around that time are all smaller than the largest.
    """
    largest = np.abs(values)
    at = stated / step
    near = largest[max(0, math.ceil(at - 1.01)) : max(0, math.floor(at + 1.01) + 1)] if 0.0 <= at < 1e9 else largest[:0]
    if not near.size or near.max() < largest.max() - rounding:
        found = float(largest.argmax()) * step
        raise source.error(None, f"the header states the peak at {stated:g} s, the data have it at {found:g} s")


def check_duration(source: Source, stated: float, count: int, step: float, rounding: float) -> None:
    """Refuse a file whose stated duration is not that of its samples.

    Parameters
    ----------
    source : Source
        The file, for the error.
    stated : float
        Duration by the header: of all steps, or from the first sample to the last [s].
    count : int
        Number of samples.
    step : float
        Step between samples [s].
    rounding : float
        Half a unit of the last digit of `stated` [s].

    Raises
    ------
    RecordError
        If it is neither of them to the rounding.
    """
    off = min(abs(stated - samples * step) for samples in (count - 1, count))
    if not off <= 1.001 * rounding + 1e-9:
        raise source.error(
            None, f"the header states a duration of {stated:g} s, {count} samples at {step:g} s last {count * step:g} s"
        )


def in_unit(record: Record, title: str, unit: str | None, most: int) -> list[FloatArray]:
    """Return the samples of a record in the one unit that a format holds, for writers.

    Parameters
    ----------
    record : Record
        What to write.
    title : str
        Name of the format, for the error.
    unit : str, optional
        Unit of the format; that of the first component if it holds any.
    most : int
        Largest number of components it holds.

    Returns
    -------
    list of ndarray
        Samples of each component.

    Raises
    ------
    RecordError
        If there is no component, there are more, or one is not a row of at least 2 finite samples in a known unit.
    """
    if not 1 <= len(record.components) <= most:
        raise RecordError(f"{title} holds 1 to {most} components a file, got {len(record.components)}")
    rows = []
    unit = unit or record.components[0].unit
    for part in record.components:
        values = np.asarray(part.acceleration, dtype=np.float64)
        if values.ndim != 1 or values.size < 2 or not np.isfinite(values).all():
            raise RecordError(f"component {part.name!r:.60} must be a row of at least 2 finite samples")
        if part.unit not in ACCELERATION_UNITS:
            raise RecordError(f"unit must be one of {', '.join(ACCELERATION_UNITS)}, got {part.unit!r:.60}")
        if not 1e-6 <= part.time_step <= 10.0:
            raise RecordError(f"time step must be in [1e-6, 10] s, got {part.time_step!r:.60}")
        same = ACCELERATION_UNITS[part.unit] == ACCELERATION_UNITS[unit]
        rows.append(values if same else values * (ACCELERATION_UNITS[part.unit] / ACCELERATION_UNITS[unit]))
    return rows


def half_digit(word: str) -> float:
    """Return the largest error that rounding can have left in a printed number: half a unit of its last digit.

    Parameters
    ----------
    word : str
        The number as printed.

    Returns
    -------
    float
        The error, with a millionth to spare for arithmetic in the last place.

    Examples
    --------
    >>> f"{half_digit('4.954'):.3g}", f"{half_digit('4.136E+1'):.3g}", f"{half_digit('-12'):.3g}"
    ('0.0005', '0.005', '0.5')
    """
    mantissa, _, exponent = word.strip().upper().replace("D", "E").partition("E")
    return 0.500001 * 10.0 ** min(int(exponent or "0") - len(mantissa.partition(".")[2]), 300)


def check_stated(source: Source, stated: float, found: float, rounding: float, what: str) -> None:
    """Refuse a file whose header states another number than its data give; signs count.

    Parameters
    ----------
    source : Source
        The file, for the error.
    stated, found : float
        The number by the header and by the data.
    rounding : float
        Largest difference that rounding in the file explains.
    what : str
        What it is.

    Raises
    ------
    RecordError
        If they differ by more.
    """
    if not abs(stated - found) <= rounding:
        raise source.error(None, f"the header states a {what} of {stated:g}, the data have {found:g}")
