"""Model error: similarity, hierarchy of tested bodies, posterior from invented tests, and negative controls."""

import json
import math

import numpy as np
import pytest

import rocking as rk
from rocking.bodies.solid import box
from rocking.decision.prediction._predict import sampled_bodies
from rocking.decision.prediction.model_error import (
    CLASSES,
    KEPT,
    ORDERS,
    BodyEvidence,
    ModelError,
    evidence,
    hierarchy,
    kept,
    kept_error,
    model_error_of,
)
from rocking.decision.prediction.recalibration import WIDE, BodyTests, calibration_slope, wide_samples
from rocking.errors import InvalidValueError, RockingError
from rocking.statistics.scores import Forecasts

pytestmark = pytest.mark.verifies(room="studies")
NATURAL = CLASSES["natural"].deviation
FIXED = {"restitution": 0.9, "friction": 0.6, "base": 0.0, "centre": 1.0, "azimuth": 0.0}
PULSES = [rk.pulses.sine(a, t).sampled(0.005) for a, t in ((2.6, 0.5), (3.0, 0.9), (4.5, 0.7), (6.0, 0.4), (3.4, 1.3))]


def _factors(uplift, barrier):
    """Return a model error with nearly fixed factors."""
    return ModelError((math.log(uplift), math.log(barrier)), ((1e-24, 0.0), (0.0, 1e-24)), "test")


def _solid(size=1.0):
    return rk.Solid(box(0.5 * size, 0.5 * size, 2.0 * size))


def _outcomes(body, error, motions=PULSES, **inputs):
    mechanics = sampled_bodies(body, motions, {**FIXED, **inputs, "model_error": error})
    draws = np.full((1, sum(mechanics.widths.values())), 0.5)
    return [mechanics.run(draws, k, np.ones(1), 1) for k in range(len(motions))]


@pytest.mark.verifies("invariant", "the body of another size", room="studies", control="test_wrong_size_is_detected")
@pytest.mark.parametrize("size", [0.5, 1.7])
def test_barrier_alone_is_another_size(size):
    """Equal uplift acceleration and a barrier per mass times s: the body s times larger."""
    for factors, larger in zip(_outcomes(_solid(), _factors(1.0, size)), _outcomes(_solid(size), "off"), strict=True):
        assert (factors.overturning, factors.uplift) == (larger.overturning, larger.uplift)
        np.testing.assert_allclose(factors.sliding, larger.sliding, rtol=1e-3, atol=1e-5)


@pytest.mark.verifies("negative control", room="studies")
def test_wrong_size_is_detected():
    """The peak tilt of the body 0.5 times as large is not that of a barrier times 1.7."""
    factors, smaller = _outcomes(_solid(), _factors(1.0, 1.7)), _outcomes(_solid(0.5), "off")
    assert any(abs(a.peak[0] - b.peak[0]) > 0.1 * b.peak[0] for a, b in zip(factors, smaller, strict=True))


@pytest.mark.verifies("closed form", "uplift at g b/h times the factor", room="studies")
@pytest.mark.parametrize("factor", [0.7, 1.3])
def test_uplift_acceleration_times_the_factor(factor):
    """A solid lifts above factor x g b/h, and not below."""
    threshold = factor * rk.conventions.g * 0.25
    for ratio, lifts in ((0.98, 0.0), (1.02, 1.0)):
        motion = rk.pulses.sine(ratio * threshold, 0.8).sampled(0.005)
        (outcome,) = _outcomes(_solid(), _factors(factor, 1.0), [motion], friction=2.0)
        assert outcome.uplift[0] == lifts


def test_off_has_the_same_samples_as_no_input():
    """Without model error the input has no dimension, and the answer names it among the inputs not sampled."""
    mechanics = sampled_bodies(_solid(), PULSES[:1], {"model_error": "off"})
    assert "model_error" not in mechanics.widths
    assert "model_error" in mechanics.not_sampled


