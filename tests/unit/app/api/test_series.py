"""Thinning keeps what can be seen: in every dot of the picture, what all samples would have covered."""

import numpy as np
import pytest

from rocking.app.api.response import thinned

TIME = np.linspace(0.0, 30.0, 30_001)
WAVE = np.sin(7.0 * TIME) * np.exp(-0.1 * TIME)
NOISE = np.random.default_rng(1).normal(size=TIME.size)
GAPS = np.where((TIME * 3.0) % 2.0 < 0.3, np.nan, 1.0 / np.maximum(np.abs(WAVE), 1e-9))
LEANING = np.where(WAVE > 0.0, 0.03 * WAVE, 1.7 * WAVE)
CURVES = {"wave": (WAVE,), "both": (WAVE, NOISE), "gaps": (GAPS, LEANING)}


def by_dot(points, window=(0.0, 30.0)):
    """Of every sample the dot over which it is drawn."""
    first, last = window
    return np.clip((TIME - first) / (last - first) * points, -1, points).astype(int)


def span(values):
    """Least and largest of what is a number."""
    return (np.nan, np.nan) if np.isnan(values).all() else (np.nanmin(values), np.nanmax(values))


@pytest.mark.parametrize("curves", CURVES)
@pytest.mark.parametrize("points", [10, 57, 640, 2000])
def test_every_dot_covers_what_all_samples_would(curves, points):
    """Each curve has in each dot its least and largest value, its first and last, and a gap where it has one."""
    kept = thinned(TIME, CURVES[curves], points)
    assert np.all(np.diff(kept) > 0)
    assert kept.size <= points * (2 + 4 * len(CURVES[curves])) + 2
    dot, chosen = by_dot(points), np.isin(np.arange(TIME.size), kept)
    for curve in CURVES[curves]:
        for k in range(points):
            whole, drawn = curve[dot == k], curve[(dot == k) & chosen]
            assert np.array_equal(span(whole), span(drawn), equal_nan=True)
            assert np.isnan(whole).any() == np.isnan(drawn).any()
            assert np.array_equal(whole[[0, -1]], drawn[[0, -1]], equal_nan=True)


def test_a_spike_of_one_sample_stays_and_nothing_else_would_have_it():
    """A spike of one sample is drawn wherever it stands; negative controls, every nth sample and means, lose it."""
    for place in (0, 1, 12_347, 15_000, TIME.size - 1):
        spike = LEANING.copy()
        spike[place] = -9.0
        assert spike[thinned(TIME, (NOISE, spike), 600)].min() == -9.0
    assert spike[:-1:15].min() > -9.0
    assert spike[:-1].reshape(-1, 15).mean(axis=1).min() > -9.0


def test_a_short_curve_is_kept_whole():
    """Nothing is left out where there are no more than two samples for each dot."""
    assert thinned(TIME[:50], (WAVE[:50],), 25).tolist() == list(range(50))


def test_part_of_the_time_is_cut_out_with_its_neighbours():
    """Within a window all samples are there once they fit, and one on either side: lines reach its ends."""
    kept = thinned(TIME, (NOISE,), 600, (7.0002, 7.9998))
    assert kept.tolist() == list(range(7000, 8001))
    wide = thinned(TIME, (NOISE,), 600, (5.0, 15.0))
    assert (wide[0], wide[-1]) == (5000, 15_000)
    dot, chosen = by_dot(600, (5.0, 15.0)), np.isin(np.arange(TIME.size), wide)
    for k in range(600):
        assert span(NOISE[dot == k]) == span(NOISE[(dot == k) & chosen])
    assert thinned(TIME, (NOISE,), 600, (40.0, 50.0)).tolist() == [TIME.size - 1]


def test_equal_times_are_no_matter():
    """Two values at one time, as at a jump that is drawn upright, are both kept."""
    time = np.repeat(np.arange(5000.0), 2)
    jump = np.tile([0.0, 1.0], 5000)
    kept = thinned(time, (jump,), 100)
    assert {*jump[kept]} == {0.0, 1.0}
