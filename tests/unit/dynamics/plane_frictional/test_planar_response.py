"""The planar response at its doors: refusals, outcomes, exports, forces, positions between samples."""

import math
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import rocking as rk
from rocking.dynamics import ContactSettings, SpeedRestitution, simulate
from rocking.dynamics.plane_frictional import (
    GroundContact,
    Regime,
    Start,
    friction_demand,
    regime_at_start,
)
from rocking.dynamics.plane_frictional.base import Mode, PlaneBase
from rocking.dynamics.plane_frictional.engine import ContactEngine
from rocking.dynamics.plane_frictional.history import History
from rocking.errors import InvalidValueError
from rocking.motions import GroundMotion, Segments
from rocking.outcome import Outcome, Status

pytestmark = pytest.mark.verifies(room="sliding, hopping and flight")

G = 9.80665
BODY = rk.Block(width=1.0, height=2.0)


@pytest.fixture(scope="module")
def rocked():
    """Sliding, rocking and impacts under a sine pulse."""
    return rk.simulate(rk.Block(width=1.2, height=2.0), rk.pulses.sine(amplitude=9.0, period=0.9), None, friction=0.62)


def test_of_two_changes_at_one_time_the_last_counts():
    """A mode of no duration leaves nothing behind, and one that returns at once has not ended."""
    log, stands, rocks, slides = History(1, G), Mode((-1, 1)), Mode((1,)), Mode((1,), 1)
    for time, mode in ((0.0, stands), (0.5, rocks), (0.5, slides), (0.7, rocks), (0.7, slides)):
        log.change(time, mode)
    assert log.changes == [(0.0, stands), (0.5, slides)]


@pytest.mark.slow
def test_outcomes_of_five_bodies(rocked):
    """Rest, sliding, rocking, both, overturning: each has its sentence, with "overturned" only where it did."""
    pulse = rk.pulses.rectangular(4.0, 0.5)
    found = [
        rk.simulate(BODY, rk.pulses.rectangular(1.0, 0.5), None, friction=0.5),
        rk.simulate(BODY, pulse, None, friction=0.3),
        rk.simulate(BODY, rk.pulses.rectangular(6.0, 0.1), None, friction=1.0),
        rocked,
        rk.simulate(rk.Block(width=0.2, height=2.0), pulse, None, friction=0.6),
    ]
    expected = [
        Outcome.NO_UPLIFT,
        Outcome.SLID,
        Outcome.ROCKED,
        Outcome.ROCKED_AND_SLID,
        Outcome.OVERTURNED,
    ]
    assert [response.outcome for response in found] == expected
    assert ["overturned" in response.summary for response in found] == [False, False, False, False, True]
    assert found[-1].overturning_time > 0.0
    assert found[-1].peak_rotation == pytest.approx(0.5 * math.pi, rel=1e-12, abs=0.0)
    assert math.isnan(rocked.overturning_time)
    assert "slid" in repr(rocked)


@pytest.mark.slow
def test_body_that_rests_is_only_looked_up():
    """A minute of ground that never moves the body: no sample moves, and the forces are its weight."""
    motion = GroundMotion(np.full(6001, 0.5), 0.01)
    response = rk.simulate(BODY, motion, None, friction=0.4)
    assert not response.rotation.any()
    assert not response.displacement.any()
    assert response.forces.vertical[100] == pytest.approx(BODY.mass * G, rel=1e-14, abs=0.0)
    # moments: the left foot carries m (g b + a h) / (2 b)
    assert response.forces.left[100] == pytest.approx(BODY.mass * (G * 0.5 + 0.5 * 1.0) / 1.0, rel=1e-13, abs=0.0)
    assert response.friction_usage == pytest.approx(0.5 / G / 0.4, rel=1e-12, abs=0.0)


def test_regimes_follow_without_gaps(rocked):
    """Every interval starts where the last one ended, from 0 to the end; sliding adds up to the path."""
    regimes = rocked.regimes
    assert regimes["start"][0] == 0.0
    assert np.array_equal(regimes["start"][1:], regimes["end"][:-1])
    assert np.abs(regimes["distance"]).sum() == pytest.approx(rocked.sliding_distance, rel=1e-9)
    assert np.all(np.sign(regimes["distance"]) == regimes["slip"])


