"""A fall goes on by the equation of motion until a corner meets the ground: energy, quadrature, longer histories."""

import math

import numpy as np
import pytest

from rocking.bodies import Block, MassPoints, Region, Section, shapes
from rocking.dynamics import free_rocking, simulate
from rocking.motions import GroundMotion
from rocking.motions.pulses import sine
from rocking.plots.animation_scene import DrawnShape, fall_of, scene_of

BODIES = {
    "leaning": Section([Region(shapes.trapezoid(0.5, 0.3, 1.8, lean=0.1), 2000.0)]),
    "wide base": Section([Region(shapes.trapezoid(1.0, 0.2, 1.5, lean=0.05), 2000.0)]),
    "overhang": Section([Region(shapes.trapezoid(0.4, 0.9, 1.2, lean=0.15), 2000.0)]),
    "points": MassPoints([(0.2, 2.0), (0.0, 0.5), (-0.3, 1.4)], [1.0, 3.0, 0.7], feet=(-0.5, 0.7)),
}


def falling(body, side, **more):
    """Let a body go a little beyond its top, to one side."""
    alpha = body.side("right" if side > 0 else "left").slenderness_angle
    return free_rocking(body, rotation=side * 1.02 * alpha, **more)


@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("side", [-1, 1], ids=["left", "right"])
def test_the_body_ends_on_the_ground_and_never_in_it(name, side):
    """At the end a corner beside the foot stands on the ground, and before no corner is below it."""
    shape = DrawnShape.of(BODIES[name])
    scene = scene_of(falling(BODIES[name], side, duration=0.3))
    corners = np.unique(shape.corners, axis=0)
    lowest = [shape.turned(corners, theta)[:, 1] for theta in scene.rotation]
    assert min(each.min() for each in lowest) > -1e-9
    assert np.count_nonzero(np.abs(lowest[-1]) < 1e-9) == 2
    assert np.count_nonzero(np.abs(lowest[-2]) < 1e-9) == 1
    assert np.sign(scene.rotation[-1]) == side


@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("side", [-1, 1], ids=["left", "right"])
def test_a_free_fall_keeps_its_energy_and_takes_the_time_of_its_integral(name, side):
    """theta'^2 / 2 p^2 + cos(alpha - |theta|) stays; time is the integral of d theta over theta' that follows from it.

    Negative control: a fall at the speed with which it begins, as was drawn before, takes a fifth longer.
    """
    body = BODIES[name]
    fall = fall_of(falling(body, side, duration=0.3), DrawnShape.of(body).lying)
    about = body.side("right" if side > 0 else "left")
    alpha, p = about.slenderness_angle, about.frequency_parameter
    size, rate = np.abs(fall.rotation), np.abs(fall.velocity)
    energy = 0.5 * (rate / p) ** 2 + np.cos(alpha - size)
    assert np.abs(energy - energy[0]).max() < 1e-9
    x, w = np.polynomial.legendre.leggauss(400)
    theta = size[0] + 0.5 * (x + 1.0) * (size[-1] - size[0])
    speed = p * np.sqrt(2.0 * (energy[0] - np.cos(alpha - theta)))
    expected = 0.5 * (size[-1] - size[0]) * (w / speed).sum()
    assert fall.time[-1] - fall.time[0] == pytest.approx(expected, rel=1e-7)
    straight = (size[-1] - size[0]) / max(rate[0], 0.5)
    assert straight > 1.2 * expected


def test_a_fall_that_was_cut_is_that_of_the_longer_history():
    """Cut in the middle of a fall, under a ground that has stopped, it goes on as the history that was not cut."""
    body = BODIES["leaning"]
    motion = sine(6.0, 0.8)
    whole = simulate(body, motion, "ked")
    cut = simulate(body, motion, "ked", duration=motion.duration)
    assert cut.time[-1] < whole.time[-1]
    assert abs(cut.rotation[-1]) < 1.2 < abs(whole.dense_output.rotation[-1, 1])
    fall = fall_of(cut, DrawnShape.of(body).lying)
    known = fall.time < whole.dense_output.end[-1]
    assert known.sum() > 10
    np.testing.assert_allclose(fall.rotation[known], whole.at(fall.time[known]), atol=1e-8)


def test_a_ground_that_goes_on_goes_on_in_the_fall():
    """Beyond a quarter turn the shaking still counts: the torque is that of the equation of motion, at any instant."""
    body, step = BODIES["wide base"], 0.01
    time = step * np.arange(3000)
    motion = GroundMotion(9.0 * np.sin(5.0 * time), step, vertical=3.9 * np.cos(3.0 * time))
    response = simulate(body, motion, 0.9)
    fall = fall_of(response, DrawnShape.of(body).lying)
    assert abs(fall.rotation[0]) >= 0.5 * math.pi - 1e-9
    assert fall.time.size > 10
    middle = 0.5 * (fall.time[1:-1] + fall.time[:-2])
    found = np.diff(fall.velocity[:-1]) / np.diff(fall.time[:-1])
    side = np.sign(fall.rotation[0])
    about = body.side("right" if side > 0 else "left")
    psi = about.slenderness_angle * side - 0.5 * (fall.rotation[1:-1] + fall.rotation[:-2])
    push, lift = np.interp(middle, time, motion.acceleration), np.interp(middle, time, motion.vertical)
    torque = (1.0 + lift / 9.80665) * np.sin(psi) + push / 9.80665 * np.cos(psi)
    np.testing.assert_allclose(found, -(about.frequency_parameter**2) * torque, rtol=2e-3, atol=2e-3)


def test_a_body_that_ends_on_its_way_over_the_other_foot_lands_on_it_first():
    """Cut while it swings back with more than the other side holds, it lands, loses its speed there, and falls on."""
    body = BODIES["leaning"]
    rotation, velocity = 0.2, -3.0
    cut = free_rocking(body, rotation=rotation, angular_velocity=velocity, restitution="ked", duration=0.01)
    whole = free_rocking(body, rotation=rotation, angular_velocity=velocity, restitution="ked", duration=3.0)
    assert (cut.impacts.size, whole.impacts.size, cut.outcome) == (0, 1, whole.outcome)
    fall = fall_of(cut, DrawnShape.of(body).lying)
    known = fall.time < whole.dense_output.end[-1]
    np.testing.assert_allclose(fall.rotation[known], whole.at(fall.time[known]), atol=1e-8)
    assert fall.rotation[-1] < -1.4


def test_what_stands_does_not_fall():
    """A response that stays standing has no fall, and is shown as before."""
    response = simulate(Block(width=0.5, height=2.0), sine(3.2, 0.8), 0.9)
    assert fall_of(response, (-1.5, 1.5)).time.size == 0
    assert scene_of(response).time[-1] <= response.time[-1]


def test_where_bodies_lie():
    """A block lies after a quarter turn, a body that leans out by 45 degrees on one side after an eighth there."""
    assert DrawnShape.of(Block(width=0.5, height=2.0)).lying == pytest.approx(
        (-0.5 * math.pi, 0.5 * math.pi), abs=1e-12
    )
    leans = Section([Region([(-0.25, 0.0), (0.25, 0.0), (1.25, 1.0), (-0.75, 1.0)])])
    assert DrawnShape.of(leans).lying == pytest.approx((-math.atan(2.0), 0.25 * math.pi), abs=1e-12)
