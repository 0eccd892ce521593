"""What is drawn, what becomes of it, and how it is told: rows against bodies made by hand, seeds, words, refusals."""

import json
import math

import numpy as np
import pytest
import scipy.stats
from random_cases import noise_motion, section

import rocking as rk
from rocking.answers import plain
from rocking.decision.prediction import Prediction, predict
from rocking.decision.prediction._predict import _chance
from rocking.decision.prediction.mechanics import Uncertain
from rocking.decision.prediction.plane import SampledInPlane, contact_settings
from rocking.errors import RockingError
from rocking.statistics import share_interval
from rocking.studies import SyntheticSet

pytestmark = pytest.mark.verifies(room="studies")
BODY = section(4)
PULSE = rk.pulses.sine(amplitude=4.2, period=0.8)
BLOCK = rk.Block(width=0.5, height=2.0)
KNOWN = {
    "restitution": 0.9, "friction": 0.6, "base": 0.0, "centre": 1.0, "offset": 0.0, "level": 0.0, "polarity": 1.0,
    "model_error": "off",
}  # fmt: skip


def mechanics(body, motions, **given):
    return SampledInPlane(body, motions, {**KNOWN, **given}, contact_settings(rk.conventions.g, 0.0, "newton"))


def peaks(what, draws=None, motion=0):
    draws = np.empty((1, 0)) if draws is None else draws
    return what.run(draws, motion, np.ones(len(draws)), 1)


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "bodies on other feet, made and simulated one by one", within="1e-9")
@pytest.mark.parametrize("polarity", [1.0, -1.0])
def test_drawn_rows_are_the_bodies_that_they_mean(polarity):
    """Feet, friction and coefficients of an asymmetric body, mirrored as the motion turned round."""
    what = mechanics(BODY, PULSE, friction=(0.1, 0.8), base=(0.0, 0.05), polarity=polarity)
    draws = np.random.default_rng(2).random((6, 3))
    drawn, found = what.values(draws), peaks(what, draws)
    for k in range(6):
        left, right = drawn["base"][k]
        body = BODY.with_feet(BODY.feet[0] + left, BODY.feet[1] - right)
        alone = rk.simulate_many(
            body, PULSE, 0.9, friction=float(drawn["friction"][k, 0]), scale=polarity, threads=1
        ).squeeze()
        assert found.overturning[k] == alone.overturned
        assert found.peak[k] == pytest.approx(abs(float(alone.peak_rotation)), rel=1e-9)
        assert found.sliding[k] == pytest.approx(float(alone.sliding_distance), rel=1e-7, abs=1e-12)
    assert np.ptp(found.peak) > 0.0


@pytest.mark.verifies("computed anew", "the model of the body on other feet", within="1e-9")
def test_coefficients_follow_the_base():
    """That of the shifted impulse exactly; a coefficient that was given stays."""
    from rocking.evidence import calibrate_hierarchy

    model = rk.restitution.ShiftedImpulse(k=calibrate_hierarchy().summary["k"]["mean"])
    what = mechanics(BODY, PULSE, restitution=model, base=(0.0, 0.05))
    draws = np.random.default_rng(3).random((4, 2))
    drawn = what.values(draws)
    levers = what._levers - drawn["base"]
    found = what._coefficients(np.full(4, 0.5), levers, np.full(4, what._height))
    for k, (left, right) in enumerate(drawn["base"]):
        body = BODY.with_feet(BODY.feet[0] + left, BODY.feet[1] - right)
        assert found[k] == pytest.approx([model.coefficient(body, foot) for foot in ("left", "right")], abs=1e-9)
    fixed = mechanics(BODY, PULSE, base=(0.0, 0.05))._coefficients(np.full(4, 0.5), levers, np.full(4, what._height))
    assert (fixed <= 0.9).all()


