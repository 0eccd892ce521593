"""Quantiles, and counts of outcomes."""

import ast
import math
import statistics
from pathlib import Path

import numpy as np
import pytest

import rocking
from rocking.errors import InvalidValueError
from rocking.statistics import count_outcomes, count_states
from rocking.statistics.quantiles import quantiles

SOURCE = Path(rocking.__file__).parent


@pytest.mark.parametrize("count", [1, 2, 3, 10, 24])
def test_medians_are_those_of_the_standard_library(count):
    """The median of an even number is the mean of the middle two."""
    values = np.random.default_rng(count).lognormal(size=count)
    assert quantiles(values, 0.5) == pytest.approx(statistics.median(values.tolist()), rel=1e-15)
    if count % 2 == 0:  # negative control
        assert quantiles(values, 0.5) != pytest.approx(statistics.median_low(values.tolist()), rel=1e-3)


def test_quantiles_are_linear_between_neighbours():
    """By hand: 84 % of 1, 2, 4, 8 is at rank 2.52, 16 % at .48; the ends are the extremes."""
    found = quantiles([8.0, 1.0, 4.0, 2.0], [0.0, 0.16, 0.84, 1.0])
    np.testing.assert_allclose(found, [1.0, 1.48, 4.0 + 0.52 * 4.0, 8.0], rtol=1e-15)


@pytest.mark.parametrize("axis", [0, 1, 2, -1])
def test_shapes_are_those_of_numpy(axis):
    values = np.random.default_rng(3).normal(size=(5, 4, 3))
    for probabilities in (0.5, [0.025, 0.3, 0.975], [[0.1, 0.2]]):
        wanted = np.quantile(values, probabilities, axis=axis)
        np.testing.assert_allclose(quantiles(values, probabilities, axis=axis), wanted, rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize(
    ("values", "median"),
    [
        ((1.0, math.inf), math.inf),  # of two motions one overturns: the median is beyond the finite rotation
        ((math.inf, math.inf), math.inf),
        ((-math.inf, 1.0), -math.inf),
        ((-math.inf, -math.inf), -math.inf),
        ((1.0, 2.0, math.inf), 2.0),
        ((1.0, 2.0, 4.0, math.inf), 3.0),
        ((math.nan, 1.0, 2.0), 1.5),
        ((-math.inf, math.inf), math.nan),
        ((math.nan,), math.nan),
        ((), math.nan),
    ],
)
def test_infinite_values_lie_beyond_all_others(values, median):
    np.testing.assert_equal(float(quantiles(values, 0.5)), median)


def test_a_rank_that_rounding_moves_stays_a_rank():
    """0.28 * 25 is 7.000000000000001: rounding must not let an infinite neighbour in."""
    values = np.where(np.arange(26) > 7, math.inf, np.arange(26.0))
    assert quantiles(values, 0.28) == 7.0
    assert quantiles(values, 0.2801) == math.inf


def test_missing_values_count_in_no_column():
    values = np.array([[1.0, math.nan], [2.0, 5.0], [4.0, 7.0], [9.0, math.nan]])
    np.testing.assert_allclose(quantiles(values, 0.5), [3.0, 6.0])


@pytest.mark.parametrize("probability", [-0.5, 1.001, [0.5, -1e-9], math.nan])
def test_probabilities_are_within_0_and_1(probability):
    with pytest.raises(InvalidValueError, match="probabilities"):
        quantiles([1.0, 2.0, 3.0], probability)


SECOND = {"quantile", "nanquantile", "percentile", "nanpercentile"}


def second_definitions(source: str) -> list[str]:
    """Return calls that choose another definition than the default one."""
    calls = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Call)]
    named = [(getattr(call.func, "attr", getattr(call.func, "id", "")), call) for call in calls]
    return [
        f"{name}, line {call.lineno}"
        for name, call in named
        if name in {"median_low", "median_high"}
        or (name in SECOND and any(word.arg in {"method", "interpolation"} for word in call.keywords))
    ]


