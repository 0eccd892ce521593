"""Initial rotations and velocities of the bodies of a stack."""

import math
from typing import Any

import numpy as np

from rocking import checks
from rocking.errors import InvalidValueError


def values_per_body(name: str, values: Any, count: int) -> tuple[float, ...]:
    """Return the initial values of all bodies. One number applies to all bodies."""
    array = checks.real_array(name, values, "rad" if name == "rotation" else "rad/s")
    if array.ndim == 0:
        array = np.full(count, array)
    if array.shape != (count,) or not np.isfinite(array).all():
        raise InvalidValueError(parameter=name, allowed=f"one number, or {count} numbers, lowest first", value=values)
    return tuple(array.tolist())


def start_within(start: tuple[Any, Any], count: int, fastest: float) -> tuple[tuple[float, ...], ...]:
    """Return theta and theta' of all bodies. Raise an error above a quarter turn or the fastest velocity [rad/s]."""
    limits = {"rotation": (0.5 * math.pi, "rad", True), "angular_velocity": (fastest, "rad/s", False)}
    return tuple(
        tuple(
            checks.within(name, value, -limit, limit, unit=unit, open_low=is_open, open_high=is_open, hint="in radians")
            for value in values_per_body(name, values, count)
        )
        for (name, (limit, unit, is_open)), values in zip(limits.items(), start, strict=True)
    )
