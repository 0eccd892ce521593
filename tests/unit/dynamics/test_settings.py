"""Settings and outcomes: ranges, usual values, one enumeration each."""

import importlib
import math
import pkgutil
import re
from enum import Enum
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rocking as rk
from rocking.dynamics import ConstantRestitution, PlaneSettings, SpatialBody
from rocking.dynamics.mechanics import MECHANICS, mechanics_for, mechanics_for_all, mechanics_of, study_settings
from rocking.dynamics.settings import NEVER_SLIDES
from rocking.errors import InvalidValueError
from rocking.motions import pulses
from rocking.outcome import Outcome, Status

NO_NUMBERS: list[Any] = [math.nan, math.inf, -math.inf, None, "1", True, [1.0, 2.0], 1j]
RANGES: dict[str, Any] = {
    "gravity": (r"\(0, 1e\+06\] m/s2", [0.0, -9.81, 1.1e6], [1e-9, 1e6]),
    "rest_speed": (r"\[0, 0.1\]", [-1e-9, 0.11], [0.0, 0.1]),
    "longest_step": (r"\[1e-06, 1\]", [0.0, 0.9e-6, 1.01], [1e-6, 1.0]),
    "tolerance": (r"\[1e-17, 0.001\]", [0.0, 0.9e-17, 0.0011], [1e-17, 1e-3]),
}


@pytest.mark.parametrize("name", RANGES)
@pytest.mark.parametrize("value", NO_NUMBERS)
def test_no_numbers(name: str, value: Any) -> None:
    """What is not one finite number is refused under its name; as an option of a study None is the default."""
    if value is None and name != "gravity":
        assert study_settings(None, {name: None}) == PlaneSettings()
    with pytest.raises(InvalidValueError, match=f"{name} must be"):
        PlaneSettings(**{name: value})


@pytest.mark.parametrize("name", RANGES)
def test_ranges(name: str) -> None:
    """Numbers outside the range are refused with the range; the ends that belong to it are taken."""
    allowed, outside, inside = RANGES[name]
    changed: Any
    for value in outside:
        changed = {name: value}
        with pytest.raises(InvalidValueError, match=f"{name} must be in {allowed}, got"):
            PlaneSettings(**changed)
    for value in inside:
        changed = {name: value}
        assert getattr(PlaneSettings(**changed), name) == value


@pytest.mark.parametrize(
    ("name", "words", "values"),
    [
        ("most_events", "a whole number >= 1", [0, -1, 1.0, 2.5, True, None, "5", math.nan, math.inf, [1]]),
        ("linear", "True or False", [0, 1, None, "yes", 0.0, [True]]),
        (
            "order",
            r"one of \(4, 6, 8\)",
            [0, 2, 5, 7, 10, -8, 8.0, np.float64(8), "8", math.nan, True, [8], np.ones(2)],
        ),
    ],
)
def test_whole_numbers_and_choices(name: str, words: str, values: list[Any]) -> None:
    """Impacts are a whole number from 1, equations True or False, orders those compiled; not what equals one."""
    for value in values:
        with pytest.raises(InvalidValueError, match=f"{name} must be {words}, got"):
            PlaneSettings(**{name: value})


def test_options_of_a_call() -> None:
    """Options become fields; gravity is standard gravity unless said; unknown ones are refused with the known."""
    made: Any = study_settings(None, {"linear": True, "order": 6}, 9.81)
    assert (made.gravity, made.linear, made.order) == (9.81, True, 6)
    assert PlaneSettings().gravity == 9.80665
    with pytest.raises(InvalidValueError, match=r"tol does not apply to .*; options: gravity, linear, longest_step"):
        study_settings(None, {"tol": 1e-9}, 9.81)


def test_frozen_and_equal() -> None:
    """Settings cannot be changed, and equal ones are equal."""
    made = PlaneSettings(order=4)
    with pytest.raises(AttributeError):
        made.order = 8  # type: ignore[misc]
    assert made == PlaneSettings(order=4) != PlaneSettings(order=6)


ENGINES = Path(__file__).parents[3] / "engine"
LEANING = rk.Section([rk.Region([(0.0, 0.0), (0.5, 0.0), (0.3, 2.0), (0.1, 2.0)], 2400.0)])


@pytest.mark.slow
def test_body_that_overturns_says_so_by_the_same_word_everywhere():
    """Rocking, with contact, in space and in batches: one enumeration, by identity and by code."""
    pulse = pulses.sine(amplitude=6.0, period=1.0)
    plane, contact = rk.simulate(LEANING, pulse), rk.simulate(LEANING, pulse, None, friction=0.9)
    block = rk.dynamics.SpatialBody.box(0.5, 0.7, 2.0)
    space = rk.simulate(block, pulse, "housner")
    assert plane.outcome == contact.outcome == space.outcome == rk.Outcome.OVERTURNED
    assert all(isinstance(response.status, Status) for response in (plane, contact, space))
    batches = rk.simulate_many(LEANING, pulse), rk.simulate_many(block, pulse, "housner")
    assert [int(np.ravel(b.outcome)[0]) for b in batches] == [rk.Outcome.OVERTURNED.code] * 2


