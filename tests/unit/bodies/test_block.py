"""Block and mass points: their numbers, and what is neither."""

import math
from dataclasses import FrozenInstanceError

import numpy as np
import pytest

import rocking as rk
from rocking.bodies.formats import body_from_toml, body_to_toml
from rocking.errors import GeometryError, InvalidValueError

pytestmark = pytest.mark.verifies(room="bodies")

BAD = [0, 0.0, -1.0, float("nan"), float("inf"), "1", None, True, np.True_, [1.0], 1j, 1e-10, 1e10]


@pytest.mark.verifies("closed form", "the definitions", within="1e-14", control="within")
def test_numbers_of_a_block():
    """Mass, inertia, R, alpha, p and uplift acceleration of a 1 x 4 x 0.5 m block, from their definitions."""
    block = rk.Block(width=1.0, height=4.0, depth=0.5, density=2000.0)
    assert block.mass == 4000.0
    assert block.centre == (0.5, 2.0)
    assert block.feet == (0.0, 1.0)
    assert (block.half_width, block.half_height, block.slenderness_ratio) == (0.5, 2.0, 4.0)
    assert block.slenderness_angle == pytest.approx(math.atan(0.25), rel=1e-15, abs=0.0)
    assert block.semi_diagonal == pytest.approx(math.sqrt(4.25), rel=1e-15, abs=0.0)
    assert block.moment_of_inertia == pytest.approx(4000.0 * 17.0 / 12.0, rel=1e-14, abs=0.0)
    # p^2 = 3 g/(4 R) for a homogeneous rectangle
    assert block.frequency_parameter == pytest.approx(math.sqrt(0.75 * 9.80665 / math.sqrt(4.25)), rel=1e-14, abs=0.0)
    assert block.uplift_acceleration == pytest.approx(9.80665 / 4.0, rel=1e-15, abs=0.0)
    assert block.frequency_parameter != pytest.approx(math.sqrt(9.80665 / math.sqrt(4.25)), rel=1e-3)
    side = block.side("left", gravity=1.62)
    assert side.uplift_acceleration == pytest.approx(1.62 / 4.0, rel=1e-15, abs=0.0)
    assert side.moment_of_inertia == pytest.approx(4000.0 * (17.0 / 12.0 + 4.25), rel=1e-14, abs=0.0)


def test_block_and_its_section():
    """A block and its Section have the same mass, centre, inertia, feet, contact, and sides."""
    block = rk.Block(width=0.7, height=1.9, depth=0.3, density=900.0)
    section = block.to_section()
    for name in ("mass", "moment_of_inertia", "slenderness_ratio", "semi_diagonal", "frequency_parameter"):
        assert getattr(section, name) == pytest.approx(getattr(block, name), rel=1e-13, abs=0.0)
    assert section.centre == pytest.approx(block.centre, rel=1e-14, abs=0.0)
    assert section.feet == pytest.approx(block.feet, abs=1e-15)
    assert section.depth == 0.3
    assert [end for stretch in section.local_contact for end in stretch] == pytest.approx([-0.35, 0.35])
    assert block.local_contact == ((0.0, 0.7),)
    assert block.local_box == (0.0, 0.0, 0.7, 1.9)
    assert rk.Block(width=0.7, height=2.0).mass != pytest.approx(block.mass)


def test_from_angle():
    """The block with a given alpha and R has that alpha and R; degrees are refused with a hint."""
    block = rk.Block.from_angle(0.3, 2.5, density=1000.0, depth=2.0)
    assert block.slenderness_angle == pytest.approx(0.3, rel=1e-14, abs=0.0)
    assert block.semi_diagonal == pytest.approx(2.5, rel=1e-14, abs=0.0)
    assert (block.density, block.depth) == (1000.0, 2.0)
    with pytest.raises(InvalidValueError, match=r"slenderness_angle must be in \(0, pi/2\) rad, got 14; check that"):
        rk.Block.from_angle(14.0, 2.5)
    for angle in (0.0, -0.1, 0.5 * math.pi, float("nan"), "0.3"):
        with pytest.raises(InvalidValueError, match="slenderness_angle must be"):
            rk.Block.from_angle(angle, 2.5)
    with pytest.raises(InvalidValueError, match="semi_diagonal must be > 0 m, got -1"):
        rk.Block.from_angle(0.3, -1.0)


