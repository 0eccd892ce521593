"""A round base cut into corners: coefficient, peak and decay converge to the rolling rim as the corners grow in number.

The statue is asymmetric (an arm beside the axis), its motion of two components and its start are made here.
"""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.bodies.solid import Part, RoundBase, Solid, box, revolution
from rocking.dynamics.rolling import SpatialBody, SpatialStart, fast_engine, reference
from rocking.dynamics.rolling.batch import batch_in_space
from rocking.restitution.space import edge_coefficient

pytestmark = pytest.mark.verifies(room="rocking in space")

RADIUS, LENGTH = 0.3, 1.2
PROFILE = [(0.30, 0.0), (0.30, 0.15), (0.18, 0.25), (0.15, 1.2), (0.22, 1.5), (0.10, 1.75)]
START = {"tilt": 0.04, "azimuth": 0.4, "angular_velocity": (0.15, 0.1, 0.1)}
TIME = np.arange(101) * 0.01
MOTION = (
    rk.GroundMotion(0.30 * np.sin(2.0 * np.pi * TIME / 0.9), 0.01),
    rk.GroundMotion(0.225 * np.sin(2.0 * np.pi * TIME / 0.7 + 0.8), 0.01),
)
CORNERS = np.array([8, 16, 32, 64])
built = pytest.mark.skipif(not fast_engine.available(), reason="the batch engine was not built")


def statue(corners):
    """The statue on a polygon in its round foot, on the round foot itself for None."""
    parts = [Part(revolution(PROFILE), 2600.0), Part(box(0.25, 0.2, 0.3), 2600.0).moved(0.35, 0.05, 1.1)]
    if corners is None:
        return Solid(parts, base=RoundBase(np.zeros(2), RADIUS))
    angle = 2.0 * np.pi * (np.arange(corners) + 0.25) / corners
    return Solid(parts, base=RADIUS * np.column_stack([np.cos(angle), np.sin(angle)]))


def shaken(corners, law):
    return rk.simulate(statue(corners), MOTION, law, start=SpatialStart(**START), duration=LENGTH)


@pytest.fixture(scope="module")
def rim():
    """The rolling rim: its peak, and the energy that it has at the end, none of which an impact took."""
    run = shaken(None, "housner-3d")
    assert run.impacts.size == 0
    assert run.tilt.min() > math.radians(1.0)  # it never passes through lying flat
    return run.peak_tilt, run.energy.kinetic[-1] + run.energy.potential[-1]


def errors(law, corners, rim):
    """How far the peak stays below the rim's, and which share of the rim's energy impacts take."""
    bodies = [SpatialBody.of(statue(int(n))) for n in corners]
    batch = batch_in_space(bodies, MOTION, law, start=SpatialStart(**START), duration=LENGTH)
    assert (batch.status == 0).all()
    assert (batch.still_rocking == 1.0).all()
    return 1.0 - batch["peak_tilt"].ravel() / rim[0], batch["energy_lost"].ravel() / rim[1]


def orders(values):
    return np.log2(values[:-1] / values[1:])


@pytest.mark.slow
@pytest.mark.verifies(
    "order", "the rolling rim", within="0.2 of an order of 0.95", control="test_the_law_by_points_does_not_converge"
)
@built
@pytest.mark.parametrize("law", ["ked-3d", "housner-3d"])
def test_peak_and_decay_converge_to_the_rolling_rim(law, rim):
    """From 8 to 64 corners: what peak and energy lack is halved with every doubling, order 0.75 to 1.15.

    One step costs 1/n^2 and there are n a turn: order 1. Doublings from 8 corners have an order of .8 to .9 yet.
    """
    for missing in errors(law, CORNERS, rim):
        assert (missing > 0.0).all()
        assert (np.abs(orders(missing) - 0.95) < 0.2).all()
        assert missing[-1] < 0.04


@pytest.mark.slow
@pytest.mark.verifies("negative control", "the law by points")
@built
def test_the_law_by_points_does_not_converge(rim):
    """Negative control: by ked-3d-point peak and energy are further from the rim with 32 corners than with 8."""
    peak, lost = errors("ked-3d-point", CORNERS[:3:2], rim)
    assert peak[1] > peak[0] > 0.2
    assert lost[1] > lost[0] > 0.2


