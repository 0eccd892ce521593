"""What all generators share: the seed, the grid of times and the description of the parameters."""

import math
from dataclasses import fields
from typing import Any

import numpy as np

from rocking import checks
from rocking.conventions import FloatArray
from rocking.errors import InvalidValueError
from rocking.motions.motion import LONGEST_STEP, SHORTEST_STEP

MOST_SAMPLES = 10_000_000  # no synthetic motion has more samples: asking for more is a wrong unit


_GRID = 2.0**32


def normals(seed: object, *shape: int) -> FloatArray:
    """Return the standard normal numbers of a seed by NumPy's default generator, with the same bits on every processor.

    The last bit of one in 4000 of NumPy's is that of the C library's logarithm; rounding to 2e-10 takes it away.
    """
    numbers = np.random.default_rng(checks.whole("seed", seed, high=2**128 - 1)).standard_normal(shape)
    numbers *= _GRID
    np.rint(numbers, out=numbers)
    numbers *= 1.0 / _GRID
    return numbers


def times(time_step: float, duration: float) -> FloatArray:
    """Return at least three times of samples, from zero to the duration, rounded up to whole steps [s]."""
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


def described(**parts: Any) -> dict[str, str]:
    """Return parameters as the metadata of a motion.

    >>> described(seed=3, time_step=0.01)
    {'seed': '3', 'time_step': '0.01'}
    """
    lines: dict[str, str] = {}
    for name, part in parts.items():
        if hasattr(part, "__dataclass_fields__"):
            lines |= {f"{name}.{field.name}": repr(getattr(part, field.name)) for field in fields(part)}
        else:
            lines[name] = repr(part)
    return lines
