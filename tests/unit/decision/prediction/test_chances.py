"""Probabilities and their intervals by closed forms, and coefficients of restitution within what energy allows."""

import itertools
import math

import numpy as np
import pytest
from scipy.stats import beta, binom, norm

import rocking as rk
from rocking.decision.prediction._predict import _chance, _outcome_pairs
from rocking.decision.prediction.likelihood import TERMS, likelihood, scale_words
from rocking.decision.prediction.mechanics import Uncertain
from rocking.decision.prediction.plane import SampledInPlane, contact_settings
from rocking.errors import RockingError
from rocking.statistics import share_interval

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
    known = {"friction": 0.6, "base": 0.0, "centre": 1.0, "offset": 0.0, "level": 0.0, "polarity": 1.0}
    settings = contact_settings(rk.conventions.g, 0.0, "newton")
    what = SampledInPlane(body, rk.pulses.sine(4.2, 0.8), {**known, "restitution": 1.0}, settings)
    found = what._coefficients(np.array([0.5]), np.array([[0.52, 0.28]]), np.array([0.9]))
    assert left > 1.05 * right
    # onto the left foot the body turns about the right foot before
    np.testing.assert_allclose(found, [[math.sqrt(right / left), 1.0]], rtol=1e-12)


def test_an_interval_over_motions_has_the_quantiles_of_a_binomial():
    """Alike bodies overturn under 20 of 40 motions: motions drawn anew with replacement give a binomial share."""
    found = _chance(bodies(*[20] * 400, motions=40), 0)
    drawn = [float(binom.ppf(level, 40, 0.5)) / 40.0 for level in (0.025, 0.975)]
    # one motion, the step of the share, for the quantiles of 1,000 draws
    assert (found.wide_low, found.wide_high) == pytest.approx(drawn, abs=1.0 / 40.0)
    # negative control: the interval over bodies is narrower by far more than a motion
    assert found.high < drawn[1] - 2.0 / 40.0


def test_pairs_that_rock_are_counted_and_compared():
    """Pairs at rest, of one outcome, of two outcomes, both overturning, and without a result.

    Under a second motion all are at rest; a body more has no pair.
    """
    nan = math.nan
    rows = {  # uplift, overturning of a history and of its pair
        "at rest": (0.0, 0.0, 0.0),
        "standing": (1.0, 0.0, 0.0),
        "second overturns": (1.0, 0.0, 1.0),
        "first overturns": (1.0, 1.0, 0.0),
        "both overturning": (1.0, 1.0, 1.0),
        "without a result": (1.0, 0.0, nan),
    }

    def counted(*names):
        """Return the pairs under one motion with these rows, and under a second one with all bodies at rest."""
        uplift, first, second = np.array([rows[name] for name in names]).T
        columns = {"uplift": [*uplift, 0.0, *uplift], "overturning": [*first, 0.0, *second]}
        results = {key: np.column_stack([values, np.zeros(len(values))]) for key, values in columns.items()}
        return _outcome_pairs(results, len(names) + 1, ("strong", "weak"))

    calm = counted("at rest", "standing", "standing", "both overturning", "without a result")
    assert (calm.pairs, calm.rocking, calm.apart, calm.motions_apart, calm.motions) == (5, 3, 0, (), 2)
    wild = counted("at rest", "standing", "second overturns", "first overturns")
    assert (wild.rocking, wild.apart, wild.motions_apart) == (3, 2, ("strong",))
    assert calm.sentence != wild.sentence != counted("at rest").sentence


KNOWN = {
    "friction": 0.6, "base": 0.0, "centre": 1.0, "offset": 0.0, "level": 0.0, "polarity": 1.0, "model_error": "off"
}  # fmt: skip


def mechanics(body, **given):
    return SampledInPlane(
        body, rk.pulses.sine(4.2, 0.8), {**KNOWN, **given}, contact_settings(rk.conventions.g, 0.0, "newton")
    )


def coefficients(what, levels):
    """Coefficients onto the left and the right foot of the body as it is drawn."""
    levels = np.asarray(levels)
    return what._coefficients(levels, np.tile(what._levers, (levels.size, 1)), np.full(levels.size, what._height))


def test_a_given_distribution_of_restitution_keeps_its_tails():
    """Quantiles of a lognormal, exp(ln m + s z); levels beyond 1/1,024 of either end too."""
    levels = np.array([5e-4, 0.0015, 0.25, 0.5, 0.9, 0.9985, 0.9995])
    what = mechanics(rk.Block(width=0.5, height=2.0), restitution={"median": 0.7, "dispersion": 0.05})
    for found in coefficients(what, levels).T:
        np.testing.assert_allclose(found, 0.7 * np.exp(0.05 * norm.ppf(levels)), rtol=5e-3)


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "the model of the body on other feet", within="1e-9")
def test_what_was_measured_follows_the_base():
    """A quantile of the drawn body times the ratio of the calibrated shifted impulse on the feet that were drawn."""
    from rocking.evidence import calibrate_hierarchy, restitution_distribution

    body = rk.Block(width=0.6, height=2.2, centre=(0.35, 0.9))
    model = rk.restitution.ShiftedImpulse(k=calibrate_hierarchy().summary["k"]["mean"])
    worn = body.with_feet(body.feet[0] + 0.03, body.feet[1] - 0.01)
    what, posterior = mechanics(body, restitution="measured"), restitution_distribution(body)
    found = what._coefficients(np.array([0.3]), what._levers - [[0.03, 0.01]], np.array([what._height]))
    for column, foot in enumerate(("left", "right")):
        ratio = model.coefficient(worn, foot) / model.coefficient(body, foot)
        assert found[0, column] == pytest.approx(posterior.quantile([0.3], foot)[0] * ratio, rel=1e-9)
        assert abs(ratio - 1.0) > 1e-3  # the base matters


