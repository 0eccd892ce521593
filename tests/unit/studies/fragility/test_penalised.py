"""Firth's penalised likelihood against a brute-force search and its own promise: less bias."""

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.special import log_ndtr, ndtr

from rocking.studies.fragility.counts import count_outcomes
from rocking.studies.fragility.estimate import LogScale, find_curves
from rocking.studies.fragility.lognormal import fit_lognormal
from rocking.studies.fragility.penalised import PenalisedProbit

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
    assert found.value[0] == pytest.approx(-_minus(theta, x, z, n), rel=1e-12)
    slopes = [
        (_minus(theta - turn, x, z, n) - _minus(theta + turn, x, z, n)) / (2.0 * step) for turn in step * np.eye(2)
    ]
    assert found.gradient[0] == pytest.approx(slopes, rel=1e-6)
