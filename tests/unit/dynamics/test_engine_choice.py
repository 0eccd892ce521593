"""Which engine runs, and what the first call needs."""

import subprocess
import sys
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from engines import built

import rocking as rk
from rocking.dynamics.batch import Batch
from rocking.dynamics.parameters import sides_of
from rocking.dynamics.plane import fast_engine
from rocking.dynamics.rows import Rows
from rocking.errors import InvalidValueError, MissingExtraError, SlowEngineWarning

BODY = rk.Block(width=0.5, height=2.0).with_feet(0.05, 0.5)
RECORD = rk.GroundMotion(4.0 * np.sin(0.3 * np.arange(43)), 0.05)


@pytest.fixture
def _not_built(monkeypatch: pytest.MonkeyPatch) -> None:
    """An installation without the compiled module: its import fails."""
    monkeypatch.setitem(sys.modules, "rocking.dynamics._engine", None)


@pytest.mark.slow
@pytest.mark.usefixtures("_not_built")
def test_without_the_module_the_reference_runs() -> None:
    """ "auto" warns, at the user's own line, and gives the reference engine's numbers bit for bit."""
    assert not fast_engine.available()
    calls: tuple[Any, ...] = (
        lambda name: rk.simulate(BODY, RECORD, 0.9, duration=2.0, engine=name).rotation,
        lambda name: rk.free_rocking(BODY, 0.1, 0.9, duration=1.0, engine=name).rotation,
        lambda name: rk.simulate_many(BODY, RECORD, 0.9, engine=name)["peak_rotation"].to_numpy(),
    )
    for call in calls:
        with pytest.warns(SlowEngineWarning, match="was not built.*; the reference engine runs instead") as caught:
            found = call("auto")
        assert len(caught) == 1
        assert caught[0].filename == __file__
        np.testing.assert_array_equal(found, call("reference"))
        assert np.abs(found).max() > 1e-3


@pytest.mark.usefixtures("_not_built")
def test_without_the_module_the_fast_one_is_refused() -> None:
    """ "fast" is refused, saying what it takes and what serves instead; so is the list of instruction sets."""
    message = 'C\\+\\+17 compiler .*; engine="reference" gives the same results, slowly'
    for call in (
        lambda: rk.simulate(BODY, RECORD, engine="fast"),
        lambda: rk.free_rocking(BODY, 0.1, engine="fast"),
        lambda: rk.simulate_many(BODY, RECORD, engine="fast"),
        fast_engine.instruction_sets,
        fast_engine.module,
    ):
        with pytest.raises(MissingExtraError, match=message):
            call()
    assert issubclass(MissingExtraError, ImportError)


@pytest.mark.usefixtures("_not_built")
def test_asking_for_the_reference_does_not_warn(monkeypatch: pytest.MonkeyPatch) -> None:
    """ "reference" runs in silence, whatever the environment says about a module that is not there."""
    monkeypatch.setenv("ROCKING_ISA", "nonsense")
    assert rk.simulate(BODY, RECORD, engine="reference", duration=0.5).engine.startswith("reference")


@built
def test_auto_is_the_fast_one() -> None:
    """Where it was built "auto" takes the fast engine, without a warning, and the response says so."""
    assert fast_engine.available()
    assert (fast_engine.chosen("auto"), fast_engine.chosen("fast"), fast_engine.chosen("reference")) == (
        "fast",
        "fast",
        "reference",
    )
    assert isinstance(fast_engine.module(), ModuleType)
    auto, fast = (rk.simulate(BODY, RECORD, engine=name, duration=2.0) for name in ("auto", "fast"))
    assert auto.engine == fast.engine
    np.testing.assert_array_equal(auto.rotation, fast.rotation)


