"""Flips and curves: what differs between two results, how surely, and by how much."""

import numpy as np
import pytest
from scipy import optimize, stats

from rocking.errors import InvalidValueError
from rocking.outcome import Outcome
from rocking.statistics import share_interval
from rocking.studies.sensitivity.changes import (
    Flips,
    curve_change,
    curve_distance,
    difference_of,
    fits,
    flip_map,
    flips_of,
    signed,
)

STILL, ROCKED, OVER, FAILED = range(4)


def test_a_flip_is_a_change_of_the_verdict_alone():
    """Only overturned or not counts: lifting or not is no flip; a failed history has no verdict."""
    first = [STILL, ROCKED, ROCKED, OVER, OVER, FAILED, OVER]
    second = [ROCKED, ROCKED, OVER, STILL, OVER, OVER, FAILED]
    assert flip_map(first, second).tolist() == [0, 0, 1, -1, 0, 2, 2]
    found = flips_of(first, second)
    assert (found.count, found.only_second, found.only_first, found.compared, found.unknown) == (2, 1, 1, 5, 2)
    assert found.fraction == 0.4


def test_the_other_way_round_gains_what_was_lost():
    """Exchanging the results exchanges gained and lost and leaves share and interval."""
    rng = np.random.default_rng(1)
    first, second = rng.integers(0, 4, (2, 30, 8))
    there, back = flips_of(first, second), flips_of(second, first)
    assert (there.only_second, there.only_first) == (back.only_first, back.only_second)
    assert (there.fraction_low, there.fraction_high) == (back.fraction_low, back.fraction_high)


def coverage(by_motion, repetitions=400):
    """Share of intervals that hold the true share, for histories that are alike within a motion."""
    rng = np.random.default_rng(7)
    inside = 0
    for _ in range(repetitions):
        second = np.where(rng.random((40, 12)) < rng.beta(1.0, 4.0, (40, 1)), OVER, ROCKED)  # mean 0.2
        motions = np.arange(40)[:, None] if by_motion else None
        found = flips_of(np.full_like(second, ROCKED), second, motions, sampled=not by_motion)
        inside += found.fraction_low <= 0.2 <= found.fraction_high
    return inside / repetitions


@pytest.mark.slow
def test_intervals_by_motion_cover():
    """Intervals by motion hold the truth in 93 % or more of 400 studies; those by history in less than 80 %."""
    assert coverage(by_motion=True) >= 0.93
    assert coverage(by_motion=False) < 0.80


def test_no_flips_are_as_sure_as_there_are_motions():
    """Without any flip the upper end is that of as many trials as there are motions: 1 - 0.025^(1/20)."""
    same = np.full((20, 50), ROCKED)
    found = flips_of(same, same, np.arange(20)[:, None])
    assert (found.count, found.fraction_low, found.clusters) == (0, 0.0, 20)
    assert found.fraction_high == pytest.approx(1.0 - 0.025 ** (1.0 / 20.0), rel=1e-12, abs=0.0)


def test_one_motion_is_no_sample_of_motions():
    """With a single motion there is no interval, unless every history has draws of its own: these are counted."""
    first, second = np.full((1, 50), ROCKED), np.full((1, 50), OVER)
    assert flips_of(first, second, [[0]], sampled=True) == Flips(50, 50, 50, 0, *share_interval(50, 50), 0)
    for motions in ([[0]], None):
        found = flips_of(first, second, motions)
        assert (found.count, found.fraction, found.clusters) == (50, 1.0, 0)
        assert np.isnan([found.fraction_low, found.fraction_high]).all()


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
    assert found.values == pytest.approx([0.02, -0.03, 0.1], rel=1e-12, abs=0.0)
    assert found.attrs["long_name"].startswith("difference of the absolute peak_rotation; missing if")
    assert found.attrs["units"] == "rad"


LEVELS = np.geomspace(0.4, 4.0, 9)


def test_equal_dispersions_are_farthest_apart_half_way():
    """With equal dispersions the distance is 2 Phi(d / 2 beta) - 1, half way between the logarithms of the medians."""
    for apart, beta in ((1.0, 0.5), (-0.3, 0.4), (1e-9, 0.4)):
        distance, where = curve_distance(np.array([0.2, 0.2 + apart]), np.array([beta, beta]))
        assert distance == pytest.approx(2.0 * stats.norm.cdf(abs(apart) / (2.0 * beta)) - 1.0, rel=1e-7)
        assert where == pytest.approx(0.2 + 0.5 * apart, abs=1e-12)


