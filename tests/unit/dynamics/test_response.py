"""The response at its door: samples, impacts, sides, positions between samples, doubts and flight."""

import math
from typing import Any

import numpy as np
import pytest
from engines import ENGINES, every_engine

import rocking as rk
from rocking.conventions import g
from rocking.dynamics import Outcome, Status

pytestmark = pytest.mark.verifies(room="rocking in the plane")

BLOCK = rk.Block(width=1.0, height=3.0)
ALPHA = math.atan(1.0 / 3.0)
P = math.sqrt(0.75 * g / math.hypot(0.5, 1.5))
R = 0.85


def let_go(name: str = "auto", start: float = 0.15, **more: Any) -> rk.Response:
    return rk.free_rocking(BLOCK, start, R, engine=name, linear=True, **more)


def sine(strength: float, name: str = "auto", **more: Any) -> rk.Response:
    """Under a sine of Omega = 3, a_p = strength g tan(alpha)."""
    pulse = rk.pulses.sine(strength * g / 3.0, 2.0 * math.pi / (3.0 * P))
    return rk.simulate(BLOCK, pulse, R, engine=name, **more)


@pytest.mark.slow
@every_engine
@pytest.mark.parametrize("make", [sine, lambda s, name: let_go(name)])
def test_arrays(name: str, make: Any) -> None:
    """All arrays are float64, of one length, at equal steps from zero, and start as was asked."""
    response = make(1.3, name)
    n = response.time.size
    assert n > 100
    for row in (response.rotation, response.angular_velocity, response.ground_acceleration, response.energy.kinetic):
        assert row.shape == (n,)
        assert row.dtype == np.float64
        assert np.isfinite(row).all()
    np.testing.assert_allclose(response.time, np.arange(n) * response.segments.step, rtol=1e-15)
    assert response.rotation[0] == (0.15 if response.motion is None else 0.0)
    assert response.engine.startswith(name)
    assert (response.status, response.outcome) == (Status.GOOD, Outcome.ROCKED)


def test_ground_acceleration_is_the_scaled_record() -> None:
    """The ground's column is the record times the scale, and zero once it is over."""
    samples = np.array([0.0, 1.0, -2.0, 0.0])
    found = rk.simulate(BLOCK, rk.GroundMotion(samples, 0.1), R, scale=-0.5, duration=1.0).ground_acceleration
    np.testing.assert_allclose(found[:4], -0.5 * samples, rtol=0.0, atol=1e-15)
    assert found.size == 11
    assert not found[4:].any()


