"""The fit as users meet it: numbers, intervals, bands, words."""

import json
import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy import stats
from scipy.special import log_ndtr, ndtr, ndtri

from rocking.errors import InvalidValueError
from rocking.statistics import fit_crossings, fit_lognormal
from rocking.statistics.censored import fit_censored, fit_moments

pytestmark = pytest.mark.verifies(room="statistics")

LEVELS = [0.2, 0.4, 0.6, 0.8]
FAILURES, TRIALS = [1, 8, 14, 19], [20, 20, 20, 20]
FIT = fit_lognormal(LEVELS, FAILURES, TRIALS)
counts = st.lists(st.integers(0, 12), min_size=5, max_size=5)


def _fall(median, dispersion):
    """Return the root of twice the fall of the log likelihood, straight from the definition."""

    def value(m, s):
        eta = np.log(np.array(LEVELS) / m) / s
        z, n = np.array(FAILURES), np.array(TRIALS)
        return np.sum(z * log_ndtr(eta) + (n - z) * log_ndtr(-eta))

    return math.sqrt(2.0 * max(0.0, value(FIT.median, FIT.dispersion) - value(median, dispersion)))


@pytest.mark.verifies(
    "closed form", "two equations of two levels, and the delta method", within="1e-9; 1e-8 of a standard error"
)
def test_two_levels_have_a_closed_form():
    """With two levels the curve passes through both shares: median and dispersion follow from two equations."""
    fit = fit_lognormal([0.3, 0.9], [3, 15], [20, 20])
    low, high = ndtri(3 / 20), ndtri(15 / 20)
    dispersion = math.log(3.0) / (high - low)
    assert fit.dispersion == pytest.approx(dispersion, rel=1e-9)
    assert fit.median == pytest.approx(0.3 * math.exp(-low * dispersion), rel=1e-9)
    assert fit.fractile(0.75) == pytest.approx(0.9, rel=1e-9)
    expected = 3 * math.log(3 / 20) + 17 * math.log(17 / 20) + 15 * math.log(15 / 20) + 5 * math.log(5 / 20)
    assert fit.log_likelihood == pytest.approx(expected, rel=1e-12, abs=0.0)
    # the delta method on two independent shares: Var(probit) = p (1 - p) / (n phi^2)
    error = [math.sqrt(p * (1 - p) / 20) * math.sqrt(2 * math.pi) * math.exp(ndtri(p) ** 2 / 2) for p in (0.15, 0.75)]
    spread = math.hypot(*error) * math.log(3.0) / (high - low) ** 2
    assert fit.standard_errors["dispersion"] == pytest.approx(spread, rel=1e-8)


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "the likelihood over a grid", within="1e-5")
def test_ends_of_the_profile_interval_lie_on_the_boundary_of_the_region():
    """Over all dispersions (medians) the fall at an end is never below the quantile, and reaches it."""
    grid = np.exp(np.linspace(-2.5, 1.5, 4001))
    for end in FIT.interval("median"):
        assert min(_fall(end, s) for s in grid) == pytest.approx(1.959963984540054, abs=1e-5)
    for end in FIT.interval("dispersion"):
        assert min(_fall(m, end) for m in grid) == pytest.approx(1.959963984540054, abs=1e-5)
    fractile = FIT.interval(0.16)
    for end in fractile:
        falls = [_fall(end * math.exp(-ndtri(0.16) * s), s) for s in grid]
        assert min(falls) == pytest.approx(1.959963984540054, abs=1e-5)


def test_band_and_fractile_interval_are_two_sides_of_one_region():
    """Where the upper end of the band at an end of the median's interval is taken, it is one half."""
    low, high = FIT.interval("median")
    lower, upper = FIT.band([low, high])
    assert upper[0] == pytest.approx(0.5, abs=1e-8)
    assert lower[1] == pytest.approx(0.5, abs=1e-8)