def test_equal_medians_are_farthest_apart_at_the_closed_form():
    """With equal medians the densities are equal at u^2 = 2 ln(t/s) / (1/s^2 - 1/t^2)."""
    s, t = 0.3, 0.7
    u = np.sqrt(2.0 * np.log(t / s) / (1.0 / s**2 - 1.0 / t**2))
    distance, where = curve_distance(np.zeros(2), np.array([s, t]))
    assert abs(where) == pytest.approx(u, rel=1e-12, abs=0.0)
    assert distance == pytest.approx(stats.norm.cdf(u / s) - stats.norm.cdf(u / t), rel=1e-12, abs=0.0)


@pytest.mark.slow
def test_no_place_is_farther_apart():
    """On 300 random pairs, nearly equal dispersions among them, a numerical search finds the same largest distance."""
    rng = np.random.default_rng(3)
    for k in range(300):
        m, s = rng.normal(size=2), np.exp(0.7 * rng.normal(size=2))
        if k % 4 == 0:
            s[1] = s[0] * (1.0 + 1e-9 * rng.normal())

        def apart(u, m=m, s=s):
            return np.abs(stats.norm.cdf((u - m[0]) / s[0]) - stats.norm.cdf((u - m[1]) / s[1]))

        grid = np.linspace(-15.0, 15.0, 3001)
        best = grid[apart(grid).argmax()]
        found = optimize.minimize_scalar(lambda u: -apart(u), bounds=(best - 0.02, best + 0.02), method="bounded")
        assert curve_distance(m, s)[0] == pytest.approx(-found.fun, abs=1e-9)


def test_identical_curves_do_not_differ():
    """A curve and itself: no distance, ratio one, difference zero, also in every set of motions."""
    hits = np.exp(0.4 * np.random.default_rng(1).normal(size=(60, 1))) < LEVELS
    found = curve_change(((1.0, 0.4), (1.0, 0.4)), LEVELS, hits, hits, repetitions=50)
    assert (found.median.value, found.dispersion.value, found.distance.value) == (1.0, 0.0, 0.0)
    assert (found.median.interval, found.dispersion.interval, found.distance.interval) == ((1, 1), (0, 0), (0, 0))


def fitted(hits):
    """Curve of stripes by maximum likelihood, straight from the definition."""
    z, n = hits.sum(axis=0), len(hits)

    def loss(parameters):
        eta = (np.log(LEVELS) - parameters[0]) / np.exp(parameters[1])
        return -(z * stats.norm.logcdf(eta) + (n - z) * stats.norm.logcdf(-eta)).sum()

    best = optimize.minimize(loss, [0.3, -1.0], method="Nelder-Mead", options={"xatol": 1e-10, "fatol": 1e-12})
    return best.x[0], np.exp(best.x[1])


@pytest.mark.slow
def test_curves_are_the_likeliest():
    """Curves of sets of motions agree with a direct maximisation of the likelihood to 1e-6."""
    rng = np.random.default_rng(5)
    for _ in range(5):
        hits = 1.3 * np.exp(0.4 * rng.normal(size=(40, LEVELS.size))) < LEVELS
        found = fits(LEVELS, hits.sum(axis=0)[np.newaxis].astype(float), np.full((1, LEVELS.size), 40.0))
        assert found[:, 0] == pytest.approx(fitted(hits), abs=1e-6)


def capacities(rng, motions):
    """Capacities of the same motions under two choices: medians 1.2 and 1.32, nearly the same scatter by motion."""
    common = 0.4 * rng.normal(size=(motions, 1))
    own = 0.05 * rng.normal(size=(2, motions, 1))
    return 1.2 * np.exp(common + own[0]), 1.32 * np.exp(common + own[1])


@pytest.mark.slow
def test_intervals_of_the_ratio_cover():
    """Of 200 studies with 60 motions, about 95 % of the intervals hold the true ratio of medians, 1.1."""
    rng, inside = np.random.default_rng(11), 0
    for k in range(200):
        first, second = (capacity < LEVELS for capacity in capacities(rng, 60))
        curves = tuple((np.exp(m), b) for m, b in (_curve(first), _curve(second)))
        interval = curve_change(curves, LEVELS, first, second, repetitions=200, seed=k).median.interval
        inside += interval[0] <= 1.1 <= interval[1]
    # four standard deviations of a binomial share of 200 below 0.95, two above
    assert 0.89 <= inside / 200 <= 0.98


def _curve(hits):
    return fits(LEVELS, hits.sum(axis=0)[np.newaxis].astype(float), np.full((1, LEVELS.size), float(len(hits))))[:, 0]


