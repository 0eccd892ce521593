"""Answers are JSON without NaN that says what mechanics says; restitutions are called as on the pages."""

import json
import math

import numpy as np
import pytest

import rocking as rk
from rocking.answers import Answer
from rocking.errors import PureRockingWarning
from rocking.evidence._coefficient_table import default_models
from rocking.motions.spectrum import response_spectrum
from rocking.plots.labels import fine_samples
from rocking.reports.body_facts import (
    ImpactAnswer,
    curves_answer,
    measured_answer,
    outline_answer,
    stages_answer,
)
from rocking.reports.response_facts import (
    ModelAgreement,
    measures_of,
    record_answer,
    restitution_words,
    spectrum_answer,
)

BLOCK = rk.Block(width=0.5, height=2.0)
LEANING = rk.Section.from_trapezoid(1.0, 0.5, 2.5)
POINTS = rk.MassPoints([(0.2, 1.0), (0.8, 2.0)], [10.0, 20.0], (0.0, 1.0))
MOTION = rk.pulses.sine(amplitude=3.2, period=0.8)


@pytest.mark.slow
@pytest.mark.parametrize("body", [BLOCK, LEANING, POINTS])
def test_everything_is_plain_json(body):
    """Body, outline, impact, stages and response of every kind of body are JSON without NaN."""
    answer = ImpactAnswer.of(body, None, foot="both", gravity=9.81, identities=False)
    response = rk.simulate(body, MOTION)
    answers = [
        body.answer(9.81), outline_answer(body), answer.answer(), stages_answer(body, "left"), response.answer(0.5),
        response.outcome_answer(), measured_answer(), Answer({"curves": curves_answer()}),
    ]  # fmt: skip
    for each in answers:
        json.dumps(each.plain(), allow_nan=False)


@pytest.mark.slow
def test_an_overturning_response_has_no_infinite_number():
    """Where the friction demand is infinite or another step changes the outcome, None stands."""
    with pytest.warns(rk.errors.PureRockingWarning, match="the contact force becomes tensile"):
        response = rk.simulate(BLOCK, MOTION, scale=20.0)
    assert math.isinf(response.contact.friction_of_motion)
    assert response.outcome is rk.Outcome.OVERTURNED
    plain = json.loads(json.dumps(response.answer(0.5).plain(), allow_nan=False))
    assert plain["friction_of_motion"] is None


def test_a_large_outline_is_thinned():
    """An ellipse of 10000 sides is drawn with at most 2000 vertices, all of them on the ellipse."""
    drawn = outline_answer(rk.Section.from_ellipse(1.0, 2.0, 10_000))["outline"][0]["outline"]
    assert 1000 < len(drawn) <= 2000
    x, y = np.array(drawn).T
    assert np.allclose(((x - x.mean()) / 0.5) ** 2 + (y - 1.0) ** 2, 1.0, atol=1e-3)


def test_the_stages_conserve_what_they_say():
    """Stage 1 leaves no vertical velocity, stage 2 none along the line to the new foot, the last one is a rotation."""
    told = stages_answer(BLOCK, "right", angular_velocity=2.0)
    points, (before, first, second, after) = np.array(told["points"]), (s["velocity"] for s in told["stages"])
    assert not np.array(first)[:, 1].any()
    assert np.allclose((np.array(second) * (points - [0.5, 0.0])).sum(axis=1), 0.0, atol=1e-12)
    speed, reach = np.hypot(*np.array(after).T), np.hypot(*(points - [0.5, 0.0]).T)
    assert np.allclose(speed / reach, told["velocity_after"])
    assert np.allclose(np.hypot(*np.array(before).T) / np.hypot(*points.T), told["velocity_before"])
    inertia = BLOCK.side("right").moment_of_inertia
    assert math.isclose(told["stages"][0]["energy"], 0.5 * inertia * 4.0)


def test_what_is_shown_of_a_record_and_a_pulse():
    """A record tells samples and step, a pulse has its peaks from its formula."""
    record = rk.GroundMotion([0.0, 1.0, -2.0, 0.5], 0.1, name="four")
    facts = record_answer(record, record, measures_of(record, record))
    assert (facts["kind"], facts["samples"], facts["time_step"]) == ("record", 4, 0.1)
    assert facts["intensity"]["pga"] == 2.0
    assert spectrum_answer(response_spectrum(record, [0.5, 1.0], 0.05))["period"].tolist() == [0.5, 1.0]
    samples = fine_samples(MOTION)
    exact = record_answer(MOTION, samples, measures_of(MOTION, samples))["intensity"]
    assert math.isclose(exact["pgv"], 3.2 * 0.8 / math.pi, rel_tol=1e-12)


@pytest.mark.slow
def test_the_verdict_names_who_says_what():
    """Two outcomes are a decision, one is none; who still rocks, and with whom the ground would pull, is named."""
    rests, cut, falls = (
        rk.simulate(BLOCK, MOTION, **each) for each in ({"duration": 60.0}, {"duration": 1.0}, {"scale": 3.0})
    )
    with pytest.warns(PureRockingWarning, match="becomes tensile"):
        torn = rk.simulate(rk.Block(width=3.0, height=1.0), rk.pulses.sine(40.0, 1.0), 0.5)
    assert torn.lost_contact
    stands = "The body does not overturn with any of these models."
    for responses, decides, words in (
        ({"a": rests, "b": falls, "c": rests}, True,
         "The result depends on the restitution model: the body does not overturn with a, c, overturns with b."),
        ({"b": falls}, False, "The body overturns with all of these models."),
        ({"a": rests, "b": cut, "c": rests}, False,
         f"{stands} The body still rocks at the end of the computation with b."),
        ({"a": rests}, False, stands),
    ):  # fmt: skip
        found = ModelAgreement.of(responses)
        assert (found.models_differ, found.sentence) == (decides, words)
    both = ModelAgreement.of({"a": rests, "b": torn}).sentence
    assert both.endswith("The contact force becomes tensile with b; the verdict assumes contact.")


@pytest.mark.slow
def test_curves_follow_the_formula_of_housner():
    """The curve of Housner is 1 - 3/2 sin(alpha)^2 at every slenderness, and zero where that is negative."""
    curve = next(one for one in curves_answer() if one["model"] == "housner")
    alpha = np.arctan(1.0 / np.array(curve["slenderness_ratio"]))
    assert np.allclose(curve["coefficient"], np.maximum(1.0 - 1.5 * np.sin(alpha) ** 2, 0.0), rtol=1e-12)


def test_no_model_is_called_by_its_key() -> None:
    """With its parameters, too, a model is told by words; only one word is both name and key."""
    for model in default_models():
        words = restitution_words(model.label)
        assert words != model.label
        assert "-" not in words
        assert ":" not in words


@pytest.mark.parametrize(
    ("label", "words"),
    [
        ("ked", "KED"),
        ("0.98*shifted-impulse:k=0.6", "0.98 \u00d7 shifted impulse, k = 0.6"),
        ("contact-bed:points=8,loss=0.1", "contact bed, points = 8, loss = 0.1"),
        ("0.9", "r = 0.9"),
        ("left 0.9, right 0.8", "r: left 0.9, right 0.8"),
        ("drawn anew at every impact", "drawn anew at every impact"),
    ],
)
def test_labels_in_words(label: str, words: str) -> None:
    """A factor, parameters and coefficients are told as the field writes them; anything else stays as it is."""
    assert restitution_words(label).replace("\u00a0", " ") == words
