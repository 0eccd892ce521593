"""Fixtures and settings of all tests: repeatable property tests, real records, runs of commands."""

import gc
import json
import os
import re
import signal
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from _pytest.doctest import DoctestModule
from hypothesis import settings

# Shells start what runs in their background with Ctrl-C ignored; tests press it, in processes of their own too.
signal.signal(signal.SIGINT, signal.default_int_handler)

# Threads of linear algebra wait in busy loops for each other: on small matrices most of the CPU time of a test, and of
# the processes that it starts.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

gc.set_threshold(20_000, 20, 20)  # cycles are looked for seldom: a fifteenth of the time of all tests

settings.register_profile("rocking", derandomize=True, deadline=None, max_examples=40, database=None)
settings.load_profile("rocking")


@pytest.hookimpl(wrapper=True)
def pytest_collect_file() -> Iterator[Any]:
    """Search no examples in docstrings of tests: a tenth of the time of collection."""
    return [node for node in (yield) if not isinstance(node, DoctestModule)]


ALL_SLOW = re.compile(r"^pytestmark = \[?\s*pytest\.mark\.slow\b", re.M)


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Import no module whose tests are all of the other tier: more than half of the time of collecting slow tests."""
    tier = str(config.getoption("markexpr"))
    if collection_path.suffix != ".py" or not ("not slow" in tier or tier.startswith("slow")):
        return None
    text = collection_path.read_text("utf-8")
    is_other = ALL_SLOW.search(text) if "not slow" in tier else "mark.slow" not in text
    return True if is_other else None  # None: other plugins decide


def pytest_collection_finish() -> None:
    """Leave what was imported out of every search for cycles."""
    gc.collect()
    gc.freeze()


@pytest.fixture(scope="session")
def shared_records() -> Path:
    """Folder with real records; tests that need them are skipped where it is absent."""
    beside = Path(__file__).parents[2] / "shared" / "data" / "ground_motions"
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


@pytest.fixture
def run(capsys, request):
    """Return what runs `rocking WORDS` after the COMMAND of the module: exit code, standard output, standard error."""
    from rocking.cli import main

    command = getattr(request.module, "COMMAND", "").split()

    def call(*words):
        with pytest.raises(SystemExit) as stop:
            main([*command, *(str(word) for word in words)])
        printed = capsys.readouterr()
        return stop.value.code or 0, printed.out, printed.err

    return call


@pytest.fixture
def printed(run):
    """Return what gives the page of a run that succeeds."""

    def call(*words):
        code, out, err = run(*words)
        assert code == 0, err
        return out

    return call


@pytest.fixture
def answered(run):
    """Return what gives the JSON of a run that succeeds without a word on standard error."""

    def call(*words):
        code, out, err = run(*words, "--json")
        assert (code, err) == (0, "")
        return json.loads(out, parse_constant=pytest.fail)

    return call


@pytest.fixture
def refuses(run):
    """Return what asserts that a run ends with code 2 and one sentence on standard error, and prints no number."""

    def check(words, sentence):
        code, out, err = run(*words)
        assert (code, out) == (2, "")
        assert sentence in err
        assert err.startswith("rocking: ")
        assert err.count("\n") == 1

    return check


@pytest.fixture
def mesh(tmp_path):
    """Return what writes a prism 1 x 1 x 4 m, or another shape, as a mesh: all of its faces or some, scaled or not."""
    trimesh = pytest.importorskip("trimesh")
    from rocking.bodies.solid import box

    def write(name, scale=1.0, keep=slice(None), turn=None, shape=None):
        shape = box(1.0, 1.0, 4.0) if shape is None else shape
        faces = shape.faces[keep].copy()
        if turn is not None:
            faces[turn] = faces[turn, ::-1]
        trimesh.Trimesh(shape.vertices * scale, faces, process=False).export(tmp_path / name)
        return tmp_path / name

    return write
