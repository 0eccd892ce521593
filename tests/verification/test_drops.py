"""Solids with friction that start in the air or in motion: closed forms of flight and of the first landing."""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.bodies.solid import Solid, box
from rocking.dynamics import SpatialStart
from rocking.dynamics.frictional import histories
from rocking.dynamics.frictional.body import HullBody
from rocking.errors import InvalidValueError

pytestmark = pytest.mark.verifies(room="sliding, hopping and flight")
needs_engine = pytest.mark.skipif(not histories.available(), reason="the compiled engine was not built")
G = rk.conventions.g
SECTION = rk.Section([rk.Region([(0.0, 0.0), (0.5, 0.0), (0.4, 1.1), (0.05, 1.3)], 2400.0)], depth=0.6)
ENGINES = ["reference", pytest.param("fast", marks=needs_engine)]


def _body() -> Solid:
    """A solid without a plane of symmetry across x, its centre beside the middle of its base."""
    return Solid.from_section(SECTION)


@pytest.mark.verifies("closed form", "a flat drop: time of the fall, energy at the landing", within="1e-9")
@pytest.mark.parametrize("engine", ENGINES)
def test_a_body_that_is_dropped_flat_lands_after_the_time_of_a_fall(engine):
    """It falls for sqrt(2 h / g), lands with m g h, and rests: a plastic landing on the whole base loses all of it."""
    solid, height = _body(), 0.03
    start = SpatialStart(height=height)
    found = rk.free_rocking(solid, restitution="housner", friction=0.6, start=start, engine=engine, duration=0.3)
    assert found.outcome is rk.Outcome.FLEW
    assert found.impacts.size == 1
    assert found.impacts["time"][0] == pytest.approx(math.sqrt(2.0 * height / G), rel=1e-9)
    assert found.impacts["energy_before"][0] == pytest.approx(solid.mass * G * height, rel=1e-9)
    assert found.impacts["energy_after"][0] == pytest.approx(0.0, abs=1e-9)
    assert found.centre[-1, 2] == pytest.approx(solid.centre[2] - solid.ground, rel=1e-9)


@pytest.mark.slow
@pytest.mark.verifies("closed form", "a tilted drop: angular momentum about the edge that lands is kept", within="1e-8")
@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_tilted_drop_lands_on_an_edge(engine, side):
    """The edge stops with all its momentum: what is left turns about it, (m v x)^2 / (2 I), x its lever."""
    solid, height, tilt = _body(), 0.02, 0.11
    start = SpatialStart(tilt=tilt, azimuth=0.0 if side > 0.0 else math.pi, height=height)
    found = rk.free_rocking(solid, restitution="housner", friction=5.0, start=start, engine=engine, duration=0.1)
    (x, z), (left, right) = SECTION.centre, SECTION.feet
    b, h = (right - x if side > 0.0 else x - left), z
    lever = b * math.cos(tilt) - h * math.sin(tilt)
    speed = math.sqrt(2.0 * G * height)
    inertia = solid.inertia[1, 1] + solid.mass * (b**2 + h**2)
    left_over = (solid.mass * speed * lever) ** 2 / (2.0 * inertia)
    assert found.impacts["energy_after"][0] == pytest.approx(left_over, rel=1e-8)
    assert found.impacts["energy_after"][0] < 0.5 * found.impacts["energy_before"][0]


