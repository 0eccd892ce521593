"""Round bases in the batch engine: steady wobbles, invariants, and the reference engine.

REF numbers (CONTRIBUTING.md): (b = 0.25, h = 1, g = 9.81).
"""

import math

import numpy as np
import pytest

import rocking as rk
from rocking import conventions
from rocking.dynamics import SpaceBatchSettings
from rocking.dynamics.rolling import SpatialBody, SpatialStart, attitude, fast_engine
from rocking.dynamics.rolling.batch import batch_in_space
from rocking.dynamics.rolling.fast_engine import steps_of
from rocking.dynamics.rolling.ground import ground_of
from rocking.errors import InvalidValueError

pytestmark = [
    pytest.mark.verifies(room="rocking in space"),
    pytest.mark.skipif(not fast_engine.available(), reason="the batch engine was not built"),
]

G = 9.81
RADIUS, HEIGHT = 0.25, 1.0
CYLINDER = SpatialBody.cylinder(2.0 * RADIUS, 2.0 * HEIGHT)


def _tilts(theta, rate, spin, duration=2.0):
    """Tilts of a wobble with precession `rate` [rad/s] and `spin` about its own axis, over some seconds."""
    axis = np.array([math.sin(theta), 0.0, math.cos(theta)])
    velocity = rate * np.array([0.0, 0.0, 1.0]) + (spin - rate * math.cos(theta)) * axis
    start = SpatialStart(theta, angular_velocity=tuple(velocity.tolist()))
    course = steps_of(CYLINDER, ground_of(), duration, start=start, settings=SpaceBatchSettings(gravity=G))
    return np.arccos(course["rotation"][:, 2, 2][course["time"] < duration])


@pytest.mark.verifies("closed form", "both steady wobbles of a cylinder", within="1e-8 rad", control="within")
@pytest.mark.parametrize(
    ("theta", "still", "circling"),
    [
        (0.05, 10.70164812017945, 5.356640038471763),
        (0.1, 6.611781509202098, 3.256231580927705),
        (0.02, 18.04554843342824, 9.11987805688183),
    ],
)
def test_steady_wobbles_keep_their_tilt(theta, still, circling):
    """Both exact steady wobbles, with the centre at rest and round a circle, keep their tilt to 1e-8 rad."""
    for rate, spin in (
        (still, HEIGHT / RADIUS * still * math.sin(theta)),
        (circling, circling * (math.cos(theta) - 1.0)),
    ):
        assert np.abs(_tilts(theta, rate, spin) - theta).max() < 1e-8
        # negative control: 1 % off, and it nods
        assert np.abs(_tilts(theta, 1.01 * rate, 1.01 * spin) - theta).max() > 1e-3 * theta


@pytest.mark.verifies("invariant", "energy", within="1e-11")
def test_energy_stays_while_it_rolls():
    """Two seconds of rolling without slip on ground at rest: energy to 1e-11."""
    start = SpatialStart(0.1, 0.3, angular_velocity=(0.2, 0.1, 0.6))
    course = steps_of(CYLINDER, ground_of(), 2.0, start=start)
    course = course[course["kind"] == -1]
    assert set(course["contact"]) == {3.0}
    up, w = course["rotation"][:, 2], course["velocity"]
    low = -RADIUS * up[:, :2] / np.linalg.norm(up[:, :2], axis=1)[:, None]
    arm = CYLINDER.centre - np.column_stack([low, np.zeros(len(low))])
    speed = np.cross(w, arm)
    energy = 0.5 * np.einsum("na,ab,nb->n", w, CYLINDER.inertia, w) + 0.5 * CYLINDER.mass * np.square(speed).sum(axis=1)
    energy += CYLINDER.mass * conventions.g * (up * arm).sum(axis=1)
    assert np.ptp(energy) < 1e-11 * energy.max()


