"""Outcomes that come in clusters: which intervals are taken, when they are refused, and what is said of them."""

import math

import numpy as np
import pytest

from rocking.errors import InvalidValueError
from rocking.statistics import count_outcomes, fit_lognormal
from rocking.statistics.maximum_likelihood import LogScale, with_cluster_errors
from rocking.statistics.probit import Probit

pytestmark = pytest.mark.verifies(room="statistics")

LEVELS = np.geomspace(0.3, 2.1, 9)


def study(capacities, levels=LEVELS):
    """Fit of motions that fail at all levels above a capacity of their own; one cluster each."""
    failures = np.asarray(capacities)[:, None] < levels
    names = np.repeat(np.arange(len(capacities)), levels.size)
    return fit_lognormal(np.tile(levels, len(capacities)), failures.ravel(), clusters=names.tolist())


SPREAD = study(np.exp(0.5 * np.random.default_rng(3).normal(size=30)))


@pytest.mark.parametrize("kind", ["parametric", "cases", "clusters", "capacities"])
def test_a_bootstrap_knows_how_often_it_was_repeated(kind):
    """Thirty motions at nine levels, the study repeated 47 times: each kind says 47, and its own name."""
    sample = SPREAD.bootstrap(kind, repetitions=47, seed=1)
    assert (sample.kind, sample.repetitions) == (kind, 47)


def test_one_cluster_gives_no_bootstrap_and_no_certainty():
    """One motion at nine levels: the cluster bootstrap is refused, the interval open-ended, the verdict says why."""
    failed = [0, 0, 1, 0, 1, 0, 1, 1, 1]
    fit = fit_lognormal(LEVELS, failed, clusters=["one"] * 9)
    with pytest.raises(InvalidValueError, match="1 distinct cluster, where 5 are needed"):
        fit.interval("median", method="bootstrap")
    low, high = fit.interval("median")
    assert (low, high) == fit_lognormal(LEVELS, failed).interval("median")
    assert high > 1.5 * low
    assert fit.interval_method == fit.summary()["interval_method"] == "profile"
    assert "too narrow" in fit.verdict
    assert "are from the bootstrap" not in fit.verdict


@pytest.mark.parametrize("capacities", [[0.4, 0.6, 0.8, 1.2], [1.0] * 40 + [0.5, 0.7, 1.4]])
def test_fewer_than_five_distinct_clusters_are_refused(capacities):
    """Four motions, or forty-three of four distinct outcomes: both are flagged and keep the likelihood's interval."""
    fit = study(capacities)
    assert fit.counts.scarcity
    assert fit.interval_method == "profile"
    with pytest.raises(InvalidValueError, match="too narrow"):
        fit.bootstrap("clusters")


@pytest.mark.parametrize(("levels", "needed"), [(1, 2), (2, 3), (3, 4), (4, 5), (9, 5)])
def test_how_many_outcomes_must_differ(levels, needed):
    """One more than there are levels, five at most: so many of 42 clusters are enough, one less is told."""
    heights = np.arange(1.0, levels + 1.0)

    def scarcity(distinct):
        # the weakest clusters fail at all levels, each next kind at one less
        failed = (np.arange(42) % distinct + 0.5)[:, None] < heights
        names = np.repeat(np.arange(42), levels)
        return count_outcomes(np.tile(heights, 42), failed.ravel(), clusters=names.tolist()).scarcity

    assert scarcity(needed) == ""
    assert scarcity(needed - 1) == f"42 clusters of {needed - 1} distinct outcomes, where {needed} are needed"


def test_few_levels_leave_few_outcomes_that_can_differ():
    """At two levels only three outcomes can differ while they grow with the level: three are enough there."""
    random = np.random.default_rng(5)
    fit = study(np.exp(0.5 * random.normal(size=40)), np.array([0.7, 1.4]))
    assert fit.counts.distinct_clusters[1].size == 3
    assert (fit.counts.scarcity, fit.interval_method) == ("", "bootstrap")


def test_the_usual_interval_is_that_of_whole_clusters():
    """Interval, band and summary without a method are those of the cluster bootstrap, and the summary names it."""
    assert SPREAD.interval_method == "bootstrap"
    assert SPREAD.interval("median") == SPREAD.interval("median", method="bootstrap")
    assert SPREAD.interval("median") != SPREAD.interval("median", method="profile")
    for usual, asked in zip(SPREAD.band([0.5, 1.0]), SPREAD.band([0.5, 1.0], method="bootstrap"), strict=True):
        assert usual.tolist() == asked.tolist()
    told = SPREAD.summary()
    assert told["interval_method"] == "bootstrap"
    assert told["median_95"] == list(SPREAD.interval("median"))
    assert "whole clusters" in SPREAD.verdict
    single = fit_lognormal(LEVELS, [0, 0, 1, 0, 1, 0, 1, 1, 1], clusters=range(9))
    assert (single.interval_method, "cluster" in single.verdict) == ("profile", False)


@pytest.mark.verifies("computed anew", "the sandwich formula, summed cluster by cluster", within="1e-7")
def test_errors_of_clusters_by_the_sum_over_single_clusters():
    """The covariance is that of the textbook, H^-1 M H^-1, with M summed cluster by cluster from the likelihood."""
    counts, scale = SPREAD.counts, LogScale.of(SPREAD.counts)
    curves, position = SPREAD.curves, scale.position(counts.levels)[None]
    total = np.zeros((2, 2))
    for failures, trials in zip(counts.cluster_failures, counts.cluster_trials, strict=True):
        score = Probit(position, failures[None], (trials - failures)[None]).derivatives(curves.theta).gradient[0]
        total += np.outer(score, score)
    inverse = np.linalg.inv(curves.curvature[0])
    made = with_cluster_errors(counts, scale, curves, counts.distinct_clusters[1][None])
    np.testing.assert_allclose(np.linalg.inv(made.curvature[0]), inverse @ total @ inverse, rtol=1e-7)


def test_a_hundred_thousand_clusters_are_drawn_by_their_outcomes():
    """Clusters alike are drawn together: of 30 000 motions at nine levels only the ten outcomes are held."""
    fit = study(np.exp(0.5 * np.random.default_rng(4).normal(size=30_000)))
    assert fit.counts.distinct_clusters[1].sum() == 30_000
    assert fit.counts.distinct_clusters[0].shape == (10, 18)
    low, high = fit.interval("median")
    assert low < 1.0 < high
    # the median of 30 000 capacities of dispersion 0.5 is known to 0.5 sqrt(pi / 2) / sqrt(30 000) = 0.0036 at best
    assert 0.005 < math.log(high / low) < 0.03
