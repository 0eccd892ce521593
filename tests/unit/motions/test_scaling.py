"""Scaling to targets."""

import numpy as np
import pytest

from rocking.errors import InvalidValueError
from rocking.motions import GroundMotion, scaled_to, spectral_measure

MOTION = GroundMotion([0.0, 1.0, -1.0, 0.0], 1.0, vertical=[0.0, 0.5, 0.25, 0.0])


def test_targets_are_met_by_closed_forms():
    """The zigzag has PGA 1 and PGV 3/4; a step has PSA 2: the factors follow, for the vertical part too."""
    np.testing.assert_allclose(scaled_to(MOTION, "pga", 2.5).vertical, 2.5 * MOTION.vertical, rtol=1e-15)
    np.testing.assert_allclose(scaled_to(MOTION, "pgv", 1.5).acceleration, 2.0 * MOTION.acceleration, rtol=1e-15)
    step = GroundMotion(np.ones(200), 0.01)
    assert scaled_to(step, spectral_measure(0.5, 0.0), 5.0).peak == pytest.approx(2.5, rel=1e-4)


def test_provenance_tells_what_was_done():
    """The line of provenance names measure, target and factor."""
    assert "PGV is 1.5 m/s" in scaled_to(MOTION, "pgv", 1.5).provenance[-1]
    assert "PSA(1 s, 0.05)" in scaled_to(MOTION, "sa(1)", 1.0).provenance[-1]


def test_bad_values_are_refused():
    """A motion of zeros cannot be scaled, nor can one be scaled to zero or beyond all motions."""
    nothing = GroundMotion([0.0, 0.0], 0.1)
    for measure in ("pga", "pgv"):
        with pytest.raises(InvalidValueError, match="zero throughout"):
            scaled_to(nothing, measure, 1.0)
        for target in (0.0, -1.0, np.nan):
            with pytest.raises(InvalidValueError, match="target"):
                scaled_to(MOTION, measure, target)
    with pytest.raises(InvalidValueError, match="zero throughout"):
        scaled_to(nothing, "sa(1)", 1.0)
    with pytest.raises(InvalidValueError, match="wrong unit"):
        scaled_to(MOTION, "pga", 1e9)
