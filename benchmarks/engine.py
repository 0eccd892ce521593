"""The engines compared with alternatives, with the reference results, and with the limits of the processor."""

import sys
import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from benchmarks import engine_duels, engine_limits, engine_truth, table
from benchmarks.engine_batch import COUNT, Fast, Histories, histories
from benchmarks.table import Row
from rocking.dynamics.plane.fast_engine import instruction_set

PACKAGES = ("numpy", "scipy", "numba", "jax", "diffrax", "mujoco", "pymunk")
COMMAND = "python -m benchmarks engine"


@dataclass
class Session:
    """Data and results of all sections."""

    batch: Histories
    full: bool
    truth: np.ndarray
    rows: list[Row] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    began: float = field(default_factory=time.perf_counter)

    def say(self, text: str) -> None:
        """Progress, apart from the results."""
        print(f"[{time.perf_counter() - self.began:5.0f} s] {text}", file=sys.stderr, flush=True)

    def add(self, name: str, section: Callable[["Session"], None]) -> None:
        """Run a part; one that fails is a goal missed, and does not take the others with it."""
        self.say(name)
        before = len(self.rows)
        try:
            section(self)
        except Exception as error:  # noqa: BLE001 - whatever stops a peer or a process is written into the table
            traceback.print_exc()
            self.rows.append(Row(name, "-", f"failed: {type(error).__name__}: {error!s:.80}", "-", False))
        for row in self.rows[before:]:
            self.say(f"  {row.what} | {row.against}: {row.measured}")


def main(*, full: bool = False, count: int = COUNT) -> bool:
    """Measure all, print the page and keep it; whether every goal was met."""
    began = time.perf_counter()
    print(f"making {count:,} histories ...", file=sys.stderr, flush=True)
    batch = histories(count)
    # until the reference engine has spoken
    session = Session(batch, full, Fast(batch)()[0]["outcome"], began=began)
    session.add("verdicts against the reference engine", _truth)
    session.add("threads", lambda s: s.rows.append(engine_limits.threads(s.batch, 15 if full else 9)))
    session.add("share of the processor's peak", _peak)
    session.add("instruction sets and orders", _variants)
    session.add("a single response, and the first of a process", lambda s: s.rows.extend(engine_limits.single(s.batch)))
    session.add("growth to a million histories", lambda s: s.rows.extend(engine_limits.growth()))
    for duel in engine_duels.DUELS:
        session.add(f"against {duel.name}", lambda s, d=duel: _duel(s, d))  # type: ignore[misc]
    if count == COUNT:
        table.keep("RESULTS-engine.md", _page(session))
    else:  # a trial
        print("\n".join(_page(session)))
    return all(row.met is not False for row in session.rows)


def _truth(session: Session) -> None:
    session.truth = engine_truth.reference_outcomes(session.batch, session.say)
    rows, notes = engine_truth.agreement(session.batch, session.truth)
    session.rows += rows
    session.notes += notes


def _peak(session: Session) -> None:
    session.rows += engine_duels.shares(session.batch, 15 if session.full else 9)


def _variants(session: Session) -> None:
    session.rows += engine_duels.variants(session.batch, session.truth == 2)
    session.rows.append(engine_duels.layout(session.batch))


def _duel(session: Session, duel: engine_duels.Duel) -> None:
    if not duel.installed():
        session.say(f"  skipped: {duel.package} is not installed")
        session.notes.append(f"- {duel.name}: skipped, {duel.package} is not installed")
        return
    session.rows.append(engine_duels.fight(duel, session.batch, session.truth == 2, full=session.full))


def _page(session: Session) -> list[str]:
    batch, out = session.batch, Fast(session.batch)()[0]
    parts = np.bincount(session.truth, minlength=4)
    minutes = (time.perf_counter() - session.began) / 60.0
    text = [
        "# Speed of the engines",
        "",
        f"Made by `{COMMAND}{' --full' if session.full else ''}` in {minutes:.0f} minutes. Peers that are not installed"
        " are left out.",
        "Medians of interleaved repeats in one run, CPU time of all threads, with their spread. Slow peers take a part",
        "of the batch: every n-th history in order of impacts, other ones each time.",
        "",
        f"- Machine: {table.machine()}; the fast engine uses {instruction_set()}",
        f"- Versions: {table.versions(*PACKAGES)}",
        f"- Batch: {len(batch):,} blocks of R 0.2 to 10 m and slenderness 2 to 10, each under a record of its own"
        f" (8 to 40 s at 0.01 s, {batch.megabytes:.0f} MB in all); {parts[0]:,} are not lifted, {parts[1]:,} rock,"
        f" {parts[2]:,} overturn; {int(out['impacts'].sum()):,} impacts",
        "",
        *table.lines(session.rows),
    ]
    if session.notes:
        text += ["", "Notes:", "", *session.notes]
    return text
