"""Three states: nested curves, where they cross, and one dispersion for both."""

import math

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.special import ndtr

from rocking.errors import InvalidValueError
from rocking.statistics import fit_lognormal, fit_ordered
from rocking.statistics.ordered_probit import nested_curves

pytestmark = pytest.mark.verifies(room="statistics")

LEVELS, ROCKED, OVERTURNED = [0.2, 0.4, 0.6, 0.8], [2, 9, 18, 20], [0, 3, 9, 16]


def test_separate_curves_are_the_two_fits():
    """One by one, each curve is the fit of its own counts."""
    fit = fit_ordered(LEVELS, ROCKED, OVERTURNED, [20] * 4)
    for curve, counts in ((fit.rocked, ROCKED), (fit.overturned, OVERTURNED)):
        alone = fit_lognormal(LEVELS, counts, [20] * 4)
        assert curve == (alone.median, alone.dispersion)


@pytest.mark.verifies("computed anew", "a simplex search of the likelihood by SciPy", within="1e-6")
def test_common_dispersion_against_a_direct_search():
    """Medians and the one dispersion agree with a simplex search of the likelihood of three states."""
    fit = fit_ordered(LEVELS, ROCKED, OVERTURNED, [20] * 4, method="common-dispersion")

    def minus(q):
        one, two = (ndtr((np.log(LEVELS) - m) / math.exp(q[2])) for m in (q[0], q[0] + math.exp(q[1])))
        shares = np.stack([1 - one, one - two, two])
        y = np.stack([20 - np.array(ROCKED), np.array(ROCKED) - OVERTURNED, OVERTURNED])
        return -np.sum(y * np.log(shares))

    options = {"xatol": 1e-11, "fatol": 1e-14, "maxiter": 9000, "maxfev": 9000}
    best = minimize(minus, [-1.0, -1.0, -1.0], method="Nelder-Mead", options=options).x
    assert fit.rocked[0] == pytest.approx(math.exp(best[0]), rel=1e-6)
    assert fit.overturned[0] == pytest.approx(math.exp(best[0] + math.exp(best[1])), rel=1e-6)
    assert fit.rocked[1] == fit.overturned[1] == pytest.approx(math.exp(best[2]), rel=1e-6)
    assert fit.crossing is None
    assert fit.excess == 0.0
    assert "do not cross" in fit.verdict


def test_common_dispersion_recovers_the_truth():
    """With a million trials the known curves come back within their Monte Carlo error."""
    random = np.random.default_rng(3)
    levels = np.exp(np.linspace(-1.5, 1.5, 7))
    one, two = ndtr(np.log(levels / 0.7) / 0.5), ndtr(np.log(levels / 1.3) / 0.5)
    y = np.array([random.multinomial(150_000, q) for q in np.stack([1 - one, one - two, two], axis=1)])
    fit = fit_ordered(levels, y[:, 1] + y[:, 2], y[:, 2], [150_000] * 7, method="common-dispersion")
    np.testing.assert_allclose([*fit.rocked, *fit.overturned], [0.7, 0.5, 1.3, 0.5], rtol=5e-3)


@pytest.mark.verifies("closed form", "curves that were put in", within="1e-4")
@pytest.mark.parametrize(
    ("medians", "dispersion"),
    [((2.0, 3.0), 0.3), ((0.1, 0.3, 1.0), 1.5), ((10.0, 30.0), 1.2), ((0.1, 2.0), 2.5), ((0.05, 1.5, 40.0), 3.0)],
)
def test_known_curves_steep_and_shallow(medians, dispersion):
    """Counts as the curves themselves say, of 100 000 trials, give medians and dispersion back, also far outside."""
    levels, trials = np.geomspace(0.5, 8.0, 7), np.full(7, 1e5)
    reached = np.round(trials * ndtr(np.log(levels / np.array(medians)[:, None]) / dispersion))
    curves = nested_curves(levels, reached, trials)
    # the counts are rounded to one in 100 000
    np.testing.assert_allclose(curves, [(median, dispersion) for median in medians], rtol=1e-4)