def test_pairing_is_what_makes_the_interval_narrow():
    """With the motions of one choice shuffled the interval is more than twice as wide: pairs were really kept."""
    first, second = (capacity < LEVELS for capacity in capacities(np.random.default_rng(2), 60))
    curves = ((1.2, 0.4), (1.32, 0.4))
    paired, shuffled = (
        curve_change(curves, LEVELS, first, other).median.interval
        for other in (second, np.random.default_rng(0).permutation(second))
    )
    assert 2.0 * (paired[1] - paired[0]) < shuffled[1] - shuffled[0]


def test_failed_histories_count_on_neither_side():
    """A history that failed with one choice is left out of both curves: the change is that of the other motions."""
    first, second = ((capacity < LEVELS).astype(float) for capacity in capacities(np.random.default_rng(4), 60))
    first[:3], second[3:6] = np.nan, np.nan
    found = curve_change(((1.2, 0.4), (1.3, 0.4)), LEVELS, first, second, repetitions=200)
    hidden, wrong = [[values.copy() for values in (first, second)] for _ in range(2)]
    hidden[0][3:6], hidden[1][:3] = 1.0, 0.0  # what the other choice gave for a history that failed
    wrong[0][:3] = 0.0  # a failed history taken for one that stood
    again, other = (curve_change(((1.2, 0.4), (1.3, 0.4)), LEVELS, *pair, repetitions=200) for pair in (hidden, wrong))
    assert again == found
    assert other != found


def test_without_curves_there_is_no_interval():
    """Where nothing ever reaches the state no curve exists, and no interval is claimed."""
    nothing = np.zeros((20, LEVELS.size))
    found = curve_change(((1.0, 0.4), (1.1, 0.4)), LEVELS, nothing, nothing, repetitions=50)
    assert (found.median.interval, found.without_curve) == (None, 50)
    assert "no interval" in found.text("m/s2")


def test_words():
    """A rise and a fall are told apart."""
    assert [signed(x) for x in (0.1, -0.1, 0.0)] == ["+10 %", "-10 %", "+0 %"]
    hits = 1.2 * np.exp(0.4 * np.random.default_rng(1).normal(size=(60, 1))) < LEVELS
    for second, word in ((1.32, "the median changes by +10 % "), (1.08, "the median changes by -10 % ")):
        found = curve_change(((1.2, 0.4), (second, 0.4)), LEVELS, hits, hits, repetitions=10)
        assert word in found.text("g", 2.0)
        assert found.text("g", 2.0).endswith(f" at {found.level / 2.0:.4g} g")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"levels": LEVELS[::-1]}, "must increase from value to value"),
        ({"levels": [1.0]}, "two or more"),
        ({"levels": -LEVELS}, "> 0"),
        ({"first": np.zeros((20, 3))}, "shape"),
        ({"first": np.zeros((19, LEVELS.size))}, "same motions"),
        ({"second": np.full((20, LEVELS.size), 2.0)}, "0 or 1"),
        ({"curves": ((1.0, 0.0), (1.0, 0.4))}, "dispersion"),
        ({"curves": ((1.0, 0.4), (float("nan"), 0.4))}, "finite"),
        ({"repetitions": -1}, "repetitions"),
    ],
)
def test_bad_input_is_refused(changes, message):
    """Levels that do not increase, arrays that do not fit and curves that are none are refused."""
    hits = np.zeros((20, LEVELS.size))
    given = {"curves": ((1.0, 0.4), (1.1, 0.4)), "levels": LEVELS, "first": hits, "second": hits} | changes
    with pytest.raises(InvalidValueError, match=message):
        curve_change(**given)


def test_sets_are_drawn_in_pieces_of_any_size(monkeypatch):
    """Memory is bounded by drawing sets of motions in pieces, whose size does not change a bit; another seed does."""
    rng = np.random.default_rng(5)
    capacity = np.exp(rng.normal(0.2, 0.5, (60, 1)))
    pair = [(capacity * factor < LEVELS).astype(float) for factor in (1.0, 0.9)]
    curves = (np.exp(0.2), 0.5), (0.9 * np.exp(0.2), 0.5)
    whole = curve_change(curves, LEVELS, *pair, repetitions=200, seed=1)
    monkeypatch.setattr("rocking.studies.sensitivity.changes._WEIGHTS", 700)
    assert curve_change(curves, LEVELS, *pair, repetitions=200, seed=1) == whole
    assert curve_change(curves, LEVELS, *pair, repetitions=200, seed=2) != whole