@pytest.mark.slow
def test_there_is_no_second_list():
    """No other enumeration of the package says how a history ends or whether it could be computed."""
    shared, found = {"OVERTURNED", "FAILED", "GOOD", "NOT_FINITE", "LOST_CONTACT"}, set()
    for module in pkgutil.walk_packages(rk.__path__, "rocking."):
        if module.name.startswith(("rocking.dynamics", "rocking.restitution", "rocking.studies")):
            things = vars(importlib.import_module(module.name)).values()
            found |= {c for c in things if isinstance(c, type) and issubclass(c, Enum) and shared & set(c.__members__)}
    assert {f"{c.__module__}.{c.__name__}" for c in found} == {
        "rocking.outcome.Outcome",
        "rocking.outcome.Status",
        "rocking.restitution.bed.impact.BedStatus",  # of one impact on a bed
    }


@pytest.mark.skipif(not ENGINES.exists(), reason="needs the sources of the C++ engines, which a checkout has")
@pytest.mark.parametrize("source", ["batch.hpp", "spatial/record.hpp"])
@pytest.mark.parametrize("kind", [Outcome, Status])
def test_codes_of_the_fast_engines_are_those_of_python(source, kind):
    """Every name that C++ gives a code has the same code in Python."""
    text = (ENGINES / source).read_text()
    body = re.search(rf"enum {kind.__name__} [^{{]*{{([^}}]*)}}", text)
    named = re.findall(r"k(\w+) = (\d+)", body[1])
    assert named
    for name, code in named:
        word = re.sub(r"(?<!^)(?=[A-Z])", "_", name).upper()
        assert kind[word].code == int(code)


BLOCK = rk.Block(width=0.5, height=2.0)
BOX = SpatialBody.box(width=0.5, depth=0.6, height=2.0)
SOLID = rk.Solid(rk.bodies.solid.box(0.5, 0.6, 2.0))
PULSE = rk.pulses.sine(amplitude=3.0, period=0.6)
CASES: dict[str, tuple[Any, float | None]] = {
    "plane": (BLOCK, None), "contact": (BLOCK, 0.4), "space": (BOX, None), "hull": (SOLID, 0.4),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_one_mechanics_takes_each_body(name: str) -> None:
    """Of all mechanics one takes a body with or without friction; its settings lead back to it."""
    body, friction = CASES[name]
    (mechanics,) = [each for each in MECHANICS if each.takes(body, friction)]
    assert mechanics.name == name
    assert mechanics_for(body, friction) is mechanics is mechanics_for_all([body, body], friction)
    assert mechanics_of(mechanics.settings()) is mechanics_of(mechanics.batch_settings()) is mechanics


def test_studies_let_solids_hop() -> None:
    """A study takes plane bodies with and without friction, and solids with friction, which is large if not given."""
    found = [study_settings(body, {"friction": mu}) for body in (BLOCK, SOLID) for mu in (None, 0.4)]
    assert [mechanics_of(each).name for each in found] == ["plane", "contact", "hull", "hull"]
    assert [each.friction for each in found] == [np.inf, 0.4, NEVER_SLIDES, 0.4]
    assert ["friction" in each.stated for each in found] == [False, True, True, True]
    (space,) = (mechanics for mechanics in MECHANICS if mechanics.name == "space")
    with pytest.raises(InvalidValueError, match="studies do not accept a body in space without friction"):
        space.rows([], ConstantRestitution(), space.settings(), "auto")


@pytest.mark.parametrize("name", CASES)
def test_columns_are_those_of_the_dataset(name: str) -> None:
    """A batch fills the columns that its mechanics state, and no others."""
    pytest.importorskip("xarray")
    body, friction = CASES[name]
    found = rk.simulate_many(body, PULSE, "housner", friction=friction, scale=0.5)
    assert set(found.data_vars) == set(mechanics_for(body, friction).columns)


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_options_of_other_mechanics_are_refused(name: str) -> None:
    """Of every option that a mechanics lacks the refusal states the value and the options that there are."""
    body, friction = CASES[name]
    mechanics = mechanics_for(body, friction)
    known = {*mechanics.settings.names(), *mechanics.options}
    values: dict[str, Any] = {
        "linear": True, "order": 8, "longest_step": 0.1, "normal_restitution": 0.1, "normal_restitution_law": "stronge",
        "stream": 3,
        "engine": "fast", "no_option": 1.0,
    }  # fmt: skip
    for option in values.keys() - known:
        with pytest.raises(InvalidValueError, match=rf"{option} does not apply to .*, got .*; options: .*gravity"):
            rk.simulate(body, PULSE, "housner", friction=friction, **{option: values[option]})  # type: ignore[misc]
    unchanged: dict[str, Any] = {
        "linear": False,
        "order": None,
        "normal_restitution": 0.0,
        "stream": 0,
        "engine": "auto",
    }
    assert rk.simulate(body, PULSE, "housner", friction=friction, **unchanged).outcome is not rk.Outcome.FAILED


def test_signature_shows_the_options() -> None:
    """The signature of `simulate` has each option by name, as help and completion show them."""
    import inspect

    shown = inspect.signature(rk.simulate).parameters
    assert "options" not in shown
    assert {name for each in MECHANICS for name in {*each.settings.names(), *each.options}} <= set(shown)