@pytest.mark.slow
@pytest.mark.verifies("second engine", "the reference engine in space", within="1e-7")
@pytest.mark.parametrize("spin", [(0.0, 0.0, 0.4), (0.3, -0.2, 0.5)])
def test_free_rolling_is_that_of_the_reference_engine(spin):
    """Attitudes over four seconds of rolling, by two engines, to 1e-7."""
    start = {"tilt": 0.1, "azimuth": 0.3, "angular_velocity": spin}
    slow = rk.free_rocking(CYLINDER, restitution="housner", start=SpatialStart(**start), duration=4.0)
    course = steps_of(CYLINDER, ground_of(), 4.0, start=SpatialStart(**start))
    course = course[(course["kind"] == -1) & (course["time"] < 4.0)]
    assert np.abs(slow.at(course["time"]).rotation - course["rotation"]).max() < 1e-7
    assert attitude.tilt(slow.quaternion).max() > 0.05


@pytest.mark.slow
@pytest.mark.verifies(
    "second engine", "the reference engine in space", within="1e-12 s of the uplift, 1e-3 rad of the direction"
)
def test_a_pulse_throws_a_cylinder_over_as_the_reference_engine_says():
    """A strong pulse along x and y: outcome and uplift by both engines; direction of the fall to 1e-3 rad."""
    pulse = rk.pulses.sine(amplitude=9.0, period=0.8)
    batch = {name: batch_in_space(CYLINDER, (pulse, pulse.scaled(0.5)), engine=name) for name in ("fast", "reference")}
    assert batch["fast"].outcome.item() == batch["reference"].outcome.item()
    assert batch["fast"].overturned.item()
    uplift, direction = ([one[name].item() for one in batch.values()] for name in ("first_uplift", "direction"))
    assert uplift[0] == pytest.approx(uplift[1], abs=1e-12)
    assert direction[0] == pytest.approx(direction[1], abs=1e-3)


@pytest.mark.verifies("damage", "a law that a rim cannot have")
def test_ked_by_points_on_a_rim_is_refused_in_words():
    """KED by points needs moments of the landing point, and a rim has any number of them."""
    with pytest.raises(InvalidValueError, match="does not apply to a round base"):
        batch_in_space(CYLINDER, restitution="ked-3d-point", start=SpatialStart(0.1))


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "the coefficient of the cylinder over its diameter, 15 digits", within="1e-7")
def test_ked_on_a_rim_is_that_of_the_plane():
    """A cylinder let go over its rim falls flat on the far side: REF to 1e-7 at three impacts, both engines."""
    body, start = SpatialBody.cylinder(1.0, 4.0), {"tilt": 0.08, "azimuth": 0.7}
    slow = rk.free_rocking(body, start=SpatialStart(**start), duration=2.5, restitution="ked")
    course = steps_of(body, ground_of(), 2.5, "ked-3d", start=SpatialStart(**start))
    hits = course[course["kind"] == 1]
    for ratio in (hits["after"] / hits["before"], slow.impacts["energy_after"] / slow.impacts["energy_before"]):
        # the rim rolls down to tilts of 1e-11, where rounding turns the last bit of the motion sideways
        np.testing.assert_allclose(np.sqrt(ratio[:3]), 0.9501165798529068, rtol=1e-7)


@pytest.mark.slow
@pytest.mark.verifies("second engine", "the reference engine in space", within="as many impacts")
@pytest.mark.parametrize("share", [0.3, 0.75])
def test_a_round_base_that_is_pushed_comes_to_rest(share):
    """Pushed by a share of what tips it, it lies still after as many impacts as in the reference engine."""
    push = rk.GroundMotion(np.full(101, share * G * RADIUS / HEIGHT), 0.01)
    batch = batch_in_space([CYLINDER], [push], [0.2], start=SpatialStart(0.02), settings=SpaceBatchSettings(gravity=G))
    slow = rk.simulate(CYLINDER, push, 0.2, start=SpatialStart(0.02), gravity=G)
    assert slow.impacts.size > 3
    assert batch.values["impacts"].item() == slow.impacts.size
    assert not batch.still_rocking.item()
    assert not slow.still_rocking