DENSITIES = [0, -5.0, float("nan"), float("inf"), "concrete", None, True, 1e10]
WORDS = r"(number|finite|> 0|in \[1e-09, 1e\+09\])"


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        *((name, value, f"^{name} must be .*{WORDS}") for name in ("width", "height", "depth") for value in BAD),
        *(("density", value, "^density must be ") for value in DENSITIES),
    ],
    ids=repr,
)
def test_what_is_no_block(name, value, words):
    """No length and no density are refused; the message starts with the name and holds a range or the value."""
    with pytest.raises(InvalidValueError, match=words):
        rk.Block(**{"width": 1.0, "height": 2.0, name: value})


@pytest.mark.parametrize("value", [0.0, -9.81, float("nan"), "g"], ids=repr)
def test_bad_gravity_and_factors(value):
    """Gravity and scale factors above zero only."""
    block = rk.Block(width=1.0, height=2.0)
    for ask, words in (
        (lambda: block.side("left", gravity=value), r"^gravity must be "),
        (lambda: block.scaled(size=value), r"^size must be "),
        (lambda: block.scaled(density=value), r"^density must be "),
        (lambda: block.side("middle"), "foot must be"),
    ):
        with pytest.raises(InvalidValueError, match=words):
            ask()


def test_frozen_scaled_mirrored():
    """A block cannot be changed; scaling changes mass by size^3 density; it is its own mirror image."""
    block = rk.Block(width=1.0, height=2.0)
    with pytest.raises(FrozenInstanceError):
        block.width = 3.0
    assert block.scaled(size=2.0, density=0.5).mass == pytest.approx(4.0 * block.mass, rel=1e-15, abs=0.0)
    assert block.mirrored() == block
    assert block != rk.Block(width=1.0, height=2.1)


@pytest.mark.parametrize("sizes", [(1e-9, 1e9), (1e9, 1e-9), (1e-6, 1e9), (1e9, 1e9), (1e-9, 1e-9)])
def test_extreme_blocks(sizes):
    """Every pair of allowed lengths is a block with finite numbers: nothing is said to fall over by
    itself."""
    block = rk.Block(width=sizes[0], height=sizes[1])
    assert block.slenderness_ratio == pytest.approx(sizes[1] / sizes[0])
    assert 0.0 < block.frequency_parameter < math.inf
    assert 0.0 <= rk.coefficient_of_restitution(block, "ked") <= 1.0


POINTS, MASSES, FEET = [(-0.5, 1.0), (0.5, 1.0), (0.0, 3.0)], [1.0, 1.0, 2.0], (-1.0, 1.0)


@pytest.mark.verifies("closed form", "sums by hand", control="within")
def test_sums():
    """Mass, centre, inertia, box and contact of three points, by hand."""
    body = rk.MassPoints(POINTS, MASSES, FEET)
    assert body.mass == 4.0
    assert body.centre == (0.0, 2.0)
    assert body.moment_of_inertia == pytest.approx(0.5 + 4.0)
    assert body.local_box == (-1.0, 0.0, 1.0, 3.0)
    assert body.local_contact == ((-1.0, 1.0),)
    assert body.side("left").moment_of_inertia == pytest.approx(4.5 + 4.0 * 5.0)
    assert body.moment_of_inertia != pytest.approx(4.0 + 4.0 * 5.0)


def test_copies():
    """Scaling, mirroring and other feet, with contact stretches cut at the feet."""
    body = rk.MassPoints(POINTS, MASSES, FEET, contact=[(0.5, 2.0), (-1.0, -0.9)])
    assert body.local_contact == ((-1.0, -0.9), (0.5, 1.0))
    assert body.mirrored().local_contact == ((-1.0, -0.5), (0.9, 1.0))
    assert body.scaled(size=2.0).local_contact == ((-2.0, -1.8), (1.0, 2.0))
    assert body.scaled(density=3.0).mass == 12.0
    assert body.with_feet(-0.2, 0.6).local_contact == ((0.5, 0.6),)
    assert body.with_feet(-0.2, 0.6).feet == (-0.2, 0.6)
    assert body.feet == FEET