@pytest.mark.slow
def test_measured_restitution_is_the_posterior():
    from rocking.evidence import restitution_distribution

    what, posterior = mechanics(BODY, PULSE, restitution="measured"), restitution_distribution(BODY)
    levels = np.array([[0.1], [0.5], [0.9]])
    found = what._coefficients(levels[:, 0], np.tile(what._levers, (3, 1)), np.full(3, what._height))
    for column, foot in enumerate(("left", "right")):
        assert found[:, column] == pytest.approx(posterior.quantile(levels[:, 0], foot), abs=1e-12)


@pytest.mark.verifies("invariant", "one component alone, and half a turn as the mirrored motion", within="1e-9")
def test_azimuths_of_two_components():
    """A quarter turn is the other component, half a turn the body seen from behind."""
    x, y = (noise_motion(k, peak=5.0) for k in (5, 6))
    pair = {"x": x, "y": y}
    across = peaks(mechanics(BODY, pair, azimuth=0.5 * math.pi)).peak
    assert across == pytest.approx(peaks(mechanics(BODY, y)).peak, rel=1e-9)
    turned = peaks(mechanics(BODY, pair, azimuth=math.pi)).peak
    assert turned == pytest.approx(peaks(mechanics(BODY, x, polarity=-1.0)).peak, rel=1e-9)
    # negative control: the body is not symmetric, so that which way round it stands matters
    assert turned != pytest.approx(peaks(mechanics(BODY, x)).peak, rel=1e-3)


@pytest.mark.slow
def test_the_same_seed_gives_the_same_answer_on_any_number_of_threads():
    motions = [noise_motion(k, peak=5.0) for k in range(3)]
    one, two, other = (
        predict(BLOCK, motions, count=32, seed=seed, threads=threads).answer().plain()
        for seed, threads in ((1, 1), (1, 2), (2, 1))
    )
    assert plain(one) == plain(two)
    assert plain(one) != plain(other)


def test_what_is_known_leaves_nothing_to_chance():
    """All inputs given: the probability is that of the one history, and no input has a share."""
    found = predict(BLOCK, rk.pulses.sine(12.0, 0.8), **KNOWN, count=16)
    alone = rk.simulate_many(BLOCK, rk.pulses.sine(12.0, 0.8), 0.9, friction=0.6).squeeze()
    assert found.chances["overturning"].value == float(alone.overturned) == 1.0
    assert found.contributions == {} or set(found.contributions) == set()
    assert [each for each in found.assumed if each.startswith(("friction", "base", "centre", "restitution:"))] == []


def test_impacts_by_complementarity_only():
    """Without a coefficient: the bodies have the peak of a response by complementarity, not that of a coefficient."""
    drawn = peaks(mechanics(BODY, rk.pulses.sine(5.0, 0.8), restitution="complementarity"))
    alone, other = (
        rk.simulate(BODY, rk.pulses.sine(5.0, 0.8), restitution, friction=KNOWN["friction"])
        for restitution in (None, 0.9)
    )
    assert drawn.peak[0] == pytest.approx(abs(alone.peak_rotation), rel=1e-7)
    assert drawn.peak[0] != pytest.approx(abs(other.peak_rotation), rel=1e-3)


@pytest.mark.verifies("behaviour", control="test_the_input_that_decides_has_the_share")
def test_rare_outcomes_have_no_contributions():
    """With fewer than four samples of the rarer outcome no further history is computed, and the answer says so."""
    predictions = [predict(BLOCK, rk.pulses.sine(a, 0.8), count=16, seed=2) for a in np.linspace(2.4, 6.0, 13)]
    for prediction in predictions:
        fallen = 16.0 * prediction.chances["overturning"].value
        if min(fallen, 16.0 - fallen) < 4.0:
            assert prediction.histories == 32  # sampled bodies and pairs
            assert not any(share.total for share in prediction.contributions.values())
            assert prediction.decides
    rare = [p for p in predictions if 0.0 < p.chances["overturning"].value < 0.25]
    assert any("Too few histories differ" in p.decides for p in rare)


