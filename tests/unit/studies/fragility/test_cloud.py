"""Cloud analysis: the line, the three parts of the probability, plans, what is refused."""

import dataclasses
import json
import math
import re

import numpy as np
import pytest
from random_cases import smooth_noises
from scipy import stats

import rocking as rk
from rocking import conventions
from rocking.errors import InvalidValueError
from rocking.statistics import regression
from rocking.studies import fragility_analysis
from rocking.studies.fragility.question import FragilityQuestion
from rocking.studies.fragility.subject import Responses, Subject

pytestmark = pytest.mark.verifies(room="studies")

BLOCK = rk.Block(width=0.5, height=2.0)


def records(count, seed=3, samples=500):
    """Noise in a window, smoothed, of peaks from 1.5 to 9 m/s2."""
    noises = zip(np.geomspace(1.5, 9.0, count), smooth_noises(count, seed, samples), strict=True)
    return [rk.GroundMotion(noise * peak / np.abs(noise).max(), 0.02) for peak, noise in noises]


MOTIONS = records(80)


@pytest.fixture(scope="module")
def found():
    return fragility_analysis(BLOCK, MOTIONS, restitution=0.9, limit_states=(0.2, 0.5), analysis="cloud")


@pytest.mark.verifies("second engine", "the reference engine, every tenth motion", within="1e-6")
def test_outcomes_are_those_of_the_motions_as_they_are(found):
    """Every tenth motion, simulated alone by the reference engine, ends in the same state with the same rotation."""
    alpha = math.atan(0.25)
    for k in range(0, 80, 10):
        one = rk.simulate(BLOCK, MOTIONS[k], restitution=0.9, engine="reference")
        assert found.responses.outcome[k] == one.outcome.code
        if one.outcome is rk.Outcome.ROCKED:
            assert found.responses.rotation[k] == pytest.approx(one.peak_rotation / alpha, rel=1e-6)
    assert found.responses.overturned.sum() > 5


@pytest.mark.verifies("computed anew", "SciPy's linregress", within="1e-11; 1e-9 of the p-value")
def test_the_line_against_scipy(found):
    """Slope, intercept, p-value, errors and R squared are those of scipy's independent regression."""
    rocked = found.responses.rocked & (found.responses.rotation >= 0.01)
    peaks = np.array([np.abs(m.acceleration).max() for m in MOTIONS])
    line = stats.linregress(np.log(peaks[rocked]), np.log(found.responses.rotation[rocked]))
    mine = found.regression
    assert mine.count == rocked.sum()
    assert mine.slope == pytest.approx(line.slope, rel=1e-11, abs=0.0)
    assert mine.intercept == pytest.approx(line.intercept, rel=1e-11, abs=0.0)
    assert mine.slope_error == pytest.approx(line.stderr, rel=1e-11, abs=0.0)
    assert mine.determination == pytest.approx(line.rvalue**2, rel=1e-11, abs=0.0)
    assert mine.p_value == pytest.approx(line.pvalue, rel=1e-9)


@pytest.mark.verifies("computed anew", "the definitions, with SciPy's normal distribution", within="1e-12")
def test_three_parts_of_the_probability(found):
    """No rocking, below, beyond and overturned add up to one, and each is what its definition says."""
    found = dataclasses.replace(found, min_rotation=1e-9)  # no history of these is lifted by less
    assert found.barely_lifted == 0
    levels, threshold = np.array([2.0, 2.6, 4.0, 8.0]), conventions.g * 0.25
    parts = found.parts(levels, 0.3)
    np.testing.assert_allclose(sum(parts.values()), 1.0, rtol=1e-14)
    assert parts["no rocking"].tolist() == [1.0, 0.0, 0.0, 0.0]
    fit, line = found.fits["overturned"], found.regression
    over = stats.norm.cdf(np.log(levels / fit.median) / fit.dispersion) * (levels > threshold)
    beyond = stats.norm.sf((math.log(0.3) - line.intercept - line.slope * np.log(levels)) / line.scatter)
    expected = over + (1.0 - over) * beyond * (levels > threshold)
    np.testing.assert_allclose(found.probability(levels, 0.3), expected, rtol=1e-12)


def barely(count):
    """A cloud whose first histories above the threshold are lifted by 1e-7 alpha only, and where they are."""
    question = FragilityQuestion.of(Subject.of(BLOCK, MOTIONS, 0.9, "pga", {}), "cloud")
    arrays = question.histories.run(0, 80)
    chosen = np.flatnonzero(arrays["outcome"] == rk.Outcome.ROCKED.code)[::2][:count]
    arrays["peak_rotation"][chosen] = 1e-7 * math.atan(0.25)
    return question.answer(arrays), chosen


