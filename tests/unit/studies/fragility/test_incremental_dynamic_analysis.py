"""Incremental analysis: intervals, both definitions, censoring, the search between levels."""

import json
import math

import numpy as np
import pytest

import rocking as rk
from rocking.dynamics import ImpactLaw
from rocking.errors import InvalidValueError
from rocking.studies import fragility_analysis
from rocking.studies.fragility.incremental_dynamic_analysis import (
    OutcomeBrackets,
    brackets_of,
    intervals_of,
    refined,
)
from rocking.studies.fragility.question import FragilityQuestion
from rocking.studies.fragility.subject import Subject

BODY = rk.Block(width=0.4, height=1.6).with_feet(0.04, 0.4)
PULSES = [rk.pulses.sine(1.0, period) for period in np.linspace(0.35, 0.9, 12)]
LEVELS = np.linspace(2.0, 12.0, 41)


@pytest.fixture(scope="module")
def found():
    return fragility_analysis(BODY, PULSES, LEVELS, restitution=0.9, tolerance=1e-10, analysis="incremental")


def inside(intervals, motion, level):
    """Whether a level is in one of the intervals of a motion."""
    return any(i.motion == motion and i.start <= level < i.end for i in intervals)


def test_intervals_agree_with_every_level(found):
    """A motion overturns the body at a level exactly if the level is within one of its intervals."""
    expected = [[inside(found.intervals, k, level) for level in LEVELS] for k in range(12)]
    assert np.isinf(found.curves).tolist() == expected
    assert found.resurrected()


def test_intervals_agree_with_levels_in_between(found):
    """The same holds at random levels that were never among those tried, by single simulations."""
    random = np.random.default_rng(1)
    for motion, level in zip(random.integers(0, 12, 60), random.uniform(2.0, 12.0, 60), strict=True):
        one = rk.simulate(BODY, PULSES[motion].scaled(float(level)), restitution=0.9)
        assert (one.outcome is rk.Outcome.OVERTURNED) == inside(found.intervals, motion, level)


def test_boundaries_are_as_close_as_wanted(found):
    """Just below and above every boundary single simulations end differently."""
    for interval in found.intervals:
        for end, rises in ((interval.start, True), (interval.end, False)):
            if math.isinf(end):
                continue
            over = [
                rk.simulate(BODY, PULSES[interval.motion].scaled(end * f), restitution=0.9).outcome
                is rk.Outcome.OVERTURNED
                for f in (1.0 - 1e-9, 1.0 + 1e-9)
            ]
            assert over == ([False, True] if rises else [True, False])
        assert interval.start_width <= 1e-10 * interval.start


def test_fraction_is_that_of_the_stripes(found):
    """The definition "fraction" is the multiple-stripe analysis at the same levels, curve and all."""
    stripes = fragility_analysis(BODY, PULSES, LEVELS, restitution=0.9)
    np.testing.assert_array_equal(found.fractions, stripes.counts["overturned"] / 12)
    assert found.fits["overturned"].median == stripes.fits["overturned"].median


def test_first_crossing_is_never_below_the_fraction(found):
    """Passed first crossings are at least as many as overturned motions, and more where one has come back."""
    passed = np.array([np.mean(found.first_crossings <= level) for level in LEVELS])
    assert np.all(passed >= found.fractions)
    back = {
        k
        for k in range(12)
        for level in LEVELS
        if found.first_crossings[k] < level and not inside(found.intervals, k, level)
    }
    assert back <= set(found.resurrected())
    assert np.any(passed > found.fractions)
    assert found.fraction_resurrected() == len(found.resurrected()) / 12


def test_survivals_by_their_width(found):
    """The wider a survival must be, the fewer motions have one; each stands at the middle of its own."""
    shares = [found.fraction_resurrected(width) for width in (0.0, 0.01, 0.1, 1.0)]
    assert shares == sorted(shares, reverse=True)
    assert shares[0] > shares[-1]
    for motion, low, high in found.survivals:
        middle = rk.simulate(BODY, PULSES[motion].scaled(0.5 * (low + high)), restitution=0.9)
        assert middle.outcome is not rk.Outcome.OVERTURNED
    with pytest.raises(InvalidValueError):
        found.resurrected(-1.0)


