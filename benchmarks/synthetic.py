"""Cost of a synthetic motion of 40 s at 0.01 s for each of the three models: CPU time on one core."""

import statistics
from collections.abc import Callable

import rocking as rk
from benchmarks.table import Row
from benchmarks.timing import cpu_seconds
from rocking.motions import synthetic

GOAL = 5e-4
"""Seconds of CPU a motion."""


def models() -> dict[str, Callable[[int], rk.GroundMotion]]:
    """A motion of 4001 samples from a seed, by the name of its model."""
    modulation = synthetic.modulation_from_intensity(1.0, 12.0, 8.0)
    shaper, layer = synthetic.NonstationaryFilter(), synthetic.KanaiTajimi(0.01)
    source = synthetic.PointSource(6.5, 20e3)
    return {
        "filtered noise": lambda seed: synthetic.nonstationary_motion(modulation, shaper, seed=seed, duration=40.0),
        "Kanai-Tajimi": lambda seed: synthetic.kanai_tajimi_motion(layer, seed=seed, duration=40.0),
        "point source": lambda seed: synthetic.point_source_motion(source, seed=seed, duration=40.0),
    }


def seconds(make: Callable[[int], rk.GroundMotion], repeats: int = 301) -> float:
    """Median CPU seconds of one motion, each of a seed of its own."""
    make(0)
    return statistics.median(cpu_seconds(lambda s=seed: make(s)) for seed in range(repeats))


def rows() -> list[Row]:
    """A row for each model."""
    spent = {name: seconds(make) for name, make in models().items()}
    return [
        Row(f"Synthetic motion of 40 s, {name}", "-", f"{1e3 * times:.2f} ms", f"< {1e3 * GOAL:g} ms", times < GOAL)
        for name, times in spent.items()
    ]
