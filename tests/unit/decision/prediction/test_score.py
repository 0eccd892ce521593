"""Predictions beside plain curves: differences by hand, each kind of verdict, and forecasts that must not pass."""

import numpy as np
import pytest
from scipy.special import expit, logit

from rocking.decision.prediction import Validation, score
from rocking.errors import InvalidValueError
from rocking.statistics import logistic_left_out

pytestmark = [pytest.mark.slow, pytest.mark.verifies(room="studies")]
MOTIONS, TRIALS = 40, 8


def trials(seed=3, sharp=4.0):
    """Return what decides, which PGA and PGV tell in part, the true probabilities, and outcomes, with their motions."""
    random = np.random.default_rng(seed)
    names = np.repeat(np.arange(MOTIONS), TRIALS)
    pga, hidden = np.exp(random.normal(size=MOTIONS))[names], random.normal(size=names.size)
    p = expit(sharp * (0.5 * np.log(pga) + hidden))
    return names, {"pga": pga, "pgv": 0.1 * pga}, p, (random.random(p.size) < p).astype(float)


@pytest.mark.verifies("computed anew", "means of squares and logarithms by hand", within="1e-12")
def test_differences_by_hand():
    """Over the outcomes that are known; a share of 16 histories counts as (h + 1/2)/17."""
    names, peaks, p, fell = trials()
    share = np.round(16.0 * p) / 16.0
    share[3], fell[11] = np.nan, np.nan
    found = score(share, fell, names, **peaks, count=16, repetitions=50)
    known = np.delete(np.arange(p.size), [3, 11])
    said, seen = ((16.0 * share + 0.5) / 17.0)[known], fell[known]
    curve = logistic_left_out(np.log(np.column_stack([peaks["pga"], peaks["pgv"]])), fell, names)[known]
    differences = found.differences["logistic"]
    assert differences["brier"].value == pytest.approx(np.mean((curve - seen) ** 2 - (said - seen) ** 2), abs=1e-12)
    surprise = [-np.log(np.where(seen == 1.0, each, 1.0 - each)) for each in (curve, said)]
    assert differences["logarithmic"].value == pytest.approx(np.mean(surprise[0] - surprise[1]), abs=1e-12)
    assert found.forecasts["prediction"].probability == pytest.approx(said, abs=1e-15)
    others = (names != 0) & ~np.isnan(fell)
    rate = (fell[others].sum() + 0.5) / (others.sum() + 1.0)  # a half added to either count, by Firth's penalty
    assert found.probability["base rate"][0] == pytest.approx(rate, rel=1e-7)
    assert found.answer().plain()["left_out"] == 2


def test_who_knows_more_is_better():
    names, peaks, p, fell = trials()
    found = score(p, fell, names, **peaks)
    assert (found.finding, found.clusters) == ("better", MOTIONS)
    assert found.sentences[-1].endswith("the difference is not resolved.")


@pytest.mark.verifies("negative control", room="studies")
@pytest.mark.parametrize("seed", range(4))
def test_outcomes_of_other_trials_are_not_foreseen(seed):
    """The same forecast and the same outcomes, in another order."""
    names, peaks, p, fell = trials()
    found = score(p, np.random.default_rng(seed).permutation(fell), names, **peaks)
    assert found.finding == "worse"


@pytest.mark.verifies("negative control", room="studies")
def test_balanced_accuracy_does_not_save_who_is_too_sure():
    """The odds to the sixth power: every yes and no as before, so the same balanced accuracy, but far too sure."""
    names, peaks, p, fell = trials(sharp=1.5)
    sure = expit(6.0 * logit(p))
    right, wrong = (score(each, fell, names, **peaks) for each in (p, sure))
    both = [each.forecasts["prediction"].balanced_accuracy.value for each in (right, wrong)]
    assert both[0] == both[1] > 0.6
    assert right.finding == "better"
    assert wrong.finding in {"worse", "mixed"}
    assert (right.too_sure, wrong.too_sure) == (False, True)
    assert wrong.differences["base rate"]["logarithmic"].high < 0.0


