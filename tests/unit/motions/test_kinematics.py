"""Velocity and displacement of the ground by closed forms of straight lines."""

import numpy as np
import pytest

from rocking.motions import (
    GroundMotion,
    ground_displacement,
    ground_velocity,
    peak_ground_displacement,
    peak_ground_velocity,
)
from rocking.motions.integrals import quadratic_roots


def motion_of(samples: list[float], step: float) -> GroundMotion:
    return GroundMotion(np.array(samples), step)


def test_a_ramp() -> None:
    """Under a = c t the velocity is c t^2 / 2 and the displacement c t^3 / 6 at every sample."""
    t = np.arange(11) * 0.3
    motion = GroundMotion(np.asarray(2.0 * t, dtype=np.float64), 0.3)
    np.testing.assert_allclose(ground_velocity(motion), t**2, rtol=1e-14)
    np.testing.assert_allclose(ground_displacement(motion), t**3 / 3.0, rtol=1e-14)


def test_a_zigzag() -> None:
    """One step up, one down, by hand: v = 0, 1/2, 1/2, 0 and u = 0, 1/6, 5/6, 1."""
    motion = motion_of([0.0, 1.0, -1.0, 0.0], 1.0)
    np.testing.assert_allclose(ground_velocity(motion), [0.0, 0.5, 0.5, 0.0], rtol=0.0, atol=1e-15)
    np.testing.assert_allclose(ground_displacement(motion), [0.0, 1 / 6, 5 / 6, 1.0], rtol=0.0, atol=1e-15)


def test_smooth_motions_converge() -> None:
    """Half the step, a quarter of the error: the integrals of a sampled sine are of second order."""
    errors = []
    for count in (100, 200):
        t = np.linspace(0.0, np.pi, count + 1)
        v = ground_velocity(GroundMotion(np.sin(t), float(t[1])))
        errors.append(float(np.abs(v - (1.0 - np.cos(t))).max()))
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=1e-3)


def test_steps_scale() -> None:
    """Velocity grows with the step, displacement with its square, and both with the motion."""
    samples = [0.3, -1.0, 2.0, 0.1]
    one, other = motion_of(samples, 0.1), motion_of([-3.0 * a for a in samples], 0.2)
    np.testing.assert_allclose(ground_velocity(other), -6.0 * ground_velocity(one), rtol=1e-14)
    np.testing.assert_allclose(ground_displacement(other), -12.0 * ground_displacement(one), rtol=1e-14)


def test_peak_ground_velocity_inside_a_step() -> None:
    """A line from 3 to -1 crosses zero at 3/4 of the step: there the velocity is 9/8 h, more than 1 h at the end."""
    assert peak_ground_velocity(motion_of([3.0, -1.0], 2.0)) == pytest.approx(2.25, rel=1e-15)
    assert peak_ground_velocity(motion_of([-3.0, 1.0], 2.0)) == pytest.approx(2.25, rel=1e-15)
    assert peak_ground_velocity(motion_of([1.0, 1.0], 2.0)) == 2.0
    assert peak_ground_velocity(motion_of([0.0, 0.0], 2.0)) == 0.0


def test_peak_ground_displacement_inside_a_step() -> None:
    """From 1 to -2 in a unit step u = t^2 / 2 - t^3 / 2: the largest is 2/27 at t = 2/3, and zero at the end."""
    assert peak_ground_displacement(motion_of([1.0, -2.0], 1.0)) == pytest.approx(2.0 / 27.0, rel=1e-14)
    assert peak_ground_displacement(motion_of([-1.0, 2.0], 1.0)) == pytest.approx(2.0 / 27.0, rel=1e-14)
    assert peak_ground_displacement(motion_of([0.0, 0.0, 0.0], 1.0)) == 0.0
    assert peak_ground_displacement(motion_of([2.0, 2.0], 1.0)) == 1.0


def test_against_many_instants() -> None:
    """Over random motions the exact largest values are reached, never passed, by a fine resampling."""
    random = np.random.default_rng(3)
    for _ in range(10):
        motion = GroundMotion(random.normal(size=12), 0.1)
        t = np.linspace(0.0, 1.1, 11_001)
        fine = GroundMotion(np.interp(t, motion.time, motion.acceleration), float(t[1]))
        for largest, samples in (
            (peak_ground_velocity(motion), ground_velocity(fine)),
            (peak_ground_displacement(motion), ground_displacement(fine)),
        ):
            seen = float(np.abs(samples).max())
            assert seen <= largest * (1.0 + 1e-12)
            assert seen == pytest.approx(largest, rel=1e-5)


def test_quadratic_roots() -> None:
    """Both roots without cancellation, even 1e-12 beside 1; complex, linear and empty ones are not finite."""
    second, first = np.array([1.0, 1.0, 0.0]), np.array([-1.0 - 1e-12, 0.0, 2.0])
    one, other = quadratic_roots(second, first, np.array([1e-12, 1.0, 3.0]))
    assert sorted([one[0], other[0]]) == pytest.approx([1e-12, 1.0], rel=1e-14)
    assert np.isnan(one[1])
    assert np.isnan(other[1])
    assert not np.isfinite(one[2])
    assert other[2] == -1.5
