"""Outcomes of the fast engine compared with the reference engine, and the distance of differences to the boundary."""

import os
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context

import numpy as np

from benchmarks.engine_batch import Fast, Histories, reference
from benchmarks.table import Row

PIECE = 50
BAND = 1e-6
"""Relative change of the motion within which engines may disagree."""


def outcomes_of(batch: Histories) -> np.ndarray:
    """Outcomes by the reference engine."""
    return np.asarray(reference(batch)["outcome"])


def reference_outcomes(batch: Histories, say: Callable[[str], None]) -> np.ndarray:
    """Outcomes by the reference engine, two processes at a time."""
    outcomes = np.zeros(len(batch), np.int8)
    pieces = np.array_split(np.arange(len(batch)), max(1, len(batch) // PIECE))
    done, tenths = 0, 0
    with ProcessPoolExecutor(min(2, os.cpu_count() or 1), mp_context=get_context("spawn")) as crew:
        running = {crew.submit(outcomes_of, batch.some(piece)): piece for piece in pieces}
        for future in as_completed(running):
            outcomes[running[future]] = future.result()
            done += running[future].size
            if done * 10 // len(batch) > tenths:
                tenths = done * 10 // len(batch)
                say(f"  reference engine: {done:,} of {len(batch):,}")
    return outcomes


def agreement(batch: Histories, truth: np.ndarray) -> tuple[list[Row], list[str]]:
    """Rows of the table, and a line for each history on which the engines differ."""
    outcome = Fast(batch)()[0]["outcome"]
    near = flips(batch, outcome, BAND)
    fell, falls = outcome == 2, truth == 2
    count, strangers, others = len(batch), fell != falls, outcome != truth
    lost = int((strangers & ~near).sum())
    rows = [
        Row(
            f"Verdicts of {count:,} histories",
            "reference engine",
            f"{count - int(strangers.sum()):,} equal; {int(strangers.sum())} differ, {lost} of them away from the"
            f" boundary ({int(near.sum())} lie within {BAND:g} of it)",
            f"all equal but within {BAND:g}",
            lost == 0,
        ),
        Row(
            f"Outcomes of {count:,} histories (no uplift, rocked, overturned)",
            "reference engine",
            f"{count - int(others.sum()):,} equal; {int((others & ~near).sum())} differ away from the boundary",
            f"all equal but within {BAND:g}",
            not (others & ~near).any(),
        ),
    ]
    return rows, [_line(batch, k, outcome, truth) for k in np.flatnonzero(others).tolist()]


def flips(batch: Histories, outcome: np.ndarray, band: float) -> np.ndarray:
    """Which histories end otherwise if the motion is a little stronger or weaker."""
    is_flipped = np.zeros(len(batch), bool)
    for fraction in (
        1.0,
        0.5,
        0.2,
        0.1,
        1e-2,
        1e-3,
        1e-4,
        1e-6,
    ):  # where impacts magnify errors, the boundary is no line
        for sign in (-1.0, 1.0):
            is_flipped |= Fast(batch.rescaled(1.0 + sign * band * fraction))()[0]["outcome"] != outcome
    return is_flipped


def _line(batch: Histories, k: int, outcome: np.ndarray, truth: np.ndarray) -> str:
    single = batch.some(np.array([k]))
    distance = next((band for band in 10.0 ** np.arange(-13.0, -1.0) if flips(single, outcome[[k]], band)[0]), np.inf)
    names = ("no uplift", "rocked", "overturned", "failed")
    return (
        f"- history {k}: fast {names[outcome[k]]}, reference {names[truth[k]]}; the fast verdict changes when the"
        f" motion is rescaled by 1 +- {distance:.0e}"
    )
