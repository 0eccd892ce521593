"""Long-run dynamics: forcing cycles per second, a bifurcation diagram and a basin, beside numba and `simulate`."""

import math
import resource
import subprocess
import sys
from collections.abc import Callable
from statistics import median
from typing import Any

import numpy as np

import rocking as rk
from benchmarks import longrun_peer, table
from benchmarks.table import Row
from benchmarks.timing import cpu_seconds
from rocking.studies.longrun import HarmonicRocking, ends_of, over_periods, start_states, symmetric_orbit
from rocking.studies.longrun.basins import cells

CYCLES, ORBITS, REPEATS = 2000, 8, 5
GOALS = {0: 150_000, 1: 100_000, 2: None}
MAP = ("--width", "0.5", "--height", "2", "sine:amplitude=3,period=1")
AXES = ("--x", "frequency_ratio=0.5:10:1000", "--y", "amplitude_ratio=1:12:1000")
FEW = ("--x", "frequency_ratio=0.5:10:2", "--y", "amplitude_ratio=1:12:2")


def a_system() -> HarmonicRocking:
    """A block of slenderness 4 with KED at three times p: the symmetric orbit is stable."""
    return HarmonicRocking.of_ratios(rk.Block(width=1.0, height=4.0), 1.5, 3.0, restitution="ked")


def starts(system: HarmonicRocking) -> np.ndarray:
    """States near the symmetric orbit, after an impact."""
    orbit = symmetric_orbit(system)
    phases = orbit.phase + np.linspace(0.0, 0.05, ORBITS)
    return start_states(system, np.column_stack([phases, np.full(ORBITS, orbit.speed)]))


def middle(work: Callable[[], object]) -> float:
    """Median CPU seconds of repeats."""
    work()
    return median(cpu_seconds(work) for _ in range(REPEATS))


def cycle_rows() -> list[Row]:
    """Cycles per second with 0, 1 and 2 tangent vectors, and those of the peers."""
    system = a_system()
    states = starts(system)
    rows, speeds, last = [], {}, None
    for vectors, goal in GOALS.items():
        last = over_periods(system, states, kept=CYCLES, vectors=vectors)
        spent = middle(lambda vectors=vectors: over_periods(system, states, kept=CYCLES, vectors=vectors))
        speeds[vectors] = CYCLES * ORBITS / spent
        met = None if goal is None else speeds[vectors] >= goal
        text = "-" if goal is None else f">= {goal:,}"
        rows.append(Row(f"Forcing cycles, tangent vectors: {vectors}", "-", f"{speeds[vectors]:,.0f} per s", text, met))
    assert last is not None
    rows += [_numba(vectors, system, states, last, speeds[vectors]) for vectors in (0, 1)]
    motion = rk.pulses.harmonic(system.excitation.amplitude, system.excitation.period, 200)
    spent = middle(lambda: rk.simulate(system.body, motion, "ked"))
    rows.append(Row("Forcing cycles, tangent vectors: 0", "rk.simulate", _times(speeds[0], 200 / spent), "-"))
    return rows


def _times(ours: float, theirs: float) -> str:
    return f"{theirs:,.0f} per s: {ours / theirs:.1f} times faster"


def _numba(vectors: int, system: HarmonicRocking, states: np.ndarray, last: Any, ours: float) -> Row:
    what = f"Forcing cycles, tangent vectors: {vectors}"
    peer = f"numba, {longrun_peer.STEPS} Runge-Kutta steps per period"
    try:
        follow = longrun_peer.periods(bool(vectors))
    except ImportError:
        return Row(what, peer, "numba is not installed", "-")
    alpha, p2, r = system.sides[:3]
    body = (alpha, p2, system.excitation.amplitude / system.gravity, system.excitation.frequency)
    ends = np.array([follow(*state, CYCLES, r, body)[:2] for state in states])
    spent = middle(lambda: [follow(*state, CYCLES, r, body) for state in states])
    error = float(np.nanmax(np.abs(ends[:, 0] - last.states[:, -1, 0]))) / alpha
    return Row(what, peer, f"{_times(ours, CYCLES * ORBITS / spent)}; its error {error:.0e} alpha", "-")


def study_rows() -> list[Row]:
    """A bifurcation diagram of 2,000 amplitudes, 500 cycles and 4 initial states, and a slender basin."""
    block, found = rk.Block(width=1.0, height=2.0), []
    motion = rk.Harmonic(amplitude=1.0, period=2.0 * math.pi / (3.0 * block.frequency_parameter))
    orbit = symmetric_orbit(HarmonicRocking.of_ratios(block, 3.6, 3.0, restitution="housner"))
    near = np.column_stack([orbit.phase + 0.02 * np.arange(4), np.full(4, orbit.speed)])  # few overturn
    values = np.linspace(1.5, 5.5, 2000)
    for exponents, limit in ((False, 30.0), (True, 45.0)):
        out: list[Any] = []

        def work(exponents: bool = exponents, out: list[Any] = out) -> None:
            out.append(rk.bifurcation(
                block, motion, "amplitude", values, "housner", starts=near, cycles=(372, 128), exponents=exponents,
                threads=1,
            ))  # fmt: skip

        spent = cpu_seconds(work)
        lost = float((out[0]["attractor"] == 4).mean())
        what = f"Bifurcation diagram of 2,000 x 500 x 4{' with exponents' if exponents else ''}"
        measured = f"{spent:.1f} s CPU; {lost:.0%} overturn"
        found.append(Row(what, "-", measured, f"< {limit:.0f} s", spent < limit))
    system = HarmonicRocking.of_ratios(rk.Block(width=1.0, height=4.0), 0.9, 3.0, restitution=0.9, linear=True)
    grid = np.stack(np.meshgrid(*cells(100, 100, 2.0), indexing="ij")).reshape(2, -1)
    spent = middle(lambda: ends_of(system, *grid))
    found.append(Row("Slender basin of 100 x 100", "-", f"{spent:.2f} s CPU", "< 1.2 s", spent < 1.2))
    return found


def default_row() -> Row:
    """The map of a default study, compared with KED and Housner, beside that of one model."""
    fixed = _command(*FEW, "--restitution", "calibrated")
    one, three = (_command(*AXES, *words) - fixed for words in (("--restitution", "calibrated"), ()))
    what = "Map of 1,000 x 1,000 pulses with the default: calibrated, and KED and Housner for comparison"
    return Row(what, "--restitution calibrated", f"{three / one:.2f} times ({three:.1f} s and {one:.1f} s CPU)", "-")


def _command(*words: str) -> float:
    """CPU seconds of `rocking map`."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [sys.executable, "-m", "rocking", "map", *MAP, *words]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime


def main() -> bool:
    """Print and keep the table; whether every goal was met."""
    found = [*cycle_rows(), *study_rows(), default_row()]
    text = [
        "# Speed of long-run dynamics",
        "",
        "Made by `python -m benchmarks longrun`; CPU time of one core, medians of 5 repeats (diagrams and maps: one);",
        f"{ORBITS} orbits of a block of slenderness 4 with KED at 3 p over {CYCLES:,} cycles. The engine's error of a",
        "step is 1e-16 alpha.",
        "",
        f"- Machine: {table.machine()}",
        f"- Versions: {table.versions('numpy', 'numba')}",
        "",
        *table.lines(found),
        "",
        "A study without `--restitution` uses the calibrated model, and repeats all simulations with KED and Housner",
        "for comparison: three times the simulations, and two to three times the time of one model (last row).",
        "`--restitution calibrated` omits the comparison.",
    ]
    table.keep("RESULTS-longrun.md", text)
    return all(row.met is not False for row in found)
