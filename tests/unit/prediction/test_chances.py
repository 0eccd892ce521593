"""Probabilities and their intervals by closed forms, and coefficients of restitution within what energy allows."""

import math

import numpy as np
import pytest
from scipy.stats import beta

import rocking as rk
from rocking.prediction._predict import _chance
from rocking.prediction.mechanics import Uncertain
from rocking.prediction.plane import PlaneMechanics, whole_settings

pytestmark = pytest.mark.verifies(room="studies")


def exact(share, trials):
    """Interval of Clopper and Pearson (1934, doi:10.1093/biomet/26.4.404); trials need not be whole."""
    hits = share * trials
    low = beta.ppf(0.025, hits, trials - hits + 1.0) if hits > 0.0 else 0.0
    return low, beta.ppf(0.975, hits + 1.0, trials - hits) if hits < trials else 1.0


def bodies(*hits, motions):
    """Outcomes of one body per row that overturns under its first motions."""
    return np.array([[float(k < count) for k in range(motions)] for count in hits])


def test_bodies_of_one_mean_count_as_their_number():
    """Each of 6 bodies overturns under 5 of 10 motions: their means do not scatter, and 6 histories count."""
    found = _chance(bodies(*[5] * 6, motions=10), 0)
    assert (found.low, found.high) == pytest.approx(exact(0.5, 6.0), rel=1e-12)


def test_bodies_that_scatter_little_count_as_all_their_histories():
    """Means .5, .5, .5, .6: p (1 - p) N / s^2 = .249375 * 4 / .001875 = 532, more than the 40 histories there are."""
    found = _chance(bodies(5, 5, 5, 6, motions=10), 0)
    assert found.value == pytest.approx(0.525, rel=1e-15)
    assert (found.low, found.high) == pytest.approx(exact(0.525, 40.0), rel=1e-12)
    # negative control: more histories than there are would give a narrower interval
    assert np.ptp(exact(0.525, 532.0)) < 0.5 * (found.high - found.low)


def test_bodies_that_decide_count_once():
    """Bodies that overturn under all motions or none: s^2 = p (1 - p), as many histories as bodies."""
    found = _chance(bodies(10, 10, 0, 0, 0, 0, 0, 0, motions=10), 0)
    assert (found.low, found.high) == pytest.approx(exact(0.25, 8.0), rel=1e-12)


def test_bodies_between_count_as_a_binomial_share_of_their_variance():
    """Means 0, .5, .5, 1 of 10 motions: p (1 - p) N / s^2 = .25 * 4 / .125 = 8 of 40 histories."""
    found = _chance(bodies(0, 5, 5, 10, motions=10), 0)
    assert (found.low, found.high) == pytest.approx(exact(0.5, 8.0), rel=1e-12)


@pytest.mark.parametrize(
    ("given", "median"),
    [
        ({"values": [0.3, 0.6]}, 0.45),
        ([0.2, 0.9, 0.4, 0.5], 0.45),
        ([0.2, 0.9, 0.4], 0.4),
        ((0.3, 0.8), 0.55),
        ({"median": 0.5, "dispersion": 0.2}, 0.5),
        (0.7, 0.7),
    ],
)
def test_the_median_of_an_input(given, median):
    """Of an even number of values the mean of the middle two; of a range its middle."""
    assert Uncertain.of("friction", given, 0.01, 10.0).median == pytest.approx(median, rel=1e-9)


def test_no_restitution_creates_energy():
    """A coefficient of 1 onto the foot with the larger moment of inertia is cut to sqrt(I_old / I_new), Eq. 29.

    Moments about the feet by Steiner's theorem; bounds the other way round would cut the other foot.
    """
    body = rk.Block(width=0.8, height=2.2, depth=1.2, mass=650.0, centre=(0.52, 0.9))
    about_centre = body.moment_of_inertia
    left, right = (about_centre + 650.0 * (lever**2 + 0.9**2) for lever in (0.52, 0.28))
    known = {"friction": 0.6, "base": 0.0, "centre": 1.0, "polarity": 1.0}
    settings = whole_settings(rk.conventions.g, 0.0, "newton")
    what = PlaneMechanics(body, rk.pulses.sine(4.2, 0.8), {**known, "restitution": 1.0}, settings)
    found = what._coefficients(np.array([0.5]), np.array([[0.52, 0.28]]), np.array([0.9]))
    assert left > 1.05 * right
    # onto the left foot the body turns about the right foot before
    np.testing.assert_allclose(found, [[math.sqrt(right / left), 1.0]], rtol=1e-12)
