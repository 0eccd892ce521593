"""Histories in space: laws, doors, outcomes, exports."""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.dynamics.rolling import ContactMode, SpatialBody, SpatialStart
from rocking.dynamics.rolling.impact_laws import law_of
from rocking.errors import InvalidValueError
from rocking.outcome import Outcome, Status

BOX = SpatialBody.box(1.0, 1.2, 4.0, density=2000.0)


@pytest.mark.slow
def test_under_little_gravity_it_rocks_slower():
    """Let go until it rests under a ten thousandth of g: as many impacts, a hundred times as late."""
    here, there = (rk.free_rocking(BOX, restitution=0.6, start=SpatialStart(0.1), gravity=9.8 * k) for k in (1.0, 1e-4))
    assert here.impacts.size == there.impacts.size > 3
    np.testing.assert_allclose(there.impacts["time"], 100.0 * here.impacts["time"], rtol=1e-9)
    assert there.trajectory.pieces[-1].contact.mode is ContactMode.REST


@pytest.mark.slow
def test_a_law_of_ones_own_serves():
    """An object with velocity_after and label: half of the projection leaves a quarter of its energy."""

    class Half:
        label = "half"

        def velocity_after(self, *args):
            return 0.5 * law_of("housner-3d").velocity_after(*args)

    whole = rk.free_rocking(BOX, restitution="housner", start=SpatialStart(0.1, 0.5), duration=1.0).impacts[0]
    half = rk.free_rocking(BOX, restitution=Half(), start=SpatialStart(0.1, 0.5), duration=1.0).impacts[0]
    assert half["energy_after"] == pytest.approx(0.25 * whole["energy_after"], rel=1e-12, abs=0.0)


@pytest.mark.slow
def test_a_body_that_is_pushed_over_says_where_and_over_what():
    """A strong pulse along y: overturned towards -y over the edge y = -0.6, number 0-1, at the time of the plane."""
    pulse = rk.pulses.half_sine(amplitude=8.0, period=1.2)
    run = rk.simulate(BOX, {"y": pulse}, "housner")
    plane = rk.simulate(rk.Block(width=1.2, height=4.0), pulse, "housner", engine="reference")
    assert run.outcome is Outcome.OVERTURNED
    assert run.overturning_direction == pytest.approx(-0.5 * math.pi, abs=1e-12)
    assert run.overturned_over == "edge 0-1"
    assert run.overturning_time == pytest.approx(plane.overturning_time, abs=1e-8)
    assert "towards -90 degrees over edge 0-1" in run.summary
    assert run.peak_tilt == plane.peak_rotation == 0.5 * math.pi  # it lies


def test_a_body_that_rests_stays_where_it_is():
    """Under a weak pulse: no uplift, no events, no energy; a body let go upright rests."""
    for run in (
        rk.simulate(BOX, rk.pulses.sine(amplitude=1.0, period=0.5), "housner"),
        rk.free_rocking(BOX, restitution="housner", duration=1.0),
    ):
        assert run.outcome is Outcome.NO_UPLIFT
        assert run.intervals == [(0.0, run.end, ContactMode.REST, (0, 1, 2, 3))]
        assert not run.energy.kinetic.any()
        assert not run.tilt.any()


@pytest.mark.parametrize(
    "bad",
    [
        {"start": SpatialStart(0.1), "rotation": 0.1},
        {"angular_velocity": (1.0, 2.0)},
        {"angular_velocity": (math.inf, 0.0, 0.0)},
        {"linear": True},
    ],
)
def test_bad_input_is_refused_at_the_door(bad):
    """What has no meaning in space is an InvalidValueError, never a number."""
    with pytest.raises(InvalidValueError):
        rk.free_rocking(BOX, **bad)


def test_a_motion_is_needed():
    """No component at all is refused with the name of the function that does without."""
    with pytest.raises(InvalidValueError, match="use free_rocking for ground at rest"):
        rk.simulate(BOX, {}, "housner")


def test_too_many_events_is_a_status():
    """A limit on events stops a history without a result."""
    run = rk.free_rocking(BOX, restitution="housner", start=SpatialStart(0.1, 0.4), most_events=3)
    assert (run.outcome, run.status) == (Outcome.FAILED, Status.TOO_MANY_EVENTS)
    assert math.isnan(run.peak_tilt)


def test_a_sticking_corner_that_would_need_a_pull_is_counted():
    """On an edge with a spin about the vertical the struck corner must be held: the impact shows the pull."""
    run = rk.free_rocking(
        BOX, restitution="housner", start=SpatialStart(0.1, 0.0, angular_velocity=(0.0, 0.0, 0.2)), duration=1.0
    )
    assert run.impacts["pull"].max() > 0.0
    assert "slipped" in run.summary
    assert run.energy.closure < 1e-9


def test_times_outside_are_refused():
    """States are known from the start to the end, and nowhere else."""
    run = rk.free_rocking(BOX, restitution="housner", start=SpatialStart(0.1), duration=1.0)
    with pytest.raises(InvalidValueError, match="the duration of the response"):
        run.at([0.5, 9.0])
    np.testing.assert_allclose(np.linalg.norm(run.quaternion, axis=1), 1.0, rtol=0.0, atol=1e-15)


def test_nothing_of_a_response_lies_beyond_its_end():
    """Thrown so that it overturns over the other edge, of the 0.02 s asked for only the first edge is told, and no
    impact, though the engine went on until the fate was known."""
    run = rk.free_rocking(
        BOX, restitution="housner", start=SpatialStart(0.1, angular_velocity=(0.0, -1.2, 0.0)), duration=0.02
    )
    assert run.outcome is Outcome.OVERTURNED
    assert run.trajectory.pieces[-1].end > run.overturning_time > run.end == 0.02
    assert run.intervals == [(0.0, 0.02, ContactMode.EDGE, (1, 2))]
    assert run.impacts.size == 0
    assert run.time[-1] <= 0.02


@pytest.mark.slow
def test_energy_closes_where_steps_hold_several_samples():
    """Under slow pulses the steps of a body that rocks are longer than its samples are apart, and the work is right at
    each of them."""
    pulse = rk.pulses.half_sine(amplitude=1.0, period=12.0)
    run = rk.simulate(
        BOX,
        {"x": pulse, "y": pulse.scaled(0.3), "z": pulse.scaled(-0.2)},
        "housner",
        start=SpatialStart(0.15, 0.3),
        duration=4.0,
    )
    starts = np.array([piece.start for piece in run.trajectory.pieces if piece.contact.mode is not ContactMode.REST])
    assert np.bincount(np.searchsorted(starts, run.time[run.time < 4.0], side="right"))[1:].max() > 2
    assert np.abs(run.energy.work).max() > 100.0
    assert run.energy.closure < 1e-9
