"""Functions for all generators: random numbers, sample times, and parameters as metadata."""

import math
from dataclasses import fields
from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.motions.motion import LONGEST_STEP, SHORTEST_STEP

MOST_SAMPLES = 10_000_000  # larger numbers result from a wrong unit


_GRID = 2.0**32


def normals(seed: object, *shape: int) -> FloatArray:
    """Return the standard normal numbers of a seed, with the same bits on every processor.

    In NumPy, the last bit of 1 in 4000 numbers depends on the logarithm of the C library. Rounding to 2e-10 removes
    this dependence.
    """
    numbers = np.random.default_rng(checks.whole("seed", seed, high=2**128 - 1)).standard_normal(shape)
    numbers *= _GRID
    np.rint(numbers, out=numbers)
    numbers *= 1.0 / _GRID
    return numbers


def times(time_step: float, duration: float) -> FloatArray:
    """Return the sample times from zero to the duration, rounded up to whole steps [s]. There are at least three."""
    step = checks.within("time_step", time_step, SHORTEST_STEP, LONGEST_STEP, unit="s", hint="in seconds")
    ratio = checks.positive("duration", duration, "s") / step
    if not 1.0 + 1e-6 < ratio < MOST_SAMPLES:
        raise InvalidValueError(
            "duration must be in ({step:g}, {most:g}) s for steps of {step:g} s, got {duration:g}",
            step=step,
            most=step * MOST_SAMPLES,
            duration=duration,
        )
    return np.arange(math.ceil(ratio - 1e-6) + 1, dtype=np.float64) * step


def described(**parameters: Any) -> dict[str, str]:
    """Return parameters as metadata of a motion.

    >>> described(seed=3, time_step=0.01)
    {'seed': '3', 'time_step': '0.01'}
    """
    lines: dict[str, str] = {}
    for name, value in parameters.items():
        if hasattr(value, "__dataclass_fields__"):
            lines |= {f"{name}.{field.name}": repr(getattr(value, field.name)) for field in fields(value)}
        else:
            lines[name] = repr(value)
    return lines