def test_row_in_the_contributions():
    prediction = rk.predict(rk.Block(width=0.5, height=2.0), PULSES[:2], count=16, friction=0.6)
    assert "model_error" in prediction.contributions
    assert any("granite" in text or "prior" in text for text in prediction.assumed)
    off = rk.predict(rk.Block(width=0.5, height=2.0), PULSES[:2], count=16, friction=0.6, model_error="off")
    assert "model_error" not in off.contributions


@pytest.mark.parametrize(
    "stated", ["on", 3, {"mean": [0.0, 0.0]}, {"mean": [0.0, 9.0], "covariance": [[0.1, 0.0], [0.0, 0.1]]},
               {"mean": [0.0, 0.0], "covariance": [[0.1, 0.2], [0.2, 0.1]]}],
)  # fmt: skip
def test_refused_model_errors(stated):
    with pytest.raises(InvalidValueError):
        model_error_of(stated, "natural")


def test_file_of_an_update_is_read(tmp_path):
    error = ModelError((0.1, -0.2), ((0.04, 0.01), (0.01, 0.09)), "7 tests")
    error.save(tmp_path / "own.json")
    assert model_error_of(str(tmp_path / "own.json"), "natural") == error


def _body(mean, deviation=0.02, name="body", kind="natural"):
    return BodyEvidence(name, kind, 40, 20, np.array(mean), np.diag([deviation**2, (2.0 * deviation) ** 2]), 0.01)


@pytest.mark.verifies(
    "closed form", "moments of the half-normal prior", room="studies", control="test_many_specimens_do"
)
def test_one_specimen_does_not_shrink_the_variance_between_bodies():
    """With one body, however exact, the variance between bodies keeps its prior: E[t2] + (1/(t2 + V) + 1/M2)^-1."""
    deviations, weights = np.linspace(1e-4, 1.6, 4000), None
    weights = np.exp(-0.5 * (deviations / NATURAL) ** 2)
    weights /= weights.sum()
    variance = weights @ (deviations**2 + 1.0 / (1.0 / (deviations**2 + 1e-10) + NATURAL**-2))
    result = hierarchy([_body((0.0, 0.0), 1e-5)], "natural")
    assert result.covariance[0, 0] == pytest.approx(variance, rel=0.05)  # grid of deviations
    assert result.covariance[0, 0] > NATURAL**2 * 0.9


@pytest.mark.verifies("negative control", room="studies")
def test_many_specimens_do():
    """Thirty equal bodies leave little variance between bodies; thirty scattered bodies have theirs."""
    equal = hierarchy([_body((0.3, 0.6))] * 30, "natural")
    assert equal.covariance[0, 0] < 0.1 * NATURAL**2
    assert equal.mean[0] == pytest.approx(0.3, abs=0.02)
    random = np.random.default_rng(5)
    scattered = hierarchy([_body(0.4 * ORDERS * random.normal(size=2)) for _ in range(30)], "natural")
    assert scattered.covariance[0, 0] == pytest.approx(0.16, rel=0.5)  # of 30 bodies


def _invented(barrier, seed=3, count=128):
    """Return tests of a block whose true uplift acceleration and barrier have factors, invented by seed."""
    random = np.random.default_rng(seed)
    motions = [
        rk.pulses.sine(a, t).sampled(0.01)
        for a, t in zip(random.uniform(2.2, 5.0, 60), random.uniform(0.4, 1.4, 60), strict=True)
    ]
    block = rk.Block(width=0.5, height=2.0)
    inputs = {"restitution": (0.85, 0.95), "friction": (0.5, 0.8), "base": (0.0, 0.005), "centre": 1.0}
    truth = sampled_bodies(block, motions, {**inputs, "model_error": _factors(math.sqrt(barrier), barrier)})
    draws = random.random((60, sum(truth.widths.values())))
    observed = np.array([truth.run(draws[k : k + 1], k, np.ones(1), 1).overturning[0] for k in range(60)])
    wide = sampled_bodies(block, motions, {**inputs, "model_error": WIDE})
    tests = BodyTests(*wide_samples(wide, count, seed, 1), observed, np.arange(60))
    off = rk.predict(block, motions, **inputs, model_error="off", count=64, contributions=False, threads=1)
    fractions = (off.chances["overturning"].per_motion * 64 + 0.5) / 65
    return tests, observed, fractions


