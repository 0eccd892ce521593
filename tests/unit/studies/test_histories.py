import pickle
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest

import rocking as rk
from rocking.dynamics import ImpactLaw, PlaneSettings, RandomRestitution
from rocking.dynamics.plane.fast_engine import RESULTS
from rocking.errors import InvalidValueError
from rocking.restitution import model
from rocking.studies import Histories, HistoryTable, MotionList, MotionSet, Product, SampledRestitution, histories
from rocking.studies.motion_sets import digest


class Sines(MotionSet):
    """Pulses made from their number when they are asked for."""

    def __len__(self):
        return 5

    def __getitem__(self, index):
        return rk.pulses.sine(amplitude=2.0 + 0.5 * index, period=0.4 + 0.1 * index)

    def description(self):
        return {"kind": "sines"}


class Slower(Sines):
    """Other pulses that describe themselves with the same words."""

    def __getitem__(self, index):
        return rk.pulses.sine(amplitude=2.0 + 0.5 * index, period=0.8 + 0.1 * index)


class Reversed(Product):
    """A product that says no more of itself than a product does."""

    def rows(self, first, last):
        rows = super().rows(first, last)
        return type(rows)(rows.values, rows.motion[::-1].copy(), rows.stream)


@dataclass
class Worn(ImpactLaw):
    """A law of one's own: each impact takes a little more."""

    rate: Any
    times: Any = 1.0

    def factor(self, speed, key, impact):
        return float(np.sum(self.rate)) ** impact


@dataclass
class Battered(Worn):
    """Another law with the same numbers."""

    def factor(self, speed, key, impact):
        return 0.9 * super().factor(speed, key, impact)


class Bare(ImpactLaw):
    """A law that does not say what makes it."""

    def __init__(self, rate):
        self.rate = rate

    def factor(self, speed, key, impact):
        return self.rate


class Told(Bare):
    """A law that says it."""

    def content(self):
        return {"rate": self.rate}


def product(motions=None, law=None, **changed):
    angle = np.array([[0.2, 0.2], [0.25, 0.25], [0.3, 0.3]])
    sides = {"alpha_right": angle, "alpha_left": angle, "p_right": 8.0 * angle, "p_left": 8.0 * angle}
    sides |= {"r_right": np.array([[0.8, 0.9]] * 3), "r_left": np.array([[0.8, 0.9]] * 3)}
    sides |= {"q_right": np.full((3, 2), 0.75), "q_left": np.full((3, 2), 0.75)} | changed
    motions = MotionList([Sines()[k] for k in range(5)]) if motions is None else motions
    return Product(motions, sides, np.array([0.5, 1.0, 2.0, 4.0]), **({} if law is None else {"law": law}))


def joined(histories: Histories, size: int):
    pieces = [
        histories.run(first, min(first + size, histories.count), threads=1) for first in range(0, histories.count, size)
    ]
    return {name: np.concatenate([piece[name] for piece in pieces]) for name in RESULTS}


def same(one, other):
    return all(np.array_equal(one[name], other[name], equal_nan=True) for name in RESULTS)


def test_product_order():
    """The motion changes slowest, then the body, the scale and the choice of restitution."""
    made = product()
    rows = made.rows(0, made.count)
    assert made.shape == (5, 3, 4, 2)
    assert made.count == 120
    motion, body, scale, choice = np.unravel_index(np.arange(120), made.shape)
    assert np.array_equal(rows.motion, motion)
    assert np.array_equal(rows.values["alpha_right"], np.array([0.2, 0.25, 0.3])[body])
    assert np.array_equal(rows.values["scale"], np.array([0.5, 1.0, 2.0, 4.0])[scale])
    assert np.array_equal(rows.values["r_left"], np.array([0.8, 0.9])[choice])
    assert np.array_equal(rows.stream, np.arange(120))


@pytest.mark.slow
@pytest.mark.parametrize("size", [1, 7, 50])
@pytest.mark.parametrize(
    "law",
    [None, RandomRestitution.normal(0.9, 0.05, seed=3), SampledRestitution.normal(0.9, 0.05, seed=3)],
    ids=["constant", "per impact", "per history"],
)
def test_pieces_are_the_whole(size, law):
    """Pieces of any size, each history by its number alone, give the bits of the whole, random laws included."""
    made = product(law=law)
    assert same(made.run(0, made.count), joined(made, size))


