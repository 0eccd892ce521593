"""The energy ledger closes on real records, where they are at hand: stored + lost = work of the ground."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import rocking as rk
from rocking.dynamics.plane import dense_output, fast_engine

# What limits the closure is the ledger, not the engines: the work integrates the quintic through both ends of every
# interval, whose error grows with the sixth power of its length and with the slope of the record. Intervals up to
# p h = 0.1 are one quintic; at 0.02 s and the 1.5 g spike of Cape Mendocino that leaves 5e-9. Kinks of the record
# are ends of intervals, so that no quadrature runs across one.
CLOSURE = 2e-8
SHORT = 1e-10
"""Closure if intervals are cut to p h <= 0.02, so that quintics do not limit it [-]."""

STRONGEST: dict[str, dict[str, Any]] = {
    "peer/CPM000.AT2": {},
    "plain_values/tabasFN.txt": {"units": "g", "time_step": 0.02},
    "two_column/CHV1-20140203E.txt": {"units": "cm/s2"},
    "two_column/Kobe.dat": {"units": "m/s2"},
}
"""Those of largest peak, as their description lists them: 1.50, 0.90, 0.76 and 0.69 g."""

BLOCK = rk.Block(width=0.5, height=2.0)
ENGINES = [
    pytest.param("fast", marks=pytest.mark.skipif(not fast_engine.available(), reason="fast engine not built")),
    "reference",
]


def rocked(folder: Path, name: str, engine: str) -> rk.Response:
    """Return the response of the block to a record."""
    return rk.simulate(BLOCK, rk.read_motion(folder / name, **STRONGEST[name]), "ked", engine=engine)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", STRONGEST)
def test_closes(shared_records: Path, name: str, engine: str) -> None:
    """Nothing is left over beyond 2e-8 of the largest energy, over ten impacts and more."""
    response = rocked(shared_records, name, engine)
    assert response.impacts.size > 10
    assert response.energy.closure < CLOSURE


@pytest.mark.parametrize("name", STRONGEST)
def test_long_intervals_limit_it(shared_records: Path, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Cut to a fifth, the intervals close to 1e-10: the same history, so the engine is not what was open."""
    monkeypatch.setattr(dense_output, "LONG", 0.02)
    assert rocked(shared_records, name, "auto").energy.closure < SHORT


@pytest.mark.parametrize("name", STRONGEST)
def test_sees_a_wrong_loss(shared_records: Path, name: str) -> None:
    """Negative control: one part in 100 000 more lost at the impacts, or work done, does not close."""
    energy = rocked(shared_records, name, "auto").energy
    for part in ("lost", "work"):
        wrong = replace(energy, **{part: (1.0 + 1e-5) * getattr(energy, part)})
        assert wrong.closure > 10.0 * CLOSURE
