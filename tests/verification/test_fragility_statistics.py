"""Fragility statistics: an independent probit fit, the true coverage of every interval, and separation.

ROCKING_CAMPAIGN=1 in the environment repeats the coverage with ten times as many studies, that of the bootstrap and of
bands with 10,000 in place of 300 (a share of 300 has a standard deviation of 1.3 %), and with the bootstrap of clouds.
"""

import os

import numpy as np
import pytest
from random_cases import lognormal_failures
from scipy.optimize import brentq
from scipy.special import ndtr, ndtri
from scipy.stats import norm

from rocking.statistics import fit_lognormal
from rocking.statistics.maximum_likelihood import LogScale, find_curves, log_dispersion, log_fractile, standard_errors
from rocking.statistics.probit import Probit
from rocking.statistics.profiles import FractileConstraint, Profile, SlopeConstraint

pytestmark = pytest.mark.verifies(room="statistics")

CAMPAIGN = bool(os.environ.get("ROCKING_CAMPAIGN"))
STUDIES = 10_000 if CAMPAIGN else 1000
DEAR = 10_000 if CAMPAIGN else 300
MEDIAN, DISPERSION = 0.8, 0.6
PARAMETERS = (0.5, "dispersion", 0.16)


def _fisher_scoring(levels, failures, trials):
    """Fit a probit by iteratively reweighted least squares, straight from the textbook (McCullagh & Nelder 1989)."""
    x, y, n = np.log(levels), np.asarray(failures), np.asarray(trials)
    design, beta = np.stack([np.ones_like(x), x], axis=1), np.zeros(2)
    for _ in range(200):
        eta = design @ beta
        p, density = norm.cdf(eta), norm.pdf(eta)
        weight = n * density**2 / (p * (1 - p))
        working = eta + (y / n - p) / density
        new = np.linalg.solve(design.T @ (weight[:, None] * design), design.T @ (weight * working))
        if np.max(np.abs(new - beta)) < 1e-13 * np.max(np.abs(new)):
            break
        beta = new
    return np.exp(-new[0] / new[1]), 1.0 / new[1]


@pytest.mark.slow
@pytest.mark.verifies(
    "computed anew",
    "Fisher scoring (McCullagh and Nelder 1989)",
    within="1e-6",
    control="test_least_squares_is_told_apart_from_maximum_likelihood",
)
def test_fifty_data_sets_agree_with_an_independent_probit_fit(agreement):
    """Median and dispersion of 50 random studies agree with Fisher scoring to 1e-6; another link does not."""
    random, compared = np.random.default_rng(1), 0
    while compared < 50:
        levels = np.sort(np.exp(random.normal(size=random.integers(3, 12))))
        trials = random.integers(1, 40, levels.size)
        failures = random.binomial(trials, ndtr(np.log(levels / random.uniform(0.5, 2)) / random.uniform(0.4, 1.2)))
        fit = fit_lognormal(levels, failures, trials)
        if fit.method != "maximum-likelihood":
            continue
        median, dispersion = _fisher_scoring(levels, failures, trials)
        agreement(abs(fit.median / median - 1.0), 1e-6)
        agreement(abs(fit.dispersion / dispersion - 1.0), 1e-6)
        compared += 1


@pytest.mark.verifies("negative control", "least squares through the shares (Baker 2015)", doi="10.1193/021113EQS025M")
def test_least_squares_is_told_apart_from_maximum_likelihood():
    """Negative control: fitting the shares by least squares, a common mistake (Baker 2015), misses by far over 1e-6."""
    levels, failures, trials = np.array([0.2, 0.4, 0.6, 0.8]), np.array([1, 8, 14, 19]), np.full(4, 20)
    slope, start = np.polyfit(np.log(levels), ndtri(failures / trials), 1)
    fit = fit_lognormal(levels, failures, trials)
    assert abs(np.exp(-start / slope) / fit.median - 1.0) > 1e-3


def _truth(parameter):
    return np.log(DISPERSION) if parameter == "dispersion" else np.log(MEDIAN) + DISPERSION * ndtri(parameter)


def _stripes(studies, seed=21):
    """Return levels and failures of many multiple-stripe studies: 8 stripes of 40 motions."""
    levels = MEDIAN * np.exp(np.linspace(-1.6, 1.6, 8) * DISPERSION)
    return levels, lognormal_failures(levels, 40, seed, MEDIAN, DISPERSION, studies)


def _clouds(studies, seed=22):
    """Return levels and outcomes of many studies of 200 single observations at random levels."""
    random = np.random.default_rng(seed)
    levels = np.exp(np.log(MEDIAN) + 0.8 * random.normal(size=200))
    order = np.sort(levels)
    return order, lognormal_failures(order, 1, random, MEDIAN, DISPERSION, studies)


