"""The fast engine and a peer on the same histories, in turn: times, their ratio, and verdicts that are wrong."""

import os
import statistics
from collections.abc import Callable
from dataclasses import dataclass, replace
from importlib.util import find_spec
from unittest.mock import patch

import numpy as np

from benchmarks import engine_bodies, engine_jax, engine_operations, engine_peak, engine_peers
from benchmarks.engine_batch import Fast, Histories, overturned
from benchmarks.engine_peers import Verdicts
from benchmarks.table import Row
from benchmarks.timing import cpu_seconds
from rocking.dynamics.plane.fast_engine import instruction_set, instruction_sets, library_of


@dataclass(frozen=True)
class Duel:
    """A peer: its preparation, number of histories and repetitions, and smallest ratio of times."""

    name: str
    package: str
    make: Callable[[Histories], Verdicts]
    count: int
    repeats: int
    goal: float | None = None

    def installed(self) -> bool:
        """Whether its package is there."""
        return find_spec(self.package) is not None


ALL = 10**9
DUELS = (
    Duel("scipy solve_ivp, DOP853 with events, 1e-8", "scipy", engine_peers.scipy_events, 40, 3, 40_000.0),
    Duel("scipy solve_ivp, RK45 with events, 1e-8", "scipy", lambda b: engine_peers.scipy_events(b, "RK45"), 20, 2),
    Duel("numba RK4, 2 substeps", "numba", engine_peers.numba_rk4, ALL, 7, 8.0),
    Duel("numba RK4, 1 substep", "numba", lambda b: engine_peers.numba_rk4(b, 1), ALL, 3),
    Duel("numba RK4, 4 substeps", "numba", lambda b: engine_peers.numba_rk4(b, 4), ALL, 3),
    Duel("JAX RK4, 2 substeps", "jax", engine_jax.jax_rk4, ALL, 2, 100.0),
    Duel("diffrax Tsit5, 2 substeps", "diffrax", engine_jax.diffrax_tsit5, ALL, 2, 100.0),
    Duel("MuJoCo, box on a plane, 1 ms", "mujoco", engine_bodies.mujoco_boxes, 40, 3),
    Duel("pymunk, box on a segment, 1 ms", "pymunk", engine_bodies.pymunk_boxes, 40, 3),
)


