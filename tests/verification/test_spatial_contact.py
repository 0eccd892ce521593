"""What stays on the ground: gaps, pulls, complementarity, uplift, and the way over.

REF numbers: see CONTRIBUTING.md. With ROCKING_CAMPAIGN=1 the property tests draw ten
times as many examples.
"""

import math
import os

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import rocking as rk
from rocking import conventions
from rocking.dynamics import SpatialStart
from rocking.dynamics.rolling import (
    ContactMode,
    SpatialBody,
    event_functions,
)
from rocking.dynamics.rolling.complementarity import SpatialState, of_impact
from rocking.dynamics.rolling.impact_laws import law_of
from rocking.outcome import Outcome, Status
from rocking.restitution.space import spatial_models

pytestmark = pytest.mark.verifies(room="rocking in space")

TIMES = 10 if os.environ.get("ROCKING_CAMPAIGN") == "1" else 1
G = 9.81
UP = np.array([0.0, 0.0, 1.0])
TOWER = SpatialBody.box(1.0, 1.3, 4.0)
SQUARE = SpatialBody.box(1.0, 1.0, 4.0)
CYLINDER = SpatialBody.cylinder(0.5, 2.0)
ANGLE = st.floats(-math.pi, math.pi)
SPIN = st.tuples(st.floats(-0.3, 0.3), st.floats(-0.3, 0.3), st.floats(-0.4, 0.4))


@pytest.mark.slow
@pytest.mark.verifies(
    "invariant",
    "gaps, energy, and energy over impacts",
    within="1e-12 m; 1e-9",
    control="test_without_watching_the_neighbours_a_body_enters_the_ground",
)
@settings(max_examples=8 * TIMES)
@given(ANGLE, st.floats(0.01, 0.2), SPIN, st.sampled_from(sorted(spatial_models())))
def test_nothing_ever_enters_the_ground_and_energy_adds_up(azimuth, tilt, spin, law):
    """To rest or overturning, by every model: gaps >= -1e-12 m, the ledger closes, impacts create no energy."""
    run = rk.free_rocking(TOWER, restitution=law, start=SpatialStart(tilt, azimuth, angular_velocity=spin))
    assert run.status is Status.GOOD or run.outcome is Outcome.OVERTURNED
    fine = np.linspace(0.0, run.time[-1], 2000)
    assert run.at(fine).min_gap.min() >= -1e-12
    assert run.energy.closure < 1e-9
    assert (run.impacts["energy_after"] <= run.impacts["energy_before"] * (1.0 + 1e-12)).all()
    if run.outcome is Outcome.ROCKED:
        assert run.contact[-1] == ContactMode.REST.code


@pytest.mark.verifies("negative control", "no gaps watched")
def test_without_watching_the_neighbours_a_body_enters_the_ground(monkeypatch):
    """Negative control: with no gaps watched the same measure shows centimetres of penetration."""
    start = {"start": SpatialStart(0.1, 0.6), "duration": 2.0}
    assert rk.free_rocking(SQUARE, **start).states.min_gap.min() >= -1e-12
    monkeypatch.setattr(event_functions, "watched", lambda body, contact: ())
    assert rk.free_rocking(SQUARE, **start).states.min_gap.min() < -1e-2


@pytest.mark.verifies("negative control", "staying on the old corner, or on the edge")
def test_an_impact_without_complementarity_is_rejected():
    """Negative control: staying on the old corner, or on the edge, contradicts gaps or impulses."""
    omega = np.array([-0.6, 0.8, 0.0])
    omega *= -np.sign(np.cross(omega, SQUARE.vertices[1] - SQUARE.vertices[0])[2])
    state = SpatialState(SQUARE.vertices[0], omega, UP, -G * UP)
    (choice,) = of_impact(SQUARE, state, (0, 1), law_of("housner-3d"))
    assert choice.contact.points == (1,)
    leaves = np.cross(choice.velocity, SQUARE.vertices[0] - SQUARE.vertices[1])[2]
    assert leaves > 0.0 > np.cross(omega, SQUARE.vertices[1] - SQUARE.vertices[0])[2]