def _profile_ends(levels, failures, trials, parameter, width=1.0):
    """Return profile intervals of many studies at once, by the code that one study uses."""
    scale = LogScale.of(fit_lognormal(levels, failures[0], trials).counts)
    number = np.broadcast_to(np.asarray(trials, dtype=float), failures.shape)
    curves = find_curves(levels, scale, failures.astype(float), number)
    assert curves.exists.all()
    theta, count = curves.theta, failures.shape[0]
    model = Probit(scale.position(levels)[None], failures.astype(float), number - failures)
    profile = Profile(model, curves.value, theta, 1.959963984540054 * width)
    variate = None if parameter == "dispersion" else float(ndtri(parameter))
    error = standard_errors(theta, curves.curvature, scale, variate)
    if variate is None:
        ends = [profile.ends(SlopeConstraint(), np.log(theta[:, 1]), error, s * np.ones(count)) for s in (1.0, -1.0)]
        return np.stack([np.log(scale.spread) - end for end in ends])
    pin, start = FractileConstraint(np.full(count, variate)), (variate - theta[:, 0]) / theta[:, 1]
    ends = [profile.ends(pin, start, error / scale.spread, s * np.ones(count)) for s in (-1.0, 1.0)]
    return np.stack([scale.log_level(end) for end in ends])


def _coverage(ends, parameter):
    return np.mean((ends[0] <= _truth(parameter)) & (_truth(parameter) <= ends[1]))


@pytest.mark.slow
@pytest.mark.verifies("repeated sampling", "1,000 studies whose truth is known", within="93 to 97 %", control="within")
@pytest.mark.parametrize("parameter", PARAMETERS)
@pytest.mark.parametrize("design", [_stripes, _clouds])
def test_profile_intervals_cover_as_often_as_they_say(design, parameter):
    """The 95 % profile interval holds the truth in 93 to 97 % of the studies, and one of half the width does not."""
    levels, failures = design(STUDIES)
    trials = np.full(levels.size, 40 if design is _stripes else 1)
    assert 0.93 <= _coverage(_profile_ends(levels, failures, trials, parameter), parameter) <= 0.97
    # an interval of half the width covers about 67 %
    assert not 0.93 <= _coverage(_profile_ends(levels, failures, trials, parameter, width=0.5), parameter) <= 0.97


@pytest.mark.verifies("invariant", "the interval whose coverage was measured", within="1e-8")
def test_one_study_has_the_interval_of_the_many():
    """The interval that a user gets is the one whose coverage was measured."""
    levels, failures = _stripes(3)
    for parameter in PARAMETERS:
        many = np.exp(_profile_ends(levels, failures, np.full(8, 40), parameter))
        for k in range(3):
            one = fit_lognormal(levels, failures[k], [40] * 8).interval(parameter)
            assert one == pytest.approx(tuple(many[:, k]), rel=1e-8)


def _bootstrap_coverage(design, studies, trials):
    levels, failures = design(studies)
    hits = np.zeros((2, 3))
    for k in range(studies):
        fit = fit_lognormal(levels, failures[k], trials)
        sample = fit.bootstrap(repetitions=399, seed=k)
        for j, parameter in enumerate(PARAMETERS):
            variate = None if parameter == "dispersion" else float(ndtri(parameter))
            low, high = sample.log_interval(variate, 0.95)
            quarter = 0.25 * (high - low)
            hits[:, j] += [low <= _truth(parameter) <= high, low + quarter <= _truth(parameter) <= high - quarter]
    return hits / studies


@pytest.mark.slow
@pytest.mark.verifies(
    "repeated sampling",
    "300 studies whose truth is known",
    within="92 to 98 %; 93 to 97 % in campaigns",
    control="within",
)
def test_bootstrap_intervals_cover_as_often_as_they_say():
    """The studentised bootstrap covers in 95 % of many studies; cut to half its width it does not."""
    whole, half = _bootstrap_coverage(_stripes, DEAR, [40] * 8)
    least, most = (0.93, 0.97) if CAMPAIGN else (0.92, 0.98)
    assert np.all((whole >= least) & (whole <= most)), whole
    assert np.all(half < 0.93), half


@pytest.mark.verifies("repeated sampling", "2,000 studies whose truth is known", within="93 to 97 %", control="within")
@pytest.mark.skipif(not CAMPAIGN, reason="minutes: ROCKING_CAMPAIGN=1 runs it")
def test_bootstrap_intervals_of_clouds_cover_as_often_as_they_say():
    """The studentised bootstrap covers in 93 to 97 % for clouds of 200 observations too."""
    whole, half = _bootstrap_coverage(_clouds, 2000, [1] * 200)
    assert np.all((whole >= 0.93) & (whole <= 0.97)), whole
    assert np.all(half < 0.93), half


