"""Mechanics: one is chosen for each body, once; each states its settings, options and columns."""

from typing import Any

import numpy as np
import pytest

import rocking as rk
from rocking.dynamics import ConstantRestitution, SpatialBody
from rocking.dynamics.mechanics import MECHANICS, mechanics_for, mechanics_for_all, mechanics_of, study_settings
from rocking.dynamics.settings import NEVER_SLIDES
from rocking.errors import InvalidValueError

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
    space = MECHANICS[2]
    with pytest.raises(InvalidValueError, match="studies do not take a body in space without friction"):
        space.rows([], ConstantRestitution(), space.settings(), "auto")


@pytest.mark.parametrize("name", CASES)
def test_columns_are_those_of_the_dataset(name: str) -> None:
    """A batch fills the columns that its mechanics state, and no others."""
    pytest.importorskip("xarray")
    body, friction = CASES[name]
    found = rk.simulate_many(body, PULSE, "housner", friction=friction, scale=0.5)
    assert set(found.data_vars) == set(mechanics_for(body, friction).columns)


@pytest.mark.parametrize("name", CASES)
def test_options_of_other_mechanics_are_refused(name: str) -> None:
    """Of every option that a mechanics lacks the refusal states the value and the options that there are."""
    body, friction = CASES[name]
    mechanics = mechanics_for(body, friction)
    known = {*mechanics.settings.names(), *mechanics.options}
    values: dict[str, Any] = {
        "linear": True, "order": 8, "longest_step": 0.1, "bounce": 0.1, "bounce_law": "stronge", "stream": 3,
        "engine": "fast", "no_option": 1.0,
    }  # fmt: skip
    for option in values.keys() - known:
        with pytest.raises(InvalidValueError, match=rf"{option} does not apply to .*, got .*; options: .*gravity"):
            rk.simulate(body, PULSE, "housner", friction=friction, **{option: values[option]})  # type: ignore[misc]
    unchanged: dict[str, Any] = {"linear": False, "order": None, "bounce": 0.0, "stream": 0, "engine": "auto"}
    assert rk.simulate(body, PULSE, "housner", friction=friction, **unchanged).outcome is not rk.Outcome.FAILED


def test_signature_shows_the_options() -> None:
    """The signature of `simulate` has each option by name, as help and completion show them."""
    import inspect

    shown = inspect.signature(rk.simulate).parameters
    assert "options" not in shown
    assert {name for each in MECHANICS for name in {*each.settings.names(), *each.options}} <= set(shown)