@pytest.mark.slow
def test_ends_of_a_range_are_means_of_its_fifths():
    """Of friction from 0.1 to 0.9, all alike, the lowest fifth has the mean 0.18 and the highest 0.82."""
    found = rk.predict(rk.Block(width=0.5, height=2.0), rk.pulses.sine(1.0, 0.6), friction=(0.1, 0.9), count=64)
    ends = found.ends["friction"]
    # 12 of 64 draws are the lowest 18.75 %: half a step of 1/64 of the range
    assert (ends.low, ends.high) == pytest.approx((0.18, 0.82), abs=0.8 / 64.0)


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
    assert {term.text: (round(100 * term.low), round(100 * term.high)) for term in TERMS} == printed
    assert all(words in scale_words() for words in printed)


@pytest.mark.verifies("invariant", "all intervals of a grid of 41 probabilities")
def test_a_term_holds_the_whole_interval():
    """Both ends of an interval lie within the range of the term, or of the first and the last term."""
    ranges = {term.text: term for term in TERMS}
    for low, high in itertools.combinations(np.linspace(0.0, 1.0, 41), 2):
        first, _, last = likelihood(low, high).partition(" to ")
        assert ranges[first].low <= low <= ranges[first].high
        assert ranges[last or first].low <= high <= ranges[last or first].high


@pytest.mark.slow
@pytest.mark.verifies("closed form", "1 - 0.025**(1/16)", within="1e-12")
def test_none_of_sixteen_is_not_almost_certain():
    """0 of 16 histories: the Clopper-Pearson interval ends at 20.6 %, and the word is "unlikely"."""
    found = rk.predict(BLOCK, WEAK, count=16, contributions=False)
    chance = found.chances["overturning"]
    assert (chance.low, chance.high) == pytest.approx((0.0, 1.0 - 0.025 ** (1.0 / 16.0)), abs=1e-12)
    assert found.verdict == (
        "Overturning is unlikely given this motion (PGA 0.102 g; PGV 0.191 m/s), for the sampled inputs: "
        "probability 0 % (95 % interval 0 % to 20.6 %)."
    )
    # negative control: with enough histories the strong word is earned
    assert likelihood(*share_interval(0, 16)) != "exceptionally unlikely"
    assert likelihood(*share_interval(0, 512)) == "exceptionally unlikely"


@pytest.mark.slow
@pytest.mark.verifies("invariant", "sentences against the outcomes of all histories")
def test_sentences_of_one_answer_agree():
    """Where a sentence says that an input changes the probability, none says that all histories end alike."""
    for seed, amplitude in itertools.product(range(4), (1.0, 2.75, 2.9, 3.4)):
        found = rk.predict(BLOCK, rk.pulses.sine(amplitude, 0.8), count=4, seed=seed, friction=(0.1, 0.8))
        alike = found.outcomes == 1
        assert ("same outcome" in found.decides) == alike
        value = found.chances["overturning"].value
        if value in {0.0, 1.0}:
            assert not any("near" in words for words in found.sentences)


@pytest.mark.slow
def test_every_probability_has_its_condition():
    found = rk.predict(BLOCK, [rk.pulses.sine(a, 0.8) for a in (1.0, 3.0)], count=16, contributions=False)
    assert "PGA 0.204 g, 0.102 to 0.306 g; PGV" in found.verdict
    assert found.condition in found.verdict
    assert found.answer().plain()["condition"] == found.condition
    assert [each["peak_ground_acceleration"] for each in found.answer().plain()["motions"]] == [1.0, 3.0]


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "motions scaled by hand", within="1e-12")
def test_scaled_to_a_pga():
    """As the motions scaled before; of two components the stronger has the PGA; of a floor it is refused."""
    from rocking.motions.floors import on_floor

    strong = rk.GroundMotion(np.sin(0.1 * np.arange(200.0)), 0.01)
    weak = strong.scaled(0.4)
    by_hand = rk.predict(BLOCK, strong.scaled(3.0 / strong.peak), count=16, contributions=False)
    found = rk.predict(BLOCK, strong, pga=3.0, count=16, contributions=False)
    assert found.chances["overturning"].value == by_hand.chances["overturning"].value
    assert found.motions[0].peak == pytest.approx(3.0, rel=1e-12)
    assert "so that PGA is 3 m/s2" in found.motions[0].provenance[-1]
    pair = rk.predict(BLOCK, {"x": weak, "y": strong}, pga=3.0, count=16, contributions=False)
    assert pair.motions[0].peak == pytest.approx(3.0, rel=1e-12)
    assert rk.predict(BLOCK, rk.pulses.sine(1.0, 0.8), pga=3.0, count=16, contributions=False).motions[0].peak == 3.0
    for motion, pga, why in (
        (on_floor(strong, 2, 3, 0.5), 3.0, "floor 2 of 3"), (strong, -1.0, "pga"), (strong, np.nan, "pga"),
        (strong.scaled(0.0), 3.0, "zero throughout"),
    ):  # fmt: skip
        with pytest.raises(RockingError, match=why):
            rk.predict(BLOCK, motion, pga=pga, count=16)