def spread_out(batch: Histories, impacts: np.ndarray, count: int, turn: int) -> np.ndarray:
    """Return every n-th history in order of impacts, a representative sample; other ones each turn."""
    if count >= len(batch):
        return np.arange(len(batch))
    order, stride = np.argsort(impacts, kind="stable"), len(batch) // count
    return np.asarray(order[(stride // 2 + turn * 37) % stride :: stride][:count])


def fight(duel: Duel, batch: Histories, truth: np.ndarray, *, full: bool) -> Row:
    """One line of the table."""
    ours, spent, ratios = Fast(batch), [], []
    impacts = ours()[0]["impacts"]
    is_complete = duel.count >= len(batch)
    count = len(batch) if is_complete else duel.count * (5 if full else 1)
    peer: Verdicts | None = None
    wrong = tried = 0
    for turn in range(duel.repeats + (2 if full else 0)):
        which = spread_out(batch, impacts, count, turn)
        if peer is None or not is_complete:
            peer = duel.make(batch.some(which))
        mine = statistics.median(cpu_seconds(ours) for _ in range(3)) / len(batch)
        verdicts: list[np.ndarray] = []
        spent.append(cpu_seconds(lambda: verdicts.append(peer())) / which.size)  # noqa: B023 - called at once
        ratios.append(spent[-1] / mine)
        if not is_complete or not turn:
            wrong, tried = wrong + int((verdicts[0] != truth[which]).sum()), tried + which.size
    middle = statistics.median(ratios)
    measured = (
        f"{middle:,.1f} times faster ({min(ratios):,.1f} to {max(ratios):,.1f});"
        f" {_time(statistics.median(spent))} a history; {wrong} of {tried:,} verdicts wrong"
    )
    goal = "for information" if duel.goal is None else f">= {duel.goal:,.0f} times"
    return Row("Fast engine, a history", duel.name, measured, goal, None if duel.goal is None else middle >= duel.goal)


def shares(batch: Histories, repeats: int) -> list[Row]:
    """Operations a second of the fast engine over the peak of the core: on the batch, and where nothing hits."""
    table_rows = []
    for name, work, done, goal in (
        ("the batch", Fast(batch), engine_operations.counted(batch), 0.25),
        ("the same records, bodies that never hit", _flying(batch), engine_operations.counted(*_let_go(batch)), None),
    ):
        description = f"Arithmetic, {name}"
        if done is None:
            table_rows.append(Row(description, "peak of the core", "not counted: no compiler", _goal(goal)))
            continue
        peak, spent = engine_peak.beside(work, repeats)
        step_time, speed = spent / done.steps, done.total / spent
        cost = f"{step_time * 1e9:.1f} ns an active step of {done.total / done.steps:.0f} operations"
        if peak is None:
            table_rows.append(Row(description, "peak of the core", f"{cost}; peak not measured", _goal(goal)))
            continue
        more = f"{100.0 * done.with_extremes / spent / peak:.1f} % with minima and maxima"
        share = f"{100.0 * speed / peak:.1f} % of {peak / 1e9:.1f} GFLOP/s ({cost}, {speed / 1e9:.1f} GFLOP/s; {more})"
        table_rows.append(
            Row(description, "peak of the core", share, _goal(goal), None if goal is None else speed / peak >= goal)
        )
    return table_rows


def variants(batch: Histories, truth: np.ndarray) -> list[Row]:
    """The fast engine at its other orders, and on the other instruction sets of this processor."""
    table_rows = []
    for isa in instruction_sets():
        with patch.dict(os.environ, {"ROCKING_ISA": isa}):
            orders = (8, 6, 4) if isa == instruction_sets()[0] else (8,)
            table_rows += [_variant(batch, truth, f"order {order}, {instruction_set()}", order) for order in orders]
    return table_rows


def layout(batch: Histories) -> Row:
    """Cost of the layout of the records for the engine; other lines exclude this cost, for peers as well."""
    segments = batch.segments()
    spent = statistics.median(cpu_seconds(lambda: library_of(segments)) for _ in range(3))
    return Row(
        f"Laying out {len(batch):,} records for the fast engine",
        "-",
        f"{spent * 1e3:.0f} ms, {_time(spent / len(batch))} a record, once a batch; not in the other lines",
        "for information",
    )


def _variant(batch: Histories, truth: np.ndarray, name: str, order: int) -> Row:
    work = Fast(batch, order=order)
    results, counts = work()
    spent = statistics.median(cpu_seconds(work) for _ in range(5))
    wrong = int((overturned(results) != truth).sum())
    measured = (
        f"{spent / counts['steps'] * 1e9:.1f} ns an active step, {_time(spent / len(batch))} a history;"
        f" {wrong} of {len(batch):,} verdicts wrong; {counts['events'] / counts['steps']:.2f} visits a step"
    )
    return Row("Fast engine", name, measured, "for information")


def _let_go(batch: Histories) -> tuple[Histories, np.ndarray, np.ndarray]:
    """Return blocks so large that they still fly at the end of the record after a release: plain steps only."""
    return batch, np.full(len(batch), 1e-4), 0.5 * batch.alpha


def _flying(batch: Histories) -> Fast:
    batch, p, rotation = _let_go(batch)
    work = Fast(replace(batch, p=p))
    work.rows.values["rotation"][:] = rotation
    return work


def _goal(share: float | None) -> str:
    return "for information" if share is None else f">= {100.0 * share:.0f} %"


def _time(seconds: float) -> str:
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds * 1e9:.3g} ns"