@pytest.mark.parametrize("method", ["profile", "bootstrap", "wald"])
def test_bands_hold_the_curve(method):
    """Every band lies in [0, 1] and around the curve, and is zero at level zero."""
    im = np.array([[0.0, 0.1, 0.3], [0.5, 0.9, 3.0]])
    low, high = FIT.band(im, method=method, repetitions=200)
    middle = FIT.probability(im)
    assert middle.shape == low.shape == (2, 3)
    assert np.all((low >= 0) & (low <= middle) & (middle <= high) & (high <= 1))
    assert (low[0, 0], high[0, 0]) == (0.0, 0.0)


def test_wider_level_wider_interval():
    """Intervals of higher confidence hold those of lower."""
    for method in ("profile", "bootstrap", "wald"):
        small, large = (FIT.interval("dispersion", level, method) for level in (0.8, 0.95))
        assert large[0] < small[0] < FIT.dispersion < small[1] < large[1]


def test_interval_of_data_without_trend_is_open():
    """Where a flat line is not rejected, the median has no bounds and the dispersion no upper one."""
    fit = fit_lognormal([1, 2, 3, 4], [4, 5, 5, 6], [10] * 4)
    assert fit.interval("dispersion")[1] == math.inf
    assert fit.interval("median") == (0.0, math.inf)
    assert "not significant" in fit.verdict
    assert fit.summary()["median_95"] == [None, None]
    # a flat line at 1/2 stays below 0.9: that fractile has a lower end and no upper one
    low, high = fit.interval(0.9)
    assert 0.0 < low < math.inf == high


def test_bootstrap_is_reproducible_and_seeded():
    """One seed one answer, another seed another."""
    first, second, other = (FIT.interval("median", method="bootstrap", repetitions=99, seed=s) for s in (1, 1, 2))
    assert first == second != other


def test_bootstrap_of_cases_and_clusters():
    """Clusters of identical outcomes widen the cluster bootstrap by the root of their size, nothing else."""
    random = np.random.default_rng(5)
    levels = np.exp(random.normal(size=150))
    failures = (np.log(levels) + 0.6 * random.normal(size=150) > 0).astype(int)
    names = np.repeat(np.arange(150), 4)
    fit = fit_lognormal(np.repeat(levels, 4), np.repeat(failures, 4), clusters=names.tolist())
    widths = [
        float(np.subtract(*fit.bootstrap(kind, repetitions=600, seed=3).log_interval(0.0, 0.9)[::-1]))
        for kind in ("clusters", "cases")
    ]
    # Monte Carlo error of a 90 % width from 600 repetitions is near 5 %
    assert widths[0] / widths[1] == pytest.approx(2.0, rel=0.2)
    assert "whole clusters" in fit.verdict
    assert "cluster" not in FIT.verdict
    with pytest.raises(InvalidValueError, match="in clusters="):
        FIT.bootstrap("clusters")
    with pytest.raises(InvalidValueError, match="kind must be one of"):
        FIT.bootstrap("jackknife")
    with pytest.raises(InvalidValueError, match="ends must be one of"):
        FIT.bootstrap(repetitions=30).log_interval(0.0, 0.9, "bca")


def test_repetitions_without_a_curve_widen_the_interval_and_are_counted():
    """With few trials some repetitions fix no curve: they are counted, and leave ends open rather than vanish."""
    sample = fit_lognormal([1, 2, 3, 4], [0, 1, 1, 1], [2, 2, 2, 1]).bootstrap(repetitions=200)
    assert sample.repetitions == 200
    assert sample.undetermined > 5
    assert sample.penalised > 0
    assert sample.log_interval(0.0, 0.95, "percentile") == (-math.inf, math.inf)


def test_summary_is_plain():
    """The summary survives JSON without NaN or infinity, with and without a curve."""
    for fit in (FIT, fit_lognormal([1, 2], [0, 0]), fit_lognormal([1, 2, 3], [0, 0, 1])):
        assert json.loads(json.dumps(fit.summary(), allow_nan=False))["observations"] == fit.observations


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: fit_lognormal(LEVELS, FAILURES, TRIALS, method="newton"), "method must be one of"),
        (lambda: FIT.fractile(1.0), "probability must be in"),
        (lambda: FIT.interval("mean"), "parameter must be"),
        (lambda: FIT.interval("median", 1.0), "level must be in"),
        (lambda: FIT.interval("median", method="exact"), "method must be one of"),
        (lambda: FIT.interval("median", method=""), "method must be one of"),
        (lambda: FIT.interval("median", method="bootstrap", repetitions=[1]), "repetitions must be"),
        (lambda: FIT.probability(-1.0), "im must be finite and >= 0"),
        (lambda: FIT.band([math.nan]), "im must be finite and >= 0"),
        (lambda: FIT.bootstrap(repetitions=0), "repetitions must be"),
    ],
)
def test_bad_questions_are_refused(call, words):
    """No number comes out of a bad question."""
    with pytest.raises(InvalidValueError, match=words):
        call()


