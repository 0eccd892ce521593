"""The report of an assessment: which history is plotted, and what its tables count."""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.reports._assessment import governing_history
from rocking.studies import SyntheticSet

CABINET = rk.Block(width=0.8, height=2.2, depth=1.2, mass=650.0, centre=(0.52, 0.9))


def record(peak, period=0.8, name="sine"):
    """A sine of two periods as a record."""
    time = np.arange(0.0, 2.0 * period, 0.01)
    return rk.GroundMotion(peak * np.sin(2.0 * math.pi * time / period), 0.01, name=name)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("motions", "falls"),
    [
        ([record(9.0)], True),
        ([record(2.0, 1.6, "slow"), record(9.0, name="strong")], True),
        ([SyntheticSet("firm-ground", 9, 1, pga=7.0)[8]], False),
    ],
)
def test_a_history_that_overturns_is_plotted(motions, falls):
    """The motion that overturns unscaled, or that of the smallest factor at this factor."""
    found = rk.assess(CABINET, motions, [0.85, 0.92], count=8)
    governing = governing_history(found)
    assert governing.history.outcome is rk.Outcome.OVERTURNED
    fell = bool((found.overturning_fraction > 0.0).any())
    assert fell is falls
    assert governing.description.startswith(
        f"The body{' mirrored,' if 'mirrored' in governing.description else ''} under {governing.motion.name}"
    )
    assert ("(unscaled)" in governing.description) is fell
    assert fell or f"scaled by {found.lowest.factor:.3g}," in governing.description
    # negative control: without a factor the history of the least margin stands where no motion overturns
    as_it_is = rk.simulate(CABINET, governing.motion, 0.92)
    assert fell or as_it_is.outcome is not rk.Outcome.OVERTURNED
