"""What `bed_impact` refuses at its door: engines that do not exist, accelerations that are not two numbers."""

import math

import numpy as np
import pytest

from rocking.bodies import Block
from rocking.errors import InvalidValueError
from rocking.restitution.bed import ContactBed, KelvinVoigt, bed_impact, setup_of

BODY = Block(width=0.2, height=0.4).with_feet(0.02, 0.2)
BED = ContactBed.uniform(BODY, 2, KelvinVoigt(1e9, damping_ratio=1.0))


@pytest.mark.parametrize("engine", ["cuda", "", None, "Fast", 1])
def test_engines_that_do_not_exist(engine):
    """Only the three engines are taken, and the sentence names them."""
    with pytest.raises(InvalidValueError, match="engine must be one of auto, fast, reference, got"):
        bed_impact(BODY, BED, angular_velocity=1.0, engine=engine)


@pytest.mark.parametrize(
    "given", [3.0, None, "ab", (1.0,), (1.0, 2.0, 3.0), [[1.0, 2.0]], (1.0, math.nan), (math.inf, 0.0), ("1", 0.0)]
)
def test_accelerations_that_are_not_two_numbers(given):
    """One number, three, words, infinities: each is refused by its name."""
    for make in (bed_impact, setup_of):
        with pytest.raises(InvalidValueError, match=r"ground[_ ]acceleration must be"):
            make(BODY, BED, angular_velocity=1.0, ground_acceleration=given)


@pytest.mark.parametrize("given", [(0.5, -0.25), [0.5, -0.25], np.array([0.5, -0.25])])
def test_two_numbers_in_any_row(given):
    """A tuple, a list and an array mean the same: the push is the first, gravity changes by the second."""
    setup = setup_of(BODY, BED, angular_velocity=1.0, ground_acceleration=given, gravity=9.75)
    assert (setup.push, setup.rigid.gravity) == (0.5, 9.5)