def test_key_by_place_would_be_caught():
    """Random coefficients that follow the place in the piece instead of the number differ between sizes."""

    class Wrong(Product):
        def rows(self, first, last):
            rows = super().rows(first, last)
            return type(rows)(rows.values, rows.motion, rows.stream - first)

    right = product(law=RandomRestitution.normal(0.9, 0.05, seed=3))
    wrong = Wrong(right.motions, right.sides, right.scales, law=right.law)
    assert not same(wrong.run(0, wrong.count), joined(wrong, 7))


def test_motions_made_when_needed():
    """Motions that are made for a piece give the bits of motions that are at hand."""
    held, made = product(), product(Sines())
    assert not made.motions.in_memory
    assert same(held.run(0, held.count), made.run(0, made.count))
    assert same(held.run(0, held.count), joined(made, 33))


def test_table_equals_product():
    """Histories given one by one are those of the product."""
    made = product()
    rows = made.rows(0, made.count)
    table = HistoryTable(made.motions, rows.motion, rows.values)
    assert same(made.run(0, made.count), table.run(0, table.count))
    assert table.run(17, 19)["peak_rotation"].tolist() == made.run(17, 19)["peak_rotation"].tolist()


def test_pickled():
    """A copy sent to another process is the same study, without the motions as laid out for the engine."""
    made = product()
    before = made.run(0, 10)
    copy = pickle.loads(pickle.dumps(made))
    assert "_batch" in made.__dict__
    assert "_batch" not in copy.__dict__
    assert copy.key() == made.key()
    assert np.array_equal(copy.run(0, 10)["peak_rotation"], before["peak_rotation"])


def test_key_names_the_content():
    """Whatever changes a result changes the name: bodies, scales, motions, law, seed, settings, engine."""
    base = product()
    law = RandomRestitution.normal(0.9, 0.05, seed=3)
    others = [
        product(r_right=np.array([[0.8, 0.9]] * 2 + [[0.8, 0.91]])),
        Product(base.motions, base.sides, base.scales[:-1]),
        product(MotionList([Sines()[k] for k in (0, 1, 2, 3, 3)])),
        product(law=law),
        product(law=RandomRestitution.normal(0.9, 0.05, seed=4)),
        Product(base.motions, base.sides, base.scales, settings=PlaneSettings(linear=True)),
        Product(base.motions, base.sides, base.scales, settings=PlaneSettings(gravity=9.81)),
        Product(base.motions, base.sides, base.scales, engine="reference"),
    ]
    others += [product(law=law) for law in (Worn(0.99), Worn(0.98), Worn(np.array([0.5, 0.49])), Battered(0.99))]
    others += [product(law=law) for law in (Worn(0.99, times=0.9), Told(0.9), Told(0.8))]
    others += [product(Sines()), product(Slower()), Reversed(base.motions, base.sides, base.scales)]
    keys = [base.key(), *[other.key() for other in others]]
    assert len(set(keys)) == len(keys)
    assert product().key() == base.key()
    models = [product(law=Worn(0.99, times=model(name))).key() for name in ("ked", "housner")]
    assert models[0] == models[1]  # what a law multiplies is in the coefficients
    assert product(law=Worn(np.float32(0.5))).key() == product(law=Worn(0.5)).key()


def test_laws_that_do_not_say_what_makes_them_are_refused():
    """Without fields, with a field that is no number, with values from around: a name for two laws is none."""
    given = 0.5

    @dataclass
    class Around(ImpactLaw):
        def factor(self, speed, key, impact):
            return given

    class Undeclared(Worn):
        pass

    for law in (Bare(0.9), Worn(np.sin), Worn([1.0, {}]), Worn(float("nan")), Around(), Undeclared(0.9)):
        with pytest.raises(InvalidValueError, match=r"define content\(\) for a law of your own"):
            product(law=law).key()


def test_contents_that_are_not_plain_are_refused():
    """What a law says of itself must be writable as JSON, without NaN."""
    for value in (np.ones(2), float("inf")):
        with pytest.raises(InvalidValueError, match="must contain finite numbers, texts, lists"):
            product(law=Told(value)).key()


def test_numbers_of_settings_are_of_one_kind():
    """9 and 9.0, or numbers of another library, are the same settings with the same key."""
    base = product()
    one = replace(base, settings=PlaneSettings(gravity=9, order=np.int64(8), most_events=np.int32(500)))
    two = replace(base, settings=PlaneSettings(gravity=9.0, order=8, most_events=500))
    assert one.key() == two.key()
    assert type(one.settings.gravity) is float
    narrow = replace(base, settings=PlaneSettings(gravity=np.float32(9.8), longest_step=np.float16(0.125)))
    assert (
        narrow.key() == replace(base, settings=PlaneSettings(gravity=float(np.float32(9.8)), longest_step=0.125)).key()
    )


