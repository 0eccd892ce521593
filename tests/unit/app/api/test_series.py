"""Thinning keeps what can be seen: ends, extremes, and a bound on what the straight lines miss."""

import numpy as np
import pytest

from rocking.app.api.series import merged, thinned

TIME = np.linspace(0.0, 30.0, 30_001)
WAVE = np.sin(7.0 * TIME) * np.exp(-0.1 * TIME)
NOISE = np.random.default_rng(1).normal(size=TIME.size)


@pytest.mark.parametrize("points", [10, 57, 300, 2000, 20_000])
def test_never_more_than_asked(points):
    """At most `points` samples are kept, in increasing order, each once, the first and the last among them."""
    kept = thinned((WAVE, NOISE), points)
    assert kept.size <= points
    assert (kept[0], kept[-1]) == (0, TIME.size - 1)
    assert np.all(np.diff(kept) > 0)


@pytest.mark.parametrize("points", [10, 300, 2000])
def test_extremes_of_every_curve_are_kept(points):
    """The largest and the smallest value of each curve survive, down to ten points."""
    kept = thinned((WAVE, NOISE), points)
    for curve in (WAVE, NOISE):
        assert curve[kept].max() == curve.max()
        assert curve[kept].min() == curve.min()


def test_a_short_curve_is_kept_whole():
    """Nothing is left out where there are no more samples than asked for."""
    assert thinned((WAVE[:50],), 50).tolist() == list(range(50))


def missed(curve, kept):
    """Largest distance of the curve from the straight lines between kept samples."""
    return np.abs(np.interp(TIME, TIME[kept], curve[kept]) - curve)


@pytest.mark.parametrize("curves", [(WAVE,), (WAVE, NOISE)])
def test_straight_lines_stay_within_the_stated_bound(curves):
    """Nowhere do the lines leave a curve by more than it changes within two neighbouring runs."""
    points = 1000
    kept = thinned(curves, points)
    length = -(-TIME.size // ((points - 2) // (2 * len(curves))))
    for curve in curves:
        rows = np.pad(curve, (0, -TIME.size % length), mode="edge").reshape(-1, length)
        low, high = rows.min(axis=1), rows.max(axis=1)
        before, after = np.roll(low, 1), np.roll(low, -1)
        lowest = np.minimum(low, np.minimum(before, after))
        highest = np.maximum(high, np.maximum(np.roll(high, 1), np.roll(high, -1)))
        bound = np.repeat(highest - lowest, length)[: TIME.size]
        assert np.all(missed(curve, kept) <= bound)


def test_a_smooth_curve_misses_little():
    """A sine of 7 rad/s whose samples are at most two runs of 31 ms apart is missed by less than 7^2 h^2 / 8."""
    assert missed(WAVE, thinned((WAVE,), 2000)).max() < 49.0 * 0.062**2 / 8.0


def test_negative_control_every_nth_sample_loses_a_spike():
    """Plain decimation, which this is not, loses a spike of one sample; the thinning keeps it."""
    spike = WAVE.copy()
    spike[12_347] = 9.0
    every = np.arange(0, TIME.size, 15)
    assert spike[every].max() < 9.0
    assert spike[thinned((spike,), 2000)].max() == 9.0


def test_instants_are_merged_in_order():
    """Impact instants come in among the samples once each; one that is a sample already adds nothing."""
    time, at = merged(np.array([0.0, 1.0, 2.0]), np.array([0.5, 1.0, 1.5, 1.5, 9.0]))
    assert time.tolist() == [0.0, 0.5, 1.0, 1.5, 2.0]
    assert time[at].tolist() == [0.5, 1.0, 1.5]
