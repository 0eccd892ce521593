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
from rocking.dynamics.frictional import histories
from rocking.dynamics.frictional.body import HullBody

sys.path.append(str(Path(__file__).parents[2]))  # the time stepping lives beside the benchmarks

import math

from benchmarks import hull_stepping, time_stepping
from benchmarks.time_stepping import Bodies, Motion

from rocking.dynamics import SpatialBody, SpatialStart
from rocking.dynamics.frictional.ground import HullGround
from rocking.dynamics.frictional.histories import hull_histories
from rocking.dynamics.frictional.settings import HullSettings
from rocking.outcome import Outcome, Status

pytestmark = [pytest.mark.slow, pytest.mark.verifies(room="rocking in space")]

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


B, HEIGHT, TILT, DROP = 0.25, 2.0, 0.05, 0.1
ACROSS = (3.0 * B**2 + HEIGHT**2) / 12.0  # moment of inertia about a horizontal axis through the centre, over the mass
FOOT = ACROSS + B**2 + 0.25 * HEIGHT**2  # about the foot
HOUSNER = (FOOT - 2.0 * B**2) / FOOT


def _prism(count: int) -> HullBody:
    angle = np.arange(count) * 2.0 * math.pi / count
    points = [(x, y, z) for x, y in (B * np.column_stack([np.cos(angle), np.sin(angle)])).tolist() for z in (0, HEIGHT)]
    return HullBody(np.array(points), 1.0, np.array([0, 0, 0.5 * HEIGHT]), np.diag([ACROSS, ACROSS, 0.5 * B**2]))


@needs_engine
@pytest.mark.verifies("closed form", "energies of a dropped cylinder that does not slide", within="1e-4")
@pytest.mark.parametrize("rest_speed", [1e-5, 1e-7])
def test_a_dropped_cylinder_comes_to_rest(rest_speed):
    """The landing keeps m s^2 / I of the energy, each impact the square of Housner's coefficient; all of it is lost.

    s is the horizontal distance of the centre of mass from the foot. The sides of the polygon are 4e-5 nearer.
    """
    cylinder = SpatialBody.cylinder(2.0 * B, HEIGHT)
    start = SpatialStart(tilt=TILT, height=DROP)
    fallen = rk.free_rocking(cylinder, 0.0, "housner", friction=1e6, start=start, rest_speed=rest_speed)
    assert fallen.status is Status.GOOD
    assert fallen.outcome is Outcome.FLEW
    assert not fallen.still_rocking
    before, after = fallen.impacts["energy_before"], fallen.impacts["energy_after"]
    weight = cylinder.mass * rk.conventions.g
    assert before[0] == pytest.approx(weight * DROP, rel=1e-9)
    arm = B * math.cos(TILT) - 0.5 * HEIGHT * math.sin(TILT)
    assert after[0] / before[0] == pytest.approx(arm**2 / FOOT, rel=1e-4)
    np.testing.assert_allclose((after / before)[1:30], HOUSNER**2, rtol=1e-4)
    lowered = DROP + B * math.sin(TILT) + 0.5 * HEIGHT * (math.cos(TILT) - 1.0)
    assert fallen.trajectory.lost == pytest.approx(weight * lowered, rel=1e-6)
    assert after[1] / before[1] != pytest.approx(arm**2 / FOOT, rel=1e-2)  # negative control


@pytest.mark.verifies("second engine", "rest of a prism after a small tilt, both engines on hulls", within="1e-6")
@pytest.mark.parametrize("drop", [0.0, 1e-4])
def test_both_engines_let_a_prism_rest(drop):
    """A prism that does not slide comes to rest in both engines, with the same impacts."""
    found = []
    for engine in ("fast", "reference") if histories.available() else ("reference",):
        start, how = SpatialStart(tilt=2e-5, height=drop), HullSettings(most_events=200)
        batch = hull_histories(_prism(16), HullGround(), "housner-3d", 1e6, 1.0, start, settings=how, engine=engine)
        found.append([batch[name].item() for name in ("status", "still_rocking", "impacts", "peak_tilt")])
    assert found[0][:2] == [list(Status).index(Status.GOOD), False]
    assert found[0][2] > 20
    np.testing.assert_allclose(found[-1], found[0], rtol=1e-6)


@needs_engine
@pytest.mark.verifies("invariant", "time of rest, whatever the rest speed", within="1e-3", control="within")
def test_the_rest_speed_hardly_changes_the_history():
    """Below the usual rest speed the peak is the same and the rest comes later, by the last small impacts."""
    ends = []
    for rest_speed in (1e-5, 1e-6, 1e-7):
        start = SpatialStart(tilt=TILT)
        rocked = rk.free_rocking(
            SpatialBody.cylinder(2.0 * B, HEIGHT), 0.0, "housner", friction=1e6, start=start, rest_speed=rest_speed
        )
        assert rocked.status is Status.GOOD
        assert rocked.peak_tilt == pytest.approx(TILT, rel=1e-12)
        ends.append(float(rocked.trajectory.time[-1]))
    assert ends == sorted(ends)
    assert ends[-1] == pytest.approx(ends[0], rel=1e-3)
    sooner = rk.free_rocking(
        SpatialBody.cylinder(2.0 * B, HEIGHT), 0.0, "housner", friction=1e6, start=start, rest_speed=1e-2
    )
    assert float(sooner.trajectory.time[-1]) != pytest.approx(ends[0], rel=1e-3)  # negative control
