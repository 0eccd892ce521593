"""A Section of 10,000 vertices: from points to the coefficient of restitution."""

import statistics

import numpy as np

from benchmarks.timing import cpu_seconds
from rocking import Section
from rocking.restitution import Ked

VERTICES = 10_000
GOAL = 0.020


def outline() -> np.ndarray:
    """A wavy column: two feet and a rippled top."""
    x = np.linspace(0.5, -0.5, VERTICES - 2)
    top = np.column_stack([x, 3.0 + 0.05 * np.sin(300.0 * x)])
    return np.vstack([[(-0.5, 0.0), (0.5, 0.0)], top])


def seconds() -> float:
    """Median CPU seconds for construction (with all checks) and the coefficient."""
    points, model = outline(), Ked()
    return statistics.median(cpu_seconds(lambda: model.coefficient(Section.from_points(points))) for _ in range(15))