@pytest.mark.verifies("invariant", "levels in another unit", within="1e-6")
@settings(max_examples=25)
@given(counts, st.floats(1e-6, 1e6))
def test_unit_of_the_levels_scales_the_median_alone(failures, factor):
    """Levels in another unit: the median follows, the dispersion and the likelihood stay."""
    levels = np.array([0.1, 0.25, 0.3, 0.7, 1.1])
    one = fit_lognormal(levels, failures, [12] * 5)
    other = fit_lognormal(levels * factor, failures, [12] * 5)
    assert other.separation is one.separation
    assume(one.exists)
    assert other.median == pytest.approx(one.median * factor, rel=1e-6)
    assert other.dispersion == pytest.approx(one.dispersion, rel=1e-6)
    assert other.log_likelihood == pytest.approx(one.log_likelihood, rel=1e-9)


@pytest.mark.verifies("same bits", "single observations in any order")
@settings(max_examples=25)
@given(counts, st.randoms())
def test_splitting_stripes_changes_nothing(failures, random):
    """Single observations in any order give bitwise what their stripes give."""
    levels = [0.1, 0.25, 0.3, 0.7, 1.1]
    singles = [(level, int(k < z)) for level, z in zip(levels, failures, strict=True) for k in range(12)]
    random.shuffle(singles)
    one, other = fit_lognormal(levels, failures, [12] * 5), fit_lognormal(*zip(*singles, strict=True))
    assert (one.median, one.dispersion, one.separation) == (other.median, other.dispersion, other.separation)


@settings(max_examples=25)
@given(counts, st.integers(0, 4))
def test_a_failure_more_never_lowers_the_curve_there(failures, place):
    """A failure added at a level never lowers the probability at that level (a consequence of concavity)."""
    levels, trials = [0.1, 0.25, 0.3, 0.7, 1.1], np.full(5, 12)
    added = np.eye(5, dtype=int)[place]
    one, other = (fit_lognormal(levels, failures + k * added, trials + k * added) for k in (0, 1))
    assume(one.method == other.method == "maximum-likelihood")
    assert other.probability(levels[place]) >= one.probability(levels[place]) - 1e-9


@settings(max_examples=25)
@given(counts, st.integers(0, 4))
def test_a_failure_more_between_median_and_mean_level_lowers_the_median(failures, place):
    """A failure added on the median's side of the weighted mean level lowers the median."""
    levels, trials = np.array([0.1, 0.25, 0.3, 0.7, 1.1]), np.full(5, 12)
    added = np.eye(5, dtype=int)[place]
    one, other = (fit_lognormal(levels, failures + k * added, trials + k * added) for k in (0, 1))
    assume(one.method == other.method == "maximum-likelihood")
    means = [_weighted_mean(fit, levels) for fit in (one, other)]
    sides = [(math.log(levels[place]) - m) * (math.log(f.median) - m) for f in (one, other) for m in means]
    assume(min(sides) > 0.0)
    assert other.median < one.median


def test_a_failure_far_above_can_raise_the_median():
    """The median itself may rise: a failure at the top steepens a curve whose median lies below the mean level."""
    before = fit_lognormal([1.0, 2.0, 4.0, 8.0], [4, 7, 8, 9], [10] * 4)
    after = fit_lognormal([1.0, 2.0, 4.0, 8.0], [4, 7, 8, 29], [10, 10, 10, 30])
    assert after.probability(8.0) > before.probability(8.0)
    assert after.median > before.median


