"""Level and offset: a body on a slope, and probabilities that are too sure without the slope."""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.bodies.solid import Solid, box
from rocking.decision.prediction import predict
from rocking.decision.prediction._predict import _mechanics
from rocking.decision.prediction.placement import SHELF
from rocking.errors import RockingError
from rocking.statistics.scores import Forecasts

pytestmark = pytest.mark.verifies(room="studies")
GRAVITY = rk.conventions.g
FIXED = {
    "restitution": 0.9, "friction": 5.0, "base": 0.0, "centre": 1.0, "offset": 0.0, "polarity": 1.0,
    "model_error": "off",
}  # fmt: skip
OPTIONS = {"contributions": False, "threads": 1}


def on_slope(motion, slope):
    """A motion as it acts in the axes of a slope that descends towards x, on ground that is then level."""
    a = motion.acceleration
    return rk.GroundMotion(
        a * math.cos(slope) - GRAVITY * math.sin(slope), motion.time_step,
        vertical=a * math.sin(slope) + GRAVITY * (math.cos(slope) - 1.0),
    )  # fmt: skip


@pytest.mark.verifies("closed form", "uplift on a slope: g tan(alpha -+ slope)", control="within")
@pytest.mark.parametrize(("level", "offset"), [(0.02, 0.0), (-0.02, 0.0), (0.0, 0.01), (0.01, -0.02)])
def test_uplift_of_a_plane_body(level, offset):
    """The slope turns the slenderness angles; the offset moves the centre between the feet."""
    block, ramp = rk.Block(width=0.4, height=2.0), np.linspace(0.0, 1.0, 400)
    for sign, lever in ((1.0, 0.2 - offset), (-1.0, 0.2 + offset)):
        threshold = GRAVITY * math.tan(math.atan(lever / 1.0) - sign * level)
        for factor in (0.999, 1.001):
            motion = rk.GroundMotion(-sign * factor * threshold * ramp, 0.02)
            prediction = predict(block, motion, **{**FIXED, "level": level, "offset": offset}, count=4, **OPTIONS)
            assert prediction.chances["uplift"].value == float(factor > 1.0)
            # negative control: level ground and a centre in the middle
            plain = predict(block, motion, **FIXED, level=0.0, count=4, **OPTIONS).chances["uplift"].value
            assert plain == float(threshold * factor > GRAVITY * 0.2)


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "made-up bodies on slopes, simulated one by one", control="within")
def test_without_the_slope_a_prediction_is_too_sure():
    """Bodies on shelves of hidden slope: with the slope sampled the probabilities are calibrated, without it not."""
    random = np.random.default_rng(11)
    said, outcome = {"sampled": list[float](), "ignored": list[float]()}, list[float]()
    for _ in range(60):
        height = random.uniform(0.8, 1.6)
        block = rk.Block(width=height * random.uniform(0.12, 0.2), height=height)
        pulse = rk.pulses.sine(1.0, random.uniform(0.5, 1.0)).sampled(0.01)
        scales = GRAVITY * math.tan(block.slenderness_angle) * np.geomspace(1.0, 8.0, 80)
        level = rk.simulate_many(block, pulse, 0.9, friction=5.0, scale=scales, threads=1).overturned.values.ravel()
        motion = pulse.scaled(float(scales[np.argmax(level)]) * random.uniform(0.93, 1.07))
        slope = random.uniform(-SHELF, SHELF)
        truth = rk.simulate_many(block, on_slope(motion, slope), 0.9, friction=5.0, threads=1).overturned.item()
        outcome.append(float(truth))
        for name, stated in (("sampled", "shelf"), ("ignored", 0.0)):
            hits = predict(block, motion, **FIXED, level=stated, count=32, **OPTIONS).chances["overturning"].value
            said[name].append((32.0 * hits + 0.5) / 33.0)
    z = {name: Forecasts(np.array(values), np.array(outcome)).calibration for name, values in said.items()}
    assert 15 < sum(outcome) < 45
    assert abs(z["sampled"]) < 2.0
    assert abs(z["ignored"]) > 3.0


@pytest.mark.verifies("behaviour")
def test_supports_have_names():
    """A shelf slopes more than a floor; unknown supports are refused with the known ones."""
    block, pulse = rk.Block(width=1.0, height=4.0), rk.pulses.sine(3.0, 0.8)
    by_support = {name: predict(block, pulse, level=name, count=4, **OPTIONS) for name in ("floor", "shelf", "road")}
    assert by_support["floor"].inputs["level"] == "uniform, -0.006 to 0.006 rad"
    assert by_support["shelf"].inputs["level"] == "uniform, -0.016 to 0.016 rad"
    assert any("2.5 %" in text for text in by_support["road"].assumed)
    assert any(text.startswith("level:") for text in by_support["floor"].assumed)
    with pytest.raises(RockingError, match="level"):
        predict(block, pulse, level="table", count=4)


@pytest.mark.verifies("behaviour")
def test_the_headline_names_its_condition():
    """The verdict holds for the sampled inputs; what was not sampled and what a known azimuth would change follow."""
    x = rk.pulses.sine(3.0, 0.8).sampled(0.01)
    prediction = predict(rk.Block(width=0.5, height=2.0), {"x": x, "y": x.scaled(0.1)}, count=32, **OPTIONS)
    assert ", for the sampled inputs: probability" in prediction.verdict
    assert any(sentence.startswith("The probability does not include how often") for sentence in prediction.sentences)
    assert any(sentence.startswith("The azimuth was sampled") for sentence in prediction.sentences)
    stated = predict(rk.Block(width=0.5, height=2.0), {"x": x, "y": x}, azimuth=0.1, count=4, **OPTIONS)
    assert not any(sentence.startswith("The azimuth was sampled") for sentence in stated.sentences)
    one_value = "Inputs with one stated value, without uncertainty: "
    assert next(text for text in stated.sentences if one_value in text).endswith("azimuth.")
    assert not any("azimuth" in text for text in prediction.sentences if one_value in text)


@pytest.mark.verifies("computed anew", "bodies that are sampled again", within="0")
@pytest.mark.parametrize("body", [rk.Block(width=0.5, height=2.0), Solid(box(0.5, 0.7, 2.0))])
def test_another_restitution_leaves_the_bodies(body):
    """Bodies with another restitution are those of a prediction with this restitution, to the bit."""
    motion = rk.pulses.sine(3.0, 0.8)
    first, other, new = (
        _mechanics(body, motion, {"restitution": name}, GRAVITY, 0.0, "newton") for name in ("measured", "ked", "ked")
    )
    draws = np.random.default_rng(3).random((8, sum(new.widths.values())))
    shared, separate = (each.run(draws, 0, np.ones(8), 1) for each in (first.with_restitution("ked"), other))
    np.testing.assert_array_equal(shared.peak, separate.peak)
    assert first.with_restitution("ked").inputs["restitution"].text == new.inputs["restitution"].text
    # negative control: the restitution before
    levels = np.random.default_rng(3).random((8, sum(first.widths.values())))
    assert (first.run(levels, 0, np.ones(8), 1).peak != separate.peak).any()
