"""One campaign of many histories in this process: its time and the most memory that it took, as JSON."""

import json
import statistics
import sys
import time
from pathlib import Path

import numpy as np

from benchmarks.engine_batch import histories
from rocking.dynamics.batch import Batch
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.dynamics.rows import Rows

RECORDS = 1000


def main(count: int) -> None:
    """Print time and memory."""
    batch = histories(RECORDS)
    campaign = Batch(batch.segments(), threads=1, engine="fast")

    def rows(first: int, last: int) -> Rows:
        """Every block under every record, at scales that go up and down a little."""
        number = np.arange(first, last)
        body, motion = (number * 7919 + number // RECORDS) % RECORDS, number % RECORDS
        factor = batch.scale[motion] * np.tan(batch.alpha[body]) / np.tan(batch.alpha[motion])
        values = {f"{name}_{side}": getattr(batch, name)[body] for name in ("alpha", "p", "r") for side in SIDES}
        return Rows.of(last - first, motion, number, scale=factor, **values)

    campaign.run(4096, rows)
    clean = _forget_peak()
    spent = []
    for _ in range(max(1, min(9, 300_000 // count))):  # short ones several times
        results: Arrays = {}  # those of the time before are let go first
        start = time.process_time()
        results, work = campaign.run(count, rows)
        spent.append(time.process_time() - start)
    size = sum(values.nbytes for values in results.values())
    memory = _peak() if clean else None
    print(json.dumps({"cpu": statistics.median(spent), "memory": memory, "results": size, "steps": work["steps"]}))


SIDES = ("right", "left")


def _forget_peak() -> bool:
    try:
        Path("/proc/self/clear_refs").write_text("5", encoding="utf-8")
    except OSError:
        return False
    return True


def _peak() -> int | None:
    """Largest resident size since then [bytes]."""
    for line in Path("/proc/self/status").read_text(encoding="utf-8").splitlines():
        if line.startswith("VmHWM:"):
            return int(line.split()[1]) * 1024
    return None


if __name__ == "__main__":
    main(int(sys.argv[1]))