@pytest.mark.slow
@every_engine
def test_rotation_between_the_samples(name: str) -> None:
    """Until the first impact theta = alpha - (alpha - theta_0) cosh(p t), at any time, either sign, any shape."""
    response = let_go(name)
    first = math.acosh(ALPHA / (ALPHA - 0.15)) / P
    t = np.linspace(0.0, first, 700).reshape(7, 100)
    expected = ALPHA - (ALPHA - 0.15) * np.cosh(P * t)
    np.testing.assert_allclose(response.at(t), expected, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(let_go(name, start=-0.15).at(t), -expected, rtol=0.0, atol=1e-12)
    assert response.at(0.25 * first).shape == ()
    np.testing.assert_allclose(response.at(response.time), response.rotation, rtol=0.0, atol=1e-15)
    assert np.abs(response.at(t + 1e-4 * first) - expected).max() > 1e-6, "control: a shifted clock is seen"


@pytest.mark.verifies("closed form", "acosh and atanh of the linear equations", within="1e-12")
@every_engine
def test_impacts(name: str) -> None:
    """Times, speeds, coefficients and feet of the first five impacts are those of the closed form."""
    impacts = let_go(name).impacts
    time, speed = math.acosh(ALPHA / (ALPHA - 0.15)) / P, P * math.sqrt(ALPHA**2 - (ALPHA - 0.15) ** 2)
    assert impacts.dtype.names == ("time", "velocity_before", "velocity_after", "coefficient", "foot")
    for k in range(5):
        row, sign = impacts[k], -1.0 if k % 2 == 0 else 1.0
        assert row["time"] == pytest.approx(time, rel=1e-12, abs=0.0)
        assert row["velocity_before"] == pytest.approx(sign * speed, rel=1e-12, abs=0.0)
        assert row["velocity_after"] == pytest.approx(sign * R * speed, rel=1e-12, abs=0.0)
        assert (row["coefficient"], row["foot"]) == (R, "left" if sign < 0.0 else "right")
        speed *= R
        time += 2.0 * math.atanh(speed / (P * ALPHA)) / P


@pytest.mark.slow
@every_engine
def test_peak_between_the_samples(name: str) -> None:
    """Let go from 0.15 nothing exceeds 0.15; pushed from rest the peak is alpha - sqrt(alpha^2 - (v / p)^2)."""
    assert let_go(name).peak_rotation == pytest.approx(0.15, rel=1e-15, abs=0.0)
    pushed = rk.free_rocking(BLOCK, 0.0, R, angular_velocity=-0.5, engine=name, linear=True)
    assert pushed.peak_rotation == pytest.approx(ALPHA - math.sqrt(ALPHA**2 - (0.5 / P) ** 2), rel=1e-12, abs=0.0)
    assert pushed.trajectory.peak_time == pytest.approx(math.atanh(0.5 / (P * ALPHA)) / P, rel=1e-9)
    assert pushed.trajectory.peak_rotation < 0.0, "to the left"


@every_engine
def test_no_uplift(name: str) -> None:
    """Below g tan(alpha) nothing moves, and the sentence says so; tables are empty but have their columns."""
    response = sine(0.999, name)
    assert response.outcome is Outcome.NO_UPLIFT
    assert response.summary == "stayed at rest without uplift"
    assert response.peak_rotation == 0.0
    assert not response.rotation.any()
    assert math.isnan(response.overturning_time)
    assert response.impacts.shape == response.uplifts.shape == (0,)
    assert response.impacts["coefficient"].size == 0
    assert not response.at([0.0, 1.0]).any()
    assert (response.contact.friction_of_impacts, response.energy.closure) == (0.0, 0.0)


@pytest.mark.slow
@every_engine
def test_uplift_under_a_ramp(name: str) -> None:
    """Ground that accelerates as c t lifts the body at t = g tan(alpha) / c, onto its left foot."""
    ramp = rk.GroundMotion(np.array([0.0, 4.0, 0.0]), 1.0)
    response = rk.simulate(BLOCK, ramp, R, engine=name)
    np.testing.assert_allclose(response.uplifts[:1], [g / 3.0 / 4.0], rtol=1e-13)
    assert response.at(0.9) < 0.0
    assert response.trajectory.uplifts == response.uplifts.size


@every_engine
def test_rocked_sentence(name: str) -> None:
    """The sentence gives the largest rotation in degrees, its share of alpha, and the number of impacts."""
    response = let_go(name)
    count = response.impacts.size
    share = 0.15 / ALPHA
    expected = f"rocked but did not overturn: largest rotation 8.594 degrees, {share:.3g} of the slenderness angle, "
    assert response.summary == f"{expected}{count} impacts"
    assert repr(response).startswith(f"<Response: {expected}")
    assert f"[{name} (Taylor" in repr(response)


@every_engine
def test_overturned_before_an_impact(name: str) -> None:
    """A strong sine throws the block over to the left without an impact; the rotation ends at a quarter turn."""
    response = sine(4.0, name)
    assert (response.outcome, response.trajectory.side) == (Outcome.OVERTURNED, -1)
    start = "overturned to the left without an impact, past the point of no return at "
    assert response.summary == f"{start}{response.overturning_time:.4g} s"
    assert response.peak_rotation == 0.5 * math.pi
    assert abs(float(response.at(response.overturning_time))) == pytest.approx(ALPHA, rel=1e-9)
    assert response.impacts.size == 0
    assert np.isfinite(response.rotation).all()
    assert response.time.size == response.rotation.size < response.trajectory.rotation.size
    assert 1.3 < abs(response.rotation[-1]) < 1.8, "followed until it lies"


@pytest.mark.slow
@every_engine
def test_overturned_after_an_impact(name: str) -> None:
    """A weaker sine does it after one impact, to the other side; turned round it does so mirrored."""
    response, mirrored = sine(1.8, name), sine(1.8, name, scale=-1.0)
    assert response.summary.startswith("overturned to the right after 1 impact, past")
    assert mirrored.summary.startswith("overturned to the left after 1 impact, past")
    assert response.impacts.size == 1
    assert response.impacts["time"][0] < response.overturning_time
    np.testing.assert_array_equal(response.rotation, -mirrored.rotation)


@every_engine
def test_overturned_after_several_impacts(name: str) -> None:
    """Rocking of its own, then a throw: as many impacts in the sentence as in the table."""
    throw = rk.GroundMotion(np.concatenate([np.zeros(60), np.full(40, 12.0)]), 0.05)
    response = rk.simulate(BLOCK, throw, R, engine=name, rotation=0.15)
    count = response.impacts.size
    assert count > 1
    assert f"after {count} impacts, past the point of no return" in response.summary


@every_engine
def test_stopped(name: str) -> None:
    """A history that is stopped has no outcome, says why, and its samples end where it was stopped."""
    response = let_go(name, most_events=3)
    assert (response.outcome, response.status) == (Outcome.FAILED, Status.TOO_MANY_EVENTS)
    assert response.summary == "no result: stopped: more impacts and changes of contact than allowed"
    assert math.isnan(response.peak_rotation)
    assert response.impacts.size == 3
    assert response.time[-1] <= response.impacts["time"][-1]


@every_engine
def test_error_estimate(name: str) -> None:
    """Halving every step moves theta by less than 1e-10; where that changes the outcome it is infinite."""
    assert 0.0 <= let_go(name, duration=2.0).error_estimate < 1e-10


def test_error_estimate_of_another_outcome(monkeypatch: pytest.MonkeyPatch) -> None:
    """If the finer run overturns where this one stood, the estimate is infinite."""
    response, other = let_go(duration=2.0), sine(4.0)
    monkeypatch.setattr("rocking.dynamics.response.run", lambda *_, **__: other.trajectory)
    assert response.error_estimate == math.inf


def test_how_long_it_is_followed() -> None:
    """A response lasts as long as asked, else the motion and 15 / p after it; free rocking until it rests."""
    record = rk.GroundMotion(np.zeros(21), 0.1)
    assert rk.simulate(BLOCK, record, R).time[-1] == pytest.approx(2.0 + 15.0 / P, abs=0.1)
    assert rk.simulate(BLOCK, record, R, duration=0.55).time[-1] == pytest.approx(0.6, rel=1e-12, abs=0.0)
    assert rk.simulate(BLOCK, record, R, duration=5.0).time[-1] == pytest.approx(5.0, rel=1e-12, abs=0.0)
    vertical = rk.GroundMotion(np.zeros(21), 0.1, vertical=np.ones(21))
    assert rk.simulate(BLOCK, vertical, R, duration=0.55).segments.vertical is not None
    free = let_go()
    assert free.rotation[-1] == free.angular_velocity[-1] == 0.0
    assert free.rotation[-4:].any(), "and not longer"
    assert rk.free_rocking(BLOCK, 0.0, R).time.size == 3
    endless = rk.free_rocking(BLOCK, 0.1, 1.0)
    assert endless.time[-1] == pytest.approx(300.0 / P, rel=1e-3)


@pytest.mark.slow
@every_engine
def test_a_motion_that_was_cut_is_told(name: str) -> None:
    """A motion followed for 2 s only is said to be cut there, whatever came of it; a whole one is not."""
    record = rk.GroundMotion(np.concatenate([np.zeros(61), np.full(40, 12.0)]), 0.05)
    told = "; the motion was cut at 2 s, with ground at rest afterwards"
    for rotation, start in ((0.0, "stayed at rest"), (0.15, "rocked but did not overturn")):
        response = rk.simulate(BLOCK, record, R, engine=name, rotation=rotation, duration=2.0)
        assert response.summary.startswith(start)
        assert response.summary.removesuffix(f"; {response.unfinished}").endswith(told)
        assert told in repr(response)
        assert "cut" not in rk.simulate(BLOCK, record, R, engine=name, rotation=rotation, duration=5.0).summary
        assert "cut" not in rk.simulate(BLOCK, record, R, engine=name, rotation=rotation).summary
    short = sine(1.3, name, duration=0.5)
    assert f"cut at 0.5141 s, with ground at rest afterwards; {short.unfinished}" in short.summary
    assert "cut" not in let_go(name, duration=0.5).summary, "ground at rest stays so"
    lies = rk.simulate(BLOCK, record, R, engine=name, duration=4.9)
    assert lies.outcome is Outcome.OVERTURNED
    assert "cut" not in lies.summary, "it lay before"


@pytest.mark.slow
def test_the_same_question_to_the_full_equations() -> None:
    """Where contact is not lost, feet that do not slide give the same history: body, coefficients by side, scale,
    start and gravity are those asked for. The friction is 10 if none is given."""
    pulse = rk.pulses.sine(0.4 * g / 3.0, 2.0 * math.pi / (3.0 * P))
    response = rk.simulate(
        BLOCK, pulse, {"left": 0.85, "right": 0.8}, scale=-1.3, rotation=0.05, angular_velocity=0.1, gravity=0.9 * g
    )
    assert response.impacts.size > 5
    assert not response.lost_contact
    full = response.with_contact()
    assert (full.law.friction, full.law.restitution, full.law.bounce) == (10.0, (0.85, 0.8), 0.0)
    assert response.with_contact(0.7).law.friction == 0.7
    until = min(response.impacts["time"][5], full.trajectory.end)
    t = np.linspace(0.0, until, 200)
    np.testing.assert_allclose(full.at(t)[:, 2], response.at(t), rtol=0.0, atol=1e-7)
    assert full.trajectory.end == pytest.approx(response.time[-1], rel=1e-9)


BODY = rk.Block(width=0.5, height=2.0).with_feet(0.05, 0.5)
# a ground that goes to the left throws the body to the right: the half sine is far above what the block can bear
PUSH = rk.pulses.half_sine(30.0, 0.5)
FALLS = {1: -1.0, -1: 1.0}
"""Side to the factor on the pulse."""

STOOD = {
    "rocked": lambda: rk.free_rocking(BODY, 0.1, 0.9),
    "no uplift": lambda: rk.simulate(BODY, rk.pulses.sine(1.0, 0.5), "ked"),
    "stopped": lambda: rk.free_rocking(BODY, 0.1, 0.95, most_events=4, duration=3.0),
}


def fallen(side: int, engine: str = "auto") -> rk.Response:
    """Return a response that overturns to a side."""
    return rk.simulate(BODY, PUSH, "ked", scale=FALLS[side], engine=engine)


@pytest.mark.slow
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("side", FALLS)
def test_side_is_against_the_ground(side: int, engine: str) -> None:
    """A ground that starts to the left leaves the body behind on the right, and the other way round."""
    response = fallen(side, engine)
    assert response.outcome is rk.Outcome.OVERTURNED
    assert response.side == side
    assert isinstance(response.side, int)
    assert float(response.rotation[-1]) * side > 0.0
    facts = response.exported().provenance
    assert (facts["side"], facts["overturning_time"], facts["impacts"]) == (
        side, response.overturning_time, response.impacts.size,
    )  # fmt: skip


@pytest.mark.parametrize("kind", STOOD)
def test_no_side_without_a_fall(kind: str) -> None:
    """Negative control: what stays standing, rests or was stopped has the side 0, and no time of overturning."""
    response = STOOD[kind]()
    assert response.side == 0
    found = response.exported().provenance
    assert found["side"] == 0
    assert "overturning_time" not in found
    assert found["impacts"] == response.impacts.size


@pytest.mark.parametrize("side", FALLS)
def test_batches_say_the_same(side: int) -> None:
    """`simulate_many` has the same side under the same name."""
    pytest.importorskip("xarray")
    found = rk.simulate_many(BODY, PUSH, "ked", scale=FALLS[side])
    assert found["side"].item() == fallen(side).side