@pytest.mark.slow
@pytest.mark.verifies("closed form", "a launch: parabola of the centre, momentum kept in flight", within="1e-9")
@pytest.mark.parametrize("engine", ENGINES)
def test_a_launched_body_flies_along_a_parabola(engine):
    """The velocity is that of the lowest point, so that the centre has w x r besides; angular momentum is kept."""
    solid, spin, velocity = _body(), np.array([0.3, -0.5, 0.4]), np.array([0.4, -0.2, 1.5])
    start = SpatialStart(tilt=0.08, azimuth=0.7, angular_velocity=spin, height=0.05, velocity=velocity)
    found = rk.free_rocking(solid, restitution="housner", friction=0.6, start=start, engine=engine, duration=0.2)
    assert found.impacts.size == 0
    body = HullBody.of(solid)
    first = found.trajectory.states[0]
    axes = np.array(rk.dynamics.rolling.attitude.matrix(np.array(first.attitude)))
    places = np.array(body.points) @ axes.T
    low = places[places[:, 2].argmin()]
    assert first.position[2] + low[2] == pytest.approx(0.05, abs=1e-12)
    begin = velocity - np.cross(spin, low)
    times = found.time
    expected = np.array(first.position) + np.outer(times, begin) - np.outer(0.5 * G * times**2, [0.0, 0.0, 1.0])
    np.testing.assert_allclose(found.centre, expected, atol=1e-8)
    tensor = np.array(body.tensor)

    def momentum(state):
        turned = np.array(rk.dynamics.rolling.attitude.matrix(np.array(state.attitude)))
        return turned @ tensor @ np.array(state.spin)

    flying = [state for time, state in zip(found.trajectory.time, found.trajectory.states, strict=True) if time < 0.2]
    assert len(flying) > 1
    np.testing.assert_allclose(momentum(flying[-1]), momentum(first), rtol=1e-9)
    still = SpatialStart(tilt=0.08, azimuth=0.7, angular_velocity=spin, height=0.05)
    other = rk.free_rocking(solid, restitution="housner", friction=0.6, start=still, engine=engine, duration=0.2)
    assert not np.allclose(other.centre[: len(times)][:5], found.centre[:5], atol=1e-3)


@needs_engine
@pytest.mark.verifies("closed form", "a push along the ground", within="1e-6")
def test_a_pushed_body_slides_to_a_stop():
    """With friction below what tips it, a body at v slides v^2 / (2 mu g)."""
    low, mu, speed = Solid(box(0.8, 0.9, 0.3)), 0.3, 0.7
    start = SpatialStart(velocity=(speed, 0.0, 0.0))
    found = rk.free_rocking(low, restitution="housner", friction=mu, start=start)
    assert found.outcome is rk.Outcome.SLID
    assert found.sliding_distance == pytest.approx(speed**2 / (2.0 * mu * G), rel=1e-6)


@needs_engine
@pytest.mark.verifies("second engine", "drops in a batch", within="1e-12")
def test_a_batch_takes_the_same_starts_and_others_refuse_them():
    """Each row of a batch is the single history; a mechanics without friction refuses, with the reason."""
    solid = _body()
    starts = [SpatialStart(height=0.02), SpatialStart(tilt=0.1, height=0.05, velocity=(0.1, 0.0, -0.3))]
    still = {"x": rk.pulses.rectangular(1e-9, 1e-3)}
    table = rk.simulate_many([solid], [still], "housner", friction=0.6, start=starts, duration=0.5)
    for row, start in zip(np.ravel(table["peak_tilt"]), starts, strict=True):
        one = rk.simulate(solid, still, "housner", friction=0.6, start=start, duration=0.5)
        assert row == pytest.approx(one.peak_tilt, rel=1e-6, abs=1e-12)
    for start in starts:
        with pytest.raises(InvalidValueError, match="height and velocity of the start must be 0 without friction"):
            rk.free_rocking(solid, restitution="housner", start=start)
        with pytest.raises(InvalidValueError, match="height and velocity of the start must be 0 without friction"):
            rk.simulate_many([solid], [still], "housner", start=start)
    low, part, none = SpatialStart(height=-0.1), SpatialStart(velocity=(1.0, 2.0)), SpatialStart(height=math.nan)
    for wrong, words in ((low, "height must be"), (part, "velocity must be"), (none, "height must be")):
        with pytest.raises(InvalidValueError, match=words):
            rk.free_rocking(solid, restitution="housner", friction=0.6, start=wrong)
