"""What all tests share: property tests that draw the same examples on every run, the folder of real records."""

import gc
import os
import signal
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import settings

# programs that tests start as processes of their own
collect_ignore_glob = ["verification/durability/*", "regression/[cdg]*.py"]

# Shells start what runs in their background with Ctrl-C ignored; tests press it, in processes of their own too.
signal.signal(signal.SIGINT, signal.default_int_handler)

gc.set_threshold(20_000, 20, 20)  # cycles are looked for seldom: a fifteenth of the time of all tests

settings.register_profile("rocking", derandomize=True, deadline=None, max_examples=40, database=None)
settings.load_profile("rocking")


def pytest_collection_finish() -> None:
    """Leave what was imported out of every search for cycles."""
    gc.collect()
    gc.freeze()


@pytest.fixture(scope="session")
def shared_records() -> Path:
    """Folder with real records; tests that need them are skipped where it is absent."""
    beside = Path(__file__).parents[1].parent / "shared" / "data" / "ground_motions"
    folder = Path(os.environ.get("ROCKING_GROUND_MOTIONS", beside))
    if not folder.is_dir():
        pytest.skip("shared ground motions are absent")
    return folder


@pytest.fixture
def agreement(record_property: Callable[[str, object], None]) -> Callable[[float, float], None]:
    """Ask that a deviation stays below a bound, and record it for the manual's page of verification."""

    def below(deviation: float, bound: float) -> None:
        record_property("deviation", float(deviation))
        assert deviation < bound

    return below
