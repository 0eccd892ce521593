"""Bodies in space under plane motion against the plane engine and closed forms.

REF numbers: see CONTRIBUTING.md.
"""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.dynamics import SpatialStart
from rocking.dynamics.rolling import (
    ContactMode,
    SpatialBody,
)
from rocking.dynamics.rolling.complementarity import SpatialState, of_impact
from rocking.dynamics.rolling.impact_laws import law_of

pytestmark = pytest.mark.verifies(room="rocking in space")

G = 9.81
UP = np.array([0.0, 0.0, 1.0])
ALPHA = math.atan(0.25)
TOWER = SpatialBody.box(1.0, 1.3, 4.0)
PLANE = {
    "ked-3d": "ked",
    "ked-3d-point": "ked",
    "housner-3d": "housner",
    "horizontal-momentum-3d": "horizontal-momentum",
    "calibrated-3d": "calibrated",
    0.9: 0.9,
}


def _signed(states, axis):
    """Rotation of a plane motion: lean towards x (0) or y (1) over the vertical."""
    rotation = states.rotation
    return np.arctan2(rotation[:, axis, 2], rotation[:, 2, 2])


@pytest.mark.slow
@pytest.mark.verifies("second engine", "the reference engine of the plane", within="1e-10", control="within")
@pytest.mark.parametrize(("model", "plane"), PLANE.items())
@pytest.mark.parametrize("axis", [0, 1])
def test_free_rocking_in_a_plane_is_that_of_the_plane(axis, model, plane):
    """A box let go about an edge: rotation over eight impacts and their times are those of the plane model to 1e-10."""
    block = rk.Block(width=(1.0, 1.3)[axis], height=4.0)
    angle = 0.5 * block.slenderness_angle
    expected = rk.free_rocking(block, angle, plane, engine="reference", duration=8.0)
    space = rk.free_rocking(TOWER, restitution=model, start=SpatialStart(angle, 0.5 * math.pi * axis), duration=8.0)
    time = np.linspace(0.0, 8.0, 201)
    np.testing.assert_allclose(_signed(space.at(time), axis), expected.at(time), rtol=0.0, atol=1e-10)
    np.testing.assert_allclose(space.impacts["time"][:8], expected.impacts["time"][:8], rtol=0.0, atol=1e-10)
    # negative control: another coefficient's impacts come at other times
    other = rk.free_rocking(block, angle, 0.91, engine="reference", duration=8.0)
    assert np.abs(other.impacts["time"][1:5] - space.impacts["time"][1:5]).max() > 1e-2


@pytest.mark.slow
@pytest.mark.verifies("second engine", "the reference engine of the plane", within="1e-10")
@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("amplitude", [3.4, 4.0, -4.2])
def test_a_sine_pulse_in_a_plane_is_the_plane_solution(axis, amplitude):
    """Uplift, impacts, peak and outcome under a sine pulse are those of the plane engine to 1e-10."""
    block, pulse = rk.Block(width=(1.0, 1.3)[axis], height=4.0), rk.pulses.sine(amplitude=amplitude, period=1.0)
    plane = rk.simulate(block, pulse, "housner", engine="reference", duration=5.0, rest_speed=1e-6)
    space = rk.simulate(TOWER, {"xy"[axis]: pulse}, "housner", duration=5.0)
    assert space.outcome is plane.outcome
    time = plane.time[(plane.time < 5.0) & ~(plane.time > plane.overturning_time) & (plane.time < space.time[-1])]
    np.testing.assert_allclose(_signed(space.at(time), axis), plane.at(time), rtol=0.0, atol=1e-10)
    if plane.outcome is rk.Outcome.ROCKED:
        assert space.peak_tilt == pytest.approx(plane.peak_rotation, abs=1e-10)
    else:
        assert space.overturning_time == pytest.approx(plane.overturning_time, abs=1e-8)
        assert abs(space.overturning_direction) == pytest.approx(
            (0.0 if plane.trajectory.side > 0 else math.pi) if axis == 0 else 0.5 * math.pi, abs=1e-9
        )


@pytest.mark.slow
@pytest.mark.verifies("second engine", "the reference engine of the plane", within="1e-9")
def test_a_record_with_a_vertical_part_is_the_plane_solution():
    """Two components of a record, straight lines between samples, through twelve impacts: 1e-9."""
    time = np.arange(300) * 0.02
    along = 2.6 * np.sin(5.0 * time) * np.exp(-0.2 * time) + 0.9 * np.sin(23.0 * time)
    up = 1.5 * np.sin(17.0 * time)
    plane = rk.simulate(
        rk.Block(width=1.0, height=4.0), rk.GroundMotion(along, 0.02, up), "housner", engine="reference"
    )
    space = rk.simulate(TOWER, {"x": rk.GroundMotion(along, 0.02), "z": rk.GroundMotion(up, 0.02)}, "housner")
    count = 12
    np.testing.assert_allclose(space.impacts["time"][:count], plane.impacts["time"][:count], rtol=0.0, atol=1e-9)
    until = plane.impacts["time"][count]
    time = plane.time[plane.time < until]
    np.testing.assert_allclose(_signed(space.states, 0)[: time.size], plane.rotation[: time.size], rtol=0.0, atol=1e-9)
    assert space.energy.closure < 1e-9


# theta_0 / alpha: full period of the exact equations
@pytest.mark.verifies("closed form", "elliptic integral", within="1e-10 s; 1e-9 s next to the top")
@pytest.mark.parametrize(
    ("share", "period"),
    [(0.1, 0.9932837337787516), (0.5, 2.79337281563169), (0.9, 6.340566423733241), (0.999, 16.0963990677361)],
)
def test_the_period_about_an_edge_is_the_elliptic_integral(share, period):
    """A quarter of the exact period to the first impact, REF, to 1e-10."""
    found = rk.free_rocking(
        TOWER, restitution="housner", start=SpatialStart(share * ALPHA), gravity=G, duration=0.3 * period
    )
    assert 4.0 * found.impacts["time"][0] == pytest.approx(period, abs=1e-9 if share > 0.99 else 1e-10)
    assert found.intervals[0][2] is ContactMode.EDGE


@pytest.mark.verifies("closed form", "h/b = 1 / sqrt 2", within="between 0.70 and 0.715")
def test_a_slender_body_goes_on_and_a_squat_one_stops():
    """Complementarity finds the limit 1 / sqrt 2 of slenderness: below it both edges push and the body stops."""
    for ratio, contact in ((0.70, ContactMode.REST), (0.715, ContactMode.EDGE)):
        body = SpatialBody.box(1.0, 1.0, ratio)
        state = SpatialState(body.vertices[0], -body.edges[0], UP, -G * UP)
        (choice,) = of_impact(body, state, (0, 1, 2, 3), law_of("housner-3d"))
        assert choice.contact.mode is contact
        assert choice.supports.min() > 0.0
