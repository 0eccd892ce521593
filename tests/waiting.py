"""Waiting for states in tests. No test fails because the machine is slow or busy; `make speed` measures speed."""

import time
from collections.abc import Callable
from typing import TypeVar

HANG = 1200.0
"""Wall time after which a test counts as hanging [s]."""

T = TypeVar("T")


def wait_for(condition: Callable[[], T], pause: float = 0.02) -> T:
    """Return the value of a condition as soon as it is true."""
    deadline = time.monotonic() + HANG
    while not (value := condition()):
        assert time.monotonic() < deadline, "the condition did not become true"
        time.sleep(pause)
    return value


_NOMINAL = 0.67  # wall time of three million turns of a loop on the machine of the stated limits [s]


def _loop() -> float:
    begun, s = time.perf_counter(), 0
    for i in range(300_000):
        s += i * i
    return 10.0 * (time.perf_counter() - begun)


def allowed(seconds: float) -> float:
    """Return a limit of wall time on this machine, as busy as it is now: five times the stated time, at its pace."""
    return 5.0 * seconds * max(1.0, sorted(_loop() for _ in range(3))[1] / _NOMINAL)