@pytest.mark.verifies("negative control", room="studies")
def test_the_same_knowledge_is_not_resolved():
    """The plain curve itself as the forecast is not better than itself, though better than the base rate."""
    names, peaks, _, fell = trials()
    features = np.log(np.column_stack([peaks["pga"], peaks["pgv"]]))
    found = score(logistic_left_out(features, fell, names), fell, names, **peaks)
    assert (found.differences["logistic"]["brier"].value, found.finding) == (0.0, "not resolved")
    assert found.verdict.startswith("Not resolved: ")


def test_an_impossible_that_happened():
    """A certain no that was wrong costs without bound, and is told so."""
    names, peaks, p, fell = trials()
    given = np.where(np.arange(p.size) == np.flatnonzero(fell)[0], 0.0, p)
    found = score(given, fell, names, **peaks)
    assert found.forecasts["prediction"].logarithmic.value == np.inf
    assert found.finding != "worse" or "worse" in found.verdict
    assert score(given, fell, names, **peaks, count=64).forecasts["prediction"].logarithmic.value < 1.0


def test_too_much_said_is_seen():
    names, peaks, p, fell = trials()
    found = score(expit(logit(p) + 1.5), fell, names, **peaks, event="uplift")
    assert found.forecasts["prediction"].bias.low > 0.0


@pytest.mark.parametrize("motions", [1, 4])
def test_few_motions_resolve_nothing(motions):
    """However good it is; of one motion there is no curve that has not seen it."""
    names, peaks, p, fell = (
        each[: motions * TRIALS] if not isinstance(each, dict) else {k: v[: motions * TRIALS] for k, v in each.items()}
        for each in trials()
    )
    found = score(p, fell, names, **peaks)
    assert found.finding == "not resolved"
    assert found.clusters == motions
    assert len(found.differences) == (0 if motions == 1 else 2)
    assert found.answer().plain()["motions"] == motions


@pytest.mark.parametrize(("yes", "resolved"), [(5, True), (4, False)])
def test_a_verdict_needs_as_many_motions_as_it_says(yes, resolved):
    """Five motions of either outcome are enough, four of one are not, as the verdict's own sentence asks."""
    names = np.repeat(np.arange(12), TRIALS)
    fell = (names < yes) * 1.0
    found = score(np.where(fell == 1.0, 0.9, 0.1), fell, names, pga=1.0 + names % 3, pgv=1.0 + names % 5)
    assert found.either == (yes, 12 - yes)
    assert found.enough == resolved


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"pgv": np.ones(3)}, "arrays of equal length"),
        ({"pga": np.zeros(320)}, "pga must be above zero"),
        ({"outcome": np.full(320, np.nan)}, "a score needs a known outcome"),
        ({"probability": np.full(320, 30.0)}, "Use fractions"),
        ({"event": "falling"}, "event must be one of overturning, uplift, sliding"),
        ({"count": 0}, "count"),
    ],
)
def test_refusals(changes, why):
    names, peaks, p, fell = trials()
    given = {"probability": p, "outcome": fell, "motions": names, **peaks, **changes}
    with pytest.raises(InvalidValueError, match=why):
        score(given.pop("probability"), given.pop("outcome"), given.pop("motions"), **given)


@pytest.mark.verifies("negative control", room="studies")
def test_all_outcomes_alike_resolve_nothing():
    """Who always says no is right about what never happened; neither that nor a rare one makes a verdict."""
    names, peaks, p, _ = trials()
    never = score(np.full(p.size, 0.001), np.zeros(p.size), names, **peaks)
    rare = score(np.full(p.size, 0.001), (np.arange(p.size) < 4 * TRIALS) * 1.0, names, **peaks)
    assert never.differences["base rate"]["brier"].resolved  # of intervals without a width
    assert [each.finding for each in (never, rare)] == ["not resolved"] * 2
    assert never.either == (0, 40)


def test_what_is_drawn_is_a_validation():
    from rocking.plots import reliability_picture

    with pytest.raises(InvalidValueError, match="must be a Validation"):
        reliability_picture(0.5)
    names, peaks, p, fell = trials()
    found = score(p, fell, names, **peaks)
    assert isinstance(found, Validation)
    left, right = reliability_picture(found).axes
    counts = [int(text.get_text()) for text in left.texts]
    assert sum(counts) == 320
    assert len(right.get_yticks()) == 4
