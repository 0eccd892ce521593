"""Scores of probabilities: closed forms, intervals by whole motions, and the plain logistic curve."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import expit, logit

from rocking.errors import InvalidValueError
from rocking.statistics import Forecasts, logistic_left_out

pytestmark = pytest.mark.verifies(room="statistics")


def test_by_hand():
    """Four outcomes, one probability each."""
    made = Forecasts([0.9, 0.2, 0.6, 0.1], [1, 0, 0, 0])
    assert made.brier.value == pytest.approx((0.01 + 0.04 + 0.36 + 0.01) / 4.0, rel=1e-14)
    assert made.logarithmic.value == pytest.approx(-np.log([0.9, 0.8, 0.4, 0.9]).mean(), rel=1e-14)
    assert (made.accuracy.value, made.balanced_accuracy.value) == (0.75, pytest.approx(5.0 / 6.0))
    assert made.skill(0.25).value == pytest.approx((0.75**2 + 3 * 0.25**2) / 4.0 - made.brier.value, rel=1e-13)
    assert made.skill(0.5, "logarithmic").value == pytest.approx(np.log(2.0) - made.logarithmic.value, rel=1e-13)
    assert made.bias.value == pytest.approx((0.9 - 1.0 + 0.2 + 0.6 + 0.1) / 4.0, rel=1e-13)
    assert made.sureness.value == pytest.approx((0.1 * -0.8 - 0.2 * 0.6 - 0.6 * -0.2 - 0.1 * 0.8) / 4.0, rel=1e-13)
    assert Forecasts([0.0, 1.0], [1, 1]).logarithmic.value == np.inf
    assert Forecasts([0.5, np.nan, 0.3], [1, 1, np.nan]).left_out == 2
    one, two = Forecasts([0.05, 0.12, 0.18], [0, 1, 0]).reliability()
    assert (one.count, one.observed, two.count, two.predicted, two.observed) == (1, 0.0, 2, pytest.approx(0.15), 0.5)


@pytest.mark.verifies("invariant", "the same outcomes named the other way round", within="1e-13")
@given(st.lists(st.tuples(st.floats(0.01, 0.99), st.booleans()), min_size=2, max_size=30))
def test_neither_outcome_is_preferred(pairs):
    """A fall foreseen with p is a stand foreseen with 1 - p, in every score."""
    p, happened = (np.array(each, dtype=float) for each in zip(*pairs, strict=True))
    one, other = Forecasts(p, happened, repetitions=1), Forecasts(1.0 - p, 1.0 - happened, repetitions=1)
    for name in ("brier", "logarithmic"):
        assert getattr(one, name).value == pytest.approx(getattr(other, name).value, rel=1e-13)
    assert one.calibration == pytest.approx(other.calibration, abs=1e-9)


@pytest.mark.verifies(
    "repeated sampling",
    "2000 studies of probabilities that are right",
    within="three standard errors",
    control="within",
)
def test_calibration_is_standard_normal():
    """Where outcomes happen as often as was said; probabilities that are too sure of themselves are found out."""
    random = np.random.default_rng(5)
    p = random.beta(0.7, 0.9, size=(2000, 150))
    happened = (random.random(p.shape) < p).astype(float)
    values = np.array([Forecasts(*row, repetitions=1).calibration for row in zip(p, happened, strict=True)])
    assert abs(values.mean()) < 3.0 / 2000**0.5
    assert abs(values.var() - 1.0) < 3.0 * (2.0 / 2000) ** 0.5
    sure = expit(2.0 * logit(np.clip(p, 1e-9, 1.0 - 1e-9)))  # the odds squared
    control = [Forecasts(*row, repetitions=1).calibration for row in zip(sure[:100], happened[:100], strict=True)]
    assert np.mean(np.array(control) > 2.0) > 0.9


@pytest.mark.verifies("repeated sampling", "400 studies of 30 motions", within="91 to 98 %", control="within")
def test_intervals_count_motions():
    """Outcomes under one motion are alike: intervals by motion hold the truth, those by outcome far too rarely."""
    random, holds = np.random.default_rng(7), np.zeros(2)
    names = np.repeat(np.arange(30), 8)
    for k in range(400):
        level = random.normal(size=30)[names]
        happened = (level + 0.3 * random.normal(size=names.size) > 0.0).astype(float)
        for j, clusters in enumerate((names, None)):  # the truth: half of them happen, and 0.5 is said of all
            interval = Forecasts(np.full(names.size, 0.3), happened, clusters, repetitions=300, seed=k).brier
            holds[j] += interval.low <= 0.5 * (0.09 + 0.49) <= interval.high
    assert 0.91 <= holds[0] / 400 <= 0.98
    assert holds[1] / 400 < 0.7


def test_difference_is_drawn_in_pairs():
    """The same outcomes for both: a small gain over a neighbour is resolved, over itself there is none."""
    random = np.random.default_rng(3)
    p = random.random(600)
    happened = (random.random(600) < p).astype(float)
    good, worse = Forecasts(p, happened), Forecasts(np.clip(p + 0.15, 0.0, 1.0), happened)
    assert good.skill(worse).resolved
    assert good.skill(worse).value > 0.0
    assert (good.skill(good).value, good.skill(good).resolved) == (0.0, False)


@pytest.mark.verifies("closed form", "half an outcome added to each cell of a table", within="1e-7", control="within")
def test_logistic_of_two_groups():
    """Of two groups the penalised curve adds a half to every count; so it is finite where a group has no fall."""
    groups = np.repeat([0.0, 1.0], [9, 6])
    happened = np.r_[np.zeros(9), np.ones(4), np.zeros(2)]
    features, outcome = np.r_[groups, 0.0, 1.0][:, None], np.r_[happened, np.nan, np.nan]
    p = logistic_left_out(features, outcome, np.r_[np.zeros(15), 1, 1])
    assert p[-2:] == pytest.approx([0.5 / 10.0, 4.5 / 7.0], abs=1e-7)
    assert abs(p[-1] - 4.0 / 6.0) > 0.02  # the likelihood itself
    separated = logistic_left_out(np.r_[groups, 0.5][:, None], np.r_[groups, 0.0], np.r_[np.zeros(15), 1])
    assert 0.0 < separated[-1] < 1.0


def test_left_out_is_not_seen():
    """Outcomes of a motion do not change what is foreseen of it; those of others do; units do not matter."""
    random = np.random.default_rng(11)
    features, names = random.normal(size=(60, 2)), np.repeat(np.arange(12), 5)
    happened = (features @ [2.0, -1.0] + random.normal(size=60) > 0.3).astype(float)
    p = logistic_left_out(features, happened, names)
    changed = np.where(names == 4, 1.0 - happened, happened)
    q = logistic_left_out(features, changed, names)
    assert q[names == 4] == pytest.approx(p[names == 4], rel=1e-12)
    assert np.abs(q[names == 3] - p[names == 3]).max() > 1e-3
    assert logistic_left_out(features * [100.0, 3.0] + 5.0, happened, names) == pytest.approx(p, rel=1e-6)
    assert np.isnan(logistic_left_out(features[:5], happened[:5], names[:5])).all()


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (lambda: Forecasts([0.5], [1, 0]), "rows of one length"),
        (lambda: Forecasts([50.0], [1]), r"in \[0, 1\], got 50; Use fractions"),
        (lambda: Forecasts([0.5], [2]), "outcome must be 1, 0 or NaN, got 2"),
        (lambda: Forecasts([0.5], [np.nan]), "a score needs a known outcome"),
        (lambda: Forecasts([0.5], [1]).skill(Forecasts([0.5], [0])), "same outcomes"),
        (lambda: Forecasts([0.5], [1]).skill(0.5, "accuracy"), "measure must be one of brier, logarithmic"),
        (lambda: logistic_left_out([0.1, 0.2], [0, 1], [0, 1]), "one row per outcome"),
        (lambda: logistic_left_out([[-np.inf], [1.0]], [0, 1], [0, 1]), "logarithms of zero"),
    ],
)
def test_bad_input_is_refused(wrong, words):
    with pytest.raises(InvalidValueError, match=words):
        wrong()
