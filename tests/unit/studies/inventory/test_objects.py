"""Objects of an inventory: closed forms for uplift, bodies with the centre and the base that were measured."""

import math

import pytest

from rocking.bodies import Block
from rocking.errors import InvalidValueError
from rocking.studies.inventory.objects import DIRECTIONS, InventoryObject

G = 9.80665
SIZE = {"name": "thing", "width": 0.4, "depth": 0.3, "height": 1.2}


def test_uplift_is_g_b_over_h():
    """Without base and centre: g B / H in either direction; the block itself says the same."""
    thing = InventoryObject(**SIZE)
    assert thing.uplift_acceleration("width") == pytest.approx(G * 0.4 / 1.2, rel=1e-14)
    assert thing.uplift_acceleration("depth") == pytest.approx(G * 0.3 / 1.2, rel=1e-14)
    assert thing.body("width") == Block(width=0.4, height=1.2, depth=0.3)


@pytest.mark.parametrize("centre", [None, 0.3, 0.6, 0.9])
@pytest.mark.parametrize("base", [None, 0.2])
def test_body_has_the_base_and_the_centre_that_were_measured(base, centre):
    """Mass, height of the centre and half the base come out; alpha = atan(b / z); uplift is g b / z."""
    thing = InventoryObject(**SIZE, mass=80.0, base_width=base, base_depth=base, centre_of_mass_height=centre)
    height = 0.6 if centre is None else centre
    for way in DIRECTIONS:
        half = 0.5 * (base or SIZE[way])
        for foot in ("left", "right"):
            side = thing.body(way).side(foot)
            assert side.mass == pytest.approx(80.0, rel=1e-12)
            assert side.centre_height == pytest.approx(height, rel=1e-12)
            assert side.slenderness_angle == pytest.approx(math.atan(half / height), rel=1e-12)
            assert side.uplift_acceleration == pytest.approx(thing.uplift_acceleration(way), rel=1e-12)


def test_moment_of_inertia_is_that_of_two_rectangles():
    """Centre at a third: two thirds of the mass below it, one third above, each even; I about the foot by hand."""
    thing = InventoryObject(**SIZE, mass=90.0, centre_of_mass_height=0.4)
    inertia = 0.0
    for mass, height, middle in ((60.0, 0.4, 0.2), (30.0, 0.8, 0.8)):
        inertia += mass * ((0.4**2 + height**2) / 12.0 + 0.2**2 + middle**2)
    assert thing.body("width").side("left").moment_of_inertia == pytest.approx(inertia, rel=1e-12)


def test_weight_does_not_matter():
    """Frequency parameter and angle are those of any other weight."""
    light, heavy = (InventoryObject(**SIZE, mass=mass).body("width").side("left") for mass in (2.0, 2000.0))
    assert light.frequency_parameter == pytest.approx(heavy.frequency_parameter, rel=1e-12)
    assert light.slenderness_angle == heavy.slenderness_angle


def test_base_as_wide_as_the_body_is_the_body():
    """A base that equals the width but for the rounding of units is the width."""
    thing = InventoryObject(**SIZE, base_width=0.4 * (1.0 + 1e-12))
    assert thing.base("width") == 0.4
    assert isinstance(thing.body("width"), Block)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"name": " "}, "name must not be empty"),
        ({"width": 0.0}, "width must be in"),
        ({"depth": -1.0}, "depth must be in"),
        ({"height": math.nan}, "height must be finite"),
        ({"height": math.inf}, "height must be finite"),
        ({"height": 180.0}, "wrong unit"),
        ({"width": "0.4"}, "width must be a number"),
        ({"base_width": 0.5}, "base_width must be at most the width of the body, 0.4 m"),
        ({"base_depth": 0.31}, "base_depth must be at most the depth"),
        ({"centre_of_mass_height": 1.2}, "must be below the height"),
        ({"centre_of_mass_height": 0.0}, "centre_of_mass_height must be in"),
        ({"mass": 0.0}, "weight must be > 0"),
        ({"mass": 80000.0}, "wrong unit of the weight"),
        ({"mass": 0.08}, "wrong unit of the weight"),
        ({"count": 0}, "count must be a whole number"),
        ({"count": 1.5}, "count must be a whole number"),
        ({"count": True}, "count must be a whole number"),
    ],
)
def test_refusals(change, words):
    """Every value outside its range is refused, and the error names what was measured."""
    with pytest.raises(InvalidValueError, match=words):
        InventoryObject(**(SIZE | change))
