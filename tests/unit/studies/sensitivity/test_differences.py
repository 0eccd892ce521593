"""Flips counted right, intervals that cover, differences only where both stood."""

import numpy as np
import pytest
from scipy import stats

from rocking.errors import InvalidValueError
from rocking.outcome import Outcome
from rocking.statistics import share_interval
from rocking.studies.sensitivity.changes import Flips, difference_of, flip_map, flips_of

STILL, ROCKED, OVER, FAILED = range(4)


def test_a_flip_is_a_change_of_the_verdict_alone():
    """Only overturned or not counts: lifting or not is no flip; a failed history has no verdict."""
    first = [STILL, ROCKED, ROCKED, OVER, OVER, FAILED, OVER]
    second = [ROCKED, ROCKED, OVER, STILL, OVER, OVER, FAILED]
    assert flip_map(first, second).tolist() == [0, 0, 1, -1, 0, 2, 2]
    found = flips_of(first, second)
    assert (found.count, found.gained, found.lost, found.compared, found.unknown) == (2, 1, 1, 5, 2)
    assert found.share == 0.4


def test_the_other_way_round_gains_what_was_lost():
    """Exchanging the results exchanges gained and lost and leaves share and interval."""
    rng = np.random.default_rng(1)
    first, second = rng.integers(0, 4, (2, 30, 8))
    there, back = flips_of(first, second), flips_of(second, first)
    assert (there.gained, there.lost) == (back.lost, back.gained)
    assert (there.low, there.high) == (back.low, back.high)


@pytest.mark.parametrize(("hits", "size"), [(0, 50), (3, 50), (25, 50), (50, 50)])
def test_the_interval_is_the_exact_binomial_one(hits, size):
    """The interval of independent cells is that of scipy's exact binomial test."""
    expected = stats.binomtest(hits, size).proportion_ci(0.95, "exact")
    assert share_interval(hits, size) == pytest.approx((expected.low, expected.high), rel=1e-9, abs=1e-12)


def coverage(by_motion, repetitions=400):
    """Share of intervals that hold the true share, for histories that are alike within a motion."""
    rng = np.random.default_rng(7)
    inside = 0
    for _ in range(repetitions):
        second = np.where(rng.random((40, 12)) < rng.beta(1.0, 4.0, (40, 1)), OVER, ROCKED)  # mean 0.2
        motions = np.arange(40)[:, None] if by_motion else None
        found = flips_of(np.full_like(second, ROCKED), second, motions, drawn=not by_motion)
        inside += found.low <= 0.2 <= found.high
    return inside / repetitions


def test_intervals_by_motion_cover():
    """Intervals by motion hold the truth in 93 % or more of 400 studies; those by history in less than 80 %."""
    assert coverage(by_motion=True) >= 0.93
    assert coverage(by_motion=False) < 0.80


def test_no_flips_are_as_sure_as_there_are_motions():
    """Without any flip the upper end is that of as many trials as there are motions: 1 - 0.025^(1/20)."""
    same = np.full((20, 50), ROCKED)
    found = flips_of(same, same, np.arange(20)[:, None])
    assert (found.count, found.low, found.clusters) == (0, 0.0, 20)
    assert found.high == pytest.approx(1.0 - 0.025 ** (1.0 / 20.0), rel=1e-12)


def test_one_motion_is_no_sample_of_motions():
    """With a single motion there is no interval, unless every history has draws of its own: these are counted."""
    first, second = np.full((1, 50), ROCKED), np.full((1, 50), OVER)
    assert flips_of(first, second, [[0]], drawn=True) == Flips(50, 50, 50, 0, *share_interval(50, 50), 0)
    for motions in ([[0]], None):
        found = flips_of(first, second, motions)
        assert (found.count, found.share, found.clusters) == (50, 1.0, 0)
        assert np.isnan([found.low, found.high]).all()


@pytest.mark.parametrize(
    ("first", "second", "message"),
    [
        ([0, 1], [0, 1, 2], "one shape"),
        ([0, len(Outcome)], [0, 1], "codes"),
        ([0, -1], [0, 1], "codes"),
        ([0.5, 1.0], [0, 1], "codes"),
        ([3, 3], [1, 2], "all 2 histories failed"),
    ],
)
def test_what_cannot_be_compared_is_refused(first, second, message):
    """Other shapes, other codes, and results without a verdict are refused."""
    with pytest.raises(InvalidValueError, match=message):
        flips_of(first, second)


def test_values_are_compared_where_both_stood():
    """A difference is missing where either overturned, infinite peaks and quarter turns included."""
    xr = pytest.importorskip("xarray")

    def result(outcome, ratio):
        return xr.Dataset({"outcome": ("x", outcome), "ratio": ("x", ratio, {"units": "1"}), "word": ("x", ["a"] * 4)})

    first = result([STILL, ROCKED, OVER, OVER], [0.0, 0.5, np.inf, np.inf])
    second = result([ROCKED, ROCKED, ROCKED, OVER], [0.25, 0.25, 0.75, np.inf])
    assert difference_of(first, second, "ratio").values.tolist()[:2] == [0.25, -0.25]
    assert np.isnan(difference_of(first, second, "ratio").values[2:]).all()
    moved = result([Outcome.SLID.code, Outcome.FLEW.code, FAILED, OVER], [0.25, 0.5, 0.5, 0.5])
    found = difference_of(first, moved, "ratio").values
    assert found[:2].tolist() == [0.25, 0.0]  # what slid or flew and did not overturn stood as well
    assert np.isnan(found[2:]).all()
    assert difference_of(first, second, "verdict").values.tolist() == [0, 0, -1, 0]
    with pytest.raises(InvalidValueError, match="verdict or one of outcome, ratio"):
        difference_of(first, second, "word")


def test_peak_rotations_differ_by_their_sizes():
    """0.10 to the right and 0.12 to the left differ by 0.02, not by 0.22; and the long name says that it is sizes."""
    xr = pytest.importorskip("xarray")
    first, second = (
        xr.Dataset({"outcome": ("x", [ROCKED] * 3), "peak_rotation": ("x", peaks, {"units": "rad"})})
        for peaks in ([0.10, -0.10, -0.2], [-0.12, 0.07, -0.3])
    )
    found = difference_of(first, second, "peak_rotation")
    assert found.values == pytest.approx([0.02, -0.03, 0.1], rel=1e-12)
    assert found.attrs["long_name"] == "difference of the size of peak_rotation; missing where either did not stand"
    assert found.attrs["units"] == "rad"
