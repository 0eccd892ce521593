"""Which laws of restitution an incremental analysis takes: those that are the same whenever a motion is repeated."""

import numpy as np
import pytest

import rocking as rk
from rocking.dynamics.impact_law import ImpactLaw
from rocking.errors import InvalidValueError
from rocking.studies.fragility._incremental import incremental
from rocking.studies.fragility.stripes import multiple_stripes

BLOCK = rk.Block(width=0.4, height=1.6)
PULSES = [rk.pulses.sine(1.0, period) for period in np.linspace(0.35, 0.9, 12)]
LEVELS = np.linspace(2.0, 12.0, 11)


def test_random_coefficients_have_no_crossing():
    """Coefficients drawn anew for every history leave no crossing to search: refused, and stripes take them."""
    law = rk.dynamics.RandomRestitution(np.array([0.9, 1.0]), seed=3)
    with pytest.raises(InvalidValueError, match="drawn anew"):
        incremental(BLOCK, PULSES, LEVELS, restitution=law)
    assert multiple_stripes(BLOCK, PULSES, LEVELS, restitution=law).failed == 0


class Slower(ImpactLaw):
    """A law of one's own that always takes the coefficient."""

    def factor(self, speed, key, impact):
        return 1.0


class Drawn(Slower):
    """The same, which claims one draw a history."""

    per_history = True


def test_a_law_of_ones_own_is_taken_with_a_note():
    """A factor of one gives the crossings of the plain coefficient, and the summary says what it takes for granted."""
    own = incremental(BLOCK, PULSES[:2], [3.0, 6.0], restitution=Slower(), tolerance=1e-4)
    plain = incremental(BLOCK, PULSES[:2], [3.0, 6.0], restitution=1.0, tolerance=1e-4)
    np.testing.assert_allclose(own.first_crossings, plain.first_crossings, rtol=2e-4)
    assert "law of one's own" in own.summary()["restitution note"]
    assert plain.summary()["restitution note"] == ""
    with pytest.raises(InvalidValueError, match="drawn anew"):
        incremental(BLOCK, PULSES[:2], [3.0, 6.0], restitution=Drawn())