@pytest.mark.slow
def test_both_definitions_are_printed(found):
    """The summary names both definitions, with a curve for each, and the resurrections."""
    told = json.loads(json.dumps(found.summary()))
    assert set(told["definition"]) == {"first crossing", "fraction"}
    assert told["first crossing"]["crossings"] + told["first crossing"]["censored"] == 12
    assert told["motions with resurrection"] == len(found.resurrected()) > 0
    assert "definition_first_crossing" in found.dataset.attrs
    assert found.dataset.sizes["interval"] == len(found.intervals)


def test_levels_that_start_above_the_crossing():
    """With the first level already overturning, the crossing below it is found all the same."""
    low = fragility_analysis(
        BODY, PULSES[3], [3.0, 3.5, 4.0, 4.5, 5.0], restitution=0.9, tolerance=1e-10, analysis="incremental"
    )
    high = fragility_analysis(BODY, PULSES[3], [5.0], restitution=0.9, tolerance=1e-10, analysis="incremental")
    assert high.first_crossings[0] == pytest.approx(low.first_crossings[0], rel=1e-9)


def test_motions_that_never_overturn_are_censored():
    """Levels below all crossings leave no crossing, no fit, and the right words."""
    none = fragility_analysis(BODY, PULSES[:3], [2.5, 2.6], restitution=0.9, analysis="incremental")
    assert none.first_crossings.tolist() == [math.inf] * 3
    assert none.first_crossing_fit is None
    assert none.summary()["first crossing"] is None
    assert none.intervals == ()


def test_motions_with_a_failure_have_no_crossing_and_are_named(found):
    """A failed history takes its motion out of the first crossings and leaves the others bitwise as they were."""
    subject = Subject.of(BODY, PULSES, 0.9, "pga", {})
    question = FragilityQuestion.of(subject, "incremental", LEVELS, tolerance=1e-10)
    arrays = question.histories.run(0, question.histories.count)
    arrays["outcome"][5], arrays["peak_rotation"][5] = rk.Outcome.FAILED.code, math.nan
    hurt = question.answer(arrays)
    assert math.isnan(hurt.first_crossings[0])
    np.testing.assert_array_equal(hurt.first_crossings[1:], found.first_crossings[1:])
    assert hurt.summary()["incomplete motions"] == [0]
    assert hurt.trials[5] == 11


def bracket(low, high, before, after, motion=0):
    """One bracket."""
    return OutcomeBrackets(*(np.array([value]) for value in (motion, low, high, before, after)))


def test_search_keeps_what_the_first_round_finds():
    """A bracket that hides an interval of survival is split into both of its intervals."""

    def outcomes(motion, level):
        return 1 * ((level > 1.2) & ~((level > 1.5) & (level < 1.7))), np.ones(level.size, bool)

    found = intervals_of(refined(bracket(1.0, 2.0, 0, 1, motion=4), outcomes, 1e-12))
    assert [(round(i.start, 9), round(i.end, 9)) for i in found] == [(1.2, 1.5), (1.7, math.inf)]
    assert {i.motion for i in found} == {4}


@pytest.mark.parametrize("width", [0.3, 1e-2, 1e-5, 1e-8])
def test_survival_between_sides_is_found(width):
    """Between overturning right and left there is survival, however narrow: the search finds both of its ends."""

    def outcomes(motion, level):
        return np.where(level < 1.37, 1, np.where(level > 1.37 + width, -1, 0)), np.ones(level.size, bool)

    found = refined(bracket(1.0, 2.0, 1, -1), outcomes, 1e-12)
    assert found.stops.tolist() == [True, False]
    assert found.starts.tolist() == [False, True]
    assert found.low == pytest.approx([1.37, 1.37 + width], rel=1e-11, abs=0.0)


def test_sides_that_meet_within_the_tolerance():
    """Survival narrower than the tolerance leaves one bracket without start or stop, and no interval ends there."""

    def outcomes(motion, level):
        return np.where(level < 1.37, 1, -1), np.ones(level.size, bool)

    found = refined(bracket(1.0, 2.0, 1, -1), outcomes, 1e-12)
    assert len(found) == 1
    assert not found.starts[0]
    assert not found.stops[0]
    before = bracket(0.0, 0.5, 0, 1)
    assert [i.is_open for i in intervals_of(before.joined(found))] == [True]


