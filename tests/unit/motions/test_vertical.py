"""A vertical motion joined to a horizontal one: samples, lengths, provenance, and what is refused."""

from typing import Any

import pytest

from rocking.errors import InvalidValueError
from rocking.motions import GroundMotion, pulses, resampled, with_vertical

ALONG = GroundMotion([0.0, 1.0, -2.0, 4.0], 0.1, name="H", metadata={"component": "90"}, provenance=("read along",))
UP = GroundMotion([0.5, 0.0, 0.0, 3.0], 0.1, name="V", metadata={"component": "UP"}, provenance=("read up", "cut"))


def test_samples_and_where_they_come_from() -> None:
    """The first motion's samples stay, the second's are the vertical part; name, both components and both histories."""
    both = with_vertical(ALONG, UP)
    assert both.vertical is not None
    assert both.acceleration.tolist() == [0.0, 1.0, -2.0, 4.0]
    assert both.vertical.tolist() == [0.5, 0.0, 0.0, 3.0]
    assert (both.name, both.time_step, both.peak, both.peak_vertical) == ("H", 0.1, 4.0, 3.0)
    assert dict(both.metadata) == {"component": "90", "vertical component": "UP"}
    assert both.provenance == ("read along", "vertical part: read up", "vertical part: cut")
    # negative control: the other way round is another motion
    assert with_vertical(UP, ALONG).peak == 3.0


def test_unequal_lengths_are_cut_to_the_shorter() -> None:
    """Whichever is longer, both are cut, and the last line of the provenance says so."""
    short = GroundMotion([7.0, 8.0], 0.1)
    for first, second, counts in ((ALONG, short, "4 and 2"), (short, ALONG, "2 and 4")):
        both = with_vertical(first, second)
        assert both.vertical is not None
        assert (both.acceleration.tolist(), both.vertical.tolist()) == (
            first.acceleration[:2].tolist(),
            second.acceleration[:2].tolist(),
        )
        assert both.provenance[-1] == f"components of {counts} samples, both cut to 2"
    assert with_vertical(ALONG, short).provenance[1] == "vertical part: samples of 'ground motion'"


def test_steps_must_be_equal() -> None:
    """Half the step is refused, and taken after resampling; a difference by rounding is none."""
    fine = resampled(UP, 0.05)
    with pytest.raises(InvalidValueError, match=r"step of horizontal, 0\.1 s, got 0\.05 s; resample one first"):
        with_vertical(ALONG, fine)
    assert with_vertical(ALONG, resampled(fine, 0.1)).peak_vertical > 0.0
    assert with_vertical(ALONG, GroundMotion([1.0, 2.0], 0.1 * (1.0 + 1e-15))).time_step == 0.1


def test_two_components_of_one_name_keep_apart() -> None:
    """Where both files call their component the same, the vertical one is told from the other."""
    both = with_vertical(ALONG, GroundMotion([1.0, 2.0], 0.1, metadata={"component": "90", "header": "top"}))
    assert both.metadata["vertical component"] == "90 (vertical)"
    assert both.metadata["vertical header"] == "top"
    assert with_vertical(GroundMotion([1.0, 2.0], 0.1), ALONG).metadata["vertical component"] == "90"


def test_what_cannot_be_joined() -> None:
    """A motion that has a vertical part already is refused on either side, and so is what is no record."""
    both = with_vertical(ALONG, UP)
    with pytest.raises(InvalidValueError, match="horizontal must have no vertical part yet"):
        with_vertical(both, UP)
    with pytest.raises(InvalidValueError, match="vertical must have no vertical part yet"):
        with_vertical(ALONG, both)
    bad: Any
    for bad in (pulses.sine(1.0, 1.0), None, [1.0, 2.0]):
        with pytest.raises(InvalidValueError, match="vertical must be a GroundMotion, got"):
            with_vertical(ALONG, bad)