@pytest.mark.verifies("negative control")
def test_the_input_that_decides_has_the_share():
    """Where it overturns if the friction holds its foot, and slides if not, friction has all of the variance."""
    found = predict(BLOCK, rk.pulses.sine(12.0, 0.8), **{**KNOWN, "friction": (0.05, 0.8)}, count=64)
    assert 0.1 < found.chances["overturning"].value < 0.9
    assert found.contributions["friction"].first > 0.6
    ends = found.ends["friction"]
    assert ends.low < math.tan(BLOCK.slenderness_angle) < ends.high
    assert (ends.probability_low, ends.probability_high) == (0.0, 1.0)
    told = f"0 % with friction near {ends.low:.3g} and 100 % with friction near {ends.high:.3g}"
    assert f"The probability of overturning is {told}." in found.sentences


@pytest.mark.slow
@pytest.mark.verifies("repeated sampling", "beta-distributed probabilities of motions", within="5 %")
def test_spread_between_motions():
    """The variance between motions without that of sampling; with none of it, next to nothing is found."""
    random = np.random.default_rng(7)
    true = random.beta(2.0, 2.0, 2000)
    happened = (random.random((64, 2000)) < true).astype(float)
    assert _chance(happened, 0).between == pytest.approx(math.sqrt(1.0 / 20.0), rel=0.05)
    none = _chance((random.random((64, 2000)) < 0.5).astype(float), 0)
    assert none.between < 0.02
    assert none.low < 0.5 < none.high
    assert none.high - none.low < 0.01  # independent histories
    alike = _chance(np.repeat((random.random((64, 1)) < 0.5).astype(float), 2000, axis=1), 0)
    assert (alike.low, alike.high) == pytest.approx(share_interval(alike.value * 64, 64))  # 64 of them, not 128,000


@pytest.mark.slow
def test_outcomes_change_with_small_differences_under_a_long_motion_and_not_under_a_pulse():
    small = predict(BLOCK, rk.pulses.sine(2.6, 0.6), count=16, contributions=False).outcome_pairs
    motions = SyntheticSet("firm-ground", 2, 1, pga=5.0)
    long = predict(rk.Block(width=0.2, height=0.8), motions, count=16, contributions=False).outcome_pairs
    assert small.apart == 0
    assert long.apart > 0
    assert long.sentence != small.sentence


def test_results_out(tmp_path):
    found = predict(BLOCK, [PULSE, rk.pulses.sine(1.0, 0.8)], count=16)
    assert isinstance(found, Prediction)
    facts = json.loads(json.dumps(plain(found.answer().plain())))
    assert facts["probability"]["overturning"]["per_motion"][1] == 0.0
    assert "motion" in facts["contributions"]
    dataset = found.to_xarray()
    assert dataset["overturning"].sizes == {"motion": 2}
    assert dataset["input_total"].attrs["units"] == "1"
    lines = found.to_csv(tmp_path / "found.csv").read_text("utf-8").splitlines()
    assert lines[0].startswith("motion,support,peak_acceleration")
    assert len(lines) == 3
    assert "placement" in str(found)


@pytest.mark.parametrize(
    ("given", "share", "value"),
    [
        (0.5, 0.3, 0.5),
        ((0.4, 0.8), 0.25, 0.5),
        ([0.3, 0.5, 0.9], 0.5, 0.5),
        ({"values": [0.2, 0.4]}, 0.7, 0.4),
        ({"median": 0.5, "dispersion": 0.2}, 0.5, 0.5),
        (scipy.stats.uniform(0.2, 0.4), 0.5, 0.4),
    ],
)
def test_inputs(given, share, value):
    assert Uncertain.of("friction", given, 0.0, 10.0).quantile(np.array([share])) == pytest.approx([value])


