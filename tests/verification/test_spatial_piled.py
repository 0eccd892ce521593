"""Impacts that pile up at one moment, and bodies on their way down: every history ends, and ends right.

A corner that turns about the vertical while its neighbour chatters beside it has infinitely many impacts in a finite
time; without slip it comes to stick on both. A body past its balance has less energy than at rest, and is not at rest.
"""

import math

import numpy as np
import pytest
from random_cases import components, solid

import rocking as rk
from rocking.dynamics.rolling import SpatialBody, fast_engine, reference
from rocking.dynamics.rolling.batch import batch_in_space
from rocking.outcome import Outcome, Status

pytestmark = pytest.mark.verifies(room="rocking in space")

STEP, LENGTH = 0.02, 8.0
LAWS = ["housner-3d", "horizontal-momentum-3d", 0.9]
built = pytest.mark.skipif(not fast_engine.available(), reason="the batch engine was not built")


def _case(seed):
    rng = np.random.default_rng(seed)
    box = SpatialBody.box(rng.uniform(0.3, 1.4), rng.uniform(0.3, 1.4), rng.uniform(1.5, 5.0))
    body = box if seed % 2 else solid(rng)
    return body, components(rng, LENGTH, STEP), 1.5 * float(rng.uniform(0.3, 1.6))


def _reference(seed, law):
    body, motion, scale = _case(seed)
    return rk.simulate(body, motion, law, scale=scale, duration=LENGTH)


@pytest.mark.slow
@pytest.mark.verifies("invariant", "balance of energy", within="1e-9", control="within")
def test_a_corner_whose_neighbour_chatters_comes_to_stick(monkeypatch):
    """The history ends and its energy closes to 1e-9; impacts that may pile up for ever stop it."""
    sticks = _reference(96, "housner-3d")
    assert sticks.status is Status.GOOD
    assert sticks.energy.closure < 1e-9
    monkeypatch.setattr(reference, "_PILED", 10**9)
    assert _reference(96, "housner-3d").status is Status.TOO_MANY_EVENTS


@pytest.mark.slow
@pytest.mark.verifies("invariant", "balance of energy", within="1e-9", control="within")
def test_a_body_on_its_way_down_is_not_at_rest(monkeypatch):
    """An impact at 83 degrees: it falls, energy to 1e-9; were less energy than at rest called rest, it would stand."""
    falls = _reference(154, 0.9)
    assert falls.outcome is Outcome.OVERTURNED
    assert falls.energy.closure < 1e-9
    signed = property(lambda self: self._kinetic() + self._potential() < self.weak)
    monkeypatch.setattr(reference.SpatialReference, "_weak", signed)
    wrong = _reference(154, 0.9)
    assert wrong.outcome is Outcome.ROCKED
    assert wrong.energy.closure > 0.1


@pytest.mark.slow
@pytest.mark.verifies("behaviour")
@built
def test_no_history_on_polygons_ends_in_piled_impacts():
    """Boxes and polygons under 200 records at 3 scales by 3 laws: no pile, under 1 % that take off, peaks below 90."""
    found = [
        batch_in_space(body, motion, LAWS, scales=scale * np.array([0.5, 1.0, 1.6]))
        for body, motion, scale in map(_case, range(200))
    ]
    status, outcome = (np.concatenate([one[name].ravel() for one in found]) for name in ("status", "outcome"))
    peak = np.concatenate([one["peak_tilt"].ravel() for one in found])
    assert len(status) == 1800
    assert not (status == Status.TOO_MANY_EVENTS.code).any()
    assert not (status == Status.NOT_FINITE.code).any()
    assert (outcome == Outcome.FAILED.code).mean() < 0.01
    assert peak[outcome == Outcome.ROCKED.code].max() < 0.5 * math.pi
    assert (outcome == Outcome.OVERTURNED.code).mean() > 0.2
    assert (outcome == Outcome.ROCKED.code).mean() > 0.1
