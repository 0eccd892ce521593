"""Free rocking between two impacts against quadrature of many digits, and against computed slopes."""

from functools import partial

import mpmath
import numpy as np
import pytest

from rocking.identification import state_space

ALPHA = np.array([0.05, 0.25, 0.6])
Y = np.array([[1e-4], [0.04], [0.06], [0.5], [0.95]])


def test_duration_is_the_quadrature_of_the_energy():
    """Also where the difference of two elliptic integrals has lost its digits."""
    for y in (1e-6, 0.3, 0.97):
        alpha, s = mpmath.mpf("0.25"), mpmath.sin(mpmath.mpf("0.125"))
        m = 1 - (1 - mpmath.mpf(y) ** 2) * s**2
        exact = 2 * mpmath.ellipf(mpmath.asin(y / mpmath.sqrt(m)), m)
        assert float(state_space.duration(np.array(y), np.array(0.25))) == pytest.approx(float(exact), rel=1e-13)
        top = float(state_space.peak(np.array(y), np.array(0.25)))
        if y > 0.1:
            until = mpmath.quad(partial(_integrand, alpha, y * s, top), [0, mpmath.sqrt(top)])
            assert float(exact) == pytest.approx(float(until.real), rel=1e-6)


def _integrand(alpha, turning, top, z):
    """Of p T over the root of what is missing to the top, from the energy; turning: half of the speed over p."""
    rotation = top - z * z
    return 4 * z / mpmath.sqrt(4 * turning**2 - 2 * (mpmath.cos(alpha - rotation) - mpmath.cos(alpha)))


def test_slopes_are_those_of_the_duration():
    found, by_y, by_alpha = state_space.duration_and_slopes(Y, ALPHA)
    step = 1e-5
    at = state_space.duration
    np.testing.assert_allclose(found, at(Y, ALPHA), rtol=1e-14)
    numeric = (at(Y * np.exp(step), ALPHA) - at(Y * np.exp(-step), ALPHA)) / (2 * step)
    np.testing.assert_allclose(by_y, numeric, rtol=1e-7)
    numeric = (at(Y, ALPHA + step) - at(Y, ALPHA - step)) / (2 * step)
    np.testing.assert_allclose(by_alpha, numeric, rtol=1e-5, atol=1e-11)


def test_speed_is_the_inverse_of_duration():
    np.testing.assert_allclose(state_space.speed(state_space.duration(Y, ALPHA), ALPHA), Y + 0.0 * ALPHA, rtol=1e-12)


def test_rotation_begins_at_zero_with_the_speed_and_ends_reversed():
    taken = state_space.duration(Y, ALPHA)
    begin, end = (state_space.rotation(t, Y, ALPHA) for t in (0.0 * taken, taken))
    for rotation, speed, sign in ((*begin, 1.0), (*end, -1.0)):
        np.testing.assert_allclose(rotation, 0.0, atol=1e-13)
        np.testing.assert_allclose(speed, sign * Y * state_space.overturning_speed(ALPHA), rtol=1e-7)
    np.testing.assert_allclose(state_space.rotation(0.5 * taken, Y, ALPHA)[0], state_space.peak(Y, ALPHA), rtol=1e-9)


def test_viscous_loss_has_its_slope_and_no_step():
    each, slope = state_space.viscous_loss(Y)
    above, below = (state_space.viscous_loss(Y * np.exp(sign * 1e-5))[0] for sign in (1.0, -1.0))
    np.testing.assert_allclose(slope, (above - below) / 2e-5, rtol=2e-5)
    low, high = (float(state_space.viscous_loss(np.array(0.05 + d))[0]) for d in (-1e-12, 1e-12))
    assert low == pytest.approx(high, rel=1e-5)
    assert each.shape == Y.shape
