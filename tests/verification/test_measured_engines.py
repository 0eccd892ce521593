"""Bodies that rock on the contact bed and on their hull, measured as if nobody knew: the coefficient that they have.

Both engines know more than the model that is fitted: impacts that take time, hops, motion in three dimensions.
"""

import numpy as np
import pytest

import rocking as rk
from rocking.bodies.solid import Part, Solid, box
from rocking.dynamics.rolling import SpatialStart
from rocking.identification import ImpactTimes, RotationSeries, identify
from rocking.restitution.bed import ContactBed, KelvinVoigt, bed_free_rocking

pytestmark = [pytest.mark.slow, pytest.mark.verifies(room="evidence")]

BLOCK = rk.Block(width=0.1, height=0.4, density=2400.0)
TOWER = Solid([Part(box(0.3, 0.2, 0.8), 2400.0), Part(box(0.1, 0.2, 0.3), 2400.0).moved(0.04, 0.0, 0.8)])
R = 0.92
STILL = {"x": rk.GroundMotion([0.0] * 3, 0.01)}


def on_bed(frequency, damping, points, jitter, **known):
    """What a bed with a frequency [Hz] says of a block, and the mean coefficient of its peaks after the first."""
    law = KelvinVoigt(BLOCK.mass * (2.0 * np.pi * frequency) ** 2, damping_ratio=damping)
    bed = ContactBed.uniform(BLOCK, points, law)
    rocked = bed_free_rocking(BLOCK, bed, rotation=0.6 * BLOCK.slenderness_angle, peaks=12)
    times = rocked.touches + jitter * np.random.default_rng(points).normal(size=rocked.touches.size)
    return identify(ImpactTimes(times), BLOCK, size_error=0.005, **known), float(
        np.exp(np.log(rocked.coefficients[1:]).mean())
    )


@pytest.mark.verifies(
    "second engine", "blocks on a contact bed, heard to 0.2 ms", within="the interval",
    control="test_hops_on_a_bed_are_told",
)  # fmt: skip
@pytest.mark.parametrize(("damping", "points"), [(1.0, 2), (1.0, 5), (0.3, 11), (1.0, 41)])
def test_impacts_on_a_bed_tell_its_coefficient(damping, points):
    """The mean of the peaks on the bed is within the interval of the times, which is narrower than 0.005."""
    found, own = on_bed(1500.0, damping, points, 2e-4)
    assert not found.refused
    assert found.mean.low < own < found.mean.high < found.mean.low + 0.005


BEDS = [(400.0, 1.0, 2), (1500.0, 0.3, 11), (1500.0, 1.0, 41)]


@pytest.mark.verifies(
    "second engine", "beds that change with the speed, heard to 0.1 ms, with a trend", within="the interval",
    control="test_a_bed_that_changes_with_the_speed_is_told",
)  # fmt: skip
@pytest.mark.parametrize(("frequency", "damping", "points"), BEDS)
def test_the_mean_with_a_trend_is_that_of_the_impacts(frequency, damping, points):
    """Within an interval narrower than 0.001: at the speed of the first impact it was off by as much and more."""
    found, own = on_bed(frequency, damping, points, 1e-4, tilt=0.0, trend=True)
    assert not found.refused
    assert found.mean.low < own < found.mean.high < found.mean.low + 0.001


@pytest.mark.verifies(
    "second engine", "the same beds, heard to 0.02 ms", within="0.0005",
    control="test_a_bed_that_changes_with_the_speed_is_told",
)  # fmt: skip
@pytest.mark.parametrize(("frequency", "damping", "points"), BEDS)
def test_impacts_that_take_time_limit_the_mean(frequency, damping, points):
    """Impacts are instants to the model: sharper times make the interval too narrow, and the mean no better."""
    found, own = on_bed(frequency, damping, points, 2e-5, tilt=0.0, trend=True)
    assert found.mean.value == pytest.approx(own, abs=5e-4)


@pytest.mark.verifies("negative control")
@pytest.mark.parametrize("points", [5, 11, 41])
def test_hops_on_a_bed_are_told(points):
    """With hardly any damping the body hops and its coefficient scatters: refused, or tenfold the interval."""
    found, _ = on_bed(1500.0, 0.02, points, 2e-4)
    assert found.refused or (found.mean.high > found.mean.low + 0.05 and found.scatter.value > 0.03)


@pytest.mark.verifies("negative control")
def test_a_bed_that_changes_with_the_speed_is_told():
    """Slow impacts lose less on a soft bed; heard sharply, one mean for all is refused, and what to try is said."""
    assert "use trend=True" in str(on_bed(400.0, 1.0, 5, 2e-5)[0].refused[0])


def on_hull(azimuth, duration, friction=0.6):
    """What a tracked rotation and the sound say of a tower that is let go about one edge, or askew."""
    plane = TOWER.in_plane(0.0)
    start = SpatialStart(0.5 * plane.side("right").slenderness_angle, azimuth)
    response = rk.simulate(TOWER, STILL, R, friction=friction, start=start, duration=duration)
    random, quaternion = np.random.default_rng(3), response.quaternion
    rotation = 2.0 * np.arctan2(quaternion[:, 2], quaternion[:, 0]) + 5e-4 * random.normal(size=response.time.size)
    times = np.unique(response.impacts["time"].round(3))[:40]
    heard = ImpactTimes(times + 1e-4 * random.normal(size=times.size))
    series = RotationSeries(response.time, rotation=rotation)
    return [identify(each, plane, size_error=0.005, first="left") for each in (series, heard)]


@pytest.mark.verifies(
    "second engine", "a tower on its hull, tracked to 0.5 mrad or heard to 0.1 ms", within="the interval",
    control="test_motion_in_three_dimensions_is_told",
)  # fmt: skip
def test_rocking_on_a_hull_tells_its_coefficient():
    """About one edge: both measurements have the coefficient within an interval narrower than 0.005."""
    for found in on_hull(0.0, 3.6):
        assert not found.refused
        assert found.mean.low < R < found.mean.high < found.mean.low + 0.005


@pytest.mark.verifies("negative control")
def test_motion_in_three_dimensions_is_told():
    """Let go askew by 0.8 rad: the sound is refused, about one axis r scatters, and its interval holds the truth."""
    series, heard = on_hull(0.8, 2.5)
    assert heard.refused
    assert series.refused or (series.scatter.value > 0.01 and series.mean.low < R < series.mean.high)


@pytest.mark.verifies("negative control")
def test_sliding_is_told():
    """With a friction of 0.15 it slides: neither measurement gives a number."""
    assert all(found.refused for found in on_hull(0.0, 2.5, friction=0.15))
