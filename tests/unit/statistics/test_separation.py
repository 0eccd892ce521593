"""Hand-made data of every kind of separation, with the known answer."""

import numpy as np
import pytest
from random_cases import lognormal_failures
from scipy.special import ndtr

from rocking.errors import InvalidValueError
from rocking.statistics import Separation, fit_lognormal
from rocking.statistics.goodness import group_of
from rocking.statistics.maximum_likelihood import classify

pytestmark = pytest.mark.verifies(room="statistics")

CASES = [
    ([1, 2, 3, 4], [0, 0, 1, 1], Separation.COMPLETE, (2.0, 3.0)),
    ([1, 2, 2, 3], [0, 0, 1, 1], Separation.QUASI_COMPLETE, (2.0, 2.0)),
    ([1, 1, 2], [0, 1, 1], Separation.QUASI_COMPLETE, (1.0, 1.0)),
    ([1, 2, 2], [0, 0, 1], Separation.QUASI_COMPLETE, (2.0, 2.0)),
    ([1, 2, 3, 4], [0, 0, 0, 0], Separation.NONE_FAILED, (4.0, None)),
    ([1, 2, 3, 4], [1, 1, 1, 1], Separation.ALL_FAILED, (None, 1.0)),
    ([2, 2, 2], [0, 1, 1], Separation.SINGLE_LEVEL, (None, None)),
    ([2], [0], Separation.NONE_FAILED, (2.0, None)),
    ([1, 2, 3, 4], [1, 1, 0, 0], Separation.DECREASING_SEPARATED, (None, None)),
    ([1, 2, 2, 3], [1, 1, 0, 0], Separation.DECREASING_SEPARATED, (None, None)),
    ([1, 2, 3, 4], [1, 0, 1, 0], Separation.DECREASING, (None, None)),
    ([1, 1, 2, 2], [0, 1, 0, 1], Separation.FLAT, (None, None)),
    ([0.7, 0.7, 0.9, 0.9, 1.1, 1.1], [0, 1, 0, 1, 0, 1], Separation.FLAT, (None, None)),
    ([1, 2, 3, 4], [0, 1, 0, 1], Separation.OVERLAP, (None, None)),
]


@pytest.mark.verifies("closed form", "data whose separation is known by hand", within="every one")
@pytest.mark.parametrize(("levels", "failures", "kind", "interval"), CASES)
def test_kind_is_known(levels, failures, kind, interval):
    """The kind and the median interval are those read off the data by hand."""
    fit = fit_lognormal(levels, failures)
    assert fit.separation is kind
    assert fit.median_interval == interval


@pytest.mark.parametrize(("levels", "failures", "kind", "interval"), [case for case in CASES if case[2].step])
def test_the_verdict_names_the_step(levels, failures, kind, interval):
    """The step lies between the highest survival and the lowest failure, or at the level that has both."""
    low, high = interval
    where = f"between {low:g} and {high:g}" if low < high else f"at {low:g}"
    verdict = fit_lognormal(levels, failures).verdict
    assert f"towards a step {where}, with dispersion 0." in verdict
    assert f"{len(levels)} outcomes at {len(set(levels))} levels" in verdict


@pytest.mark.parametrize(("levels", "failures", "kind", "interval"), CASES)
def test_maximum_likelihood_is_refused_where_it_does_not_exist(levels, failures, kind, interval):
    """Asked for by name, a likelihood without maximum is refused, with the kind of separation in the sentence."""
    if kind is Separation.OVERLAP:
        assert fit_lognormal(levels, failures, method="maximum-likelihood").method == "maximum-likelihood"
        return
    with pytest.raises(InvalidValueError) as refusal:
        fit_lognormal(levels, failures, method="maximum-likelihood")
    assert kind.value in str(refusal.value)


@pytest.mark.parametrize(("levels", "failures", "kind", "interval"), CASES)
@pytest.mark.parametrize("method", ["auto", "penalised"])
def test_automatic_fit_claims_no_more_than_there_is(levels, failures, kind, interval, method):
    """A step is fitted by the penalised likelihood and flagged; without a rising curve there is none."""
    fit = fit_lognormal(levels, failures, method=method)
    if kind.step:
        assert fit.method == "penalised"
        assert levels[0] * (1 - 1e-9) <= fit.median <= levels[-1] * (1 + 1e-9)
        assert np.isfinite(fit.dispersion)
        assert "no maximum-likelihood curve" in fit.verdict
    elif kind is not Separation.OVERLAP:
        assert (fit.median, fit.dispersion, fit.log_likelihood, fit.covariance) == (None,) * 4
        assert fit.standard_errors is None
        assert "No curve is fitted" in fit.verdict
        with pytest.raises(InvalidValueError, match="a fragility curve is needed, got none"):
            fit.probability(1.0)


