"""Where a header states the number of samples, the peak, the unit or the step, the data must agree."""

import numpy as np

from rocking.conventions import ACCELERATION_UNITS, FloatArray
from rocking.errors import InvalidValueError
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
