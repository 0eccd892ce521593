"""The fast engine of the bed: availability, inputs and results."""

from collections.abc import Sequence
from functools import cache
from types import ModuleType

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.restitution.bed.setup import COUNTS, RESULTS, SAMPLES, Results, Run, Setup, named

MOST_STEPS = 500_000


@cache
def _module() -> ModuleType | None:
    try:
        from rocking.restitution import _bed
    except ImportError:
        return None
    return _bed


def available() -> bool:
    """Return True if the fast engine of the bed was built with this installation. Otherwise the reference is used."""
    return _module() is not None


def compute_one(setup: Setup, most_steps: int = MOST_STEPS) -> Run:
    """Return the results of one impact with its history."""
    module = _module()
    assert module is not None
    results, counts = np.zeros((1, len(RESULTS))), np.zeros((1, len(COUNTS)), dtype=np.int64)
    bed = setup.rigid.bed
    samples, forces, intervals = module.run_single(
        bed.positions,
        bed.heights,
        bed.shares,
        _numbers(setup)[None],
        _choices(setup, 0, most_steps)[None],
        results,
        counts,
    )
    return named(results[0], counts[0]), dict(zip(SAMPLES, samples.T, strict=True)), forces, intervals


def many(setups: Sequence[Setup], threads: int) -> Results:
    """Return the results of many impacts. Rows are independent, and the number of threads does not change results."""
    module = _module()
    assert module is not None
    firsts: dict[int, int] = {}
    beds, total = [], 0
    for setup in setups:
        bed = setup.rigid.bed
        if id(bed) not in firsts:
            firsts[id(bed)] = total
            beds.append(bed)
            total += len(bed.positions)
    results, counts = np.zeros((len(setups), len(RESULTS))), np.zeros((len(setups), len(COUNTS)), dtype=np.int64)
    module.run_batch(
        *(np.concatenate([getattr(bed, name) for bed in beds]) for name in ("positions", "heights", "shares")),
        np.array([_numbers(s) for s in setups]),
        np.array([_choices(s, firsts[id(s.rigid.bed)], MOST_STEPS) for s in setups]),
        results,
        counts,
        threads,
    )
    return named(results, counts)


def _numbers(setup: Setup) -> FloatArray:
    """Return the row of numbers of an impact."""
    r, law = setup.rigid, setup.law
    _, coefficient, creep = r.bed.friction.numbers
    return np.array([
        r.mass, r.inertia, r.height, setup.gravity, setup.push,
        law.stiffness, law.damping, law.exponent, law.viscosity, law.rebound, coefficient, creep,
        *setup.state, setup.tolerance, setup.depth, setup.speed, setup.half_base, setup.longest, setup.farthest,
    ])  # fmt: skip


def _choices(setup: Setup, first: int, most_steps: int) -> IntArray:
    """Return the row of integers of an impact."""
    bed = setup.rigid.bed
    numbers = [
        int(setup.law.kind), int(bed.friction.numbers[0]), int(bed.kinematics == "exact"), setup.end,
        setup.new_foot, setup.old_foot, first, len(bed.positions), most_steps,
    ]  # fmt: skip
    return np.array(numbers, dtype=np.int64)
