"""The likelihood, its derivatives and its maximum, against mpmath and finite differences."""

import mpmath
import numpy as np
import pytest

from rocking.studies.fragility.likelihood import Probit, tails
from rocking.studies.fragility.maximum import maximise, positive_definite
from rocking.studies.fragility.penalised import PenalisedProbit

U = np.array([[-1.4, -0.3, 0.2, 1.6]])
Z = np.array([[1.0, 3.0, 2.0, 8.0]])
N = np.array([[9.0, 8.0, 7.0, 9.0]])


@pytest.mark.parametrize("eta", [-3e4, -310.0, -290.0, -40.0, -5.0, -0.3, 0.0, 0.7, 6.0, 38.0])
def test_tails_agree_with_multiple_precision(eta):
    """Logarithms, slopes and curvatures hold in the far tails, where the textbook formulas underflow."""
    with mpmath.workdps(60):
        x = mpmath.mpf(eta)
        # erfc keeps the far tail, which ncdf of a large number loses
        below = mpmath.erfc(-x / mpmath.sqrt(2)) / 2
        rate = mpmath.npdf(x) / below
        expected = float(mpmath.log(below)), float(rate), float(rate * (rate + x))
    found = tails(np.array(eta))
    mirrored = tails(np.array(-eta))
    assert float(found.log_failure) == pytest.approx(expected[0], rel=1e-14, abs=1e-300)
    assert float(found.failure_rate) == pytest.approx(expected[1], rel=1e-13, abs=1e-300)
    assert float(found.failure_bend) == pytest.approx(expected[2], rel=2e-11, abs=1e-300)
    assert [float(v) for v in (mirrored.log_survival, mirrored.survival_rate, mirrored.survival_bend)] == [
        float(v) for v in (found.log_failure, found.failure_rate, found.failure_bend)
    ]


@pytest.mark.parametrize("model", [Probit, PenalisedProbit])
def test_derivatives_are_those_of_the_value(model):
    """Gradient and curvature agree with central differences of value and gradient."""
    data, theta, h = model(U, Z, N - Z), np.array([[0.3, 1.2]]), 1e-5
    at = data.derivatives(theta)
    for k in range(2):
        shift = h * np.eye(2)[k]
        up, down = data.derivatives(theta + shift), data.derivatives(theta - shift)
        np.testing.assert_allclose((up.value - down.value) / (2 * h), at.gradient[:, k], atol=1e-8)
        np.testing.assert_allclose((down.gradient - up.gradient) / (2 * h), at.curvature[:, k], atol=1e-7)


def test_expected_information_is_the_mean_of_the_observed():
    """The observed information averaged over all outcomes of three trials is Fisher's."""
    from scipy.special import ndtr

    u, theta = np.array([[-0.5, 0.1, 1.0]]), np.array([[0.2, 0.8]])
    p = ndtr(theta[0, 0] + theta[0, 1] * u[0])
    total = np.zeros((2, 2))
    for k in range(8):
        z = np.array([[float(k >> i & 1) for i in range(3)]])
        weight = np.prod(np.where(z[0] > 0, p, 1 - p))
        total += weight * Probit(u, z, 1 - z).derivatives(theta).curvature[0]
    np.testing.assert_allclose(Probit(u, np.zeros((1, 3)), np.ones((1, 3))).information(theta)[0], total, rtol=1e-12)


def test_penalty_is_jeffreys():
    """Penalised minus plain value is half the logarithm of the determinant of Fisher's information."""
    theta = np.array([[0.3, 1.2]])
    plain, firth = Probit(U, Z, N - Z), PenalisedProbit(U, Z, N - Z)
    expected = 0.5 * np.linalg.slogdet(plain.information(theta)[0])[1]
    assert (firth.derivatives(theta).value - plain.derivatives(theta).value)[0] == pytest.approx(expected, rel=1e-12)


def test_rows_do_not_touch_each_other():
    """A row of NaN leaves the other's result bitwise equal and is not proven."""
    z = np.concatenate([Z, [[0.0, np.nan, 7.0, 9.0]]])
    alone = maximise(Probit(U, Z, N - Z), np.zeros((1, 2)))
    both = maximise(Probit(U, z, N - z), np.zeros((2, 2)))
    assert both.theta[0].tolist() == alone.theta[0].tolist()
    assert both.proven.tolist() == [True, False]


def test_only_definite_matrices_count_as_definite():
    """Saddles, singular matrices and NaN are refused, of every size."""
    good, saddle = np.diag([2.0, 1.0, 3.0]), np.diag([2.0, -1.0, 3.0])
    for order in (2, 3):
        several = np.stack([good, saddle, np.ones((3, 3)), np.full((3, 3), np.nan)])[:, :order, :order]
        assert positive_definite(several).tolist() == [True, False, False, False]
