"""How long a fresh process takes: `import rocking`, `rocking --help`."""

import statistics
import subprocess
import sys
import time


def seconds(*arguments: str, repeats: int = 7) -> float:
    """Median wall seconds of a fresh interpreter with these arguments."""

    def once() -> float:
        start = time.perf_counter()
        subprocess.run([sys.executable, *arguments], check=True, capture_output=True)
        return time.perf_counter() - start

    return statistics.median(once() for _ in range(repeats))


def starts() -> list[tuple[str, float, float]]:
    """(what, seconds, goal) for each."""
    return [
        ("import rocking", seconds("-c", "import rocking"), 0.3),
        ("rocking --help", seconds("-c", "from rocking.cli import main; main(['--help'])"), 0.5),
    ]
