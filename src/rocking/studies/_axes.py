"""Axes of overturning maps by name; a new one is a class of a few lines and its entry here."""

from collections.abc import Sequence
from typing import Any

from rocking import checks
from rocking.errors import InvalidValueError
from rocking.studies.axis import Axis
from rocking.studies.body_axes import Height, RestitutionAxis, SemiDiagonal, SlendernessAngle, SlendernessRatio, Width
from rocking.studies.motion_axes import (
    AmplitudeRatio,
    Duration,
    FrequencyRatio,
    PeakAcceleration,
    PeakVelocity,
    Period,
    Scale,
)

_ALL: tuple[type[Axis], ...] = (
    FrequencyRatio, AmplitudeRatio, Scale, PeakAcceleration, PeakVelocity, Period, Duration,
    SemiDiagonal, SlendernessRatio, SlendernessAngle, Width, Height, RestitutionAxis,
)  # fmt: skip


def axes() -> dict[str, type[Axis]]:
    """Return every axis by name.

    Returns
    -------
    dict of str to type
        Name to class.

    Examples
    --------
    >>> sorted(axes())[:3]
    ['amplitude_ratio', 'duration', 'frequency_ratio']
    """
    return {kind.name: kind for kind in _ALL}


def axis_of(given: Any) -> Axis:
    """Return an axis from what a user gives.

    >>> axis_of(("pga", [1.0, 2.0])).unit
    'm/s2'
    """
    if isinstance(given, Axis):
        return given
    if not isinstance(given, Sequence) or isinstance(given, str) or len(given) != 2 or not isinstance(given[0], str):
        raise InvalidValueError(f'an axis is written as ("scale", values), got {given!r:.60}')
    known = axes()
    name = checks.spelling(given[0], known)
    if name not in known:
        there, near = ", ".join(sorted(known)), checks.nearest(name, known)
        raise InvalidValueError(f"no axis named {name!r}; there are {there}{near}")
    return known[name](given[1])
