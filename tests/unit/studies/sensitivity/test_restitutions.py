"""Restitutions by name, and coefficients drawn once for every history."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

import rocking as rk
from rocking import conventions
from rocking.dynamics import RandomRestitution, RockingParameters, SpeedRestitution
from rocking.dynamics.impact_laws import uniform
from rocking.errors import InvalidValueError
from rocking.outcome import Outcome, Status
from rocking.restitution import Fixed
from rocking.studies import HistoryTable, MotionList, Product, SampledRestitution
from rocking.studies.sensitivity.restitutions import SampledHistories, label_of, named_restitutions, sampled, uniforms

BLOCK = rk.Block(width=0.5, height=2.0)
PULSES = MotionList([rk.pulses.sine(3.0, period) for period in (0.5, 0.7, 0.9)])
LAW = SampledRestitution.normal(0.9, 0.02, seed=11)
SEEDS = (0, 1, 7, 2**32, 2**63, 2**64 - 1)


def histories(r=1.0, count=100, **options):
    """Three pulses at many scales, with a coefficient of one that a draw can multiply."""
    parameters = RockingParameters.of_body(BLOCK, r, conventions.g)
    sides = {
        f"{short}_{foot}": np.array([[getattr(getattr(parameters, foot), name)]])
        for short, name in (("alpha", "slenderness_angle"), ("p", "frequency_parameter"), ("r", "coefficient"))
        for foot in ("right", "left")
    }
    return Product(PULSES, sides, np.linspace(0.9, 3.0, count), **options)


def same(first, second):
    """Whether two sets of results are equal to the last bit."""
    return all(first[name].tobytes() == second[name].tobytes() for name in first)


@pytest.mark.parametrize("seed", SEEDS)
def test_vectorised_numbers_are_those_of_the_engine(seed):
    """The numbers of many histories at once equal those that the engines draw one by one, to the last bit."""
    keys = [0, 1, 2, 12345, 2**31, 2**40 + 7, 2**63 - 1]
    for impact in (0, 1, 77):
        assert uniforms(seed, keys, impact).tolist() == [uniform(seed, key, impact) for key in keys]


def test_vectorised_draws_are_those_of_the_law():
    """Draws of many histories equal the law's factor, to the last bit, whatever the impact and the speed."""
    assert LAW.draws(np.arange(3000)).tolist() == [LAW.factor(0.1 * k, k, k % 5) for k in range(3000)]


@pytest.mark.slow
def test_the_fast_engine_gets_what_the_reference_draws():
    """Histories with drawn columns on the fast engine end as the law itself does on the reference engine."""
    base = histories(count=12, law=LAW)
    quick = sampled(base)
    assert isinstance(quick, SampledHistories)
    fast = quick.run(0, quick.count)
    slow = replace(base, engine="reference").run(0, base.count)
    assert fast["outcome"].tolist() == slow["outcome"].tolist()
    assert set(fast["outcome"]) == {Outcome.ROCKED.code, Outcome.OVERTURNED.code}
    assert fast["peak_rotation"] == pytest.approx(slow["peak_rotation"], abs=1e-9)


def test_the_first_impact_is_drawn_as_for_every_impact():
    """With one impact at most the draw per history is the draw per impact, bitwise; with more they differ."""
    once = SampledHistories.of(histories(), LAW).run(0, 300)
    law = RandomRestitution(LAW.factors, LAW.seed)
    each = replace(histories(), law=law).run(0, 300)
    few = (once["impacts"] <= 1) & (each["impacts"] <= 1)
    assert few.sum() > 50
    assert once["peak_rotation"][few].tobytes() == each["peak_rotation"][few].tobytes()
    many = once["impacts"] > 3
    assert np.any(once["impacts"][many] != each["impacts"][many])