@pytest.mark.slow
@pytest.mark.verifies(
    "repeated sampling", "an invented body with a barrier lowered by 30 %", room="studies",
    control="test_calibration_without_the_factors",
)  # fmt: skip
@pytest.mark.parametrize("barrier", [0.7])
def test_calibration_with_a_lowered_barrier(barrier):
    """Without the factors overconfident, with them calibrated; two standard deviations reach the true factor."""
    tests, observed, fractions = _invented(barrier)
    assert Forecasts(fractions, observed).calibration > 3.0  # without the factors: overconfident
    prior = hierarchy([], "natural")
    assert abs(Forecasts(tests.left_out(prior), observed).calibration) < 2.0
    error = tests.error(prior)
    ends = np.array(error.mean)[1] + np.array([-2.0, 2.0]) * math.sqrt(error.covariance[1][1])
    assert ends[0] < math.log(barrier) < ends[1]
    assert error.mean[1] < 0.0


@pytest.mark.slow
@pytest.mark.verifies("negative control", room="studies")
def test_calibration_without_the_factors():
    """A body without error: the probabilities are calibrated before, and the factors include one."""
    tests, observed, fractions = _invented(1.0)
    assert abs(Forecasts(fractions, observed).calibration) < 2.5
    error = tests.error(hierarchy([], "natural"))
    assert abs(error.mean[0]) < 2.0 * math.sqrt(error.covariance[0][0])


def test_one_earthquake_counts_as_one_test():
    """Copies of tests under one earthquake do not change the posterior."""
    random = np.random.default_rng(1)
    logarithms = random.normal(size=(6, 64, 2)) * [0.3, 0.6]
    overturned = (logarithms[:, :, 0] < random.normal(size=(6, 1)) * 0.2) * 1.0
    observed = (np.arange(6) % 2).astype(float)
    once = BodyTests(logarithms, overturned, observed, np.arange(6))
    copies = [np.repeat(values, 5, axis=0) for values in (logarithms, overturned, observed, np.arange(6))]
    np.testing.assert_allclose(BodyTests(*copies).weights(None), once.weights(None), rtol=1e-9, atol=1e-15)


def test_kept_evidence_is_numbers_about_tests_only():
    """The kept file has posteriors, scores and reliability; no record, no single outcome."""
    table = json.loads(KEPT.read_text("utf-8"))
    assert KEPT.stat().st_size < 20_000
    counts = [row["count"] for row in table["reliability"]]
    assert sum(counts) == sum(body["tests"] for body in table["bodies"])
    assert max(len(values) for body in table["bodies"] for values in body.values() if isinstance(values, list)) == 2
    error = kept_error("natural")
    assert error.covariance[0][0] > NATURAL**2  # another body: at least the variance between bodies
    assert "granite" in error.source


@pytest.mark.parametrize("probability", [0.0, 0.2, 0.5, 0.95, 1.0])
def test_evidence_is_the_row_of_the_probability(probability):
    text = evidence(probability)
    row = next(row for row in kept()["reliability"] if row["low"] <= probability <= row["high"])
    assert f"of {row['count']} tests" in text


