"""Outcomes are checked and pooled before anything is fitted."""

import numpy as np
import pytest

from rocking.errors import InvalidValueError
from rocking.statistics import count_outcomes, count_states


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
        ([1.0, 2.0], [0.5, 1], {}, "whole numbers >= 0, got 0.5 at index 0; a fraction"),
        ([1.0, 2.0], [-1, 1], {}, "got -1 at index 0"),
        ([1.0, 2.0], [np.nan, 1], {}, "got nan at index 0"),
        ([1.0, 2.0], [3, 1], {}, "failures must not exceed trials, got 3 of 1 at index 0; is trials= missing"),
        ([1.0, 2.0], [0, 5], {"trials": [4, 4]}, "got 5 of 4 at index 1"),
        ([1.0, 2.0], [0, 0], {"trials": [4, 0]}, "trials must be whole numbers >= 1, got 0 at index 1; leave out"),
        ([1.0, 2.0], [0, 0, 0], {}, "failures must have one number a level: 2, got 3"),
        ([1.0, 1.0 + 1e-15], [0, 1], {}, "rounding of one and the same level"),
        ([1.0, 2.0], [0, 1], {"clusters": ["a"]}, "clusters must name one cluster a level: 2, got 1"),
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