def test_pieces_equal_the_whole():
    """Any division into pieces gives the same results to the last bit; draws keyed by the place in a piece do not."""

    class ByPlace(SampledHistories):
        def rows(self, first, last):
            rows = super().rows(first, last)
            wrong = self.draw.draws(np.arange(last - first))
            return replace(rows, values=rows.values | {"r_right": wrong, "r_left": wrong})

    def differs(kind):
        made = kind.of(histories(), LAW)
        whole = made.run(0, 300)
        parts = [made.run(a, b) for a, b in ((0, 1), (1, 100), (100, 237), (237, 300))]
        return not same(whole, {name: np.concatenate([p[name] for p in parts]) for name in whole})

    assert not differs(SampledHistories)
    assert differs(ByPlace)


@pytest.mark.parametrize("r", [0.9, 0.87654321])
def test_a_distribution_without_width_is_the_constant(r):
    """Quantiles that are all the same give the results of that coefficient, to the last bit."""
    drawn = SampledHistories.of(histories(), SampledRestitution([r, r, r], seed=3)).run(0, 300)
    assert same(drawn, histories(r).run(0, 300))
    assert not same(drawn, SampledHistories.of(histories(), SampledRestitution([r, r + 0.05], seed=3)).run(0, 300))


def test_draws_multiply_what_the_histories_have():
    """Draws times the coefficients of a model are the model's times an interface factor without width."""
    ked = rk.coefficient_of_restitution(BLOCK, "ked")
    drawn = SampledHistories.of(histories("ked"), SampledRestitution([0.98, 0.98], seed=3, times="ked"))
    assert drawn.rows(0, 5).values["r_right"].tolist() == [ked * 0.98] * 5


def test_the_name_of_the_histories_knows_the_draws():
    """Seed, quantiles and base enter the key; equal ones have equal keys, also after pickling; labels do not matter."""
    base, other = histories(), histories(0.95)
    same_law = SampledRestitution(LAW.factors.copy(), LAW.seed)
    key = SampledHistories.of(base, LAW).key()
    assert SampledHistories.of(histories(), same_law).key() == key
    assert pickle.loads(pickle.dumps(SampledHistories.of(base, LAW))).key() == key
    narrower = SampledRestitution.normal(0.9, 0.019, seed=LAW.seed)
    others = [(base, replace(LAW, seed=12)), (base, narrower), (other, LAW), (replace(base, engine="fast"), LAW)]
    assert len({key, base.key(), *(SampledHistories.of(*pair).key() for pair in others)}) == 6


def test_a_pickled_piece_computes_the_same():
    """A worker that receives the histories through pickle computes the same bits."""
    made = SampledHistories.of(histories(), LAW)
    assert same(pickle.loads(pickle.dumps(made)).run(37, 63), made.run(37, 63))


def test_a_bad_row_touches_no_other():
    """A history that cannot be computed is reported, and the others get the draws that they get without it."""
    good = histories().rows(0, 300)
    broken = {name: values.copy() for name, values in good.values.items()}
    broken["alpha_right"][17] = np.nan
    found, clean = (
        SampledHistories.of(HistoryTable(PULSES, good.motion, values), LAW).run(0, 300)
        for values in (broken, good.values)
    )
    assert found["status"][17] == Status.INVALID.code
    others = np.arange(300) != 17
    assert same({k: v[others] for k, v in found.items()}, {k: v[others] for k, v in clean.items()})


def test_the_same_distribution_once_or_every_time():
    """A law for every impact becomes one for every history with the same quantiles, seed and base."""
    law = RandomRestitution.of_sample(np.linspace(0.8, 0.9, 11), seed=5, times="ked")
    once = SampledRestitution.of_law(law)
    assert (once.factors.tolist(), once.seed, once.times) == (law.factors.tolist(), 5, "ked")
    assert SampledRestitution.of_sample(np.linspace(0.8, 0.9, 11), seed=5).factors.tolist() == law.factors.tolist()


def test_histories_without_such_a_law_stay_as_they_are():
    """Only a draw for every history is rewritten."""
    base = histories()
    assert sampled(base) is base