@pytest.mark.verifies("behaviour", control="test_natural_bodies_keep_their_wide_factors")
def test_a_machined_block_is_surer_than_an_object_and_a_rock():
    """95 % of the factors: 0.85 to 1.17 of a block; a block of measured size has a steep curve of probabilities."""
    deviations = [math.sqrt(kept_error(kind).covariance[0][0]) for kind in ("machined", "object", "natural")]
    assert deviations[0] < 0.09
    assert deviations == sorted(deviations)
    assert deviations[2] > 3.0 * deviations[0]
    pulses = [rk.pulses.sine(amplitude, 0.8) for amplitude in (3.0, 5.0)]
    block, options = rk.Block(width=0.5, height=2.0), {"count": 64, "contributions": False}
    chances = {
        stated: rk.predict(block, pulses, model_error=stated, **options).chances["overturning"].per_motion
        for stated in (None, "machined", "natural")
    }
    assert chances[None][0] < 0.1
    assert chances[None][1] > 0.9
    np.testing.assert_array_equal(chances["machined"], chances[None])
    assert chances["natural"][0] > 0.2  # negative control: the factors of a rock hide the statics of the block


@pytest.mark.verifies("negative control", room="studies")
def test_natural_bodies_keep_their_wide_factors():
    """A solid has by default the factors of a natural body; a section and mass points those of an object."""
    section = rk.Section([rk.Region([[0.0, 0.0], [0.5, 0.0], [0.5, 2.0], [0.0, 2.0]], 2400.0)])
    for body, kind in ((_solid(), "natural"), (section, "object"), (rk.Block(width=0.5, height=2.0), "machined")):
        mechanics = sampled_bodies(body, PULSES[:1], {})
        assert mechanics.kind == kind
        assert mechanics.inputs["model_error"].text == kept_error(kind).text
        assert CLASSES[kind].text in mechanics.assumed["model_error"]


@pytest.mark.verifies("closed form", "a body with larger errors as evidence: precision-weighted mean", room="studies")
def test_a_rock_counts_little_for_a_machined_block():
    """One rock moves the mean of machined blocks by s2/(s2 + t2 + V + 2 (s_rock2 - s2)) of its own, at each t."""
    rock, s = _body((-0.4, -0.8), 0.1), CLASSES["machined"].deviation
    ratios = np.linspace(0.1, 4.0, 40)
    weights = np.exp(-0.5 * ratios**2) / np.exp(-0.5 * ratios**2).sum()
    gains = s**2 / (s**2 + (ratios * s) ** 2 + 0.01 + 2.0 * (NATURAL**2 - s**2))
    moved = hierarchy([rock], "machined").mean[0]
    assert moved == pytest.approx(-0.4 * weights @ gains, rel=1e-9)
    assert abs(moved) < 0.03 * 0.4
    assert hierarchy([rock], "natural").mean[0] < 10.0 * moved  # counts fully for natural bodies


def test_a_machined_block_says_nothing_about_a_rock():
    """The errors of a class are contained in those of rougher classes, not in those of smoother ones."""
    block = _body((0.3, 0.6), kind="machined")
    np.testing.assert_array_equal(hierarchy([block], "natural").mean, [0.0, 0.0])
    assert hierarchy([block], "machined").mean[0] > 0.1


def test_model_error_in_plain_words():
    """Sentences have the factors or the missing model error as text, and no name of a key."""
    pulses = [rk.pulses.sine(amplitude, 0.8) for amplitude in (3.0, 3.4)]
    sampled = "The samples contain the error of the model: uplift acceleration times 0.8"
    missing = "without uncertainty: model error"
    for stated in (None, "off"):
        shown = str(rk.predict(rk.Block(width=0.5, height=2.0), pulses, model_error=stated, count=32))
        assert (sampled in shown, missing in shown) == (stated is None, stated == "off")
        assert "model_error" not in shown


def test_ends_of_the_model_error_are_uplift_accelerations():
    """The row has the mean factor on the uplift acceleration in its lowest and highest fifth: 1 -+ 1.4 deviations."""
    error = {"mean": [0.0, 1.0], "covariance": [[0.01, 0.0], [0.0, 0.01]]}
    prediction = rk.predict(rk.Block(width=0.5, height=2.0), PULSES[:1], model_error=error, count=256)
    ends = prediction.ends["model_error"]
    assert ends.low == pytest.approx(math.exp(-0.14), rel=0.02)
    assert ends.high == pytest.approx(math.exp(0.14), rel=0.02)  # mean of a fifth of a normal distribution: 1.40 sd


