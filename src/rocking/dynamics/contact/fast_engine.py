"""The fast engine of bodies that slide, hop and fly: whether it is there, motions and tables of histories."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from rocking.conventions import FloatArray
from rocking.dynamics.settings import BOUNCE_LAWS, CompiledEngine, Settings
from rocking.motions.segments import Segments

NUMBERS = (
    "inertia", "height", "left", "right", "friction", "bounce", "imposed_left", "imposed_right", "scale", "end",
    "x", "rise", "rotation", "u", "w", "spin",
)  # fmt: skip
"""What makes a history, beside its motion, its law and the feet that touch: as `PlaneBase`, `GroundContact`,
`ContactState` name it; imposed coefficients are NaN where there are none, `end` is how long to follow it [s]."""

FLOATS = (
    "peak_rotation", "peak_time", "peak_velocity", "overturning_time", "first_uplift", "sliding_distance",
    "residual_displacement", "friction_usage", "end_time",
)  # fmt: skip
WHOLES = ("outcome", "status", "side", "impacts", "uplifts", "still_rocking", "impacts_replaced", "shocks", "steps")

FAST = "fast: Taylor series with events and complementarity, compiled"
REFERENCE = "reference: Taylor series with events and complementarity"

_COMPILED = CompiledEngine(
    "rocking.dynamics._contact",
    "the fast engine with friction was not built: it takes a C++17 compiler when rocking is installed (in a checkout, "
    "`make engine`)",
    "the reference engine runs instead, one history at a time",
)
available, module, chosen = _COMPILED.available, _COMPILED.module, _COMPILED.chosen


def library_of(motions: Sequence[Segments]) -> Any:
    """Return motions as the compiled engine keeps them."""
    data, places, used = [], [], 0
    for motion in motions:
        parts = [motion.horizontal] if motion.vertical is None else [motion.horizontal, motion.vertical]
        places.append((used, motion.count, motion.degree + 1, len(parts) - 1))
        data += [part.ravel() for part in parts]
        used += sum(part.size for part in parts)
    steps = np.array([motion.step for motion in motions])
    return module().Library(np.concatenate(data, dtype=np.float64), np.array(places, np.int64), steps)


def run_compiled(
    library: Any,
    values: dict[str, Any],
    motion: Any,
    bounce_law: str,
    touching: Any,
    *,
    settings: Settings,
    threads: int,
) -> dict[str, np.ndarray]:
    """Return results by name of histories of `NUMBERS`; motion: their numbers."""
    # touching: 1 for the left foot plus 2 for the right
    columns = np.broadcast_arrays(*(values[name] for name in NUMBERS), motion, BOUNCE_LAWS.index(bounce_law), touching)
    numbers: FloatArray = np.column_stack([np.ravel(each) for each in columns[:-3]]).astype(np.float64)
    choices = np.column_stack([np.ravel(each) for each in columns[-3:]]).astype(np.int64)
    results, counts = np.full((len(numbers), len(FLOATS)), np.nan), np.zeros((len(numbers), len(WHOLES)), np.int64)
    library.run(
        numbers, choices, results, counts, settings.gravity, settings.rest_speed, settings.tolerance,
        settings.most_events, threads,
    )  # fmt: skip
    whole = {name: np.ascontiguousarray(counts[:, k]) for k, name in enumerate(WHOLES)}
    return whole | {name: np.ascontiguousarray(results[:, k]) for k, name in enumerate(FLOATS)}
