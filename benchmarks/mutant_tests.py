"""Which tests run which line, and how long each takes: one run of the suite under coverage, kept in a folder.

This module is also the pytest plugin of that run; with `-p benchmarks.mutant_tests` it writes durations.
"""

import json
import os
import sqlite3
import subprocess
import sys
from pathlib import Path

import pytest
from coverage.numbits import numbits_to_nums

ROOT = Path(__file__).resolve().parents[1]
DURATIONS = "ROCKING_TEST_DURATIONS"

_spent: dict[str, float] = {}


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    """Add up what a test took, its fixtures too."""
    if report.outcome == "passed":
        _spent[report.nodeid] = _spent.get(report.nodeid, 0.0) + report.duration


def pytest_sessionfinish(session: pytest.Session) -> None:
    """Write the durations; worker processes report to the first one."""
    if DURATIONS in os.environ and not hasattr(session.config, "workerinput"):
        Path(os.environ[DURATIONS]).write_text(json.dumps(_spent), encoding="utf-8")


def record(folder: Path) -> None:
    """Run the suite once under coverage, if the folder does not have it yet."""
    if (folder / "durations.json").exists():
        return
    print("Running the suite once to see which test runs which line ...", flush=True)
    command = [sys.executable, "-m", "pytest", "-q", "-n", "2", "--dist", "loadfile", "-m", "not timed and not browser"]
    command += [
        "--cov",
        "--cov-context=test",
        "--cov-report=",
        "-p",
        "benchmarks.mutant_tests",
        "-p",
        "no:cacheprovider",
    ]
    at = {"COVERAGE_FILE": str(folder / "coverage"), DURATIONS: str(folder / "durations.json")}
    done = subprocess.run(command, cwd=ROOT, env=os.environ | at, check=False)
    if done.returncode:
        (folder / "durations.json").unlink(missing_ok=True)
        raise SystemExit("the suite must pass before it can be judged")


class Covering:
    """The tests that run a line: those of the file's own name first, then quickest first."""

    def __init__(self, folder: Path) -> None:
        self.durations: dict[str, float] = json.loads((folder / "durations.json").read_text(encoding="utf-8"))
        self._database = sqlite3.connect(f"file:{folder / 'coverage'}?mode=ro", uri=True, check_same_thread=False)

    def tests(self, path: str, lines: range) -> list[str]:
        """Tests that run one of these lines; all that run the file where it runs only on import."""
        by_line = self._of_file(path)
        found = set().union(*(by_line.get(line, set()) for line in lines)) or set().union(*by_line.values())
        own = Path(path).stem
        return sorted(found & self.durations.keys(), key=lambda test: (own not in test, self.durations[test], test))

    def _of_file(self, path: str) -> dict[int, set[str]]:
        # branch coverage keeps arcs from line to line; negative numbers are entries and exits
        names = self._database.execute("select id from file where path = ?", (str(ROOT / path),)).fetchall()
        found: dict[int, set[str]] = {}
        for (number,) in names:
            query = "select context, {} from {} join context on context.id = context_id where file_id = ?"
            for test, line in self._database.execute(query.format("tono", "arc"), (number,)):
                found.setdefault(line, set()).add(test.partition("|")[0])
            for test, bits in self._database.execute(query.format("numbits", "line_bits"), (number,)):
                for line in numbits_to_nums(bits):
                    found.setdefault(line, set()).add(test.partition("|")[0])
        for tests in found.values():
            tests.discard("")
        return found