@pytest.mark.slow
@pytest.mark.verifies("order", "the rolling rim", within="0.006 of the peak and 0.01 of the energy at 200 corners")
def test_two_hundred_corners_are_nearly_the_rim(rim):
    """128 and 200 corners, reference engine: peak within .9 and .6 %, energy within 1.5 and 1 %."""
    for corners, near in ((128, 1.5), (200, 1.0)):
        run = shaken(corners, "ked-3d")
        assert 0.0 < 1.0 - run.peak_tilt / rim[0] < 0.006 * near
        assert 0.0 < run.energy.lost[-1] / rim[1] < 0.01 * near
        assert run.still_rocking
        assert "still rocking at the end of the computation, 1.2 s" in run.summary


@pytest.mark.slow
@pytest.mark.verifies("order", "the coefficient of the drum", within="0.1 of the order")
def test_the_coefficient_converges_to_that_of_the_drum():
    """Over a diameter, edge to opposite edge: r tends to that of the drum with the square of n.

    The base is narrower than the drum by the square of 1/n.
    """
    counts = (8, 16, 32, 64, 128, 200)
    drum = edge_coefficient(statue(None), start=math.pi * 1.5, model="ked-3d")
    found = []
    for n in counts:
        angle = 2.0 * np.pi * (np.arange(n) + 0.5) / n
        parts = statue(None).parts
        solid = Solid(parts, base=RADIUS * np.column_stack([np.cos(angle), np.sin(angle)]))
        normals = [math.atan2(-edge.direction[0], edge.direction[1]) for edge in solid.base.edges]
        start = int(np.argmin(np.abs(np.array(normals) + 0.5 * math.pi)))
        found.append(edge_coefficient(solid, start=start, model="ked-3d"))
    missing = np.abs(np.array(found) - drum)
    order = np.log(missing[:-1] / missing[1:]) / np.log(np.array(counts[1:]) / np.array(counts[:-1]))
    np.testing.assert_allclose(order, 2.0, rtol=0.0, atol=0.1)


@pytest.mark.slow
@pytest.mark.verifies("behaviour")
def test_what_comes_to_rest_is_not_still_rocking():
    """A box rests in the end; the same history cut short is still rocking, in words and in its files."""
    tower = SpatialBody.box(1.0, 1.3, 4.0)
    rests = rk.free_rocking(tower, restitution="ked-3d", start=SpatialStart(0.05, 0.4))
    assert not rests.still_rocking
    assert rests.unfinished == ""
    assert "still rocking" not in rests.summary
    cut = rk.free_rocking(tower, restitution="ked-3d", start=SpatialStart(0.05, 0.4), duration=1.0)
    assert cut.still_rocking
    assert "still rocking at the end of the computation, 1 s" in cut.summary
    assert cut.exported().provenance["still_rocking"]


@pytest.mark.slow
@pytest.mark.verifies("behaviour")
@built
def test_a_spin_nearly_flat_ends_after_so_many_steps(monkeypatch):
    """A disc that spins on its rim without loss takes thousands of steps a second; it is left still rocking."""
    monkeypatch.setattr(reference, "_MAX_LATE_STEPS", 40)
    tilt = 2.4e-3
    spin = (-0.1, 100.0 * math.sin(tilt), 15.0)
    ended = rk.free_rocking(
        SpatialBody.cylinder(0.5, 2.0),
        restitution="housner",
        start=SpatialStart(tilt, -0.5 * math.pi, angular_velocity=spin),
        gravity=9.81,
        duration=0.02,
    )
    assert ended.still_rocking
    assert ended.end < 0.2


@pytest.mark.verifies("behaviour")
def test_batches_say_what_is_still_rocking():
    """Both engines: cut short 1, come to rest 0, overturned 0, never lifted 0; files have the column."""
    tower = SpatialBody.box(1.0, 1.3, 4.0)
    starts = [SpatialStart(0.05, 0.4), SpatialStart(), SpatialStart(0.2, 0.0, angular_velocity=(0.0, 1.5, 0.0))]
    for name in ("fast", "reference"):
        short = batch_in_space(tower, None, "ked-3d", start=starts, duration=1.0, engine=name)
        assert short.still_rocking.ravel().tolist() == [True, False, False]
        assert short.overturned.ravel().tolist() == [False, False, True]
    long = rk.simulate_many(tower, None, restitution="ked-3d", start=starts[0])
    assert not long["still_rocking"].item()
    assert "still rocking at the end of the motion" in long["still_rocking"].attrs["long_name"]
