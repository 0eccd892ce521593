"""The bed's fast engine as Python sees it: whether it is there, and impacts in and out."""

from collections.abc import Sequence
from functools import cache
from types import ModuleType

import numpy as np

from rocking.conventions import FloatArray, IntArray
from rocking.restitution.bed.tables import COUNTS, RESULTS, Setup, choices_of, numbers_of


@cache
def _module() -> ModuleType | None:
    try:
        from rocking.restitution import _bed
    except ImportError:
        return None
    return _bed


def available() -> bool:
    """Return whether the bed's fast engine was built with this installation.

    Returns true if it is there; otherwise the reference serves.
    """
    return _module() is not None


def one(setup: Setup, most_steps: int) -> tuple[FloatArray, IntArray, FloatArray, FloatArray, FloatArray]:
    """Compute one impact with its history.

    Returns columns `RESULTS`, `COUNTS`, `SAMPLES`; forces of the points at the samples [N]; contacts (point, on, off).
    """
    module = _module()
    assert module is not None
    results, counts = np.zeros((1, len(RESULTS))), np.zeros((1, len(COUNTS)), dtype=np.int64)
    bed = setup.rigid.bed
    samples, forces, intervals = module.run_single(
        bed.positions,
        bed.heights,
        bed.shares,
        numbers_of(setup)[None],
        choices_of(setup, 0, most_steps)[None],
        results,
        counts,
    )
    return results[0], counts[0], samples, forces, intervals


def many(setups: Sequence[Setup], most_steps: int, threads: int) -> tuple[FloatArray, IntArray]:
    """Compute many impacts; no row sees another, so that threads do not change a bit.

    Returns columns `RESULTS` and `COUNTS`, a row an impact.
    """
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
        np.array([numbers_of(s) for s in setups]),
        np.array([choices_of(s, firsts[id(s.rigid.bed)], most_steps) for s in setups]),
        results,
        counts,
        threads,
    )
    return results, counts
