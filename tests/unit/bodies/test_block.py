"""Block: the numbers of a rectangle, and what is not a block."""

import math
from dataclasses import FrozenInstanceError

import numpy as np
import pytest

import rocking as rk
from rocking.errors import InvalidValueError

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
    with pytest.raises(InvalidValueError, match=r"slenderness_angle must be in \(0, pi/2\) rad, got 14; degrees\?"):
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
