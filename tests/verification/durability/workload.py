"""A small campaign with all outcomes, for processes that are going to be killed."""

import numpy as np

import rocking as rk
from rocking.dynamics import RandomRestitution
from rocking.studies import HistoryTable, MotionList

RANGES = {"alpha": (0.08, 0.5), "p": (0.9, 5.0), "r": (0.5, 0.95)}


def histories(count: int = 20_000, seed: int = 5) -> HistoryTable:
    """Random blocks, scales and coefficients under nine pulses; the coefficients change from impact to impact."""
    random = np.random.default_rng(seed)
    motions = [rk.pulses.sine(a, period) for a in (3.0, 6.0, 9.0) for period in (0.4, 0.8, 1.3)]
    values = {f"{n}_{side}": random.uniform(*RANGES[n], count) for n in RANGES for side in ("right", "left")}
    values["scale"] = random.uniform(0.2, 1.5, count)
    law = RandomRestitution.normal(0.95, 0.02, seed=3)
    return HistoryTable(MotionList(motions), random.integers(0, len(motions), count), values, law=law)