def test_kinds_of_many_data_sets_at_once():
    """All kinds in one call, with levels that a resampling left without trials."""
    levels = np.array([1.0, 2.0, 3.0])
    failures = np.array([[0, 1, 2], [0, 0, 2], [0, 1, 0], [0, 0, 0], [2, 0, 0], [1, 1, 1]], dtype=float)
    trials = np.array([[2, 2, 2], [2, 2, 2], [0, 2, 0], [2, 2, 2], [2, 2, 2], [2, 2, 2]], dtype=float)
    names = [list(Separation)[k].name for k in classify(levels, failures, trials)]
    assert names == ["QUASI_COMPLETE", "COMPLETE", "SINGLE_LEVEL", "NONE_FAILED", "DECREASING_SEPARATED", "FLAT"]


def test_nearly_separated_data_are_fitted_not_refused():
    """One survivor a millionth above one failure is overlap: a maximum exists and is found."""
    fit = fit_lognormal([0.2, 0.3, 0.3 * (1 + 1e-6), 0.6], [0, 1, 0, 1])
    assert fit.method == "maximum-likelihood"
    assert fit.median == pytest.approx(0.3, rel=1e-5)
    assert fit.interval("dispersion")[1] == np.inf


def test_penalised_curves_that_fall_are_not_reported():
    """One survival of one below 2 failures of 13: a step by order, but the penalised curve falls."""
    fit = fit_lognormal([0.8, 3.8], [0, 2], [1, 13])
    assert fit.separation is Separation.QUASI_COMPLETE
    assert fit.median is None
    assert "no maximum-likelihood curve" in fit.verdict


def test_a_median_beyond_all_numbers_is_not_reported():
    """A curve that hardly rises over 17 decades has a median beyond float64: said in words."""
    fit = fit_lognormal([4.97e10, 39.7, 0.18, 3.8e-6], [0, 1, 0, 0])
    assert fit.separation is Separation.OVERLAP
    assert (fit.median, fit.method) == (None, "none")
    assert "no median" in fit.verdict
    assert fit.summary()["dispersion"] is None


def test_the_sentence_names_the_level_that_says_most():
    """Where all failed it is the lowest, where none did the highest, each with its own trials."""
    assert fit_lognormal([1.0, 2.0, 4.0], [9, 8, 7], trials=[9, 8, 7]).verdict.count("At 1 0 of 9 survived") == 1
    assert fit_lognormal([1.0, 2.0, 4.0], [0, 0, 0], trials=[9, 8, 7]).verdict.count("At 4 0 of 7 failed") == 1


LEVELS = np.exp(np.linspace(-1.2, 1.2, 8))


@pytest.mark.verifies("closed form", "textbook formulas", within="1e-10")
def test_statistics_by_hand():
    """Deviance, Pearson's and Kolmogorov's statistics are those of the textbook formulas."""
    z, n = np.array([2.0, 5.0, 11.0, 19.0]), 20.0
    fit = fit_lognormal([0.2, 0.4, 0.6, 0.8], z, [20] * 4)
    p = fit.probability([0.2, 0.4, 0.6, 0.8])
    deviance = 2 * np.sum(z * np.log(z / (n * p)) + (n - z) * np.log((n - z) / (n - n * p)))
    found = fit.goodness(repetitions=50)
    assert found.deviance.value == pytest.approx(deviance, rel=1e-10)
    assert found.pearson.value == pytest.approx(np.sum((z - n * p) ** 2 / (n * p * (1 - p))), rel=1e-10)
    assert found.hosmer_lemeshow.value == pytest.approx(found.pearson.value, rel=1e-10)
    assert found.kolmogorov.value == pytest.approx(np.max(np.abs(z / n - p)), rel=1e-10)
    assert found.observed.tolist() == z.tolist()
    np.testing.assert_allclose(found.expected, n * p)


