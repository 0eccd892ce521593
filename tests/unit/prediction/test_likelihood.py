"""Words for probabilities: the scale, what an interval allows, and sentences of one answer that agree."""

import itertools

import numpy as np
import pytest

import rocking as rk
from rocking.errors import RockingError
from rocking.prediction import predict
from rocking.prediction.likelihood import TERMS, likelihood, scale_words
from rocking.statistics import share_interval

pytestmark = pytest.mark.verifies(room="studies")
BLOCK = rk.Block(width=0.5, height=2.0)
WEAK = rk.pulses.sine(1.0, 0.6)


@pytest.mark.verifies("published", "Mastrandrea et al. (2010), Table 1")
def test_the_terms_of_the_scale():
    """Guidance Note for Lead Authors of the IPCC Fifth Assessment Report, Table 1."""
    printed = {
        "virtually certain": (99, 100), "very likely": (90, 100), "likely": (66, 100),
        "about as likely as not": (33, 66), "unlikely": (0, 33), "very unlikely": (0, 10),
        "exceptionally unlikely": (0, 1),
    }  # fmt: skip
    assert {term.words: (round(100 * term.low), round(100 * term.high)) for term in TERMS} == printed
    assert all(words in scale_words() for words in printed)


@pytest.mark.verifies("invariant", "all intervals of a grid of 41 probabilities")
def test_a_term_holds_the_whole_interval():
    """Both ends of an interval lie within the range of the term, or of the first and the last term."""
    ranges = {term.words: term for term in TERMS}
    for low, high in itertools.combinations(np.linspace(0.0, 1.0, 41), 2):
        first, _, last = likelihood(low, high).partition(" to ")
        assert ranges[first].low <= low <= ranges[first].high
        assert ranges[last or first].low <= high <= ranges[last or first].high


@pytest.mark.verifies("closed form", "1 - 0.025**(1/16)", within="1e-12")
def test_none_of_sixteen_is_not_almost_certain():
    """0 of 16 histories: the Clopper-Pearson interval ends at 20.6 %, and the word is "unlikely"."""
    found = predict(BLOCK, WEAK, count=16, shares=False)
    chance = found.chances["overturning"]
    assert (chance.low, chance.high) == pytest.approx((0.0, 1.0 - 0.025 ** (1.0 / 16.0)), abs=1e-12)
    assert found.verdict == (
        "Overturning is unlikely given this motion (PGA 0.102 g; PGV 0.191 m/s): probability 0 % "
        "(95 % interval 0 % to 20.6 %)."
    )
    # negative control: with enough histories the strong word is earned
    assert likelihood(*share_interval(0, 16)) != "exceptionally unlikely"
    assert likelihood(*share_interval(0, 512)) == "exceptionally unlikely"


@pytest.mark.verifies("invariant", "sentences against the outcomes of all histories")
def test_sentences_of_one_answer_agree():
    """Where a sentence says that an input changes the probability, none says that all histories end alike."""
    for seed, amplitude in itertools.product(range(4), (1.0, 2.75, 2.9, 3.4)):
        found = predict(BLOCK, rk.pulses.sine(amplitude, 0.8), count=4, seed=seed, friction=(0.1, 0.8))
        alike = found.outcomes == 1
        assert ("same outcome" in found.decides) == alike
        value = found.chances["overturning"].value
        if value in {0.0, 1.0}:
            assert not any("near" in words for words in found.sentences)


def test_every_probability_has_its_condition():
    found = predict(BLOCK, [rk.pulses.sine(a, 0.8) for a in (1.0, 3.0)], count=16, shares=False)
    assert "PGA 0.204 g, 0.102 to 0.306 g; PGV" in found.verdict
    assert found.condition in found.verdict
    assert found.answer().plain()["condition"] == found.condition
    assert [each["peak_ground_acceleration"] for each in found.answer().plain()["motions"]] == [1.0, 3.0]


@pytest.mark.verifies("computed anew", "motions scaled by hand", within="1e-12")
def test_scaled_to_a_pga():
    """As the motions scaled before; of two components the stronger has the PGA; of a floor it is refused."""
    from rocking.motions.floors import on_floor

    strong = rk.GroundMotion(np.sin(0.1 * np.arange(200.0)), 0.01)
    weak = strong.scaled(0.4)
    by_hand = predict(BLOCK, strong.scaled(3.0 / strong.peak), count=16, shares=False)
    found = predict(BLOCK, strong, pga=3.0, count=16, shares=False)
    assert found.chances["overturning"].value == by_hand.chances["overturning"].value
    assert found.motions[0].peak == pytest.approx(3.0, rel=1e-12)
    assert "so that PGA is 3 m/s2" in found.motions[0].provenance[-1]
    pair = predict(BLOCK, {"x": weak, "y": strong}, pga=3.0, count=16, shares=False)
    assert pair.motions[0].peak == pytest.approx(3.0, rel=1e-12)
    assert predict(BLOCK, rk.pulses.sine(1.0, 0.8), pga=3.0, count=16, shares=False).motions[0].peak == 3.0
    for motion, pga, why in (
        (on_floor(strong, 2, 3, 0.5), 3.0, "floor 2 of 3"), (strong, -1.0, "pga"), (strong, np.nan, "pga"),
        (strong.scaled(0.0), 3.0, "zero throughout"),
    ):  # fmt: skip
        with pytest.raises(RockingError, match=why):
            predict(BLOCK, motion, pga=pga, count=16)