def test_positions_between_samples(rocked):
    """At the samples `at` is the samples; between them velocities are their differences, to second order."""
    place = rocked.at(rocked.time)
    assert np.allclose(place[:, 2], rocked.rotation, rtol=0.0, atol=1e-14)
    assert np.allclose(place[:, 0], rocked.displacement, rtol=0.0, atol=1e-14)
    step = 1e-5
    k = int(np.argmax(rocked.regime == Regime.ROCK.code)) + 2
    around = rocked.at(rocked.time[k] + np.array([-step, step]))
    assert (around[1, 2] - around[0, 2]) / (2.0 * step) == pytest.approx(rocked.angular_velocity[k], rel=1e-6)


def test_impacts_have_impulses_that_press(rocked):
    """Vertical impulses are never negative, friction stays within its cone, losses are positive."""
    impacts = rocked.impacts
    assert impacts.size > 2
    for foot in ("left", "right"):
        assert np.all(impacts[f"normal_{foot}"] >= 0.0)
        assert np.all(np.abs(impacts[f"tangential_{foot}"]) <= 0.62 * impacts[f"normal_{foot}"] * (1.0 + 1e-9) + 1e-12)
    assert np.all(impacts["energy_lost"] > 0.0)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"rest_speed": 0.0}, "rest_speed must be in"),
        ({"order": 8}, "order does not apply to a plane body with friction"),
        ({"restitution": SpeedRestitution((0.0, 1.0), (1.0, 0.9))}, "got SpeedRestitution"),
    ],
)
def test_bad_input_is_refused(options, words):
    """Each refusal names the value and its range."""
    given = {"body": BODY, "motion": rk.pulses.rectangular(4.0, 0.5), "friction": 0.3, "restitution": None, **options}
    with pytest.raises(InvalidValueError, match=words):
        rk.simulate(**given)


@pytest.mark.parametrize(
    "wrong", [{"rotation": 2.0}, {"height": -0.1}, {"vertical_velocity": math.nan}, {"angular_velocity": math.inf}]
)
def test_bad_starts_are_refused(wrong):
    """Beyond a quarter turn, under the ground, not finite."""
    with pytest.raises(InvalidValueError, match=next(iter(wrong))):
        Start(**wrong)


def test_settings_are_frozen_values():
    """Defaults pass their own checks."""
    assert ContactSettings().rest_speed == 1e-7
    assert GroundContact(0.5) == GroundContact(0.5, 0.0, None)


def test_too_many_events_are_a_status():
    """A history that is cut by its limit has no result."""
    response = rk.free_rocking(
        BODY, restitution=None, friction=0.5, normal_restitution=0.9, start=Start(height=0.1), most_events=5
    )
    assert response.status is Status.TOO_MANY_EVENTS
    assert response.outcome is Outcome.FAILED
    assert "no result" in response.summary


def test_start_with_a_foot_that_hits_the_ground():
    """A body that starts flat and turning rocks; one thrown down on its base stops at once."""
    turning = rk.free_rocking(BODY, restitution=None, friction=1.0, start=Start(angular_velocity=0.5), duration=0.1)
    assert turning.rotation[-1] > 0.0
    assert turning.impacts.size == 0
    thrown = rk.free_rocking(BODY, restitution=None, friction=1.0, start=Start(vertical_velocity=-1.0), duration=0.1)
    assert thrown.impacts.size == 1
    assert thrown.energy.lost_in_impacts[-1] == pytest.approx(0.5 * BODY.mass, rel=1e-14, abs=0.0)


@pytest.mark.slow
def test_scale_is_a_factor_on_the_motion():
    """Half of 8 m/s2 is 4 m/s2, bitwise."""
    one = rk.simulate(BODY, rk.pulses.rectangular(8.0, 0.2), None, friction=0.3, scale=0.5)
    other = rk.simulate(BODY, rk.pulses.rectangular(4.0, 0.2), None, friction=0.3)
    assert np.array_equal(one.displacement, other.displacement)


