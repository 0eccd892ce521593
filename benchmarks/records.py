"""A folder of 1,000 record files to one table, and 40 of them chosen for a target: `python -m benchmarks.records`.

Each file has two components of 8,000 samples at 0.01 s; 30 periods of RotD50 and RotD100. Two damaged files lie among
them. Seconds of the wall clock on two processes, as a user waits; it runs on an idle machine, for nothing else.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

FILES, SAMPLES, STEP = 1000, 8000, 0.01
MARK = 60.0  # longest time of the table on two processors [s]


def folder(where: Path, files: int = FILES) -> None:
    """Write files of columns with units in their header, and two damaged files."""
    time_of = np.arange(SAMPLES) * STEP
    for k in range(files):
        rng = np.random.default_rng(k)
        shape = (time_of / 8.0) ** 2 * np.exp(2.0 - 2.0 * time_of / 8.0)
        noise = np.apply_along_axis(np.convolve, 1, rng.standard_normal((2, SAMPLES)), np.hanning(9), "same")
        components = (0.4 + rng.random()) * shape * noise
        rows = np.column_stack([time_of, *components])
        np.savetxt(where / f"site{k:04d}.csv", rows, "%.6g", ",", header="time [s],x [m/s2],y [m/s2]", comments="")
    for k, cut in ((3, 1000), (7, 40)):
        path = where / f"damaged{k}.csv"
        path.write_text((where / f"site{k:04d}.csv").read_text()[:cut] + "\n1.0,oops,2\n")


def seconds(*arguments: str) -> float:
    """Wall seconds of a command."""
    begun = time.perf_counter()
    done = subprocess.run(
        [sys.executable, "-m", "rocking", "record", "batch", *arguments], check=True, capture_output=True, text=True
    )
    spent = time.perf_counter() - begun
    print("\n".join((done.stdout + done.stderr).strip().splitlines()[-4:]))
    return spent


def main() -> None:
    """Measure both."""
    with tempfile.TemporaryDirectory() as temporary:
        records = Path(temporary) / "records"
        records.mkdir()
        folder(records)
        flat = seconds(str(records), "--output", str(Path(temporary) / "flatfile.csv"))
        print(
            f"{FILES} files, 30 periods of RotD: {flat:.1f} s (mark {MARK:.0f} s): {'met' if flat < MARK else 'missed'}"
        )
        chosen = seconds(
            str(records), "--set", "motion.target=eurocode8:ag=0.35g,ground=C", "--set", "motion.count=40", "--output",
            str(Path(temporary) / "chosen.csv"),
        )  # fmt: skip
        print(f"40 of {FILES} chosen and scaled: {chosen:.1f} s")


if __name__ == "__main__":
    main()
