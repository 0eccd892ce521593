"""Motions as polynomials: the straight lines of records, cutting, and rest added at the end."""

import numpy as np
import pytest

from rocking.motions import GroundMotion, Segments

MOTION = GroundMotion(np.array([0.0, 1.0, -2.0, 0.5]), 0.2, vertical=np.array([1.0, 1.0, 0.0, 4.0]))


def test_lines_between_samples() -> None:
    """A record is one straight line a step: value at its start, and rise over it; the vertical part too."""
    segments = MOTION.segments()
    assert segments.horizontal.tolist() == [[0.0, 1.0], [1.0, -3.0], [-2.0, 2.5]]
    assert segments.vertical is not None
    assert segments.vertical.tolist() == [[1.0, 0.0], [1.0, -1.0], [0.0, 4.0]]
    assert (segments.count, segments.degree, segments.step) == (3, 1, 0.2)
    assert segments.duration == pytest.approx(0.6, rel=1e-15, abs=0.0)
    assert GroundMotion(np.array([0.0, 1.0]), 0.2).segments().vertical is None


def test_refined_is_the_same_motion() -> None:
    """Each line cut into four is four lines with the values in between; one part is the motion itself."""
    segments = MOTION.segments()
    cut = segments.refined(4)
    assert cut.count == 12
    assert cut.step == pytest.approx(0.05, rel=1e-15, abs=0.0)
    np.testing.assert_allclose(cut.horizontal[4:8, 0], [1.0, 0.25, -0.5, -1.25], rtol=0.0, atol=1e-15)
    np.testing.assert_allclose(cut.horizontal[4:8, 1], np.full(4, -0.75), rtol=0.0, atol=1e-15)
    assert cut.vertical is not None
    np.testing.assert_allclose(cut.vertical[8:, 0], [0.0, 1.0, 2.0, 3.0], rtol=0.0, atol=1e-15)
    assert segments.refined(1) is segments
    assert segments.refined(0) is segments


def test_refined_powers() -> None:
    """tau^7 cut in two is (tau / 2)^7 and, by the binomial series, ((1 + tau) / 2)^7."""
    one = Segments(1.0, np.eye(8)[7:])
    half = one.refined(2).horizontal * 2.0**7
    np.testing.assert_allclose(half[0], np.eye(8)[7], rtol=0.0, atol=1e-14)
    np.testing.assert_allclose(half[1], [1.0, 7.0, 21.0, 35.0, 35.0, 21.0, 7.0, 1.0], rtol=1e-14)


def test_polynomials_of_degree_seven_are_exact() -> None:
    """Interpolation gives back 1 + (1 + t) + ... + (1 + t)^7 to rounding, and misses t^8 (the control)."""
    tau = np.linspace(0.0, 1.0, 101)
    powers = tau[:, None] ** np.arange(8)
    expected = ((1.0 + tau[:, None]) ** np.arange(8)).sum(axis=1)
    made = Segments.of_function(lambda t: ((1.0 + t[:, None]) ** np.arange(8)).sum(axis=1), 1.0, 1)
    np.testing.assert_allclose(powers @ made.horizontal[0], expected, rtol=1e-13)
    off = Segments.of_function(lambda t: t**8, 1.0, 1)
    assert np.abs(powers @ off.horizontal[0] - tau**8).max() > 1e-6


def test_extended_with_rest() -> None:
    """The ground rests after the motion, up to a whole number of steps; a motion long enough stays itself."""
    segments = MOTION.segments()
    longer = segments.extended(0.95)
    assert longer.count == 5
    assert not longer.horizontal[3:].any()
    assert longer.vertical is not None
    assert not longer.vertical[3:].any()
    assert longer.vertical.shape == (5, 2)
    np.testing.assert_array_equal(longer.horizontal[:3], segments.horizontal)
    assert segments.extended(0.6) is segments
    assert segments.extended(0.1) is segments
    assert Segments.still(0.1, 2).extended(0.3).vertical is None


def test_still() -> None:
    """Ground at rest is zeros."""
    still = Segments.still(0.5, 4)
    assert still.duration == 2.0
    assert still.horizontal.shape == (4, 2)
    assert not still.horizontal.any()
