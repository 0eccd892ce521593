"""Forces and energy of bodies that fall or lie inside a step, or beyond the top at the start, and of long steps."""

import math
from typing import Any

import numpy as np
import pytest
from engines import every_engine

import rocking as rk
from rocking.conventions import g
from rocking.errors import InvalidValueError

BLOCK = rk.Block(width=0.5, height=2.0)
MASS, RADIUS, ALPHA, B = 2400.0, math.hypot(0.25, 1.0), math.atan(0.25), 0.25
TO_TOP = MASS * g * RADIUS * (1.0 - math.cos(ALPHA))
PUSH = 200.0
SLOW = rk.GroundMotion(np.array([0.0, 4.0, -1.0, 0.5, 0.0]), 0.6)


@pytest.mark.slow
@every_engine
@pytest.mark.parametrize("share", [1.2, -1.2])
@pytest.mark.parametrize("linear", [False, True])
def test_let_go_beyond_the_top(name: str, share: float, linear: bool) -> None:
    """Its forces at the start count: f_x = -s m 3/4 g sin cos, f_z = m (g - 3/4 g sin^2) of alpha - |theta|."""
    response = rk.free_rocking(BLOCK, share * ALPHA, engine=name, linear=linear)
    psi = -0.2 * ALPHA
    slope = psi if linear else math.sin(psi)
    f_x = -math.copysign(MASS, share) * 0.75 * g * slope * math.cos(psi)
    f_z = MASS * (g - 0.75 * g * slope * math.sin(psi))
    contact = response.contact
    assert contact.horizontal[0] == pytest.approx(f_x, rel=1e-12, abs=0.0)
    assert contact.least_vertical == pytest.approx(f_z, rel=1e-12, abs=0.0)
    assert contact.friction_demand == pytest.approx(abs(f_x / f_z), rel=1e-12, abs=0.0)
    assert response.energy.time.size == response.time.size > 10
    assert response.energy.closure < 1e-10


@pytest.mark.filterwarnings("ignore::rocking.errors.PureRockingWarning")
@every_engine
def test_lies_within_the_first_step(name: str) -> None:
    """A constant push does the work m a b up to the top; there f_x = m a / 4, f_z = m g - m R theta'^2."""
    response = rk.simulate(BLOCK, rk.GroundMotion(np.array([-PUSH] * 3 + [0.0, 0.0]), 1.0), engine=name)
    assert response.time.tolist() == [0.0]
    energy, contact = response.energy, response.contact
    work = MASS * PUSH * B
    assert energy.time.tolist() == contact.time.tolist() == [0.0, response.overturning_time]
    assert energy.work.tolist() == pytest.approx([0.0, work], rel=1e-8)
    assert energy.potential.tolist() == pytest.approx([0.0, TO_TOP], rel=1e-8)
    assert energy.closure < 1e-10
    centrifugal = 1.5 * (work - TO_TOP) / RADIUS  # of m R^2 4/3
    # both engines find the time of the fall to 1e-10
    assert contact.horizontal[1] == pytest.approx(-0.25 * MASS * PUSH, rel=1e-8)
    assert contact.vertical[1] == pytest.approx(MASS * g - centrifugal, rel=1e-8)
    assert contact.least_vertical == pytest.approx(contact.vertical[1], rel=1e-12, abs=0.0)
    assert contact.loses_contact
    assert response.at(response.overturning_time) == pytest.approx(ALPHA, rel=1e-8)
    assert response.at(response.dense_output.end[-1]) > 0.5 * math.pi
    with pytest.raises(InvalidValueError, match="the duration of the response"):
        response.at(1.0)


@pytest.mark.slow
@every_engine
def test_beyond_the_top_and_lying_within_the_first_step(name: str) -> None:
    """Let go beyond the top and lying before the second sample, only the start counts, and nothing is invented."""
    response = rk.simulate(BLOCK, rk.GroundMotion(np.array([0.0, 0.0]), 20.0), engine=name, rotation=1.2 * ALPHA)
    whole = MASS * g * RADIUS * (math.cos(0.2 * ALPHA) - math.cos(ALPHA))
    assert response.overturning_time == 0.0
    assert response.energy.potential[0] == pytest.approx(whole, rel=1e-12, abs=0.0)
    assert response.contact.friction_demand < 0.05


