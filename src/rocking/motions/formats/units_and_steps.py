"""Unit and step of a file: what it states, or what the user says where it states nothing; and units for writers."""

import numpy as np

from rocking import checks
from rocking.conventions import ACCELERATION_UNITS, FloatArray
from rocking.errors import RecordError
from rocking.motions.formats.record import Record
from rocking.motions.formats.source import Source


def acceleration_unit(source: Source, stated: str | None, asked: str | None) -> str:
    """Return the unit of a file's accelerations: what it states, or what the user says where it states nothing."""
    asked = None if asked is None else checks.one_of("units", asked, ACCELERATION_UNITS)
    if stated is None and asked is None:
        raise source.error(None, f"the file does not state its unit; say units= one of {', '.join(ACCELERATION_UNITS)}")
    if stated is not None and asked is not None and ACCELERATION_UNITS[stated] != ACCELERATION_UNITS[asked]:
        raise source.error(None, f"the file states the unit {stated}, you say {asked}")
    return stated or asked or ""


def step_between_samples(source: Source, stated: float | None, asked: float | None) -> float:
    """Return the step of a file: what it states, or what the user says where it states nothing.

    stated: step by the file [s]; asked: step by the user [s]. Returns the step, between 1e-6 and 10 s [s].
    """
    step = stated if stated is not None else asked
    if step is None:
        raise source.error(None, "the file does not state its time step; say time_step= in seconds")
    if stated is not None and asked is not None and abs(stated - asked) > 1e-9 * stated:
        raise source.error(None, f"the file states a time step of {stated:g} s, you say {asked:g}")
    if not 1e-6 <= step <= 10.0:
        raise source.error(None, f"time step must be in [1e-6, 10] s, got {step:g}")
    return float(step)


def in_unit(record: Record, title: str, unit: str | None, most: int) -> list[FloatArray]:
    """Return the samples of a record in the one unit that a format holds, for writers."""
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