def test_two_levels_fit_perfectly():
    """A curve through both shares has no disagreement: all statistics vanish and no p-value is small."""
    found = fit_lognormal([0.3, 0.9], [6, 14], [20, 20]).goodness(repetitions=50)
    for name, values in found.summary().items():
        assert values["value"] == pytest.approx(0.0, abs=1e-9), name


@pytest.mark.slow
@pytest.mark.verifies("repeated sampling", "300 studies whose curve is right", within="0.07 of a share of 0.1")
def test_error_rate_is_nominal():
    """Of 300 studies whose curve is right, about 10 % have a p-value below 0.1, by every statistic."""
    random = np.random.default_rng(8)
    p_values = []
    for k in range(300):
        z = lognormal_failures(LEVELS, 25, random, dispersion=0.7)
        found = fit_lognormal(LEVELS, z, [25] * 8).goodness(repetitions=99, seed=k)
        p_values.append([values["p_value"] for values in found.summary().values()])
    # four standard errors of a share of 0.1 among 300 are 0.07
    np.testing.assert_allclose((np.array(p_values) <= 0.1).mean(axis=0), 0.1, rtol=0.0, atol=0.07)


@pytest.mark.verifies("negative control", "outcomes that saturate at 60 %")
def test_a_wrong_curve_is_found_out():
    """Outcomes that saturate at 60 % are rejected by every statistic, and leave the band."""
    z = np.round(100 * 0.6 * ndtr((np.log(LEVELS) + 0.6) / 0.25))
    found = fit_lognormal(LEVELS, z, [100] * 8).goodness(repetitions=200)
    assert max(values["p_value"] for values in found.summary().values()) < 0.02
    # what no repetition reaches is itself one among them (Davison & Hinkley 1997, doi:10.1017/CBO9780511802843, 4.11)
    assert found.pearson.p_value == pytest.approx(1.0 / (1.0 + found.repetitions), rel=1e-12, abs=0.0)
    assert found.kolmogorov.value > found.distance_limit
    share = found.observed / found.trials
    assert np.any((share < found.band[0]) | (share > found.band[1]))


def test_single_observations_are_gathered_in_groups():
    """A cloud of 200 is judged in ten groups of twenty, and a wrong shape is found out there."""
    random = np.random.default_rng(4)
    levels = np.exp(random.normal(size=200))
    right = (random.random(200) < ndtr(np.log(levels) / 0.6)).astype(int)
    found = fit_lognormal(levels, right).goodness(repetitions=200)
    assert found.trials.tolist() == [20.0] * 10
    assert np.all(found.lower[1:] > found.upper[:-1])
    assert found.hosmer_lemeshow.p_value > 0.05
    wrong = ((np.abs(np.log(levels)) > 0.8) ^ (random.random(200) < 0.1) | (levels > 1.5)).astype(int)
    assert fit_lognormal(levels, wrong).goodness(repetitions=200).hosmer_lemeshow.p_value < 0.01


def test_groups_are_neighbours_of_about_equal_size():
    """Stripes keep their own group; many levels are shared out evenly."""
    assert group_of(np.full(8, 40.0), 10).tolist() == list(range(8))
    sizes = np.bincount(group_of(np.ones(203), 10))
    assert sizes.min() >= 20
    assert sizes.max() <= 21


def test_too_little_is_refused():
    """One group, or too few repetitions, judge nothing."""
    fit = fit_lognormal([1, 2, 3, 4], [0, 1, 0, 1])
    with pytest.raises(InvalidValueError, match="groups must be >= 2"):
        fit.goodness(groups=1)
    with pytest.raises(InvalidValueError, match="repetitions >= 20"):
        fit.goodness(repetitions=5)
    with pytest.raises(InvalidValueError, match="must have a fit"):
        fit_lognormal([1, 1, 2.05, 4, 4], [0, 0, 1, 0, 0]).goodness()


def test_repetitions_as_far_off_as_the_data_count_as_far_off():
    """One failure of 2 at each of two levels: the curve lies in the middle, a repetition is off by 0 or by as much.

    Statistics of so few trials tie, and a tie counts (Davison & Hinkley 1997, eq. 4.11): where every statistic is zero
    or equal, p is 1.
    """
    found = fit_lognormal([0.5, 0.6, 0.7], [1, 1, 2], [2, 2, 2]).goodness(repetitions=200)
    assert found.kolmogorov.p_value > 0.3