def test_barely_lifted_histories_are_no_points_of_the_line():
    """Rotations of 1e-7 alpha leave the line where it is without them; kept in, they would tilt it (the control)."""
    hurt, chosen = barely(8)
    kept = hurt.responses.rocked & (hurt.responses.rotation >= 0.01)
    line = stats.linregress(np.log(hurt.motion_levels[kept]), np.log(hurt.responses.rotation[kept]))
    assert hurt.regression.slope == pytest.approx(line.slope, rel=1e-11, abs=0.0)
    told = hurt.summary()
    assert (told["min_rotation"], told["barely lifted"]) == (0.01, hurt.responses.rocked.sum() - kept.sum())
    assert told["barely lifted"] >= chosen.size
    everything = dataclasses.replace(hurt, min_rotation=0.0)
    assert everything.barely_lifted == 0
    assert everything.regression.scatter > 3.0 * hurt.regression.scatter


def test_barely_lifted_histories_reach_no_state():
    """The total probability counts them as standing: its mean is the observed share, and without them too high."""
    hurt, _ = barely(16)
    observed = np.mean(hurt.responses.rotation > 0.05)
    mean = hurt.probability(hurt.motion_levels, 0.05).mean()
    # the fits know the shares, and miss by the shape of their curves alone
    assert abs(mean - observed) < 0.02
    ignored = (
        fragility_analysis(BLOCK, MOTIONS, restitution=0.9, analysis="cloud")
        .probability(hurt.motion_levels, 0.05)
        .mean()
    )
    assert ignored - observed > 0.07
    np.testing.assert_allclose(sum(hurt.parts(hurt.motion_levels, 0.05).values()), 1.0, rtol=1e-14)
    with pytest.raises(InvalidValueError, match="barely lifted"):
        hurt.probability(4.0, 0.005)
    for bad in (-0.1, 1.0, math.nan):
        with pytest.raises(InvalidValueError, match="min_rotation"):
            fragility_analysis(BLOCK, MOTIONS[:2], min_rotation=bad, analysis="cloud", restitution="ked")


@pytest.mark.slow
def test_the_same_motion_twice_is_one_observation():
    """Six copies of each motion: intervals come from whole motions, not from six times as many outcomes."""
    once, often = (
        fragility_analysis(BLOCK, MOTIONS * n, restitution=0.9, analysis="cloud").fits["overturned"] for n in (1, 6)
    )
    assert (once.counts.clusters, once.interval_method) == (0, "profile")
    assert (often.counts.clusters, often.interval_method) == (80, "bootstrap")
    ends = often.interval("median"), often.interval("median", method="profile")
    widths = [math.log(high / low) for low, high in ends]
    # six copies of everything narrow the interval of independent outcomes by the root of 6 = 2.4
    assert widths[0] > 1.8 * widths[1]


def test_probability_follows_what_was_observed(found):
    """Averaged over the motions, the probability of 0.3 alpha is the observed share of it."""
    observed = np.mean(found.responses.rotation > 0.3)
    expected = found.probability(found.motion_levels, 0.3).mean()
    # four standard errors of a share of 80
    assert abs(expected - observed) < 4.0 * math.sqrt(0.25 / 80)


def test_a_factor_is_a_scaled_set_of_motions(found):
    """One factor on all motions gives what motions multiplied beforehand give, level and outcome."""
    scaled = fragility_analysis(BLOCK, MOTIONS, restitution=0.9, scale=1.5, analysis="cloud")
    beforehand = fragility_analysis(BLOCK, [m.scaled(1.5) for m in MOTIONS], restitution=0.9, analysis="cloud")
    np.testing.assert_allclose(scaled.motion_levels, 1.5 * found.motion_levels, rtol=1e-14)
    np.testing.assert_allclose(scaled.motion_levels, beforehand.motion_levels, rtol=1e-14)
    assert scaled.responses.outcome.tolist() == beforehand.responses.outcome.tolist()


def test_plan_and_failures(found):
    """Results computed elsewhere finish as the same analysis; a failed one leaves the fits and is counted."""
    question = FragilityQuestion.of(Subject.of(BLOCK, MOTIONS, 0.9, "pga", {}), "cloud", limit_states=(0.2, 0.5))
    arrays = question.histories.run(0, 80)
    same = question.answer(arrays)
    assert same.fits["overturned"].median == found.fits["overturned"].median
    arrays["outcome"][79], arrays["peak_rotation"][79] = rk.Outcome.FAILED.code, math.nan
    less = question.answer(arrays)
    assert (less.failed, int(less.trials.sum()), less.fits["overturned"].observations) == (1, 79, 79)


def test_counts_by_level_are_those_of_the_motions(found):
    """Motions at equal levels are counted together."""
    twice = fragility_analysis(BLOCK, [*MOTIONS[:5], *MOTIONS[:5]], restitution=0.9, analysis="cloud")
    assert twice.levels.size == 5
    assert twice.trials.tolist() == [2] * 5
    assert sum(found.counts["overturned"]) == found.responses.overturned.sum()