@pytest.mark.slow
def test_no_other_definition_is_chosen_anywhere():
    """NumPy's default and `quantiles` are one definition: no call chooses another one."""
    found = {path.name: second_definitions(path.read_text("utf-8")) for path in SOURCE.rglob("*.py")}
    assert {name: calls for name, calls in found.items() if calls} == {}
    # negative control
    assert second_definitions("np.quantile(x, 0.5, method='inverted_cdf')") == ["quantile, line 1"]
    assert second_definitions("import statistics\nstatistics.median_low(x)") == ["median_low, line 2"]


def test_equal_levels_are_pooled():
    """Entries of one level become one, in ascending order."""
    counts = count_outcomes([0.4, 0.2, 0.4], [True, False, False])
    assert counts.levels.tolist() == [0.2, 0.4]
    assert counts.failures.tolist() == [0.0, 1.0]
    assert counts.trials.tolist() == [1.0, 2.0]
    assert counts.observations == 3


def test_clusters_keep_their_outcomes_together():
    """The table by cluster adds up to the pooled counts."""
    counts = count_outcomes([0.1, 0.2, 0.1, 0.2], [0, 1, 0, 0], clusters=["a", "a", "b", "b"])
    assert counts.cluster_failures.tolist() == [[0.0, 1.0], [0.0, 0.0]]
    assert counts.cluster_trials.sum(axis=0).tolist() == counts.trials.tolist()


@pytest.mark.parametrize(
    ("levels", "failures", "more", "words"),
    [
        ([0.0, 1.0], [0, 1], {}, "levels must be finite and > 0, got 0 at index 0"),
        ([1.0, -1.0], [0, 1], {}, "got -1 at index 1"),
        ([1.0, np.nan], [0, 1], {}, "got nan at index 1"),
        ([1.0, np.inf], [0, 1], {}, "got inf at index 1"),
        ([], [], {}, "at least one number"),
        ([[1.0]], [[1]], {}, "one row"),
        ("abc", [1], {}, "levels must be numbers"),
        ([1.0, 2.0], [0.5, 1], {}, "whole numbers >= 0, got 0.5 at index 0; Use counts"),
        ([1.0, 2.0], [-1, 1], {}, "got -1 at index 0"),
        ([1.0, 2.0], [np.nan, 1], {}, "got nan at index 0"),
        ([1.0, 2.0], [3, 1], {}, r"failures must not exceed trials, got 3 of 1 at index 0\. Check trials="),
        ([1.0, 2.0], [0, 5], {"trials": [4, 4]}, "got 5 of 4 at index 1"),
        ([1.0, 2.0], [0, 0], {"trials": [4, 0]}, "trials must be whole numbers >= 1, got 0 at index 1; Remove levels"),
        ([1.0, 2.0], [0, 0, 0], {}, "failures must have one number per level: 2, got 3"),
        ([1.0, 1.0 + 1e-15], [0, 1], {}, "Use one level"),
        ([1.0, 2.0], [0, 1], {"clusters": ["a"]}, "clusters must contain one name per level: 2, got 1"),
    ],
)
def test_bad_outcomes_are_refused(levels, failures, more, words):
    """Each kind of bad input is refused with a sentence that names it."""
    with pytest.raises(InvalidValueError, match=words):
        count_outcomes(levels, failures, **more)
    with pytest.raises(InvalidValueError, match="overturned must not exceed rocked, got 2 of 1 at index 1"):
        count_states([1.0, 2.0], [0, 1], [0, 2], [4, 4])


@pytest.mark.parametrize(
    ("levels", "clusters", "expected"),
    [
        ([1.0, 2.0, 1.0, 2.0], "aabb", True),
        ([1.0, 2.0, 3.0], "aaa", False),
        ([1.0, 1.0, 1.0], "abc", False),
        ([1.0, 2.0, 1.0], "aab", False),
        ([1.0, 2.0, 1.0, 2.0], "aaaa", False),
    ],
)
def test_records_that_are_raised_level_by_level(levels, clusters, expected):
    """Two records or more, two levels or more, each of each once."""
    counts = count_outcomes(levels, [False] * len(levels), clusters=list(clusters))
    assert counts.tries_all_levels is expected
