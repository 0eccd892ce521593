"""Synthetic sets: reproducible motion by motion, made when needed, scaled exactly."""

import json
import pickle
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import pytest

from rocking.bodies import Block
from rocking.dynamics import RockingParameters
from rocking.errors import InvalidValueError
from rocking.motions import GroundMotion, peak_ground_velocity
from rocking.motions.synthetic import Uniform, families, family
from rocking.studies import MotionList, Product, SyntheticSet


@pytest.mark.parametrize("name", list(families()))
def test_motion_does_not_depend_on_the_count(name):
    """Motion 2 of a set of 3 and of a set of 1000 are the same bits, and so are those of two sets alike."""
    small, large = SyntheticSet(name, 3, 9), SyntheticSet(name, 1000, 9)
    assert np.array_equal(small[2].acceleration, large[2].acceleration)
    assert np.array_equal(small[-1].acceleration, SyntheticSet(name, 3, 9)[2].acceleration)
    assert not np.array_equal(small[2].acceleration, SyntheticSet(name, 3, 10)[2].acceleration)


@pytest.mark.slow
def test_no_two_motions_are_alike():
    """Over 2 seeds and 50 numbers every peak is another one."""
    peaks = {
        motion.peak for seed in (0, 1) for motion in (SyntheticSet("point-source", 50, seed)[k] for k in range(50))
    }
    assert len(peaks) == 100


@pytest.mark.slow
def test_scaling_is_exact():
    """Scaled to a PGA or a PGV, every motion has it to rounding, and keeps its shape."""
    for k in range(5):
        bare = SyntheticSet("kanai-tajimi", 5, 1)[k]
        one, two = SyntheticSet("kanai-tajimi", 5, 1, pga=2.5)[k], SyntheticSet("kanai-tajimi", 5, 1, pgv=0.4)[k]
        assert one.peak == pytest.approx(2.5, rel=1e-14, abs=0.0)
        assert peak_ground_velocity(two) == pytest.approx(0.4, rel=1e-12, abs=0.0)
        assert one.acceleration / one.peak == pytest.approx(bare.acceleration / bare.peak, abs=1e-13)


def test_motions_are_made_when_asked_for():
    """A set of ten million costs nothing until a motion is wanted, and then one."""
    calls = []

    def make(values, noise, step):
        calls.append(noise)
        return GroundMotion([0.0, 1.0], step)

    motions = SyntheticSet(replace(family("firm-ground"), make=make), 10_000_000, 1)
    assert (len(motions), calls, motions.in_memory) == (10_000_000, [], False)
    motions[9_999_999]
    assert len(calls) == 1


def test_histories_are_those_of_the_same_motions_in_memory():
    """A study of the lazy set and one of its motions in a list have the same results, in any pieces."""
    motions = SyntheticSet("point-source", 6, 4, pga=3.0)
    parameters = RockingParameters.of_body(Block(width=0.2, height=1.0), "ked", 9.80665)
    names = {"alpha": "slenderness_angle", "p": "frequency_parameter", "r": "coefficient"}
    sides = {
        f"{short}_{foot}": np.full((1, 1), getattr(getattr(parameters, foot), name))
        for short, name in names.items()
        for foot in ("right", "left")
    }
    held = MotionList([motions[k] for k in range(6)])
    lazy, listed = (Product(each, sides, np.array([0.5, 1.0])) for each in (motions, held))
    whole = listed.run(0, 12)
    assert np.array_equal(lazy.run(0, 12)["peak_rotation"], whole["peak_rotation"])
    assert np.array_equal(lazy.run(5, 9)["peak_rotation"], whole["peak_rotation"][5:9])


def test_description_tells_sets_apart():
    """What makes the motions is in the description, which is JSON; what does not is not."""
    one = SyntheticSet("pulse-like", 4, 1, pga=1.0)
    assert json.loads(json.dumps(one.description())) == one.description()
    assert one.description() == SyntheticSet("pulse-like", 4, 1, pga=1.0).description()
    others = [
        SyntheticSet("firm-ground", 4, 1, pga=1.0), SyntheticSet("pulse-like", 5, 1, pga=1.0),
        SyntheticSet("pulse-like", 4, 2, pga=1.0), SyntheticSet("pulse-like", 4, 1, pga=2.0),
        SyntheticSet("pulse-like", 4, 1, pgv=1.0), SyntheticSet("pulse-like", 4, 1, pga=1.0, time_step=0.02),
    ]  # fmt: skip
    assert all(one.description() != other.description() for other in others)