@pytest.mark.parametrize(
    ("quantiles", "seed", "message"),
    [
        ([0.9, 0.8], 1, "must not decrease"),
        ([0.9, 1.1], 1, "in \\[0, 1\\]"),
        ([0.9, float("nan")], 1, "finite"),
        ([0.9], 1, "at least 2"),
        ([0.9, 0.9], -1, "seed"),
        ([0.9, 0.9], 1.5, "seed"),
    ],
)
def test_bad_distributions_are_refused(quantiles, seed, message):
    """Quantiles that decrease, leave [0, 1] or are not finite, and seeds that are none, are refused in words."""
    with pytest.raises(InvalidValueError, match=message):
        SampledRestitution(quantiles, seed)


def test_what_is_no_history_is_refused():
    """Histories that draw already, other objects and numbers that are not whole are refused."""
    drawn = SampledHistories.of(histories(), LAW)
    for base, draw in ((drawn, LAW), ("histories", LAW), (histories(), 0.9)):
        with pytest.raises(InvalidValueError):
            SampledHistories.of(base, draw)
    with pytest.raises(InvalidValueError, match="whole numbers"):
        LAW.draws([0.5])
    with pytest.raises(InvalidValueError, match="RandomRestitution"):
        SampledRestitution.of_law(0.9)


class Backwards(Product):
    """A product in another order, with the same content."""

    def rows(self, first, last):
        rows = super().rows(first, last)
        return type(rows)(rows.values, rows.motion[::-1].copy(), rows.stream)


class Halved(SampledRestitution):
    """Another draw from the same distribution, which does not say what makes it."""

    def draws(self, numbers):
        return 0.5 * super().draws(numbers)


def test_key_sees_the_classes_of_base_and_draw():
    """Another kind of histories, seed or distribution is another key; a draw of one's own must say what makes it."""
    base = histories()
    other = Backwards(base.motions, base.sides, base.scales)
    laws = [LAW, SampledRestitution.normal(0.9, 0.02, seed=12), SampledRestitution.normal(0.9, 0.03, seed=11)]
    keys = [SampledHistories.of(each, law).key() for each in (base, other) for law in laws]
    assert len(set(keys)) == 6
    assert SampledHistories.of(histories(), replace(LAW)).key() == keys[0]
    with pytest.raises(InvalidValueError, match=r"define content\(\)"):
        SampledHistories.of(base, Halved(LAW.factors, 11)).key()


@pytest.mark.parametrize(
    ("choice", "label"),
    [
        ("housner", "housner"),
        ("0.98*shifted-impulse:k=0.6", "0.98*shifted-impulse:k=0.6"),
        (Fixed(0.9), "fixed:r=0.9"),
        (0.85, "0.85"),
        ({"left": 0.8, "right": 0.9}, "left 0.8, right 0.9"),
        (SpeedRestitution([0.0, 1.0], [0.9, 0.8], times="ked"), "SpeedRestitution times ked"),
        (SampledRestitution([0.8, 1.0], 3), "drawn per history, 0.9 [0.805, 0.995], seed 3"),
        (RandomRestitution([0.8, 1.0], 3, times="ked"), "drawn per impact, 0.9 [0.805, 0.995], seed 3 times ked"),
    ],
)
def test_every_choice_has_a_name(choice, label):
    """Models, numbers, pairs and laws are named by what they are; draws with their median and 95 % range."""
    assert label_of(choice) == label


def test_a_dict_names_the_choices():
    """Names that the user gives are kept, in their order."""
    assert list(named_restitutions({"new": "ked", "old": "housner"})) == ["new", "old"]


def test_equal_choices_can_be_compared_under_names():
    """The same choice twice is allowed once it is named: the comparison must then find nothing."""
    assert named_restitutions({"a": 0.9, "b": 0.9}) == {"a": 0.9, "b": 0.9}
    with pytest.raises(InvalidValueError, match="name: choice"):
        named_restitutions([0.9, 0.9])