def test_search_stops_where_a_history_fails():
    """A failure inside a bracket leaves it as wide as it is, and the search ends."""

    def outcomes(motion, level):
        return 1 * (level > 1.2), ~((level > 1.19) & (level < 1.21))

    found = intervals_of(refined(bracket(1.0, 2.0, 0, 1), outcomes, 1e-12))[0]
    assert 0.0 < found.start_width <= 1.0
    assert abs(found.start - 1.2) <= found.start_width


@pytest.mark.parametrize("ends", [(0, 1), (1, 0), (-1, 1)])
def test_a_fractal_boundary_ends(ends):
    """Outcomes that change everywhere do not make the search explode, and starts and stops still take turns."""

    def outcomes(motion, level):
        return np.round(1.49 * np.sin(1e15 * level)).astype(int), np.ones(level.size, bool)

    found = refined(bracket(1.0, 2.0, *ends), outcomes, 1e-12)
    assert 1 <= len(found) <= 32
    assert np.all(found.high - found.low <= 1e-12 * found.high)
    turns = found.starts[found.starts | found.stops]
    assert np.all(turns[1:] != turns[:-1])


def test_brackets_alternate():
    """Starts and stops of a motion take turns, so that intervals can be read off."""
    made = brackets_of(np.array([7]), np.array([[0.0, 1.0, 2.0, 3.0]]), np.array([[0, 1, 0, -1]]))
    assert made.starts.tolist() == [True, False, True]
    assert made.stops.tolist() == [False, True, False]
    assert made.motion.tolist() == [7, 7, 7]


def test_many_brackets_are_halved_and_end_the_same():
    """Above the number at which brackets are halved instead of cut in 16, the crossings are those asked for."""
    wanted = np.random.default_rng(2).uniform(1.0, 2.0, 3000)

    def outcomes(motion, level):
        return 1 * (level >= wanted[motion]), np.ones(level.size, bool)

    many = OutcomeBrackets(np.arange(3000), np.ones(3000), np.full(3000, 2.0), np.zeros(3000, int), np.ones(3000, int))
    found = refined(many, outcomes, 1e-10)
    assert found.motion.tolist() == list(range(3000))
    assert np.all((found.low < wanted) & (wanted <= found.high))
    assert np.all(found.high - found.low <= 1e-10 * found.high)


BLOCK = rk.Block(width=0.4, height=1.6)
FEW_LEVELS = np.linspace(2.0, 12.0, 11)


def test_random_coefficients_have_no_crossing():
    """Sampled coefficients leave no crossing to search: refused, and stripes take them."""
    law = rk.dynamics.RandomRestitution(np.array([0.9, 1.0]), seed=3)
    with pytest.raises(InvalidValueError, match="sampled coefficients"):
        fragility_analysis(BLOCK, PULSES, FEW_LEVELS, restitution=law, analysis="incremental")
    assert fragility_analysis(BLOCK, PULSES, FEW_LEVELS, restitution=law).failed == 0


class Slower(ImpactLaw):
    """A law of one's own that always takes the coefficient."""

    def factor(self, speed, key, impact):
        return 1.0


class Drawn(Slower):
    """The same, which claims one draw a history."""

    per_history = True


def test_a_law_of_ones_own_is_taken_with_a_note():
    """A factor of one gives the crossings of the plain coefficient, and the summary says what it takes for granted."""
    own = fragility_analysis(
        BLOCK, PULSES[:2], [3.0, 6.0], restitution=Slower(), tolerance=1e-4, analysis="incremental"
    )
    plain = fragility_analysis(BLOCK, PULSES[:2], [3.0, 6.0], restitution=1.0, tolerance=1e-4, analysis="incremental")
    np.testing.assert_allclose(own.first_crossings, plain.first_crossings, rtol=2e-4)
    assert "user-defined law" in own.summary()["restitution note"]
    assert plain.summary()["restitution note"] == ""
    with pytest.raises(InvalidValueError, match="sampled coefficients"):
        fragility_analysis(BLOCK, PULSES[:2], [3.0, 6.0], restitution=Drawn(), analysis="incremental")
