"""Lognormal distributions of levels of which some are only known to lie above a limit."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from rocking.errors import InvalidValueError
from rocking.statistics import fit_crossings
from rocking.statistics.censored import fit_censored, fit_moments

pytestmark = pytest.mark.verifies(room="statistics")


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
