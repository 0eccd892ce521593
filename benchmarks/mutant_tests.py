"""Coverage of lines by tests, and durations of tests, from one run of the suite.

This module is also the pytest plugin of that run; with `-p benchmarks.mutant_tests` it writes durations.
"""

import hashlib
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
    """Add the duration of a test, including its fixtures."""
    if report.outcome == "passed":
        _spent[report.nodeid] = _spent.get(report.nodeid, 0.0) + report.duration


def pytest_sessionfinish(session: pytest.Session) -> None:
    """Write the durations; worker processes report to the first one."""
    if DURATIONS in os.environ and not hasattr(session.config, "workerinput"):
        Path(os.environ[DURATIONS]).write_text(json.dumps(_spent), encoding="utf-8")


def record(folder: Path, tests: list[str], workers: int) -> None:
    """Run the suite, or tests of some paths, once under coverage; later only files of tests that have changed since."""
    kept, now = folder / "recorded.json", seals(tests)
    before = json.loads(kept.read_text(encoding="utf-8")) if kept.exists() else {}
    unchanged = {path for path, seal in now.items() if before.get(path) == seal}
    changed = sorted(now.keys() - unchanged)
    is_complete = bool((before.keys() | now.keys()) - unchanged - {path for path in changed if "/test_" in path})
    if not changed and not is_complete:
        return
    durations, stale = folder / "durations.json", () if is_complete else tuple(f"{path}::" for path in changed)
    old = {} if is_complete else json.loads(durations.read_text(encoding="utf-8"))
    print("Running the tests once to see which runs which line ...", flush=True)
    command = [sys.executable, "-m", "pytest", "-q", "-m", "not speed and not browser"]
    command += ["-n", str(workers), "--dist", "loadfile"] if workers > 1 else []
    command += ["--cov", "--cov-context=test", "--cov-report=", "--cov-fail-under=0"]
    command += ["-p", "benchmarks.mutant_tests"]
    command += ["-p", "no:cacheprovider", *(tests if is_complete else ["--cov-append", *changed])]
    at = {"COVERAGE_FILE": str(folder / "coverage"), DURATIONS: str(durations)}
    kept.unlink(missing_ok=True)
    done = subprocess.run(command, cwd=ROOT, env=os.environ | at, check=False)
    if done.returncode not in (0, 5):  # 5: none of the changed files has a test that counts
        raise SystemExit("the suite must pass before it can be judged")
    by_test = json.loads(durations.read_text(encoding="utf-8"))
    durations.write_text(
        json.dumps({test: spent for test, spent in old.items() if not test.startswith(stale)} | by_test),
        encoding="utf-8",
    )
    kept.write_text(json.dumps(now), encoding="utf-8")


def seals(tests: list[str]) -> dict[str, str]:
    """Hashes of the sources and of the tests, all or those of some paths, by path."""
    files = {file for folder in ("src", *(tests or ["tests"])) for file in (ROOT / folder).rglob("*.py")}
    files |= {ROOT / folder for folder in tests if folder.endswith(".py")}
    return {str(path.relative_to(ROOT)): hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(files)}


class Covering:
    """The tests that run a line: those of the file's own name first, then quickest first."""

    def __init__(self, folder: Path, elsewhere: dict[str, list[str]]) -> None:
        self._elsewhere = elsewhere
        self.durations: dict[str, float] = json.loads((folder / "durations.json").read_text(encoding="utf-8"))
        self._seals: dict[str, str] = json.loads((folder / "recorded.json").read_text(encoding="utf-8"))
        self._database = sqlite3.connect(f"file:{folder / 'coverage'}?mode=ro", uri=True, check_same_thread=False)
        self._files: dict[str, dict[int, set[str]]] = {}

    def tests(self, path: str, lines: range) -> list[str]:
        """Tests that run one of these lines; all that run the file where it runs only on import."""
        if path not in self._files:
            self._files[path] = self._of_file(path)
        by_line = self._files[path]
        selected = set().union(*(by_line.get(line, set()) for line in lines)) or set().union(*by_line.values())
        selected |= {test for test in self.durations if test.partition("::")[0] in self._elsewhere.get(path, ())}
        own = Path(path).stem
        return sorted(selected & self.durations.keys(), key=lambda test: (own not in test, self.durations[test], test))

    def seal(self, tests: list[str]) -> str:
        """Another one where these tests are others than before, or changed."""
        stood = [(test, self._seals[test.partition("::")[0]]) for test in sorted(tests)]
        return hashlib.sha256(json.dumps(stood).encode()).hexdigest()[:8]

    def _of_file(self, path: str) -> dict[int, set[str]]:
        # branch coverage keeps arcs from line to line; negative numbers are entries and exits
        names = self._database.execute("select id from file where path = ?", (str(ROOT / path),)).fetchall()
        by_line: dict[int, set[str]] = {}
        for (number,) in names:
            query = "select context, {} from {} join context on context.id = context_id where file_id = ?"
            for test, line in self._database.execute(query.format("tono", "arc"), (number,)):
                by_line.setdefault(line, set()).add(test.partition("|")[0])
            for test, bits in self._database.execute(query.format("numbits", "line_bits"), (number,)):
                for line in numbits_to_nums(bits):
                    by_line.setdefault(line, set()).add(test.partition("|")[0])
        for tests in by_line.values():
            tests.discard("")
        return by_line