@pytest.mark.slow
@pytest.mark.verifies(
    "repeated sampling", "300 studies whose truth is known", within="92 to 98 %; 93 to 97 % in campaigns"
)
def test_bands_cover_as_often_as_they_say():
    """The pointwise 95 % band holds the true curve in 95 % of many studies at each of three levels."""
    levels, failures = _stripes(DEAR, seed=5)
    places = np.array([0.4, 0.8, 1.4])
    truth = ndtr(np.log(places / MEDIAN) / DISPERSION)
    bands = [fit_lognormal(levels, z, [40] * 8).band(places) for z in failures]
    share = np.mean([(low <= truth) & (truth <= high) for low, high in bands], axis=0)
    least, most = (0.93, 0.97) if CAMPAIGN else (0.92, 0.98)
    assert np.all((share >= least) & (share <= most)), share


@pytest.mark.verifies("repeated sampling", "parameters that were put in", within="4 standard errors of less than 0.01")
def test_recovers_known_parameters():
    """With a hundred thousand trials a stripe, median and dispersion come back within four standard errors."""
    levels = MEDIAN * np.exp(np.linspace(-1.5, 1.5, 8) * DISPERSION)
    failures = lognormal_failures(levels, 100_000, 2, MEDIAN, DISPERSION)
    fit = fit_lognormal(levels, failures, [100_000] * 8)
    assert abs(fit.median - MEDIAN) < 4 * fit.standard_errors["median"] < 0.01
    assert abs(fit.dispersion - DISPERSION) < 4 * fit.standard_errors["dispersion"] < 0.01


@pytest.mark.verifies("repeated sampling", "the spread of 8,000 studies", within="0.03")
def test_standard_errors_are_those_of_repeated_studies():
    """The spread of estimates over many studies is the mean standard error, within Monte Carlo error."""
    levels, failures = _stripes(8000, seed=9)
    scale = LogScale.of(fit_lognormal(levels, failures[0], [40] * 8).counts)
    curves = find_curves(levels, scale, failures.astype(float), np.full(failures.shape, 40.0))
    for variate, value in ((0.0, log_fractile(curves.theta, scale, 0.0)), (None, log_dispersion(curves.theta, scale))):
        error = standard_errors(curves.theta, curves.curvature, scale, variate)
        # a standard deviation from 8000 is known to 0.8 %, and the delta method leaves terms of order 1/n
        assert value.std() == pytest.approx(error.mean(), rel=0.03)


@pytest.mark.verifies("negative control", "a plain Newton's method")
@pytest.mark.parametrize(
    ("levels", "failures"),
    [([1, 2, 3, 4], [0, 0, 1, 1]), ([1, 2, 2, 3], [0, 0, 1, 1]), ([1, 1.01, 4, 9], [0, 1, 1, 1])],
)
def test_naive_newton_runs_away_where_the_answer_is_honest(levels, failures):
    """On separated data a plain Newton's slope grows step after step; the fit says so instead of converging."""
    x, y, theta, slopes = np.log(levels), np.array(failures), np.zeros(2), []
    for _ in range(8):
        eta = theta[0] + theta[1] * x
        up, down = norm.pdf(eta) / norm.cdf(eta), norm.pdf(eta) / norm.sf(eta)
        score = y * up - (1 - y) * down
        bend = y * up * (up + eta) + (1 - y) * down * (down - eta)
        design = np.stack([np.ones_like(x), x])
        theta = theta + np.linalg.solve((design * bend) @ design.T, design @ score)
        slopes.append(theta[1])
    assert np.all(np.diff(slopes) > 0.05 * np.abs(slopes[:-1]))
    fit = fit_lognormal(levels, failures)
    assert fit.separation.step
    assert fit.method == "penalised"
    assert "no maximum-likelihood curve" in fit.verdict


@pytest.mark.verifies("computed anew", "SciPy's brentq on the constrained maximum", within="1e-6")
def test_profile_end_against_a_root_finder():
    """The upper end of the dispersion agrees with brentq on the constrained maximum, in a lopsided small study."""
    levels, failures, n = np.array([0.5, 1.0, 1.5, 2.0]), np.array([1, 2, 4, 5]), 6
    x = np.log(levels)

    def constrained(s):
        grid = np.linspace(-3, 3, 60_001)[:, None]
        p = ndtr((x - grid) / s)
        with np.errstate(divide="ignore"):
            return np.max(np.sum(failures * np.log(p) + (n - failures) * np.log1p(-p), axis=1))

    fit = fit_lognormal(levels, failures, [n] * 4)
    drop = fit.log_likelihood - 0.5 * 1.959963984540054**2
    low, high = fit.interval("dispersion")
    expected = brentq(lambda s: constrained(s) - drop, fit.dispersion, 20.0, xtol=1e-9)
    # the grid of medians, 1e-4 apart, is good for 1e-8 in the likelihood
    assert high == pytest.approx(expected, rel=1e-6)
    assert high / fit.dispersion > 1.2 * fit.dispersion / low