@pytest.mark.slow
@pytest.mark.verifies("closed form", "g b / h of the edge or rim", within="between 0.999 and 1.001 of it")
@pytest.mark.parametrize("direction", [0.0, 0.3, 0.25 * math.pi, 1.2])
def test_rest_ends_where_the_pressure_leaves_the_base(direction):
    """A steady push lifts a body just above, not just below, the static limit g b / h of its edge, or of its rim."""
    for body, reach in (
        (TOWER, min(0.5 / math.cos(direction), 0.65 / max(math.sin(direction), 1e-9))),
        (CYLINDER, 0.25),
    ):
        limit = conventions.g * reach / float(body.centre[2])
        for share, lifted in ((0.999, False), (1.001, True)):
            pulses = [
                rk.pulses.rectangular(amplitude=share * limit * c, duration=0.5) if abs(c) > 1e-12 else None
                for c in (math.cos(direction), math.sin(direction))
            ]
            run = rk.simulate(body, pulses, "housner", duration=0.4)
            assert (run.outcome is not Outcome.NO_UPLIFT) is lifted


@pytest.mark.verifies("behaviour")
def test_a_ground_that_falls_faster_than_the_body_is_said_so():
    """Downwards with 2 g the contact is lost: a status, no number for the peak; with 0.9 g the body just stands."""
    drop = rk.pulses.rectangular(amplitude=-2.0 * conventions.g, duration=0.2)
    run = rk.simulate(SQUARE, {"z": drop}, "housner")
    assert (run.outcome, run.status) == (Outcome.FAILED, Status.LOST_CONTACT)
    assert math.isnan(run.peak_tilt)
    assert rk.simulate(SQUARE, {"z": drop.scaled(0.45)}, "housner").outcome is Outcome.NO_UPLIFT


@pytest.mark.slow
@pytest.mark.verifies("closed form", "the opposite direction", within="1e-6 rad")
@pytest.mark.parametrize("direction", [0.0, 1.0, 2.5, -2.0])
def test_a_strong_pulse_overturns_a_round_body_against_its_direction(direction):
    """A push of the ground towards phi throws a cylinder towards phi + 180 degrees, to 1e-6."""
    pulses = [rk.pulses.half_sine(amplitude=9.0 * c, period=1.2) for c in (math.cos(direction), math.sin(direction))]
    run = rk.simulate(CYLINDER, pulses, "housner")
    assert run.outcome is Outcome.OVERTURNED
    wrapped = (run.overturning_direction - direction) % (2.0 * math.pi) - math.pi
    assert wrapped == pytest.approx(0.0, abs=1e-6)
    assert run.overturned_over == "its rim"


@pytest.mark.slow
@pytest.mark.verifies(
    "computed anew", "the centre of pressure, by differences", within="2e-3 of the edge", control="within"
)
def test_an_edge_becomes_a_vertex_where_the_reaction_reaches_its_end():
    """A push along the edge: the centre of pressure, by differences, is at the end just before."""
    corners = 0.5 * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    body = SpatialBody(1000.0, np.array([0.1, 0.1, 2.0]), np.diag([1400.0, 1400.0, 170.0]), corners)
    along = rk.GroundMotion(np.concatenate([np.zeros(20), np.linspace(0.0, 4.5, 30), np.zeros(5)]), 0.01)
    run = rk.simulate(body, {"x": rk.pulses.half_sine(amplitude=3.5, period=1.2), "y": along}, "housner", gravity=G)
    start, end, contact, ends = run.intervals[1]
    assert (contact, ends, run.intervals[2][2:]) == (ContactMode.EDGE, (3, 0), (ContactMode.VERTEX, (0,)))
    assert run.trajectory.held == 0.0

    def pressure(time):
        """Distance of the centre of pressure from the end that stays, over the length of the edge."""
        h = 1e-4
        states = run.at([time - h, time, time + h])
        velocity, rotation = states.centre_velocity, states.rotation
        spin = np.einsum("nab,bc,nc->na", rotation, body.inertia, states.body_velocity)
        force = body.mass * ((velocity[2] - velocity[0]) / (2.0 * h) + run.ground.at(np.array([time]))[0] + G * UP)
        arm = states.point(body.centre)[1] - states.point(body.vertices[0])[1]
        moment = (spin[2] - spin[0]) / (2.0 * h) + np.cross(arm, force)
        direction = states.point(body.vertices[3])[1] - states.point(body.vertices[0])[1]
        return np.cross(UP, moment) @ direction / force[2]

    assert pressure(end - 2e-4) == pytest.approx(0.0, abs=2e-3)  # 2e-4 s before the change
    assert pressure(0.5 * (start + end)) > 0.1