@pytest.mark.slow
def test_long_steps_are_cut_where_series_need_it():
    """Straight lines of 2 s sampled at 2 s and at 0.02 s are one motion: rotations agree to 1e-11 rad."""
    coarse = GroundMotion([0.0, 7.0, -6.0, 0.0], 2.0)
    fine = GroundMotion(np.interp(np.arange(301) * 0.02, [0.0, 2.0, 4.0, 6.0], [0.0, 7.0, -6.0, 0.0]), 0.02)
    long, short = (
        rk.simulate(rk.Block(width=2.2, height=3.0), m, None, friction=0.66, duration=3.0) for m in (coarse, fine)
    )
    times = np.linspace(0.0, 3.0, 50)
    assert "SLIDE" in long.regimes["regime"]
    assert np.max(np.abs(long.at(times) - short.at(times))) < 1e-11


@pytest.mark.slow
def test_paradox_at_the_start_is_a_shock():
    """Without a contact force at time zero the foot is struck without an approach, and loses energy."""
    response = rk.free_rocking(BODY, restitution=None, friction=2.5, start=Start(rotation=0.1, horizontal_velocity=1.0))
    assert response.status is Status.GOOD
    assert response.trajectory.shocks >= 1
    assert response.impacts["time"][0] == 0.0
    assert response.impacts["energy_lost"][0] > 0.0
    assert response.energy.closure < 1e-10


def test_numbers_that_run_out():
    """Where the series of a motion are no longer finite the history has failed, and not for want of a contact force."""
    base, law = PlaneBase.of_body(BODY), GroundContact(0.6)
    for push in ([0.0, 1e200, 1e200], [0.0, 1e305, -1e305]):
        with np.errstate(all="ignore"):
            found = ContactEngine(base, Segments.between_samples(1e80, np.array(push)), law, ContactSettings()).run()
        assert found.status is Status.NOT_FINITE


def test_map_refuses_what_has_no_answer():
    """A push that does not lift has no friction demand; negative friction and gravity are refused."""
    with pytest.raises(InvalidValueError, match="acceleration must be at least"):
        friction_demand(BODY, 0.4)
    with pytest.raises(InvalidValueError, match="friction must be in"):
        regime_at_start(BODY, 0.4, -0.1)
    with pytest.raises(InvalidValueError, match="gravity must be"):
        regime_at_start(BODY, 0.4, 0.1, gravity=0.0)


@pytest.mark.slow
@pytest.mark.verifies("invariant", "balance of energy, gaps and forces", within="1e-10; 1e-11 m; 1e-9 of the weight")
@settings(max_examples=15)
@given(
    width=st.floats(0.3, 3.0),
    friction=st.sampled_from([0.0, 0.05, 0.2, 0.4, 0.7, 1.0]),
    normal_restitution=st.sampled_from([0.0, 0.2, 0.5]),
    amplitude=st.floats(1.0, 12.0),
    period=st.floats(0.3, 1.5),
    restitution=st.sampled_from([None, "ked", "plastic-winkler"]),
)
def test_any_history_keeps_its_books_and_stays_above_the_ground(
    width, friction, normal_restitution, amplitude, period, restitution
):
    """Random bodies and pulses: a result, energy closed to 1e-10, feet never under the ground, forces that press."""
    body = rk.Block(width=width, height=2.0)
    pulse = rk.pulses.sine(amplitude=amplitude, period=period)
    response = rk.simulate(
        body, pulse, restitution, friction=friction, normal_restitution=normal_restitution, duration=period + 1.0
    )
    assert response.status is Status.GOOD
    assert response.energy.closure < 1e-10
    for lever in (-0.5 * width, 0.5 * width):
        gap = response.rise + 1.0 - lever * np.sin(response.rotation) - np.cos(response.rotation)
        assert gap.min() > -1e-11
    assert min(response.forces.left.min(), response.forces.right.min()) >= -1e-9 * body.mass * G


def test_summary_tells_the_largest_rotation_in_degrees(rocked):
    """Of a body that stands, beside how far it slid; a body that was only pushed along has not rotated."""
    told = re.search(r"largest rotation (\S+) degrees, total sliding distance (\S+) m", rocked.summary)
    largest = math.degrees(np.abs(rocked.rotation).max())
    assert [float(each) for each in told.groups()] == pytest.approx([largest, rocked.sliding_distance], rel=5e-3)
    assert "rotation" not in rk.simulate(BODY, rk.pulses.rectangular(4.0, 0.5), None, friction=0.3).summary


