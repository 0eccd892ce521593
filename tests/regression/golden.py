"""Keep what the package answers today, and compare tomorrow's with it in all digits: `make golden`.

``python tests/regression/golden.py keep|compare [GROUP ...]`` works in build/golden, on one machine. ``commit`` writes
answers.json.gz: Python, commands and application with thinned arrays, which `test_regression.py` compares to 1e-9.
It says what was, not what is right.
"""

import gzip
import json
import os
import pickle
import sys
import tempfile
from pathlib import Path
from typing import Any

import cases
import trees

KEPT = cases.ROOT / "build" / "golden"
COMMITTED = Path(__file__).parent / "answers.json.gz"


def answers(group: str) -> dict[str, Any]:
    """Return what every case of a group answers, each in a folder of its own."""
    os.environ |= {"COLUMNS": "120", "NO_COLOR": "1", "TERM": "dumb"}
    made = {}
    for name, case in cases.GROUPS[group]().items():
        with tempfile.TemporaryDirectory(prefix="golden-") as folder:
            made[name] = cases.answer(case, Path(folder))
            if isinstance(made[name], dict) and "raised" in made[name]:
                print(f"{group}, {name}: {made[name]['raised']}: {made[name]['message']}", file=sys.stderr)
    return made


def main(what: str, groups: list[str]) -> int:
    """Keep, compare or commit; return how many groups differ."""
    different = 0
    for group in groups or list(cases.GROUPS):
        now, path = answers(group), KEPT / f"{group}.pickle"
        count = sum(1 for _ in trees.leaves(now))
        if what == "keep":
            KEPT.mkdir(parents=True, exist_ok=True)
            path.write_bytes(pickle.dumps(now))
            print(f"{group}: {len(now)} cases, {count} answers kept", flush=True)
            continue
        said = trees.differences(pickle.loads(path.read_bytes()), now)
        print(f"{group}: {len(now)} cases, {count} answers, {len(said)} differences", flush=True)
        print(*said[:4000], sep="\n", flush=True)
        different += bool(said)
    return different


def commit() -> None:
    """Write the answers that the test compares."""
    made = {group: trees.thinned(answers(group)) for group in ("python", "commands", "application")}
    with gzip.GzipFile(COMMITTED, "wb", mtime=0) as out:
        out.write(json.dumps(made, sort_keys=True).encode())
    print(f"{COMMITTED.name}: {COMMITTED.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    sys.exit(commit() if sys.argv[1] == "commit" else main(sys.argv[1], sys.argv[2:]))
