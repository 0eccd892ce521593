"""The operations that the benchmark counts in the fast engine are those that are written there, and no others."""

import shutil
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.append(str(Path(__file__).parents[2]))  # what counts lives beside the benchmarks

from benchmarks.engine_batch import Fast, Histories, histories
from benchmarks.engine_operations import Operations, counted

pytestmark = [
    pytest.mark.verifies(room="benchmarks"),
    pytest.mark.skipif(
        not any(map(shutil.which, ("c++", "g++", "clang++"))), reason="no C++ compiler to build the engine that counts"
    ),
]
SAMPLES = 30


def by_hand(order: int) -> int:
    """One step, read off engine/step.hpp: a record without vertical part, the nonlinear equation."""
    forcing = 1 + 1 + (2 + 1) + 2  # length of the step; slope; value at its start, times c; slope, times c and length
    sines = 1 + 19 * 2 + 1  # square; 19 multiply-adds of the two polynomials; one product
    start = 2 + 1  # kappa h^2; V0
    first = 2 + 1  # moment at the start, its velocity term
    others = (order - 1) * (2 * 2 + 1 + 1 + 1)  # moment, over its degree, sum, velocity term
    sums = 2 * (1 + 2 * (order - 2)) + (1 + 2 + (order - 3))  # rotation and its sizes; sway
    series = sum(2 * (1 + 2 * k) for k in range(order - 1)) + (order - 2) + (order - 1)
    ends = (2 + 1) + 1 + (1 + 2) + 1  # rotation, u1, v1, v1 h
    ground = 1 + 3 + 4 + 1 + 1 + 2  # -V0, what is left of v1 h, sag, y0, y1, the bound
    force = 1 + 2 + 2 + 1 + 1  # of the ground: horizontal, vertical, against the largest demand and the least force
    rest = 2 + 2 + 1 + 1  # the highest point, beyond the top, time, error
    return forcing + sines + start + first + others + sums + series + ends + ground + force + rest


def flying(p: float) -> tuple[Operations, int]:
    """Operations of three blocks that neither hit the ground nor turn round, and their steps."""
    ones = np.ones(3)
    records = [1e-6 * np.sin(np.arange(SAMPLES) + k) for k in range(3)]
    batch = Histories(records, 0.2 * ones, p * ones, 0.9 * ones, ones, ones)
    found = counted(batch, rotation=0.5 * batch.alpha)
    assert found is not None
    return found, 3 * (SAMPLES - 1)


@pytest.mark.slow
@pytest.mark.verifies(
    "computed anew", "operations of a step, read off the source by hand", within="every operation", control="within"
)
@pytest.mark.parametrize(("p", "order"), [(1.0, 6), (3.0, 8)])  # by p dt = 0.01 and 0.03
def test_a_step_takes_what_is_written(p: float, order: int) -> None:
    """A step of order 6, and one of order 8, takes the operations that are written in the engine, and no others."""
    found, steps = flying(p)
    assert found.steps == steps
    assert found.total == steps * by_hand(order)
    assert found.total != steps * by_hand(14 - order)
    assert found.total - found.fused != steps * by_hand(order)  # multiply-adds are two


@pytest.mark.slow
@pytest.mark.verifies("same bits", "the fast engine that does not count")
def test_landings_are_counted_and_histories_are_the_same() -> None:
    """Histories with impacts: the same steps and outcomes as the fast engine, and more operations than the steps."""
    batch = histories(40)
    found, (results, work) = counted(batch), Fast(batch)()
    assert found is not None
    assert found.steps == work["steps"]
    assert (found.outcome == results["outcome"]).all()
    six = (8 * work["steps"] - work["orders"]) // 2
    landings = found.total - six * by_hand(6) - (found.steps - six) * by_hand(8)
    assert 100 < landings / results["impacts"].sum() < 600  # two or three rounds of three polynomials, and their bounds
    assert found.roots > 0
