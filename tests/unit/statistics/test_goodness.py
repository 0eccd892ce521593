"""Goodness of fit: right values, right error rate, and power against wrong curves."""

import numpy as np
import pytest
from random_cases import lognormal_failures
from scipy.special import ndtr

from rocking.errors import InvalidValueError
from rocking.statistics import fit_lognormal
from rocking.statistics.goodness import group_of

pytestmark = pytest.mark.verifies(room="statistics")

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
    with pytest.raises(InvalidValueError, match="must be refitted"):
        fit_lognormal([1, 1, 2.05, 4, 4], [0, 0, 1, 0, 0]).goodness()


def test_repetitions_as_far_off_as_the_data_count_as_far_off():
    """One failure of 2 at each of two levels: the curve lies in the middle, a repetition is off by 0 or by as much.

    Statistics of so few trials tie, and a tie counts (Davison & Hinkley 1997, eq. 4.11): where every statistic is zero
    or equal, p is 1.
    """
    found = fit_lognormal([0.5, 0.6, 0.7], [1, 1, 2], [2, 2, 2]).goodness(repetitions=200)
    assert found.kolmogorov.p_value > 0.3
