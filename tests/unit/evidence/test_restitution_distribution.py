"""The calibrated distribution of a coefficient: what the posterior says, in quantiles that can be drawn from."""

import dataclasses
import math

import numpy as np
import pytest
from scipy import stats

from rocking import Block, Region, Section, simulate
from rocking.errors import InvalidValueError
from rocking.evidence import calibrate_hierarchy, restitution_distribution
from rocking.evidence.likelihood import scatter
from rocking.motions import pulses
from rocking.restitution import ShiftedImpulse

pytestmark = pytest.mark.slow

# one false alarm in a million: the draws never change, so a failure is no accident
ALARM = 1e-6
LEANING = Section([Region([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 3.0)], 2400.0)])


@pytest.mark.parametrize("slenderness", [2.0, 4.0, 8.0])
def test_agrees_with_the_prediction(slenderness):
    """Mean, scatter and 95 % interval are those of the calibration's own prediction, less what is cut off above 1."""
    found, prediction = restitution_distribution(slenderness), calibrate_hierarchy().predict([slenderness])
    cut = found.cut["right"]
    assert 0.0 < cut < 1e-2
    # the mean of the whole is that of both parts; the upper one stands above 1 by less than two deviations
    beyond = prediction.coefficient[0] - (1.0 - cut) * found.mean - cut
    assert -1e-6 < beyond < 1e-6 + 2.0 * cut * found.standard_deviation
    # a part four deviations off takes its (16 - 1) / 2 of the deviation with it
    assert found.standard_deviation == pytest.approx(prediction.standard_deviation[0], rel=2e-3 + 15.0 * cut)
    ends = prediction.low[0], prediction.high[0]
    assert found.quantile(np.array([0.025, 0.975]) / (1.0 - cut)) == pytest.approx(ends, abs=1e-5)


def simulated(slenderness, count, *, scattered):
    """Coefficients straight from the definition: draw the parameters, evaluate the model, add the scatter."""
    rng = np.random.default_rng(6)
    eta, k, s, gamma = calibrate_hierarchy().draw(count, seed=5).T
    mean = eta * np.array([float(ShiftedImpulse(one).of_slenderness([slenderness])[0]) for one in k])
    return np.clip(mean + scattered * scatter(mean, s, gamma) * rng.normal(size=count), 0.0, 1.0)


def test_agrees_with_simulation():
    """20,000 draws and 20,000 simulated coefficients pass Kolmogorov-Smirnov; without the scatter they do not."""
    drawn = restitution_distribution(4.0).sample(20_000, seed=1)
    assert stats.ks_2samp(drawn, simulated(4.0, 20_000, scattered=True)).pvalue > ALARM
    assert stats.ks_2samp(drawn, simulated(4.0, 20_000, scattered=False)).pvalue < ALARM


def test_a_body_and_its_slenderness_are_one():
    """A block of any size has the distribution of its slenderness, on both feet."""
    block = Block(width=0.25, height=1.0)
    expected = restitution_distribution(4.0).quantiles
    assert restitution_distribution(block).quantiles == pytest.approx(expected, abs=1e-12)
    assert restitution_distribution(block, foot="left").quantiles == pytest.approx(expected, abs=1e-12)


def test_never_creates_energy():
    """Quantiles increase and stay within [0, energy bound], also far outside what was measured."""
    for body in (0.3, 30.0, LEANING):
        found = restitution_distribution(body)
        assert found.extrapolated is (body in {0.3, 30.0})
        assert np.all(np.diff(found.quantiles) >= 0.0)
        assert found.quantiles[0] >= 0.0
    old, new = LEANING.side("left"), LEANING.side("right")
    bound = math.sqrt(old.moment_of_inertia / new.moment_of_inertia)
    assert restitution_distribution(LEANING, foot="right").quantiles[-1] <= bound


def test_laws_are_made_of_it():
    """Per history and per impact the law has these quantiles, and a simulation takes its draw."""
    found, block = restitution_distribution(4.0), Block(width=0.25, height=1.0)
    once, each = found.per_history(seed=3), found.per_impact(seed=3)
    assert once.factors.tolist() == each.factors.tolist() == found.quantiles.tolist()
    response = simulate(block, pulses.sine(4.0, 0.4), restitution=once)
    assert len(response.impacts) > 2
    assert response.impacts["coefficient"] == pytest.approx(once.factor(1.0, 0, 0), rel=1e-12, abs=0.0)
    varied = simulate(block, pulses.sine(4.0, 0.4), restitution=each).impacts["coefficient"]
    assert len(set(varied.tolist())) > 2


def test_a_narrower_posterior_is_narrower():
    """With one point of the posterior the distribution is the normal one of that point's scatter."""
    posterior = calibrate_hierarchy()
    one = posterior.samples[posterior.samples[:, 2] < 0.1][:1]  # whose scatter stays below 1
    point = dataclasses.replace(posterior, samples=one)
    found = restitution_distribution(4.0, calibration=point)
    eta, k, s, gamma = one[0]
    mean = eta * float(ShiftedImpulse(k).of_slenderness([4.0])[0])
    expected = stats.norm(mean, scatter(np.array(mean), s, gamma))
    assert found.quantile([0.1, 0.5, 0.9]) == pytest.approx(expected.ppf([0.1, 0.5, 0.9]), abs=1e-5)


def test_each_side_has_a_table_of_its_own():
    """A body with unequal sides has quantiles for each foot, the same whichever is asked for, and laws of both."""
    right, left = (restitution_distribution(LEANING, foot=foot) for foot in ("right", "left"))
    assert abs(right.mean - left.mean) > 1e-3
    for law in (right.per_history(seed=1), right.per_impact(seed=1), left.per_impact(seed=1)):
        for found, foot in ((right, "right"), (left, "left")):
            assert np.array_equal(law.table(foot), found.quantiles)
        with pytest.raises(InvalidValueError, match="give foot="):
            law.factor(1.0, 0, 0)


@pytest.mark.parametrize("body", [0.0, -1.0, float("nan"), float("inf"), "block", None])
def test_what_is_no_body_is_refused(body):
    """Slendernesses that are none are refused."""
    with pytest.raises(InvalidValueError):
        restitution_distribution(body)


def test_bad_questions_are_refused():
    """Probabilities outside [0, 1], unknown feet and negative counts are refused."""
    found = restitution_distribution(4.0)
    for probability in (-0.1, 1.1, float("nan")):
        with pytest.raises(InvalidValueError, match="probability"):
            found.quantile(probability)
    with pytest.raises(InvalidValueError, match="foot"):
        restitution_distribution(4.0, foot="middle")
    with pytest.raises(InvalidValueError, match="count"):
        found.sample(-1, seed=1)
