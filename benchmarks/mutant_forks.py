"""Judges errors within functions in forks of one process with collected tests: 20 times faster.

Each fork replaces the code of the changed function without another import. `benchmarks.mutants` judges errors outside
functions from the same ledger. Tests with own processes do not see the error, so the number of detected errors is a
lower bound.
"""

import ast
import contextlib
import importlib
import json
import os
import pkgutil
import resource
import sys
import time
import types
from collections import Counter, defaultdict
from pathlib import Path
from typing import Any

import pytest

from benchmarks.mutant_server import wait
from benchmarks.mutant_tests import ROOT, Covering
from benchmarks.mutants import Mutant, by_hand, sample

PATIENCE = 1.5  # times the duration of the tests under coverage, of the processor's time


class Loop:
    """The plugin that runs tests of mutants in place of all tests."""

    def __init__(self, chosen: list[Mutant], covering: Covering, ledger: Path, limit: float) -> None:
        self.chosen, self.covering, self.ledger, self.limit = chosen, covering, ledger, limit

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Judge mutants that are absent from the ledger; tests that detected other errors in the file come first."""
        items = {item.nodeid: item for item in session.items}
        lines = self.ledger.read_text(encoding="utf-8").splitlines() if self.ledger.exists() else []
        known = {entry["key"] for entry in map(json.loads, lines)}
        noticed: dict[str, Counter[str]] = defaultdict(Counter)
        for mutant in self.chosen:
            swap = None if mutant.key in known else swapped(mutant)
            if swap is None:
                continue
            tests = [test for test in self.covering.tests(mutant.path, mutant.lines) if test in items]
            tests.sort(key=lambda test, of=noticed[mutant.path]: -of[test])  # type: ignore[misc]
            kept, spent = [], 0.0
            for test in tests:
                spent += self.covering.durations[test]
                if spent > self.limit:
                    break
                kept.append(items[test])
            began = time.monotonic()
            failed = judged(*swap, kept, 10.0 + PATIENCE * min(spent, self.limit))
            noticed[mutant.path][failed] += 1
            seconds = round(time.monotonic() - began, 1)
            entry = {"key": mutant.key, "killed": bool(failed), "by": failed, "of": len(kept), "seconds": seconds}
            with self.ledger.open("a", encoding="utf-8") as out:
                out.write(json.dumps(entry | {"tests": self.covering.seal(tests)}) + "\n")
            print("killed  " if failed else "SURVIVED", mutant.key, flush=True)
        return True


def judged(function: types.FunctionType, code: types.CodeType, items: list[pytest.Item], limit: float) -> str:
    """Return the test that fails first in a fork with other code in a function; empty if all pass."""
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        os.setsid()
        resource.setrlimit(resource.RLIMIT_CPU, (int(limit), int(limit)))
        null = os.open(os.devnull, os.O_RDWR)
        for stream in range(3):
            os.dup2(null, stream)
        function.__code__ = code
        os.write(writer, _first_failure(items).encode())
        os._exit(0)
    os.close(writer)
    ended = wait(child, 8.0 * limit)
    failed = os.read(reader, 10_000).decode()
    os.close(reader)
    return failed or ("" if ended == 0 else f"code {ended}")


def _first_failure(items: list[pytest.Item]) -> str:
    failed = []

    class Notes:
        def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
            if report.failed:
                failed.append(report.nodeid)

    for item, later in zip(items, [*items[1:], None], strict=True):
        if item is items[0]:
            item.config.pluginmanager.register(Notes())
        item.config.hook.pytest_runtest_protocol(item=item, nextitem=later)
        if failed:
            break
    return "".join(failed[:1])


def swapped(mutant: Mutant) -> tuple[types.FunctionType, types.CodeType] | None:
    """Return the loaded function that an error is in, and its code with the error; None outside of functions."""
    try:
        old, new = (ast.parse(text) for text in ((ROOT / mutant.path).read_text(encoding="utf-8"), mutant.code()))
    except SyntaxError:
        return None
    names = changed(old, new)
    if not names:
        return None
    found: Any = importlib.import_module(mutant.path.removeprefix("src/").removesuffix(".py").replace("/", "."))
    code = compile(new, str(ROOT / mutant.path), "exec")
    for name in names:
        codes = [
            constant for constant in code.co_consts if isinstance(constant, types.CodeType) and constant.co_name == name
        ]
        found = vars(found).get(name)
        if len(codes) != 1 or found is None:
            return None
        (code,) = codes
    while not isinstance(found, types.FunctionType):  # what a decorator made of it
        inner = (getattr(found, name, None) for name in ("__func__", "fget", "func", "__wrapped__"))
        found = next(filter(None, inner), None)
        if found is None:
            return None
    found = getattr(found, "__wrapped__", found)
    alike = found.__code__.co_name == names[-1] and found.__code__.co_freevars == code.co_freevars
    return (found, code) if alike else None


def changed(old: Any, new: Any) -> list[str]:
    """Return the names of classes and the function in which two modules differ; empty if elsewhere."""
    pairs = zip(old.body, new.body, strict=True)
    (one, other), *more = [(one, other) for one, other in pairs if ast.dump(one) != ast.dump(other)]
    if more or type(one) is not type(other):
        return []
    if isinstance(one, ast.ClassDef):
        inner = changed(one, other)
        return [one.name, *inner] if inner else []
    if not isinstance(one, ast.FunctionDef):
        return []
    heads = [[ast.dump(part) for part in (each.args, *each.decorator_list)] for each in (one, other)]
    return [one.name] if heads[0] == heads[1] else []


def main(seed: int, count: int, limit: float, packages: list[str]) -> None:
    """Import all that is judged, collect the tests, judge."""
    import rocking

    folder = ROOT / "build/mutants"
    covering = Covering(folder, by_hand()["elsewhere"])
    for module in pkgutil.walk_packages(rocking.__path__, "rocking."):
        if not module.name.endswith("__main__"):
            with contextlib.suppress(Exception):
                importlib.import_module(module.name)
    files = sorted({test.partition("::")[0] for test in covering.durations})
    quiet = ["-q", "-s", "--tb=no", "--no-header", "-p", "no:cacheprovider", "-W", "ignore:Module already imported"]
    chosen, _ = sample(seed, count, packages)
    loop = Loop(chosen, covering, folder / "verdicts.jsonl", limit)
    pytest.main([*quiet, "-m", "not speed and not browser", *files], [loop])


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3]), sys.argv[4:])
