"""A round base on its hull comes to rest: after a drop, with any friction, at the smallest rest speed."""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.dynamics import SpatialBody, SpatialStart
from rocking.dynamics.hull import histories
from rocking.dynamics.hull.body import HullBody
from rocking.dynamics.hull.ground import HullGround
from rocking.dynamics.hull.histories import hull_histories
from rocking.dynamics.hull.settings import HullSettings
from rocking.outcome import Outcome, Status

pytestmark = pytest.mark.verifies(room="rocking in space")
needs_engine = pytest.mark.skipif(not histories.available(), reason="the compiled engine was not built")

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