@pytest.mark.verifies("closed form", "fractions with known log-odds", within="1 %", room="studies")
@pytest.mark.parametrize("true", [0.7, 1.0, 2.0])
def test_the_calibration_slope_is_found(true):
    """Outcomes with the log-odds of the probabilities times a slope; within 1 %: the prior draws towards 1."""
    probability = np.linspace(0.01, 0.99, 99)
    counts = 1000
    probabilities = np.repeat(probability, counts)
    happened = np.round(counts / (1.0 + (1.0 / probability - 1.0) ** true)).astype(int)
    outcomes = np.concatenate([np.arange(counts) < count for count in happened]) * 1.0
    assert calibration_slope(probabilities, outcomes) == pytest.approx(true, rel=0.01)
    assert calibration_slope(probabilities[:0], outcomes[:0]) == pytest.approx(1.0)  # only the prior
    few = np.array([0.6, 0.4]), np.array([1.0, 0.0])
    assert 1.0 < calibration_slope(*few) < 1.2  # two outcomes change the prior little


def test_an_earthquake_does_not_predict_itself():
    """Other outcomes under one earthquake change the predictions of all other earthquakes, but not its own."""
    random = np.random.default_rng(2)
    logarithms = random.normal(size=(24, 32, 2)) * [0.3, 0.6]
    overturned = (logarithms[:, :, 1] < random.normal(size=(24, 1))) * 1.0
    observed, earthquakes = (random.random(24) < overturned.mean(axis=1)) * 1.0, np.repeat(np.arange(6), 4)
    first = earthquakes == 0
    other = np.where(first, 1.0 - observed, observed)
    prior = hierarchy([], "natural")
    before, after = (
        BodyTests(logarithms, overturned, values, earthquakes).left_out(prior) for values in (observed, other)
    )
    np.testing.assert_array_equal(after[first], before[first])
    assert (after[~first] != before[~first]).all()


def test_a_slope_sharpens_the_probability_of_overturning(tmp_path):
    """Log-odds times the slope, also after a file; 0 and 1, and other events, are unchanged."""
    pulses = [rk.pulses.sine(amplitude, 0.8) for amplitude in (1.0, 3.4, 3.7, 30.0)]
    options = {"count": 64, "contributions": False, "threads": 1}
    plain, steep = (ModelError((0.0, 0.0), ((0.01, 0.0), (0.0, 0.04)), "tests", slope=slope) for slope in (1.0, 2.0))
    steep.save(tmp_path / "error.json")
    one, two, kept = (
        rk.predict(rk.Block(width=0.5, height=2.0), pulses, model_error=error, **options).chances
        for error in (plain, steep, tmp_path / "error.json")
    )
    p, sharp = one["overturning"].per_motion, two["overturning"].per_motion
    inner = (p > 0.0) & (p < 1.0)
    assert inner.sum() == 2
    np.testing.assert_allclose(sharp[inner], 1.0 / (1.0 + (1.0 / p[inner] - 1.0) ** 2), rtol=1e-12)
    np.testing.assert_array_equal(sharp[~inner], p[~inner])
    assert two["overturning"].value == pytest.approx(sharp.mean())
    assert two["overturning"].low < two["overturning"].value < two["overturning"].high
    np.testing.assert_array_equal(kept["overturning"].per_motion, sharp)
    np.testing.assert_array_equal(two["uplift"].per_motion, one["uplift"].per_motion)
    assert "times 2.00" in steep.text
    assert "odds" not in plain.text


@pytest.mark.parametrize("slope", [0.0, -1.0, 11.0, math.nan, "steep"])
def test_bad_slopes(slope):
    with pytest.raises(RockingError, match="slope"):
        model_error_of({"mean": [0.0, 0.0], "covariance": [[0.01, 0.0], [0.0, 0.04]], "slope": slope}, "natural")
