"""Components joined and turned, and peaks over all directions."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from rocking import pulses
from rocking.errors import InvalidValueError
from rocking.motions import GroundMotion, resampled, rotated, rotd_pga, with_vertical

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
    with pytest.raises(InvalidValueError, match=r"step of horizontal, 0\.1 s, got 0\.05 s"):
        with_vertical(ALONG, fine)
    assert with_vertical(ALONG, resampled(fine, 0.1)).peak_vertical > 0.0
    assert with_vertical(ALONG, GroundMotion([1.0, 2.0], 0.1 * (1.0 + 1e-15))).time_step == 0.1


def test_two_components_of_one_name_keep_apart() -> None:
    """Where both files call their component the same, the vertical one is told from the other."""
    both = with_vertical(ALONG, GroundMotion([1.0, 2.0], 0.1, metadata={"component": "90", "header": "top"}))
    assert both.metadata["vertical component"] == "90 (vertical)"
    assert both.metadata["vertical header"] == "top"
    assert with_vertical(GroundMotion([1.0, 2.0], 0.1), ALONG).metadata["vertical component"] == "90"


RANDOM = np.random.default_rng(8)
X, Y = (GroundMotion(row, 0.01, name=name) for row, name in zip(RANDOM.normal(size=(2, 300)), "xy", strict=True))
RAY = np.sin(np.arange(50.0))


def test_quarter_and_half_turns() -> None:
    """A quarter turn makes y of x and -x of y, half a turn both negative; lengths stay, and turning back undoes it."""
    for angle, first, second in ((0.5 * math.pi, Y, X.scaled(-1)), (math.pi, X.scaled(-1), Y.scaled(-1))):
        for turned, expected in zip(rotated(X, Y, angle), (first, second), strict=True):
            np.testing.assert_allclose(turned.acceleration, expected.acceleration, rtol=0.0, atol=2e-15)
    assert all(np.array_equal(a.acceleration, b.acceleration) for a, b in zip(rotated(X, Y, 0.0), (X, Y), strict=True))
    a, b = rotated(X, Y, 0.7)
    length = np.hypot(X.acceleration, Y.acceleration)
    np.testing.assert_allclose(np.hypot(a.acceleration, b.acceleration), length, rtol=1e-14)
    back, _ = rotated(a, b, -0.7)
    np.testing.assert_allclose(back.acceleration, X.acceleration, rtol=0.0, atol=1e-14)


def test_a_ray_is_found() -> None:
    """Motion along 30 degrees, turned by 30 degrees, is all in the first component."""
    along = GroundMotion(math.cos(math.pi / 6) * RAY, 0.1), GroundMotion(0.5 * RAY, 0.1)
    a, b = rotated(*along, math.pi / 6)
    np.testing.assert_allclose(a.acceleration, RAY, rtol=0.0, atol=1e-15)
    assert b.peak < 1e-15


def test_vertical_and_provenance() -> None:
    """Each keeps its vertical part and says by how much it was turned, with which other motion."""
    first = GroundMotion(RAY, 0.1, vertical=2.0 * RAY, name="one", provenance=("read",))
    a, b = rotated(first, GroundMotion(RAY, 0.1, name="two"), 0.25)
    assert a.vertical is not None
    assert np.array_equal(a.vertical, 2.0 * RAY)
    assert b.vertical is None
    assert a.provenance == ("read", "turned by 0.25 rad together with 'two'")
    assert "'one'" in b.provenance[-1]


def test_peaks_over_directions_by_closed_form() -> None:
    """A ray of peak A has RotD100 = A, RotD00 = 0 and RotD50 = A cos(45 degrees); a circle has A for all."""
    peak = float(np.abs(RAY).max())
    ray, nothing = GroundMotion(RAY, 0.1), GroundMotion(0.0 * RAY, 0.1)
    assert rotd_pga(ray, nothing, 100) == peak
    assert rotd_pga(ray, nothing, 0) < 1e-15
    # half of the directions lie within 45 degrees of the ray; the 180 directions round that to half a degree, 0.9 %
    assert rotd_pga(ray, nothing, 50) == pytest.approx(peak * math.cos(math.radians(45.0)), rel=0.009)
    turn = np.linspace(0.0, 2.0 * math.pi, 3601)
    circle = GroundMotion(np.cos(turn), 0.01), GroundMotion(np.sin(turn), 0.01)
    for percentile in (0, 50, 100):
        assert rotd_pga(*circle, percentile) == pytest.approx(1.0, rel=1e-5)


def test_peaks_do_not_see_the_axes() -> None:
    """RotD100 of turned components is that of the record, to rounding; percentiles rise."""
    turned = rotated(X, Y, 0.3)
    assert rotd_pga(*turned, 100) == pytest.approx(rotd_pga(X, Y, 100), rel=1e-14, abs=0.0)
    values = [rotd_pga(X, Y, p) for p in (0, 16, 50, 84, 100)]
    assert values == sorted(values)
    assert values[0] < values[-1]


BOTH = with_vertical(ALONG, UP)
PULSE = pulses.sine(1.0, 1.0)
REFUSED: list[tuple[str, Callable[[], Any]]] = [
    ("horizontal must have no vertical part", lambda: with_vertical(BOTH, UP)),
    ("vertical must have no vertical part", lambda: with_vertical(ALONG, BOTH)),
    *(("vertical must be a GroundMotion, got", lambda x=x: with_vertical(ALONG, x)) for x in (PULSE, None, [1.0, 2.0])),
    (r"0\.01 s and 300 samples, got 0\.01 s and 2", lambda: rotated(X, GroundMotion(np.zeros(2), 0.01), 0.1)),
    ("second must have the time step", lambda: rotd_pga(X, GroundMotion(Y.acceleration, 0.02), 50)),
    *(("percentile must be", lambda x=x: rotd_pga(X, Y, x)) for x in (-1, 101, math.nan, None, "50")),
    *(("angle must be", lambda x=x: rotated(X, Y, x)) for x in (math.nan, math.inf, None, "x", [0.1, 0.2])),
]


@pytest.mark.parametrize(("message", "call"), REFUSED)
def test_refusals(message: str, call: Callable[[], Any]) -> None:
    """A second vertical part, other lengths and steps, percentiles outside [0, 100], angles that are no number."""
    with pytest.raises(InvalidValueError, match=message):
        call()
