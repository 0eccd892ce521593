"""Runs tests in copies of a process that has imported all test modules except `rocking`, in half the time.

A line of standard input contains a file with arguments for pytest and a limit of CPU time [s]. A line of standard
output contains the exit code and the failed test, if any.
"""

import contextlib
import importlib
import os
import resource
import signal
import sys
import time
from pathlib import Path

READ_BEFORE = (
    "pytest", "hypothesis.extra.numpy", "schemathesis", "numpy", "scipy.integrate", "scipy.optimize", "scipy.stats",
    "xarray", "matplotlib.pyplot", "fastapi.testclient",
)  # fmt: skip
FAILED = "failed.txt"
PATIENCE = 4.0  # times the limit that may pass on a clock


def serve() -> None:
    """Answer until standard input ends."""
    for name in READ_BEFORE:
        with contextlib.suppress(ImportError):
            importlib.import_module(name)
    for line in sys.stdin:
        listed, limit = line.split()
        child = os.fork()
        if child == 0:
            os.setsid()
            resource.setrlimit(resource.RLIMIT_CPU, (int(limit), int(limit)))
            run(listed)
        code = wait(child, PATIENCE * int(limit))
        failed = Path(listed).with_name(FAILED)
        print(code, failed.read_text(encoding="utf-8") if failed.exists() else "", flush=True)
        failed.unlink(missing_ok=True)


def run(listed: str) -> None:
    """Run the tests and end this process."""
    import pytest

    null = os.open(os.devnull, os.O_RDWR)
    for stream in range(3):
        os.dup2(null, stream)

    class Notes:
        def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
            if report.failed:
                Path(listed).with_name(FAILED).write_text(report.nodeid, encoding="utf-8")

    quiet = ["-x", "-q", "--no-header", "--tb=no", "-p", "no:cacheprovider", "-W", "ignore:Module already imported"]
    os._exit(int(pytest.main([*quiet, f"@{listed}"], [Notes()])))


def wait(child: int, patience: float) -> int:
    """Return the exit code, whatever the child started ended with it; 1 if it took too long."""
    last, status = time.monotonic() + patience, None
    while status is None and time.monotonic() < last:
        done, found = os.waitpid(child, os.WNOHANG)
        if done:
            status = os.waitstatus_to_exitcode(found)
        else:
            time.sleep(0.01)
    with contextlib.suppress(ProcessLookupError):
        os.killpg(child, signal.SIGKILL)
    if status is None:
        os.waitpid(child, 0)
    return 1 if status is None else status


if __name__ == "__main__":
    serve()
