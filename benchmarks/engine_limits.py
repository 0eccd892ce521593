"""Threads, memory and time against the number of histories, a single response, the first call of a process."""

import json
import statistics
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

from benchmarks.engine_batch import STEP, Fast, Histories
from benchmarks.table import Row
from benchmarks.timing import cpu_seconds

COUNTS = (10_000, 100_000, 1_000_000)
FIRST = """
import json, time
import numpy as np
import rocking as rk
t = np.arange(4001) * 0.01
shaking = 3.0 * np.sin(2.0 * t) * np.sin(0.31 * t * t) * np.exp(-0.05 * t)
motion = rk.GroundMotion(shaking, 0.01)
block = rk.Block(width=0.5, height=2.0)
spent = []
for _ in range(31):
    start = time.process_time(), time.perf_counter()
    rk.simulate(block, motion, engine="fast")
    spent.append((time.process_time() - start[0], time.perf_counter() - start[1]))
print(json.dumps(spent))
"""


def threads(batch: Histories, repeats: int) -> Row:
    """Wall time with one thread over that with two, in turn."""
    single_thread, two_threads = Fast(batch, 1), Fast(batch, 2)
    two_threads()
    ratios = sorted(_wall(single_thread) / _wall(two_threads) for _ in range(repeats))
    middle = statistics.median(ratios)
    return Row(
        "Fast engine, 2 threads",
        "1 thread",
        f"{middle:.2f} times faster (wall time; {ratios[0]:.2f} to {ratios[-1]:.2f} in {repeats} repeats)",
        ">= 1.9 times",
        middle >= 1.9,
    )


def growth(counts: tuple[int, ...] = COUNTS) -> list[Row]:
    """Memory and time of campaigns of more and more histories, each in a process of its own."""
    measured = [json.loads(_process("-m", "benchmarks.engine_growth", str(count))) for count in counts]
    spent = [run["cpu"] for run in measured]
    # laying out the motions is paid once, so what counts is the cost of every further history
    cost = (np.diff(spent) / np.diff(counts) * 1e6).tolist()
    even, once = max(cost) / min(cost), spent[0] - cost[0] * 1e-6 * counts[0]
    numbers = ", ".join(f"{count:,}" for count in counts)
    linear = Row(
        f"Time of {numbers} histories",
        "-",
        f"{', '.join(f'{value:.1f}' for value in cost)} us a further history: within {100.0 * (even - 1.0):.0f} %;"
        f" {once * 1e3:.0f} ms once, to lay out the motions",
        "within 15 %",
        even <= 1.15,
    )
    if any(run["memory"] is None for run in measured):
        return [linear, Row(f"Memory of {numbers} histories", "-", "not measured on this system", "flat")]
    memory = [(run["memory"] - run["results"]) / 1e6 for run in measured]
    grown = memory[-1] - memory[0]
    return [
        linear,
        Row(
            f"Memory of {numbers} histories, beside their results",
            "-",
            f"{', '.join(f'{value:.0f}' for value in memory)} MB (the results take"
            f" {measured[-1]['results'] / counts[-1]:.0f} bytes a history)",
            "flat: grows by < 32 MB",
            grown < 32.0,
        ),
    ]


def single(batch: Histories) -> list[Row]:
    """A response to a 40 s record at 0.01 s from Python; and the cost of the first one in a new process."""
    import rocking as rk

    record = max(batch.records, key=np.size)
    motion = rk.GroundMotion(np.resize(record, 4001), STEP)
    block = rk.Block(width=0.5, height=2.0)

    def respond(scale: float) -> rk.Response:
        return rk.simulate(block, motion, "ked", scale=scale, engine="fast")

    def last(response: rk.Response) -> float:
        return float(response.impacts["time"].max(initial=0.0))

    def rocks_on(response: rk.Response) -> bool:
        return response.outcome is rk.Outcome.ROCKED and last(response) > 35.0

    # overturned or at rest a block is followed no further: the weakest shaking under which it rocks to the end
    scales = np.arange(2.5, 10.0, 0.02).tolist()
    scale = next((factor for factor in scales if rocks_on(respond(factor))), scales[-1])
    response = respond(scale)
    spent = statistics.median(cpu_seconds(lambda: respond(scale)) for _ in range(301))
    starts = [json.loads(_process("-c", FIRST)) for _ in range(5)]
    late, wall = (
        statistics.median(times[0][k] - statistics.median(later[k] for later in times[1:]) for times in starts)
        for k in range(2)
    )
    return [
        Row(
            f"A response of a 40 s record at 0.01 s, from Python ({response.impacts.size} impacts, the last at"
            f" {last(response):.1f} s, {response.outcome.name.lower()})",
            "-",
            f"{spent * 1e3:.2f} ms",
            "< 1 ms",
            spent < 1e-3 and rocks_on(response),
        ),
        Row(
            "First response of a fresh process",
            "its later ones",
            f"{late * 1e3:.1f} ms slower (wall time {wall * 1e3:.1f} ms; medians of 5 processes)",
            "< 50 ms",
            late < 0.05,
        ),
    ]


def _wall(work: Fast) -> float:
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def _process(*arguments: str) -> str:
    root = Path(__file__).parent.parent
    done = subprocess.run([sys.executable, *arguments], check=True, capture_output=True, text=True, cwd=root)
    return done.stdout