def test_rocking_gets_a_curve_where_no_level_decides():
    """Against PGV the probability of rocking is fitted, and overturning never exceeds it."""
    by_velocity = fragility_analysis(BLOCK, MOTIONS, restitution=0.9, im="pgv", analysis="cloud")
    levels = np.array([0.1, 0.3, 1.0])
    rocks = by_velocity.probability_of_rocking(levels)
    assert np.all((rocks > 0.0) & (rocks <= 1.0))
    assert np.all(by_velocity.parts(levels, 0.5)["overturned"] <= rocks)


def test_dataset_and_summary(found):
    """Outcomes with units, and a summary that names definition, line and outcomes."""
    assert found.dataset.level.attrs["units"] == "m/s2"
    told = json.loads(json.dumps(found.summary()))
    assert sum(told["outcomes"].values()) == 80
    assert told["definition"].startswith("cloud")


def test_share_of_what_was_clearly_lifted(found):
    """Of what rocked and stands: by hand where all are at one level, one where all are, and never above one."""
    levels, codes = np.full(5, 2.0), [rk.Outcome.ROCKED.code] * 4 + [rk.Outcome.OVERTURNED.code]
    rotation = np.array([0.3, 0.001, 0.2, 0.5, math.inf])

    def share(outcome, rotation):
        answers = Responses(np.array(outcome), np.asarray(rotation), np.zeros(5, np.int8))
        some = dataclasses.replace(found, responses=answers, motion_levels=levels, min_rotation=0.01)
        return some.clear_fraction(np.array([1.0, 4.0])).tolist()

    assert share(codes, rotation) == [0.75, 0.75]
    assert share(codes, np.maximum(rotation, 0.1)) == [1.0, 1.0]
    assert share(codes, np.minimum(rotation, 0.001)) == [0.0, 0.0]
    assert share([rk.Outcome.OVERTURNED.code] * 5, np.full(5, math.inf)) == [1.0, 1.0]


def test_a_line_without_scatter():
    """Points on a line leave no scatter: the probability above it is a step, and the slope is certain."""
    x = np.arange(4.0)
    line, flat = regression(x, 2.0 * x), regression(x, np.ones(4))
    assert line.probability_above(3.0, [1.0, 2.0]).tolist() == [0.0, 1.0]
    assert (line.p_value, flat.p_value) == (0.0, 1.0)


def test_places_that_differ_by_more_than_rounding():
    """Points a hundred-millionth apart give their line; those that only rounding tells apart give none."""
    x = np.array([0.0, 1e-8, 3e-8])
    assert regression(x, 5.0 - 3.0 * x).slope == pytest.approx(-3.0, rel=1e-6)
    far = 1e6 + 1e-3 * np.arange(3.0)
    assert regression(far, 2.0 * (far - 1e6)).slope == pytest.approx(2.0, rel=1e-9)
    for same in (np.full(3, 0.7), np.array([1e6, np.nextafter(1e6, 2e6), 1e6]), np.array([0.7, 0.7 - 1e-15, 0.7])):
        with pytest.raises(InvalidValueError, match=re.escape(f"different x, got 3 at {same[0]:g}")):
            regression(same, np.array([1.0, 3.0, 2.0]))


def test_summary_without_a_line():
    """Too few motions that rocked leave no line: the summary says why, and the rest stands."""
    told = fragility_analysis(BLOCK, MOTIONS[:3], restitution=0.9, analysis="cloud").summary()
    assert "at least 3 points" in told["regression"]["none"]
    assert told["outcomes"]["no_uplift"] > 0


def test_what_is_refused(found):
    """Levels and rotations that are no positive numbers, and a line through fewer than three points."""
    for level in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(InvalidValueError):
            found.probability(level, 0.5)
    with pytest.raises(InvalidValueError):
        found.probability(3.0, 0.0)
    with pytest.raises(InvalidValueError, match="at least 3 points"):
        _ = fragility_analysis(BLOCK, MOTIONS[:3], restitution=0.9, analysis="cloud").regression
    # places differ by more than rounding, which is relative to where they lie
    for at, apart in ((1.0, 0.0), (1.0, 1e-13), (1e6, 1e-8)):
        with pytest.raises(InvalidValueError, match="different x"):
            regression(at + apart * np.arange(5.0), np.arange(5.0))
    for at, apart in ((1.0, 1e-8), (1e6, 1e-4)):
        x = at + apart * np.arange(5.0)
        assert regression(x, np.arange(5.0)).slope == pytest.approx(1.0 / apart, rel=1e-5)  # digits that x has left
    with pytest.raises(InvalidValueError, match="finite"):
        regression(np.array([0.0, 1.0, 2.0]), np.array([0.0, math.nan, 1.0]))
