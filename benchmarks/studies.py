"""Studies: a map of pulses and a fragility study of a million histories, compared with a loop over solve_ivp."""

import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

import rocking as rk
from benchmarks import campaigns, synthetic, table
from benchmarks.engine_batch import STEP, Histories, histories
from benchmarks.engine_peers import scipy_events
from benchmarks.table import Row
from rocking import conventions

BLOCK = rk.Block(width=0.5, height=2.0)
RATIOS = np.linspace(0.5, 10.0, 200)
AMPLITUDES = np.linspace(1.0, 12.0, 200)
RECORDS = 500
LEVELS = np.linspace(0.5, 10.0, 40)
BODIES = 50
POINTS = 1000
JOB = f"""[campaign]
name = "a large map"
kind = "overturning-map"
[body]
units = "m"
width = 0.5
height = 2.0
[motions]
pulse = "sine:amplitude=3,period=1"
[map]
x = {{ axis = "frequency_ratio", from = 0.5, to = 10, count = {POINTS} }}
y = {{ axis = "amplitude_ratio", from = 1, to = 12, count = {POINTS} }}
refine = 2
"""
SAMPLE = 24
"""Histories that scipy computes: its time is that of a history times their number."""


def a_map() -> Any:
    """200 x 200 cells: one block under sine pulses of every frequency and amplitude."""
    return rk.overturning_map(
        BLOCK, rk.pulses.sine(3.0, 1.0), ("frequency_ratio", RATIOS), ("amplitude_ratio", AMPLITUDES), "ked"
    )


def cells(seed: int = 1) -> Histories:
    """Some cells of the map as blocks under sampled pulses."""
    rng = np.random.default_rng(seed)
    side = BLOCK.side("right")
    alpha, p = side.slenderness_angle, side.frequency_parameter
    r = rk.coefficient_of_restitution(BLOCK, "ked")
    ratio, amplitude = rng.choice(RATIOS, SAMPLE), rng.choice(AMPLITUDES, SAMPLE)
    pulses = [
        rk.pulses.sine(a * conventions.g * np.tan(alpha), 2.0 * np.pi / (p * w))
        for w, a in zip(ratio, amplitude, strict=True)
    ]
    ones = np.ones(SAMPLE)
    records = [pulse.sampled(STEP).acceleration for pulse in pulses]
    return Histories(records, alpha * ones, p * ones, r * ones, side.semi_diagonal * ones, ones)


def bodies() -> list[rk.Block]:
    """Blocks of many sizes and slendernesses."""
    rng = np.random.default_rng(5)
    return [
        rk.Block(width=h / s, height=h)
        for h, s in zip(rng.uniform(0.5, 6.0, BODIES), rng.uniform(2.0, 8.0, BODIES), strict=True)
    ]


def fragility(records: list[rk.GroundMotion]) -> list[Any]:
    """50 blocks, 500 records, 40 stripes: a million histories, 50 curves with their bands."""
    from rocking.studies.fragility import fragility_analysis

    return [fragility_analysis(body, records, LEVELS, "ked").fits["overturned"] for body in bodies()]


def stripes(seed: int = 2) -> Histories:
    """Some histories of the fragility study."""
    rng = np.random.default_rng(seed)
    batch, blocks = histories(RECORDS), bodies()
    chosen = [blocks[k] for k in rng.integers(BODIES, size=SAMPLE)]
    sampled = batch.some(rng.integers(RECORDS, size=SAMPLE))
    sides = [body.side("right") for body in chosen]
    return Histories(
        sampled.records,
        np.array([side.slenderness_angle for side in sides]),
        np.array([side.frequency_parameter for side in sides]),
        np.array([rk.coefficient_of_restitution(body, "ked") for body in chosen]),
        np.array([side.semi_diagonal for side in sides]),
        rng.choice(LEVELS, SAMPLE),
    )


def rows() -> list[Row]:
    """Every benchmark of studies."""
    a_map()
    drawn = min(_seconds(a_map) for _ in range(3))
    count = RATIOS.size * AMPLITUDES.size
    slow = _seconds(scipy_events(cells())) / SAMPLE * count
    table_rows = [
        _row(f"Map of {RATIOS.size} x {AMPLITUDES.size} sine pulses, all cores", drawn, slow, "seconds: < 5 s", 5.0)
    ]
    records = [rk.GroundMotion(record, STEP) for record in histories(RECORDS).records]
    count = BODIES * RECORDS * LEVELS.size
    spent = _seconds(lambda: fragility(records))
    slow = _seconds(scipy_events(stripes())) / SAMPLE * count
    table_rows.append(
        _row(f"Fragility of {BODIES} blocks, {count:,} histories, all cores", spent, slow, "minutes: < 300 s", 300.0)
    )
    spent, written = refined_map()
    count = POINTS**2
    measured = f"{spent:.1f} s and {written:.1f} s"
    table_rows.append(Row(f"Refined map of {count:,} points as a campaign, and its export", "-", measured, "-", None))
    return table_rows


def refined_map() -> tuple[float, float]:
    """A large map, two levels finer along its boundaries, in rounds on disk; then all points into one netCDF file."""
    from rocking.campaigns.jobs import Job, JobFolder, export

    with TemporaryDirectory() as path:
        folder = JobFolder.create(Path(path) / "map", Job.of_text(JOB))
        spent = _seconds(folder.run)
        return spent, _seconds(lambda: export(folder, Path(path) / "map.nc"))


def main() -> bool:
    """Print and keep the table; whether every goal was met."""
    table_rows = rows() + synthetic.rows() + campaigns.rows()
    text = [
        "# Speed of studies and campaigns",
        "",
        "Made by `python -m benchmarks studies`; wall time where cores are named, else CPU time; the scipy loop",
        f"(DOP853 with events, 1e-8) computes {SAMPLE} of the histories on one core, and its time is scaled to all.",
        "",
        f"- Machine: {table.machine()}",
        f"- Versions: {table.versions('numpy', 'scipy', 'distributed')}",
        "",
        *table.lines(table_rows),
    ]
    table.keep("RESULTS-studies.md", text)
    return all(row.met is not False for row in table_rows)


def _row(description: str, ours: float, theirs: float, goal: str, limit: float) -> Row:
    measured = f"{ours:.2f} s; {theirs / ours:,.0f} times faster ({theirs / 3600.0:,.1f} hours)"
    return Row(description, "scipy loop, one core", measured, goal, ours < limit)


def _seconds(call: Callable[[], object]) -> float:
    start = time.perf_counter()
    call()
    return time.perf_counter() - start
