"""Initial rotations and velocities of the bodies of a stack."""

from typing import Any

import numpy as np

from rocking.errors import InvalidValueError


def values_per_body(name: str, values: Any, count: int) -> tuple[float, ...]:
    """Return the initial values of all bodies. One number applies to all bodies."""
    array = np.asarray(values, dtype=np.float64)
    if array.ndim == 0:
        array = np.full(count, array)
    if array.shape != (count,) or not np.isfinite(array).all():
        raise InvalidValueError(parameter=name, allowed=f"one number, or {count} numbers, lowest first", value=values)
    return tuple(array.tolist())
