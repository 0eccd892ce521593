"""Campaigns: cost of safe storage, speed-up of a second worker, growth of time and memory.

`python -m benchmarks.campaigns` prints the table; `python -m benchmarks.campaigns COUNT FOLDER` runs one campaign and
prints its time and memory as JSON.
"""

import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import rocking as rk
from benchmarks import table
from benchmarks.engine_batch import STEP, histories
from benchmarks.engine_growth import _forget_peak, _peak
from benchmarks.table import Row
from rocking.campaigns import Campaign, Progress
from rocking.studies import HistoryTable, MotionList, Product

RECORDS = 200
MEMORY_GOAL = 2 << 30


def records(count: int) -> HistoryTable:
    """Blocks under records of 8 to 40 s, as in the benchmark of the engine."""
    batch = histories(RECORDS)
    number = np.arange(count)
    body, motion = (number * 7919 + number // RECORDS) % RECORDS, number % RECORDS
    values = {f"{name}_{s}": getattr(batch, name)[body] for name in ("alpha", "p", "r") for s in ("right", "left")}
    values["scale"] = batch.scale[motion] * np.tan(batch.alpha[body]) / np.tan(batch.alpha[motion])
    motions = [rk.GroundMotion(record, STEP) for record in batch.records]
    return HistoryTable(MotionList(motions), motion, values)


def pulses(count: int) -> Product:
    """Blocks at many scales under pulses: as many as wanted, described by a few numbers."""
    shapes = [rk.pulses.sine(a, period) for a in (3.0, 6.0, 9.0, 12.0) for period in (0.3, 0.5, 0.8, 1.2, 1.6)]
    random = np.random.default_rng(1)
    ranges = {"alpha": (0.08, 0.5), "p": (0.9, 5.0), "r": (0.5, 0.95)}
    sides = {f"{n}_{s}": random.uniform(*ranges[n], (100, 1)) for n in ranges for s in ("right", "left")}
    return Product(MotionList(shapes), sides, np.linspace(0.2, 1.5, count // 2000))


def overhead(count: int = 524_288, repeats: int = 7) -> tuple[float, float, int]:
    """Median seconds of a bare run and of a campaign of the same histories, in turn, one thread each; its chunks."""
    work = records(count)
    work.run(0, 1000, threads=1)
    pairs = []
    for _ in range(repeats):
        bare = _seconds(lambda: work.run(0, count, threads=1))
        with tempfile.TemporaryDirectory() as folder:
            campaign = Campaign.create(Path(folder) / "c", work)
            pairs.append((bare, _seconds(lambda campaign=campaign: campaign.run(workers=1))))
    bare, safe = (statistics.median(column) for column in zip(*pairs, strict=True))
    return bare, safe, campaign.plan.chunks


def two_workers(count: int = 400_000, repeats: int = 3) -> float:
    """Speed-up of two worker processes over one, from their first finished chunk to the last one."""
    work = records(count)
    pairs = [tuple(_working(work, workers) for workers in (1, 2)) for _ in range(repeats)]
    single, double = (statistics.median(column) for column in zip(*pairs, strict=True))
    return single / double


def growth(counts: tuple[int, ...] = (10_000, 100_000, 1_000_000, 10_000_000)) -> list[tuple[int, float, int]]:
    """(histories, CPU seconds, most memory [bytes]) of campaigns in processes of their own."""
    measured = []
    for count in counts:
        with tempfile.TemporaryDirectory() as folder:
            command = [sys.executable, "-m", "benchmarks.campaigns", str(count), f"{folder}/c"]
            done = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
        measured.append((count, done["cpu"], done["memory"] or 0))
    return measured


def rows() -> list[Row]:
    """Every benchmark of campaigns."""
    bare, safe, chunks = overhead()
    cost = safe / bare - 1.0
    description = f"Campaign of {chunks} chunks of default size, records"
    table_rows = [
        Row(description, "bare engine", f"{cost:+.1%} ({safe:.2f} s against {bare:.2f} s)", "< +5 %", cost < 0.05)
    ]
    if _cores() > 1:
        faster = two_workers()
        table_rows.append(Row("Two worker processes", "one", f"{faster:.2f} times", ">= 1.8 times", faster >= 1.8))
    else:
        table_rows.append(Row("Two worker processes", "one", "not measured: one core", ">= 1.8 times"))
    grown = growth()
    for count, cpu, memory in grown:
        time_text = f"{cpu:.2f} s, {cpu / count * 1e6:.2f} us a history, {memory / 1e6:.0f} MB"
        goal = "< 2 GiB" if count == grown[-1][0] else "-"
        table_rows.append(
            Row(f"Campaign of {count:,}, pulses", "-", time_text, goal, memory < MEMORY_GOAL if goal != "-" else None)
        )
    # both are many pieces of a second: a campaign of less than one grows with it
    (few, few_seconds, few_memory), (many, long, most) = grown[-2:]
    straight, flat, description = (
        long / few_seconds / (many / few),
        (most - few_memory) / 1e6,
        f"{many:,} against {few:,}",
    )
    table_rows.append(Row(description, "-", f"{straight:.2f} of the time a history", "linear: <= 1.1", straight <= 1.1))
    table_rows.append(Row(description, "-", f"{flat:+.0f} MB of memory", "flat: <= +20 MB", flat <= 20.0))
    return table_rows


def one(count: int, folder: str) -> None:
    """Run one campaign in this process; print time and memory."""
    work = pulses(count)
    work.run(0, 1000, threads=1)
    clean = _forget_peak()
    start = time.process_time()
    Campaign.create(folder, work).run(workers=1)
    spent = time.process_time() - start
    print(json.dumps({"cpu": spent, "memory": _peak() if clean else None}))
    shutil.rmtree(folder)


def _working(work: HistoryTable, workers: int) -> float:
    """Wall seconds a chunk, without the start of the processes."""
    samples: list[tuple[float, int]] = []

    def note(progress: Progress) -> None:
        samples.append((time.perf_counter(), progress.chunks_done))

    with tempfile.TemporaryDirectory() as folder:
        Campaign.create(Path(folder) / "c", work, 8192).run("processes", workers=workers, progress=note)
    inner = [entry for entry in samples if entry[1] > 2 * workers]
    return (inner[-1][0] - inner[0][0]) / (inner[-1][1] - inner[0][1])


def _seconds(call: Callable[[], object]) -> float:
    start = time.perf_counter()
    call()
    return time.perf_counter() - start


def _cores() -> int:
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:
        return os.cpu_count() or 1


def main() -> None:
    """Print the table, or run one campaign."""
    if len(sys.argv) == 3:
        one(int(sys.argv[1]), sys.argv[2])
    else:
        print("\n".join(table.lines(rows())))


if __name__ == "__main__":
    main()
