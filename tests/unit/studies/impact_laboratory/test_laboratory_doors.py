"""What counts in the impact laboratory is a whole number, or it is refused."""

import math

import numpy as np
import pytest

from rocking.errors import InvalidValueError
from rocking.restitution.bed import fast
from rocking.studies.impact_laboratory import Laboratory, points_study, profile, profile_study, random_profiles


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: profile("random", 1e-3, 5, seed=-1), "seed must be a whole number of at least 0, got -1"),
        (lambda: profile("random", 1e-3, 5, seed=0.5), "seed must be a whole number of at least 0, got 0.5"),
        (lambda: profile("random", 1e-3, 5, seed="a"), "seed must be a number"),
        (lambda: profile("random", 1e-3, 5, seed=math.nan), "seed must be finite"),
        (lambda: profile("convex", 1e-3, 2.5), "points must be a whole number of at least 2, got 2.5"),
        (lambda: profile("convex", 1e-3, 1), "points must be a whole number of at least 2, got 1"),
        (lambda: profile("convex", -1e-3, 5), "amplitude must be in"),
        (lambda: profile("wavy", 1e-3, 5), "shape must be one of convex, concave, tilted, random"),
    ],
)
def test_profiles(make, words):
    """Seeds, points, amplitudes and shapes that are none are refused with their range."""
    with pytest.raises(InvalidValueError, match=words):
        make()


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: points_study([2.7, 3]), "points must be a whole number of at least 2, got 2.7"),
        (lambda: points_study([1, 3]), "points must be a whole number of at least 2, got 1"),
        (lambda: random_profiles(1e-3, [0, 1.5]), "seed must be a whole number of at least 0, got 1.5"),
        (lambda: random_profiles(1e-3, [-1]), "seed must be a whole number of at least 0, got -1"),
        (lambda: profile_study("random", [1e-3], seed=-1), "seed must be a whole number"),
    ],
)
def test_studies(make, words):
    """A study computes what its coordinate says, or nothing."""
    pytest.importorskip("xarray")
    with pytest.raises(InvalidValueError, match=words):
        make()


def test_whole_numbers_of_any_kind_are_taken():
    """Integers of NumPy and floats without a fraction count; the same seed is the same base."""
    heights = profile("random", 1e-3, 5, seed=3)
    assert profile("random", 1e-3, np.int64(5), seed=3.0) == heights
    assert profile("random", 1e-3, 5, seed=4) != heights


@pytest.mark.skipif(not fast.available(), reason="the bed's fast engine was not built")
def test_points_are_what_the_coordinate_says():
    """Points given as floats: each result is that of a laboratory with so many points."""
    pytest.importorskip("xarray")
    start = Laboratory(slenderness=4.0)
    found = points_study([2.0, 3.0], start)
    assert found.points.values.tolist() == [2.0, 3.0]
    alone = [points_study([count], start).coefficient.values[0] for count in (2, 3)]
    assert found.coefficient.values.tolist() == alone
    assert alone[0] != alone[1]
