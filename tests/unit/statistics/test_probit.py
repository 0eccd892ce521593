"""The likelihood, plain and penalised: derivatives against mpmath and differences, maxima against brute force, bias."""

import mpmath
import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.special import log_ndtr, ndtr

from rocking.statistics import count_outcomes, fit_lognormal
from rocking.statistics.maximum_likelihood import LogScale, find_curves, maximise, positive_definite
from rocking.statistics.probit import PenalisedProbit, Probit, tails

pytestmark = pytest.mark.verifies(room="statistics")

U = np.array([[-1.4, -0.3, 0.2, 1.6]])
Z = np.array([[1.0, 3.0, 2.0, 8.0]])
N = np.array([[9.0, 8.0, 7.0, 9.0]])


@pytest.mark.verifies(
    "computed anew", "mpmath with 60 digits", within="1e-14 of logarithms, 1e-13 of slopes, 2e-11 of curvatures"
)
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


@pytest.mark.verifies("computed anew", "central differences", within="1e-8 and 1e-7")
@pytest.mark.parametrize("model", [Probit, PenalisedProbit])
def test_derivatives_are_those_of_the_value(model):
    """Gradient and curvature agree with central differences of value and gradient."""
    data, theta, h = model(U, Z, N - Z), np.array([[0.3, 1.2]]), 1e-5
    at = data.derivatives(theta)
    for k in range(2):
        shift = h * np.eye(2)[k]
        up, down = data.derivatives(theta + shift), data.derivatives(theta - shift)
        np.testing.assert_allclose((up.value - down.value) / (2 * h), at.gradient[:, k], rtol=0.0, atol=1e-8)
        np.testing.assert_allclose((down.gradient - up.gradient) / (2 * h), at.curvature[:, k], rtol=0.0, atol=1e-7)


@pytest.mark.verifies("computed anew", "the mean over all outcomes of three trials", within="1e-12")
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
    assert (firth.derivatives(theta).value - plain.derivatives(theta).value)[0] == pytest.approx(
        expected, rel=1e-12, abs=0.0
    )


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


SETS = [
    ([1.0, 2.0, 3.0, 4.0], [0, 0, 3, 3], [3, 3, 3, 3]),
    ([1.0, 2.0, 3.0, 4.0], [0, 1, 3, 3], [3, 3, 3, 3]),
    ([0.2, 0.5, 0.6, 1.5], [1, 4, 5, 9], [9, 9, 9, 9]),
    # two maxima: from a flat start the lesser one is found
    ([0.30, 0.67, 0.78, 1.6, 4.8], [0, 0, 5, 1, 2], [3, 3, 5, 1, 2]),
]


def _minus(theta, x, z, n):
    eta = theta[0] + theta[1] * x
    log_weight = -(eta**2) - np.log(2 * np.pi) - log_ndtr(eta) - log_ndtr(-eta)
    w = n * np.exp(log_weight)
    penalty = 0.5 * np.log(np.sum(w) * np.sum(w * x * x) - np.sum(w * x) ** 2)
    return -(np.sum(z * log_ndtr(eta) + (n - z) * log_ndtr(-eta)) + penalty)


@pytest.mark.verifies("computed anew", "forty simplex searches by SciPy", within="1e-5")
@pytest.mark.parametrize(("levels", "failures", "trials"), SETS)
def test_penalised_fit_is_the_highest_of_many_searches(levels, failures, trials):
    """No search from forty starts, by another algorithm and formula, gets higher or elsewhere."""
    fit = fit_lognormal(levels, failures, trials, method="penalised")
    x, z, n = np.log(levels), np.array(failures), np.array(trials)
    starts = [(-b * m, b) for b in (0.5, 1, 2, 5, 10) for m in np.linspace(x[0], x[-1], 8)]
    options = {"xatol": 1e-10, "fatol": 1e-13, "maxiter": 1500}
    with np.errstate(all="ignore"):
        found = [minimize(_minus, s, (x, z, n), method="Nelder-Mead", options=options) for s in starts]
    best = min((f for f in found if np.isfinite(f.fun)), key=lambda f: f.fun)
    assert fit.method == "penalised"
    assert "penalised likelihood" in fit.verdict
    assert fit.median == pytest.approx(np.exp(-best.x[0] / best.x[1]), rel=1e-5)
    assert fit.dispersion == pytest.approx(1.0 / best.x[1], rel=1e-5)


@pytest.mark.verifies(
    "repeated sampling",
    "1,500 small studies whose truth is known (Firth 1993)",
    within="less than 0.5 of the bias of maximum likelihood",
)
def test_penalty_removes_bias():
    """Over 1500 small studies the mean slope is off by less than half of what maximum likelihood's is (Firth 1993)."""
    levels = np.exp(np.linspace(-1.0, 1.0, 6))
    scale = LogScale.of(count_outcomes(levels, np.zeros(6), np.full(6, 20)))
    truth = np.array([0.2, 1.3])
    random = np.random.default_rng(11)
    p = ndtr(truth[0] + truth[1] * scale.position(levels))
    failures, trials = random.binomial(20, p, (1500, 6)).astype(float), np.full((1500, 6), 20.0)
    plain, firth = (find_curves(levels, scale, failures, trials, penalised=k).theta[:, 1] for k in (False, True))
    error = plain.std() / np.sqrt(plain.size)
    assert plain.mean() - truth[1] > 4 * error
    assert abs(firth.mean() - truth[1]) < 0.5 * (plain.mean() - truth[1])


def test_penalised_intervals_hold_the_curve():
    """A penalised fit has profile and bootstrap intervals, with the estimate inside."""
    fit = fit_lognormal([1.0, 2.0, 3.0, 4.0], [0, 0, 10, 10], [10] * 4)
    for method in ("profile", "bootstrap", "wald"):
        low, high = fit.interval("median", method=method, repetitions=99)
        assert low < fit.median < high
    # the data themselves place the median between 2 and 3: the interval reaches into both neighbours
    low, high = fit.interval("median")
    assert 1.0 < low < 2.5 < high < 4.0


def test_the_penalty_counts_once_however_many_levels():
    """70,000 levels, more than the likelihood takes at a time: its definition, and the slopes of it."""
    random, theta, step = np.random.default_rng(6), np.array([0.1, 0.7]), 1e-5
    x, z, n = np.sort(random.normal(size=70_000)), (random.random(70_000) < 0.5).astype(float), np.ones(70_000)
    found = PenalisedProbit(x[None], z[None], (n - z)[None]).derivatives(theta[None])
    assert found.value[0] == pytest.approx(-_minus(theta, x, z, n), rel=1e-12, abs=0.0)
    slopes = [
        (_minus(theta - turn, x, z, n) - _minus(theta + turn, x, z, n)) / (2.0 * step) for turn in step * np.eye(2)
    ]
    assert found.gradient[0] == pytest.approx(slopes, rel=1e-6)
