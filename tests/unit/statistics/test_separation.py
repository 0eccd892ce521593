"""Hand-made data of every kind of separation, with the known answer."""

import numpy as np
import pytest

from rocking.errors import InvalidValueError
from rocking.statistics import Separation, fit_lognormal
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
        assert "no likeliest curve" in fit.verdict
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
    assert "no likeliest curve" in fit.verdict


def test_a_median_beyond_all_numbers_is_not_reported():
    """A curve that hardly rises over 17 decades has a median beyond float64: said in words."""
    fit = fit_lognormal([4.97e10, 39.7, 0.18, 3.8e-6], [0, 1, 0, 0])
    assert fit.separation is Separation.OVERLAP
    assert (fit.median, fit.method) == (None, "none")
    assert "no median" in fit.verdict
    assert fit.summary()["dispersion"] is None


def test_the_sentence_names_the_level_that_says_most():
    """Where all failed it is the lowest, where none did the highest, each with its own trials."""
    assert fit_lognormal([1.0, 2.0, 4.0], [9, 8, 7], trials=[9, 8, 7]).verdict.count("At 1 none of 9 survived") == 1
    assert fit_lognormal([1.0, 2.0, 4.0], [0, 0, 0], trials=[9, 8, 7]).verdict.count("At 4 none of 7 failed") == 1