@pytest.mark.verifies("closed form", "the truncated normal distribution of SciPy", within="1e-12")
def test_a_normal_is_cut_where_values_make_no_sense():
    """Quantiles on condition that friction is not negative."""
    found = Uncertain.of("friction", {"mean": 0.3, "deviation": 0.2}, 0.0, 10.0)
    cut = scipy.stats.truncnorm(-1.5, (10.0 - 0.3) / 0.2, 0.3, 0.2)
    levels = np.linspace(0.0, 1.0, 11)[1:-1]
    assert found.quantile(levels) == pytest.approx(cut.ppf(levels), abs=1e-12)


@pytest.mark.parametrize(
    ("given", "why"),
    [
        ({"friction": -0.1}, "friction"),
        ({"friction": "rough"}, "friction must be a number, a pair"),
        ({"friction": (0.8, 0.2)}, "low to high"),
        ({"friction": [0.5]}, "two or more values"),
        ({"friction": {"mean": 0.5}}, "low and high, mean and deviation"),
        ({"friction": {"mean": 0.5, "deviation": 0.0}}, "deviation"),
        ({"friction": {"mean": 0.02, "deviation": 30.0}}, "check the unit"),
        ({"friction": scipy.stats.norm(0.0, 1.0)}, "friction must be within"),
        ({"base": 0.3}, "base"),
        ({"base": (0.0, math.nan)}, "base"),
        ({"centre": 2.0}, "centre"),
        ({"polarity": 0.0}, "polarity must be 1, -1"),
        ({"azimuth": 0.0}, "two components"),
        ({"restitution": "hausner"}, "housner"),
        ({"restitution": -1.0}, "restitution"),
        ({"count": 100}, "power of two"),
        ({"sliding_beyond": 0.0}, "sliding_beyond"),
        ({"seed": -1}, "seed"),
        ({"threads": 0}, "threads"),
        ({"body": "block"}, "body must be"),
        *(({"motions": bad}, "motions must be") for bad in ([], "sine", [1.0])),
        ({"motions": {"x": PULSE, "y": PULSE}}, "must be records"),
    ],
)
def test_bad_input(given, why):
    with pytest.raises(RockingError, match=why):
        predict(**({"body": BLOCK, "motions": PULSE} | given))


@pytest.mark.slow
def test_ked_and_housner_stand_beside_what_was_measured():
    """Their probabilities are those of the models by themselves; that of the default is of the same quarter of samples.

    A stated model or coefficient is compared with no model.
    """
    motions = [rk.pulses.sine(amplitude, 0.8) for amplitude in (3.0, 3.4, 5.0)]
    found = predict(BLOCK, motions, count=512, contributions=False)
    assert list(found.beside) == ["calibrated", "ked", "housner"]
    total, quarter = found.chances["overturning"], found.beside["calibrated"]
    assert quarter.low <= total.value <= quarter.high
    assert quarter.high - quarter.low > 1.3 * (total.high - total.low)  # about twice as wide with a quarter of samples
    for name in ("ked", "housner"):
        chance = found.beside[name]
        alone = predict(BLOCK, motions, restitution=name, count=512, contributions=False)
        assert alone.beside == {}
        assert chance.low <= alone.chances["overturning"].value <= chance.high
        assert any(f") with {name}" in sentence for sentence in found.sentences)
    assert predict(BLOCK, motions[0], restitution=0.9, count=16, contributions=False).beside == {}
    known = {
        "friction": 5.0,
        "base": 0.0,
        "centre": 1.0,
        "offset": 0.0,
        "level": 0.0,
        "polarity": 1.0,
        "model_error": "off",
    }  # nothing is left to draw
    fixed = predict(BLOCK, motions, **known, count=16, contributions=False)
    for name in ("ked", "housner"):
        chance = fixed.beside[name]
        alone = predict(BLOCK, motions, restitution=name, **known, count=16, contributions=False).chances["overturning"]
        assert chance.per_motion.tolist() == alone.per_motion.tolist()
