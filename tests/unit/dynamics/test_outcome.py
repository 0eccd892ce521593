"""One list of outcomes and one of statuses, for every kind of response and every engine."""

import importlib
import pkgutil
import re
from enum import Enum
from pathlib import Path

import numpy as np
import pytest

import rocking as rk
from rocking.motions import pulses
from rocking.outcome import Outcome, Status

ENGINES = Path(__file__).parents[3] / "engine"
LEANING = rk.Section([rk.Region([(0.0, 0.0), (0.5, 0.0), (0.3, 2.0), (0.1, 2.0)], 2400.0)])


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


def test_there_is_no_second_list():
    """No other enumeration of the package says how a history ends or whether it could be computed."""
    shared, found = {"OVERTURNED", "FAILED", "GOOD", "NOT_FINITE", "LOST_CONTACT"}, set()
    for module in pkgutil.walk_packages(rk.__path__, "rocking."):
        if module.name.startswith(("rocking.dynamics", "rocking.restitution", "rocking.studies", "rocking.app")):
            things = vars(importlib.import_module(module.name)).values()
            found |= {c for c in things if isinstance(c, type) and issubclass(c, Enum) and shared & set(c.__members__)}
    assert {f"{c.__module__}.{c.__name__}" for c in found} == {
        "rocking.outcome.Outcome",
        "rocking.outcome.Status",
        "rocking.restitution.bed.emergent.BedStatus",  # of one impact on a bed
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