def _weighted_mean(fit, levels):
    """Return the mean of ln level, weighted by the information that each level holds."""
    eta = np.log(levels / fit.median) / fit.dispersion
    weight = np.exp(-(eta**2) - log_ndtr(eta) - log_ndtr(-eta))
    return np.average(np.log(levels), weights=weight * 12.0)


def test_the_curve_is_lognormal():
    """The probability is Phi(ln(im / median) / dispersion)."""
    im = np.array([0.1, 0.5, 1.2])
    np.testing.assert_allclose(FIT.probability(im), ndtr(np.log(im / FIT.median) / FIT.dispersion), rtol=1e-12)


@pytest.mark.verifies("computed anew", "SciPy's censored fit", within="3e-4")
@settings(max_examples=15)
@given(st.integers(0, 10**6), st.integers(0, 25))
def test_censored_fit_against_scipy(seed, censored):
    """Median and dispersion are those that scipy's own censored fit of a normal distribution finds."""
    logs = np.random.default_rng(seed).normal(1.0, 0.4, 40)
    limit = math.inf if censored == 0 else float(np.sort(logs)[40 - censored])
    mask = logs >= limit
    given_levels = np.exp(np.where(mask, min(limit, 50.0), logs))
    mine = fit_censored(given_levels, mask)
    data = stats.CensoredData.right_censored(np.log(given_levels), mask)
    location, scale = stats.norm.fit(data) if mask.any() else (logs.mean(), logs.std())
    # scipy's simplex search stops at 1e-4
    assert math.log(mine.median) == pytest.approx(location, abs=3e-4)
    assert mine.dispersion == pytest.approx(scale, abs=3e-4)
    assert mine.censored == mask.sum()
    assert ("censored" in mine.method) == mask.any()


@pytest.mark.verifies("negative control", "censored motions left out")
def test_censoring_matters():
    """Negative control: leaving the censored motions out biases the median low; the fit with them does not."""
    logs = np.random.default_rng(5).normal(0.0, 0.5, 4000)
    mask = logs > 0.2
    honest = fit_censored(np.exp(np.where(mask, 0.2, logs)), mask)
    naive = fit_moments(np.exp(logs[~mask]))
    # four standard errors of a mean of 4000, widened by censoring
    assert abs(math.log(honest.median)) < 4.0 * 0.5 / math.sqrt(4000) * 1.5
    assert math.log(naive.median) < -0.15


def test_moments_and_their_limits():
    """Mean and standard deviation of logarithms by hand; too few or equal levels are refused."""
    fit = fit_moments(np.exp([0.0, 1.0, 2.0]))
    assert (fit.median, fit.dispersion) == (
        pytest.approx(math.e, rel=1e-15, abs=0.0),
        pytest.approx(1.0, rel=1e-15, abs=0.0),
    )
    with pytest.raises(InvalidValueError):
        fit_moments(np.array([1.0]))
    with pytest.raises(InvalidValueError):
        fit_censored(np.array([2.0, 2.0, 1.0]), np.array([False, False, True]))
    with pytest.raises(InvalidValueError):
        fit_censored(np.array([2.0, 3.0]), np.array([False, True]))
    equal = fit_censored(np.array([2.0, 2.0, 3.0]), np.array([False, False, True]))
    assert equal.median > 2.0
    assert equal.probability(equal.median) == pytest.approx(0.5)
    assert fit_moments(np.array([2.0, 2.0])).probability([1.9, 2.0]).tolist() == [0.0, 1.0]


def test_crossings_with_and_without_bounds():
    """All known: moments; some infinite: bounds at the highest level; too few or all equal: no fit."""
    known = np.array([2.0, 3.0, 4.0])
    assert fit_crossings(known, 9.0) == fit_moments(known)
    bounded = fit_crossings(np.array([2.0, 3.0, math.inf]), 9.0)
    assert bounded == fit_censored(np.array([2.0, 3.0, 9.0]), np.array([False, False, True]))
    assert bounded.censored == 1
    assert fit_crossings(np.array([2.0, math.inf]), 9.0) is None
    assert fit_crossings(np.array([2.0, 2.0, math.inf]), 2.0) is None