@pytest.mark.slow
def test_response_goes_on_as_long_as_its_docstring_says():
    """15 sqrt(R / g) after a motion and 60 on ground at rest, to a step of at most a tenth; as long as asked for; and
    a duration far below a step is one step."""
    slow = math.sqrt(math.hypot(0.5, 1.0) / G)
    after = rk.simulate(BODY, rk.pulses.rectangular(1.0, 0.5), None, friction=0.5)
    alone = rk.free_rocking(BODY, restitution=None, friction=0.5)
    assert 0.0 <= after.time[-1] - (0.5 + 15.0 * slow) < after.time[1] <= 0.1 * slow
    assert alone.time[-1] == pytest.approx(60.0 * slow, rel=1e-12, abs=0.0)
    assert alone.time[1] <= 0.1 * slow * (1.0 + 1e-12)
    record = GroundMotion(np.full(50, 0.5), 0.01)
    assert rk.simulate(BODY, record, None, friction=0.4, duration=0.2).time[-1] == pytest.approx(
        0.2, rel=1e-12, abs=0.0
    )
    assert rk.simulate(BODY, record, None, friction=0.4, duration=1e-13).time.tolist() == [0.0, 0.01]


def test_a_single_event_is_the_least_limit():
    """A body that rests has none, and may be held to one."""
    assert rk.simulate(BODY, rk.pulses.rectangular(1.0, 0.5), None, friction=0.5, most_events=1).status is Status.GOOD


@pytest.mark.parametrize("push", [1e-16, 1e-13])
def test_without_friction_any_push_uses_all_of_it(push):
    """A push of rounding size moves nothing, and all the friction there is, none, is used: 1, not more."""
    response = rk.simulate(BODY, GroundMotion(np.full(20, push), 0.01), None, friction=0.0, duration=0.2)
    assert response.outcome is Outcome.NO_UPLIFT
    assert response.friction_usage == 1.0


@pytest.mark.parametrize("rotation", [1.2, -1.2])
def test_dropped_without_turning_beyond_balance(rotation):
    """A body that falls without turning, its centre beyond the lower foot, was over from the start."""
    response = rk.free_rocking(BODY, restitution=None, friction=0.5, start=Start(rotation=rotation, height=1.0))
    assert response.outcome is Outcome.OVERTURNED
    assert response.overturning_time == 0.0


def test_forces_of_a_body_that_rests_follow_the_motion():
    """Under a record that moves nothing, at each sample m a along the ground and m (g + a_z) across it, the left foot
    with m ((g + a_z) b + a h) / (2 b)."""
    time = np.arange(60) * 0.02
    push, lift = 1.5 * np.sin(9.0 * time), 0.8 * np.cos(7.0 * time)
    response = rk.simulate(BODY, GroundMotion(push, 0.02, vertical=lift), None, friction=0.6, duration=1.0)
    assert response.outcome is Outcome.NO_UPLIFT
    count = len(response.time)
    assert count == 51
    weight = BODY.mass * (G + lift[:count])
    np.testing.assert_allclose(response.forces.horizontal, BODY.mass * push[:count], rtol=0.0, atol=1e-9 * BODY.mass)
    np.testing.assert_allclose(response.forces.vertical, weight, rtol=1e-12)
    np.testing.assert_allclose(response.forces.left, 0.5 * weight + BODY.mass * push[:count], rtol=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_an_asymmetric_body_passes_its_own_feet(side):
    """Without sliding the instant over the foot is that of pure rocking, over the nearer foot and over the further one.

    The former way, a line between the ends of a step, was .1 and .5 ms off.
    """
    body, push = rk.Block(width=1.0, height=3.0).with_feet(0.15, 0.8), rk.pulses.rectangular(5.0 * side, 1.0)
    found = rk.simulate(body, push, 0.6, friction=20.0)
    assert found.overturning_time == pytest.approx(simulate(body, push, 0.6).overturning_time, abs=1e-11)