@built
@pytest.mark.parametrize("wanted", ["avx512", "avx2", "plain"])
def test_responses_say_what_ran(wanted: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The order is that of the steps that a batch counts; a single history of order 8 has no kernel of AVX-512."""
    known = fast_engine.instruction_sets()
    assert known == [name for name in ("avx512", "avx2", "plain") if name in known]
    monkeypatch.delenv("ROCKING_ISA", raising=False)
    assert (known[-1], fast_engine.instruction_set()) == ("plain", known[0])
    if wanted not in known:
        pytest.skip(f"this processor has no {wanted}")
    monkeypatch.setenv("ROCKING_ISA", wanted)
    assert fast_engine.instruction_set() == wanted
    rng, orders = np.random.default_rng(3), set()
    for up in [False, True] * 8:
        step, a = 0.02 * 5.0 ** -rng.random(), rng.uniform(4.0, 40.0) * np.sin(0.3 * np.arange(43))
        record = rk.GroundMotion(a, step, vertical=0.1 * a if up else None)
        response = rk.simulate(BODY, record, 0.9, engine="fast", scale=0.7, duration=43 * step)
        rows = sides_of([response.parameters])
        _, work = Batch([response.segments]).run(1, lambda *_, rows=rows: Rows.of(1, scale=0.7, **rows))
        order = work["orders"] // work["steps"]
        orders.add(order)
        kernels = "avx2" if (wanted, order) == ("avx512", 8) else wanted
        assert response.engine == f"fast (Taylor, order {order}, {kernels})"
    assert orders == {6, 8}


@built
def test_instruction_sets_agree(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whichever set is asked for, the peak is the same to rounding; nothing asked is the first."""
    known = fast_engine.instruction_sets()
    peaks = []
    for wanted in known:
        monkeypatch.setenv("ROCKING_ISA", wanted)
        peaks.append(rk.simulate(BODY, RECORD, 0.9, engine="fast", duration=2.1).peak_rotation)
    np.testing.assert_allclose(peaks, peaks[0], rtol=1e-10)
    for empty in ("", None):
        monkeypatch.delenv("ROCKING_ISA") if empty is None else monkeypatch.setenv("ROCKING_ISA", empty)
        assert fast_engine.instruction_set() == known[0]


@built
@pytest.mark.parametrize("wanted", ["sse9", "AVX2", "avx2 ", "0"])
def test_wrong_instruction_sets(wanted: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A set that the processor lacks is refused, with those that it has, by every door of the fast engine."""
    monkeypatch.setenv("ROCKING_ISA", wanted)
    message = f"ROCKING_ISA must be one of .*plain, got '{wanted}'"
    for call in (
        fast_engine.instruction_set,
        lambda: rk.simulate(BODY, RECORD, engine="fast"),
        lambda: rk.simulate_many(BODY, RECORD, engine="auto"),
    ):
        with pytest.raises(InvalidValueError, match=message):
            call()
    assert rk.simulate(BODY, RECORD, engine="reference", duration=0.2).status.name == "GOOD"


NOT_NEEDED = {
    "csv", "json", "scipy", "shapely", "pydantic", "pandas", "xarray", "matplotlib", "rocking.evidence",
    "rocking.dynamics.plane.reference", "rocking.dynamics.plane.batch", "rocking.dynamics.plane.energy_balance",
    "rocking.tables",
}  # fmt: skip
SCRIPT = """
import sys
before = set(sys.modules)
import rocking as rk
response = rk.simulate(rk.Block(width=0.5, height=2.0), rk.pulses.sine(amplitude=3.0, period=0.6), "housner")
{more}
print(*set(sys.modules) - before)
"""


def loaded(more: str = "") -> set[str]:
    """Modules that a response adds to a fresh interpreter."""
    code = SCRIPT.format(more=more)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(done.stdout.split())


@pytest.mark.slow
@built
def test_the_first_response_loads_what_it_needs() -> None:
    """A response of the fast engine loads no files, tables or other engines; asked for, these are loaded."""
    found = loaded()
    assert {"rocking.dynamics._engine", "rocking.restitution.housner"} <= found
    assert not found & NOT_NEEDED
    assert "rocking.dynamics.plane.energy_balance" in loaded("response.contact")