@pytest.mark.verifies("computed anew", "a simplex search of the likelihood by SciPy", within="1e-6")
def test_three_curves_of_one_dispersion_against_a_direct_search():
    """The medians of three nested states and their one dispersion agree with a simplex search of the likelihood."""
    reached, n = np.array([[3, 10, 19, 20], [2, 7, 14, 18], [0, 3, 9, 15]]), 20
    curves = nested_curves(np.array(LEVELS), reached.astype(float), np.full(4, 20.0))
    ended = -np.diff(np.vstack([np.full(4, n), reached, np.zeros(4)]), axis=0)

    def minus(q):
        logs = q[0] + np.cumsum([0.0, *np.exp(q[1:3])])
        above = [ndtr((np.log(LEVELS) - m) / math.exp(q[3])) for m in logs]
        shares = -np.diff(np.vstack([np.ones(4), *above, np.zeros(4)]), axis=0)
        return -np.sum(ended * np.log(np.maximum(shares, 1e-300)))

    options = {"xatol": 1e-11, "fatol": 1e-14, "maxiter": 20_000, "maxfev": 20_000}
    best = minimize(minus, [-1.0, -1.5, -1.5, -1.0], method="Nelder-Mead", options=options).x
    medians = np.exp(best[0] + np.cumsum([0.0, *np.exp(best[1:3])]))
    assert [median for median, _ in curves] == pytest.approx(medians.tolist(), rel=1e-6)
    assert [dispersion for _, dispersion in curves] == pytest.approx([math.exp(best[3])] * 3, rel=1e-6)
    with pytest.raises(InvalidValueError, match="trials in each state"):
        nested_curves(np.array(LEVELS), reached[[0, 0, 2]].astype(float), np.full(4, 20.0))


def test_crossing_is_found_and_measured():
    """Curves with medians 1 and 1.2 and dispersions 0.2 and 1.2 cross where the two variates agree."""
    levels, n = np.exp(np.linspace(-1.5, 0.5, 9)), 10**7
    over = np.round(n * ndtr(np.log(levels / 1.2) / 1.2))
    rock = np.maximum(np.round(n * ndtr(np.log(levels) / 0.2)), over)
    fit = fit_ordered(levels, rock, over, [n] * 9)
    (m, s), (k, t) = fit.rocked, fit.overturned
    place = fit.crossing
    assert math.log(place / m) / s == pytest.approx(math.log(place / k) / t, abs=1e-9)
    grid = np.exp(np.linspace(-1.5, 0.5, 100_001))
    apart = ndtr(np.log(grid / k) / t) - ndtr(np.log(grid / m) / s)
    assert fit.excess == pytest.approx(apart.max(), rel=1e-6)
    assert fit.excess > 0.0
    assert "Use a common dispersion" in fit.verdict
    shares = fit.probabilities(grid)
    assert shares.min() >= 0.0
    np.testing.assert_allclose(shares.sum(axis=-1), 1.0, rtol=0.0, atol=1e-15)


def test_probabilities_add_up():
    """Three probabilities add up to one, are not negative, and are certain rest at level zero."""
    fit = fit_ordered(LEVELS, ROCKED, OVERTURNED, [20] * 4, method="common-dispersion")
    shares = fit.probabilities([[0.0, 0.3], [0.5, 5.0]])
    assert shares.shape == (2, 2, 3)
    assert shares[0, 0].tolist() == [1.0, 0.0, 0.0]
    assert np.all(shares >= 0.0)
    np.testing.assert_allclose(shares.sum(axis=-1), 1.0, rtol=0.0, atol=1e-15)
    with pytest.raises(InvalidValueError, match="im must be finite"):
        fit.probabilities(math.nan)


def test_a_missing_state_is_said_not_made_up():
    """Nothing overturned: no curve, no crossing, no probabilities, and words that say so."""
    fit = fit_ordered(LEVELS, ROCKED, [0, 0, 0, 0], [20] * 4)
    assert fit.overturned is None
    assert fit.crossing is None
    assert fit.excess is None
    assert "no failures" in fit.verdict.lower()
    with pytest.raises(InvalidValueError, match="two fragility curves are needed"):
        fit.probabilities(0.3)
    with pytest.raises(InvalidValueError, match="method='common-dispersion' requires"):
        fit_ordered(LEVELS, ROCKED, [0, 0, 0, 0], [20] * 4, method="common-dispersion")
    with pytest.raises(InvalidValueError, match="method must be one of"):
        fit_ordered(LEVELS, ROCKED, OVERTURNED, [20] * 4, method="both")
