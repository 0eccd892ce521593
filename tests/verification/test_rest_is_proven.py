"""Impacts that are summed up to rest: resolving every one of them instead leads to the same later history."""

import numpy as np
import pytest
from engines import every_engine

from rocking.conventions import g
from rocking.dynamics import ConstantRestitution, PlaneSettings, RockingParameters, RockingSide
from rocking.dynamics.plane import fast_engine, reference
from rocking.dynamics.plane.equations import EventKind
from rocking.motions import Segments

pytestmark = pytest.mark.verifies(room="rocking in the plane")

COUNT = 40


def case(number):
    """A block that chatters: bursts of noise about its threshold, calm between them, some with vertical motion."""
    random = np.random.default_rng([11, number])
    alpha, p, r = random.uniform(0.1, 0.4), random.uniform(1.0, 4.0), random.uniform(0.7, 0.95)
    x = np.convolve(random.normal(size=404), np.ones(5) / 5.0, mode="valid")
    x *= np.repeat(random.uniform(0.2, 1.0, 8), 50)
    x *= np.tan(alpha) * g * random.uniform(1.05, 2.0) / np.abs(x).max()
    z = 0.3 * g * random.normal(size=x.size) if number % 4 == 0 else None
    side = RockingSide(alpha, p, 1.0, r)
    return RockingParameters(side, side, ConstantRestitution(), ""), Segments.between_samples(0.02, x, z)


def run(name, number, rest_speed):
    parameters, segments = case(number)
    settings = PlaneSettings(rest_speed=rest_speed)
    return fast_engine.run(parameters, segments, settings, engine=name)


def lifts(trajectory):
    return np.array([e.time for e in trajectory.events if e.kind is EventKind.UPLIFT])


@pytest.mark.slow
@pytest.mark.verifies(
    "invariant",
    "every impact resolved instead of summed up",
    within="1e-11",
    control="test_rest_without_proof_is_wrong",
)
@every_engine
def test_the_same_later_history(name):
    """Uplifts from rest at the same instants, the same outcome and peak, with far fewer impacts."""
    saved = 0
    for number in range(COUNT):
        summed, resolved = run(name, number, 0.01), run(name, number, 0.0)
        assert summed.outcome is resolved.outcome
        np.testing.assert_allclose(lifts(summed), lifts(resolved), rtol=0.0, atol=1e-11)
        assert summed.peak_rotation == pytest.approx(resolved.peak_rotation, abs=1e-11)
        assert summed.impacts <= resolved.impacts
        saved += resolved.impacts - summed.impacts
    assert saved > 10 * COUNT, "the comparison is about impacts that were summed up"


@pytest.mark.slow
@pytest.mark.verifies("negative control", "every slow body put to rest")
def test_rest_without_proof_is_wrong(monkeypatch):
    """Putting every slow body to rest, as is often done, changes later uplifts."""
    unproven = [lifts(run("reference", number, 0.01)) for number in range(COUNT)]

    def slow(parameters, ground, sign, after, stretch, tau, rest_speed):
        side = parameters.side(sign)
        limit = rest_speed * side.frequency_parameter * side.slenderness_angle
        return after <= limit and ground.held(sign, stretch, tau) > 0.0

    monkeypatch.setattr(reference, "comes_to_rest", slow)
    changed = 0
    for number, before in enumerate(unproven):
        after = lifts(run("reference", number, 0.01))
        changed += before.size != after.size or bool((np.abs(before - after) > 1e-9).any())
    assert changed > COUNT // 4