def bump(values, noise, step):
    """A motion by a function of one's own."""
    return GroundMotion([0.0, sum(values.values()), 0.0], step)


def own(make=bump, **distributions):
    """A family of one's own."""
    given = distributions or {"first_m": Uniform(1.0, 2.0), "second_m": Uniform(1.0, 2.0)}
    return replace(family("firm-ground"), make=make, distributions=given)


def test_order_of_drawing_is_described():
    """The same distributions in another order draw other motions, and say so."""
    one = own(first_m=Uniform(1.0, 2.0), second_m=Uniform(1.0, 2.0))
    two = own(second_m=Uniform(1.0, 2.0), first_m=Uniform(1.0, 2.0))
    assert SyntheticSet(one, 3, 1).description() != SyntheticSet(two, 3, 1).description()
    assert SyntheticSet(one, 3, 1).description() == SyntheticSet(replace(one), 3, 1).description()
    named = json.dumps(SyntheticSet(one, 3, 1).description(), sort_keys=True)
    assert named != json.dumps(SyntheticSet(two, 3, 1).description(), sort_keys=True)


def test_changed_functions_are_seen(monkeypatch):
    """A function that was changed under its name makes other motions, which their hashes show."""
    before = SyntheticSet(own(), 3, 1).description()
    assert before["make"].endswith(".bump")

    def changed(values, noise, step):
        return GroundMotion([0.0, 1.0 + sum(values.values()), 0.0], step)

    changed.__qualname__, changed.__module__ = bump.__qualname__, bump.__module__
    after = SyntheticSet(own(changed), 3, 1).description()
    assert {name for name in before if before[name] != after[name]} == {"first", "last"}


@dataclass(frozen=True)
class Maker:
    """A callable that holds a number."""

    size: float

    def __call__(self, values, noise, step):
        return bump(values, noise, step)

    def make(self, values, noise, step):
        return bump(values, noise, step)


def test_functions_without_a_name_are_refused():
    """Lambdas, partials, closures, methods and callables do not say which motions they make; nor do some draws."""
    held = 1.0

    def closure(values, noise, step):
        return bump(values, held, step)

    for make in (lambda v, n, s: bump(v, n, 2.0 * s), partial(bump), closure, Maker(1.0), Maker(1.0).make):
        with pytest.raises(InvalidValueError, match="must be a named function without bound values"):
            SyntheticSet(own(make), 3, 1).description()

    class Silent(Uniform):
        __repr__ = object.__repr__

    with pytest.raises(InvalidValueError, match=r"must contain its parameters in repr\(\)"):
        SyntheticSet(own(first_m=Silent(1.0, 2.0)), 3, 1).description()


def test_description_makes_two_motions_once(monkeypatch):
    """However often a set is described, its first and last motion are made once."""
    motions, made = SyntheticSet("firm-ground", 50, 1), []
    original = SyntheticSet.__getitem__
    monkeypatch.setattr(SyntheticSet, "__getitem__", lambda self, k: made.append(k) or original(self, k))
    assert motions.description() == motions.description()
    assert made == [0, -1]


def test_set_can_be_sent_to_a_worker():
    """Pickled and back, it makes the same motion."""
    motions = SyntheticSet("soft-ground", 2, 1, pgv=0.3)
    again = pickle.loads(pickle.dumps(motions))
    assert np.array_equal(again[1].acceleration, motions[1].acceleration)


def test_numbers_outside_the_set():
    """There is no motion beyond the last: a loop over the set ends."""
    motions = SyntheticSet("point-source", 2, 1)
    assert len(list(motions)) == 2
    for index in (2, -3):
        with pytest.raises(IndexError, match="0 to 1"):
            motions[index]
