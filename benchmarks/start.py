"""CPU time of a fresh process until its first answer, in seconds of the machine that the goals are stated for."""

import resource
import statistics
import subprocess
import sys
import tempfile

NUMPY = 0.28  # CPU time of `import numpy` on the machine of the goals [s]
BLOCK = ("--width", "0.6", "--height", "1.8")
SHAKEN = (*BLOCK, "--motion", "sine:amplitude=3,period=1.2")
COMMANDS = {  # arguments, goal [s], repeats
    "--help": ((), 0.3, 5),
    "restitution": (BLOCK, 0.6, 5),
    "simulate": (SHAKEN, 0.6, 5),
    "map": (SHAKEN, 0.6, 5),
    "assess": (SHAKEN, 2.0, 5),
    "predict": (SHAKEN, 2.0, 5),
    "reproduce": ((), 12.0, 1),
}


def seconds(*arguments: str) -> float:
    """CPU seconds of a fresh interpreter with these arguments, and of its processes."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([sys.executable, *arguments], check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def scaled(*arguments: str, repeats: int = 5) -> float:
    """Median CPU seconds on the machine of the goals; this one is compared with it by `import numpy`, turn by turn."""
    pairs = [(seconds(*arguments), seconds("-c", "import numpy")) for _ in range(repeats)]
    own, unit = (statistics.median(column) for column in zip(*pairs, strict=True))
    return NUMPY * own / unit


def starts() -> list[tuple[str, float, float]]:
    """Return rows of description, time [s] and goal [s]."""
    rows = [("import rocking", scaled("-c", "import rocking"), 0.1)]
    for name, (options, goal, repeats) in COMMANDS.items():
        with tempfile.TemporaryDirectory() as folder:
            out = ("--output", folder) if name == "reproduce" else ()
            spent = scaled("-m", "rocking", name, *options, *out, repeats=repeats)
        rows.append((f"rocking {name}", spent, goal))
    return rows
