"""Bodies on the vertices of their hull against time stepping by Moreau and Jean, which shares nothing with the engine.

With ROCKING_CAMPAIGN=1 all 480 histories of `python -m benchmarks.hull_stepping`, else twenty.
"""

import os
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

import rocking as rk
from rocking.bodies.solid import Solid, box
from rocking.dynamics.hull import histories
from rocking.dynamics.hull.body import HullBody

sys.path.append(str(Path(__file__).parents[2]))  # the time stepping lives beside the benchmarks

from benchmarks import hull_stepping, time_stepping
from benchmarks.time_stepping import Bodies, Motion

pytestmark = pytest.mark.verifies(room="rocking in space")

G = rk.conventions.g
CAMPAIGN = os.environ.get("ROCKING_CAMPAIGN") == "1"
needs_engine = pytest.mark.skipif(not histories.available(), reason="the compiled engine was not built")


@pytest.mark.verifies("closed form", "a block that slides to a stop", within="0.01", control="within")
def test_the_time_stepping_slides_as_coulomb_says():
    """v^2/(2 mu g), to 1 % at 2 ms, whatever the direction; another friction stops elsewhere."""
    bodies = Bodies.of([HullBody.of(Solid(box(1.0, 0.8, 0.3)))] * 2, [0.4, 0.5])
    now, impulses = Motion.upright(bodies), np.zeros_like(bodies.points)
    now.velocity[:] = (1.2, -0.9, 0.0)
    for _ in range(250):
        now = time_stepping.advance(bodies, now, np.array([0.0, 0.0, -G]), 2e-3, impulses)
    far = np.linalg.norm(now.place[:, :2], axis=1)
    np.testing.assert_allclose(far, 1.5**2 / (2.0 * np.array([0.4, 0.5]) * G), rtol=0.01)
    assert np.abs(now.velocity).max() < 1e-6


@pytest.mark.verifies("closed form", "Housner's coefficient of a block", within="0.005", control="within")
def test_the_time_stepping_has_housners_impact():
    """A block 1 x 1 x 4 that lands on its edge keeps 1 - 1.5/17 of its rate, to 0.005 at 1 ms; a smooth one does not.

    The rate falls at once at the impact: the largest fall between two steps is it.
    """
    bodies = Bodies.of([HullBody.of(Solid(box(1.0, 1.0, 4.0)))] * 2, [10.0, 0.0])
    now, impulses = Motion.upright(bodies), np.zeros_like(bodies.points)
    now.attitude = time_stepping.rotation(np.tile([0.0, 0.03, 0.0], (2, 1)))
    now.place[:, 2] = -(bodies.points @ now.attitude.transpose(0, 2, 1))[..., 2].min(axis=1)
    spins = []
    for _ in range(500):
        now = time_stepping.advance(bodies, now, np.array([0.0, 0.0, -G]), 1e-3, impulses)
        spins.append(now.spin[:, 1].copy())
    rates = np.array(spins)
    falls = np.argmax(np.abs(np.diff(rates, axis=0)), axis=0)
    ratio = [rates[k + 1, j] / rates[k, j] for j, k in enumerate(falls)]
    assert ratio[0] == pytest.approx(1.0 - 1.5 / 17.0, abs=0.005)
    assert abs(ratio[1] - ratio[0]) > 0.05


def _families():
    if CAMPAIGN:
        return {"sines": (hull_stepping.smooth(), 1e-3), "noise": (hull_stepping.noisy(), 1e-3)}
    short = hull_stepping.smooth(10, (1.0,), slice(150, 450))  # the strong part
    short.duration = 3.6
    return {"strong part": (short, 4e-3)}


@needs_engine
@pytest.mark.verifies("second engine", "time stepping by Moreau and Jean", within="0.95", control="within")
def test_random_hulls_end_as_time_stepping_has_it():
    """Verdicts agree in 95 % of the histories and do not lean to either side; so do peaks; with half the friction not.

    A campaign of 480 compares distributions of peaks too. Time stepping has an error of the order of its step: the
    median peak within 5 % at 4 ms. Where a contact stood in, no more than 10 % (or one) differ.
    """
    for name, (runs, step) in _families().items():
        ours, other = runs.ours(), runs.stepped(step)
        same = ours.overturned == other.overturned
        assert same.mean() >= 0.95
        assert (~same & (ours.held > 0)).sum() <= max(0.1 * (ours.held > 0).sum(), 1)
        assert hull_stepping.mcnemar(ours, other) > 1e-3
        assert stats.ks_2samp(ours.ranked, other.ranked, method="asymp").pvalue > 1e-3
        gaps = np.median(np.abs(hull_stepping.apart(ours, other)))
        assert gaps < 0.05
        if name == "noise":
            continue
        wrong = runs.stepped(4e-3, 0.5)
        assert np.median(np.abs(hull_stepping.apart(ours, wrong))) > 2.0 * gaps
        if CAMPAIGN:
            assert hull_stepping.mcnemar(ours, wrong) < 1e-3


@needs_engine
@pytest.mark.verifies("invariant", "tolerance and rest speed", within="0.01", control="within")
def test_settings_of_the_engine_flip_hardly_a_verdict():
    """Ten times and a tenth of tolerance and rest speed: 1 % of verdicts at most; 1.3 times the motion flips more."""
    histories = hull_stepping.smooth(50 if CAMPAIGN else 10)
    ours = histories.ours()
    for name, settings in hull_stepping.CHANGES.items():
        assert np.mean(histories.ours(settings).overturned != ours.overturned) <= 0.01, name
    assert np.mean(histories.ours(scale=1.3).overturned != ours.overturned) > 0.01