@pytest.mark.parametrize(
    ("points", "masses", "words"),
    [
        ([(0, -0.1)], [1.0], "point 0 must be finite with y >= 0 m"),
        ([(0, 1), (0, float("nan"))], [1.0, 1.0], "point 1 must be finite"),
        ([(0, float("inf"))], [1.0], "finite|within"),
        ([(0, 1e10)], [1.0], "check the unit"),
        ([(0, 1)], [1.0, 1.0], r"shape \(2, 2\)"),
        ([0, 1], [1.0, 1.0], "shape"),
        ([], [], "shape"),
        ("ab", [1.0], "points must be a list"),
        (None, [1.0], "points must"),
        ([(0, 1)], [0.0], "masses must be finite and > 0 kg, got 0 at index 0"),
        ([(0, 1), (0, 2)], [1.0, -2.0], "-2 at index 1"),
        ([(0, 1)], [float("nan")], "masses must be finite"),
        ([(0, 1)], ["heavy"], "masses must be numbers"),
        ([(0, 1)], [True], "masses must be numbers"),
        ([(0, 1), (0, 2)], [[1.0, 1.0], [1.0, 1.0]], "masses|points"),
    ],
)
def test_points_and_masses_that_are_none(points, masses, words):
    """Points below the ground or not finite, masses not above zero, and shapes that do not match are
    refused."""
    with pytest.raises(InvalidValueError, match=words):
        rk.MassPoints(points, masses, FEET)


NO_FEET = [(1.0, -1.0), (0.0, 1.0), (0.1, 1.0), (-1.0, -0.5), (-1.0,), 3, None, "ab", (np.nan, 1.0)]
NO_CONTACT = [[(0, "a")], [(0.0, np.nan)], [(0.5, -0.5)], [1.0], "ab", [(0, 1, 2)], 3]


@pytest.mark.parametrize(
    ("feet", "contact", "words"),
    [*((feet, None, r"feet|foot") for feet in NO_FEET), *((FEET, contact, "contact") for contact in NO_CONTACT)],
    ids=repr,
)
def test_feet_and_contact_that_are_none(feet, contact, words):
    """Feet swapped, beside the centre or malformed, and stretches that are no growing pairs are refused at once."""
    with pytest.raises(InvalidValueError, match=words):
        rk.MassPoints(POINTS, MASSES, feet, contact=contact)


def test_single_point_above_the_foot_loses_nothing_and_on_the_ground_all():
    """A mass above the new foot has r = 1, on the ground r = 0; no division by zero on the
    foot."""
    body = rk.MassPoints([(-1.0, 0.0), (1.0, 2.0), (1.0, 0.0), (-1.0, 1e-3)], [1.0, 1.0, 1.0, 1.0], FEET)
    expected = np.sqrt((4.0 + 1e-12 / (4.0 + 1e-6)) / (4.0 + 4.0 + 4.0 + 1e-6))
    assert rk.coefficient_of_restitution(body, "ked") == pytest.approx(expected, rel=1e-13, abs=0.0)
    assert expected != pytest.approx(1.0, rel=1e-3)
    assert isinstance(GeometryError("x"), InvalidValueError)


def test_note_of_a_weaker_depth():
    """A stated depth below the width is noted with both uplift limits, depth/height and width/height of a block."""
    facts = rk.Block(width=0.8, height=2.0, depth=0.5).depth_note.facts
    assert (facts["width"], facts["depth"]) == (0.8, 0.5)
    assert facts["limit"] == pytest.approx(0.5 / 2.0, rel=1e-14, abs=0.0)
    assert facts["own"] == pytest.approx(0.8 / 2.0, rel=1e-14, abs=0.0)
    inset = rk.Block(width=0.8, height=2.0, depth=0.5, feet=(0.2, 0.6))  # the base is narrower than the depth
    unstated, points = rk.Block(width=1.2, height=2.0), rk.MassPoints([(0.0, 1.0)], [1.0], feet=(-2.0, 2.0))
    for body in (inset, unstated, unstated.scaled(size=0.5), points, rk.Block(width=0.8, height=2.0, depth=0.8)):
        assert body.depth_note == ""
        assert not body.is_weaker_along_depth
    block = rk.Block(width=0.8, height=2.0, depth=0.5)
    for body in (block, block.scaled(size=2.0), block.to_section(), block.mirrored()):
        assert body.assumed[-1] == body.depth_note != ""


def test_an_assumed_depth_stays_assumed_in_a_body_file():
    """A body file contains a depth if it is stated, and only then has the body that is read a note."""
    stated = rk.Block(width=1.2, height=4.0, depth=1.0)
    for body, is_weaker in ((rk.Block(width=1.2, height=4.0), False), (stated, True)):
        for version in (body, body.to_section()):
            read = body_from_toml(body_to_toml(version))
            assert version.is_weaker_along_depth is read.is_weaker_along_depth is is_weaker
            assert read.depth == 1.0