def test_arrays_are_not_shared_with_the_caller():
    """What the caller does to the arrays afterwards changes neither the key nor the results; nobody can write them."""
    whole = product()
    rows = whole.rows(0, whole.count)
    values, motion = {name: array.copy() for name, array in rows.values.items()}, rows.motion.copy()
    sides, scales = {name: array.copy() for name, array in whole.sides.items()}, whole.scales.copy()
    table, made = HistoryTable(whole.motions, motion, values), Product(whole.motions, sides, scales)
    keys, results = (table.key(), made.key()), made.run(0, made.count)
    for array in (*values.values(), *sides.values(), scales):
        np.multiply(array, 0.5, out=array)
    motion[:] = 0
    assert (table.key(), made.key()) == keys
    assert same(table.run(0, table.count), results)
    assert same(made.run(0, made.count), results)
    for array in (table.motion, table.values["scale"], made.sides["p_left"], made.scales):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0.0


class Many(MotionSet):
    """Five hundred short pulses, made when they are asked for."""

    def __len__(self):
        return 500

    def __getitem__(self, index):
        return rk.pulses.half_sine(amplitude=2.0 + 0.01 * index, period=0.4 + 0.001 * index)

    def description(self):
        return {"kind": "many"}


@pytest.mark.slow
def test_few_motions_are_held_at_once(monkeypatch):
    """Of 500 motions in any order no more than 128 are laid out at a time, and the bits are those of all at hand."""
    random = np.random.default_rng(1)
    rows = product().rows(0, 120)
    values = {name: random.permutation(np.tile(array, 10)) for name, array in rows.values.items()}
    law = RandomRestitution.normal(0.9, 0.05, seed=3)
    made = HistoryTable(Many(), random.integers(0, 500, 1200), values, law=law)
    held = HistoryTable(MotionList([Many()[k] for k in range(500)]), made.motion, made.values, law=law)
    laid, batch = [], histories.Batch

    def watched(motions, *others):
        laid.append(len(motions))
        return batch(motions, *others)

    expected = held.run(0, 1200)
    monkeypatch.setattr(histories, "Batch", watched)
    assert same(made.run(0, 1200), expected)
    assert same(made.run(0, 1200, threads=1), joined(made, 501))
    assert max(laid) == 128
    assert sum(laid[:4]) == len(np.unique(made.motion)) > 400


def test_digest_sees_the_last_bit():
    """Motions that differ in the last bit of one sample, or in the step, have other hashes."""
    samples = np.array([0.0, 1.0, -2.0, 0.5])
    nudged = samples.copy()
    nudged[2] = np.nextafter(nudged[2], 0.0)
    motions = [rk.GroundMotion(samples, 0.01), rk.GroundMotion(nudged, 0.01), rk.GroundMotion(samples, 0.02)]
    motions.append(rk.GroundMotion(samples, 0.01, vertical=np.zeros(4)))
    assert len({digest(motion) for motion in motions}) == 4
    assert digest(motions[0]) == digest(rk.GroundMotion(samples, 0.01))


def test_scales_of_each_motion():
    """Scales may be given for each motion."""
    base = product()
    scales = np.arange(1.0, 11.0).reshape(5, 2)
    made = Product(base.motions, base.sides, scales)
    rows = made.rows(0, made.count)
    assert made.shape == (5, 3, 2, 2)
    assert np.array_equal(np.unique(rows.values["scale"][rows.motion == 3]), [7.0, 8.0])


def test_a_bad_row_is_reported_alone():
    """A row outside its range fails with a status, and leaves the others bitwise equal."""
    made = product()
    rows = made.rows(0, made.count)
    values = {name: array.copy() for name, array in rows.values.items()}
    values["p_right"][11] = np.nan
    bad = HistoryTable(made.motions, rows.motion, values).run(0, made.count)
    good = made.run(0, made.count)
    others = np.arange(made.count) != 11
    assert bad["outcome"][11] == rk.Outcome.FAILED.code
    assert np.isnan(bad["peak_rotation"][11])
    assert all(np.array_equal(bad[name][others], good[name][others], equal_nan=True) for name in RESULTS)