@pytest.mark.filterwarnings("ignore::rocking.errors.PureRockingWarning")
@every_engine
def test_a_fall_inside_a_step_counts(name: str) -> None:
    """Lifted by a ramp and thrown over within the same step: at the top f_x = m a / 4, and a warning is given.

    Control: up to the uplift the friction taken is b / h = 0.25, and no warning would be due.
    """
    response = rk.simulate(BLOCK, rk.GroundMotion(np.array([0.0, PUSH, PUSH, 0.0, 0.0]), 1.0), engine=name)
    contact, fall = response.contact, response.overturning_time
    assert 0.0 < response.uplifts[0] < fall < 1.0
    assert contact.time[-1] == fall
    assert contact.horizontal[-1] == pytest.approx(0.25 * MASS * PUSH * fall, rel=1e-8)
    centrifugal = 1.5 * response.energy.kinetic[-1] / RADIUS
    assert contact.vertical[-1] == pytest.approx(MASS * g - centrifugal, rel=1e-8)
    assert contact.least_vertical <= contact.vertical[-1] < 0.0
    assert contact.friction_of_motion > 0.25
    assert "the body would leave the ground" in contact.warnings()[0]
    assert response.energy.closure < 1e-9


@pytest.mark.slow
@every_engine
@pytest.mark.parametrize(("scale", "falls"), [(1.5, True), (1.0, False)])
def test_long_steps(name: str, scale: float, falls: bool) -> None:
    """One motion in steps of 0.6 s and of 0.006 s: the same rotation at any time, the same extremes of the forces."""
    restitution: Any = 0.8
    coarse = rk.simulate(BLOCK, SLOW, restitution, engine=name, scale=scale)
    fine = rk.simulate(BLOCK, rk.motions.resampled(SLOW, 0.006), restitution, engine=name, scale=scale)
    assert math.isfinite(coarse.overturning_time) is falls
    t = np.linspace(0.0, min(coarse.time[-1], fine.time[-1], 2.0), 300)
    np.testing.assert_allclose(coarse.at(t), fine.at(t), rtol=0.0, atol=1e-7)
    one, other = coarse.contact, fine.contact
    # between the places where forces are known they are not looked for: 1 % of the weight, 2 % of the friction
    assert one.least_vertical == pytest.approx(other.least_vertical, abs=0.01 * MASS * g)
    assert one.friction_of_motion == pytest.approx(other.friction_of_motion, rel=0.02)
    assert coarse.energy.closure < 1e-8


@every_engine
def test_after_rest_in_one_step(name: str) -> None:
    """Thrown over after rest, with samples on both sides of the top: the fall counts though a sample comes later."""
    ramp = rk.GroundMotion(np.array([0.0, 6.0, 6.0, 6.0, 6.0]), 0.3)
    response = rk.simulate(BLOCK, ramp, 0.8, engine=name)
    fall = response.overturning_time
    assert response.time[-1] > fall
    assert response.contact.time.size == response.time.size
    before = response.dense_output.end <= fall * (1.0 + 1e-12)
    assert response.dense_output.end[before][-1] == pytest.approx(fall, rel=1e-12, abs=0.0)
    assert abs(float(response.at(fall))) == pytest.approx(ALPHA, rel=1e-8)


def test_stopped_before_anything_happened() -> None:
    """A history that is stopped at its very start has no energy and no forces, and the error says why."""
    response = rk.free_rocking(BLOCK, 1e-20, angular_velocity=-0.1, most_events=1, duration=1.0)
    for what in ("energy", "contact"):
        with pytest.raises(InvalidValueError, match="no response at any time above 0 s: stopped: more impacts"):
            getattr(response, what)


@pytest.mark.slow
@every_engine
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_thrown_back_within_a_long_step(name: str, sign: float) -> None:
    """From 0.8 alpha and thrown inwards, slender-linear, alpha - |theta| is u cosh pt + u' / p sinh pt up to the impact
    at any time between two samples 0.5 s apart."""
    p, speed = BLOCK.frequency_parameter, 0.4
    still = rk.GroundMotion(np.zeros(9), 0.5)
    response = rk.simulate(
        BLOCK, still, 0.5, engine=name, linear=True, rotation=sign * 0.8 * ALPHA, angular_velocity=-sign * speed
    )
    lands = response.impacts["time"][0]
    t = np.linspace(0.0, lands, 40)
    u = 0.2 * ALPHA * np.cosh(p * t) + speed / p * np.sinh(p * t)
    assert p * min(lands, 0.5) > 0.5, "the interval is long"
    assert u[-1] == pytest.approx(ALPHA, rel=1e-9)
    np.testing.assert_allclose(response.at(t), sign * (ALPHA - u), rtol=0.0, atol=1e-9)
