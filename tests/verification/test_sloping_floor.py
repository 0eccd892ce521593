"""Plane bodies on a sloping floor: closed forms, constant accelerations on a level floor, vectors in the world."""

import cmath
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import rocking as rk
from rocking.bodies.formats.body_file import body_to_toml
from rocking.dynamics.plane.equations import EventKind
from rocking.errors import InvalidValueError

pytestmark = pytest.mark.verifies(room="rocking in the plane")

G, SLOPE = 9.81, 0.05
BLOCK = rk.Block(width=0.5, height=2.0, mass=500.0)
SKEW = rk.Block(width=0.6, height=2.0, mass=500.0, centre=(0.22, 0.9), moment_of_inertia=170.0)
ENGINES = ("reference", "fast")
OPTIONS = {"restitution": "housner", "gravity": G}


def on_slope(body=SKEW, *restraints, slope=SLOPE):
    return rk.Restrained(body, restraints, floor_slope=slope)


def angle_of(body, sign):
    """Return the rotation from the floor at which the centre of mass is above the foot."""
    return body.side("right" if sign > 0 else "left", G).slenderness_angle + sign * SLOPE


def record(seed=2, strength=5.0, step=0.01):
    rng = np.random.default_rng(seed)
    return rk.GroundMotion(strength * np.convolve(rng.standard_normal(400), np.ones(8) / 8.0, "same"), step)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.verifies("closed form", "g tan of the shifted angle", within="1e-12", control="test_the_slope_is_seen")
def test_uplift_of_each_side(engine, sign):
    """Under a ground acceleration that increases in proportion to time, the body lifts at g tan(alpha +- slope)."""
    ramp = rk.GroundMotion(-sign * np.linspace(0.0, 6.0, 601), 0.01)
    response = rk.simulate(on_slope(), ramp, engine=engine, duration=6.0, **OPTIONS)
    assert response.trajectory.events[0].side == sign
    assert response.uplifts[0] == pytest.approx(G * math.tan(angle_of(SKEW, sign)), rel=1e-12)
    curve = rk.pushover(on_slope(), [0.0, sign * 1e-9], gravity=G)
    assert curve.balancing_acceleration[0] == pytest.approx(-sign * G * math.tan(angle_of(SKEW, sign)), rel=1e-8)


@pytest.mark.verifies("negative control")
def test_the_slope_is_seen():
    """Negative control: the opposite slope has another uplift."""
    ramp = rk.GroundMotion(-np.linspace(0.0, 6.0, 601), 0.01)
    opposite = rk.simulate(on_slope(slope=-SLOPE), ramp, duration=6.0, **OPTIONS)
    assert abs(opposite.uplifts[0] - G * math.tan(angle_of(SKEW, 1))) > 0.5


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.verifies("closed form", "the centre of mass above the foot", within="1e-9")
def test_static_overturning_angle(engine, sign):
    """Released at rest just below the angle alpha +- slope the body returns, just above it overturns."""
    angle = angle_of(SKEW, sign)
    for factor, overturns in ((1.0 - 1e-9, False), (1.0 + 1e-9, True)):
        response = rk.free_rocking(on_slope(), sign * factor * angle, engine=engine, duration=30.0, **OPTIONS)
        assert (response.trajectory.side == sign and response.impacts.size == 0) is overturns
        assert (response.impacts.size > 0) is not overturns


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.verifies("closed form", "Housner's quarter period with the shifted angle", within="1e-12")
def test_quarter_period(engine, sign):
    """Slender bodies: T/4 = acosh(1 / (1 - theta0 / (alpha +- slope))) / p."""
    angle, p = angle_of(SKEW, sign), SKEW.side("right" if sign > 0 else "left", G).frequency_parameter
    response = rk.free_rocking(on_slope(), sign * 0.4 * angle, linear=True, engine=engine, duration=3.0, **OPTIONS)
    assert response.impacts["time"][0] == pytest.approx(math.acosh(1.0 / 0.6) / p, rel=1e-12)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.verifies("computed anew", "a level floor with constant accelerations", within="1e-12")
def test_a_slope_is_a_constant_acceleration(engine):
    """Accelerations g sin(slope) along the floor and g (cos(slope) - 1) normal to the floor give the same response."""
    items = [rk.Tendon(x=0.3, stiffness=2e5, prestress=1e3), rk.ViscousDamper(x=0.0, length=0.4, coefficient=2e3)]
    first = rk.free_rocking(on_slope(SKEW, *items), 0.08, engine=engine, duration=2.5, **OPTIONS)
    ones, step = np.ones(300), first.time[1]
    along = rk.GroundMotion(G * math.sin(SLOPE) * ones, step)
    normal = rk.GroundMotion(G * (math.cos(SLOPE) - 1.0) * ones, step)
    level = rk.Restrained(SKEW, items)
    second = rk.simulate(level, {"x": along, "z": normal}, rotation=0.08, engine=engine, duration=2.5, **OPTIONS)
    count = min(first.time.size, second.time.size) - 1
    assert count > 40
    assert np.max(np.abs(first.rotation[:count] - second.rotation[:count])) < 1e-12
    for name in ("horizontal_force", "vertical_force", "base_shear", "overturning_moment"):
        one, two = (getattr(response.forces, name)[1:count] for response in (first, second))
        assert np.max(np.abs(one - two)) < 1e-9 * 500.0 * G


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("rotation", [0.1, -0.07])
@pytest.mark.verifies("computed anew", "vectors in the world by Dormand-Prince", within="1e-10")
def test_vectors_in_the_world(engine, rotation):
    """First impact and forces of the floor on a slope, with a spring, under a horizontal and a vertical motion.

    All points are complex numbers in the world, with the floor rotated; gravity and motion are not rotated.
    """
    spring = rk.Spring(ground=(-0.8, 1.5), point=(0.0, 1.4), stiffness=4e3)
    ramps = {
        "x": rk.GroundMotion(np.linspace(2.0, -1.0, 101), 0.01),
        "z": rk.GroundMotion(np.linspace(1.5, -2.0, 101), 0.01),
    }
    body = on_slope(SKEW, spring)
    response = rk.simulate(body, ramps, rotation=rotation, engine=engine, duration=1.0, **OPTIONS)
    floor, foot = cmath.exp(1j * SLOPE), 0.6 if rotation > 0 else 0.0
    centre, point, anchor = complex(0.22, 0.9) - foot, complex(0.0, 1.4) - foot, complex(-0.8, 1.5) - foot
    inertia, length = 170.0 + 500.0 * abs(centre) ** 2, abs(point - anchor)

    def ground(t):
        return complex(2.0 - 3.0 * t, 1.5 - 3.5 * t)

    def torque(force, arm):  # clockwise
        return (force * arm.conjugate()).imag * -1.0

    def acceleration(t, theta):
        turn = floor * cmath.exp(-1j * theta)
        cord = anchor * floor - point * turn
        pull = 4e3 * (abs(cord) - length) * cord / abs(cord)
        weight = -500.0 * (ground(t) + 1j * G)
        return (torque(weight, centre * turn) + torque(pull, point * turn)) / inertia, turn, pull

    lands = lambda _, state: state[0]  # noqa: E731
    lands.terminal = True
    run = solve_ivp(
        lambda t, s: (s[1], acceleration(t, s[0])[0]), (0.0, 1.0), [rotation, 0.0], "DOP853", rtol=1e-13, atol=1e-15,
        events=lands, dense_output=True, max_step=0.01,
    )  # fmt: skip
    impact = next(e for e in response.trajectory.events if e.kind is EventKind.IMPACT)
    assert run.t[-1] == pytest.approx(impact.time, abs=1e-10)
    assert run.y[1, -1] == pytest.approx(impact.before, abs=1e-10)
    for k in range(2, int(impact.time / response.time[1]), 7):
        theta, rate = run.sol(response.time[k])
        second, turn, pull = acceleration(response.time[k], theta)
        moved = (-1j * second - rate**2) * centre * turn  # acceleration of the centre of mass relative to the ground
        force = (500.0 * (moved + ground(response.time[k]) + 1j * G) - pull) / floor  # along and normal to the floor
        assert response.rotation[k] == pytest.approx(theta, abs=1e-10)
        assert response.forces.horizontal_force[k] == pytest.approx(force.real, abs=1e-5)
        assert response.forces.vertical_force[k] == pytest.approx(force.imag, abs=1e-5)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.verifies("invariant", "energy, weight and the mirror image", within="1e-12")
def test_energy_weight_and_mirror_image(engine):
    """Energy closes, the floor carries m g at rest in its axes, and the mirror image has the opposite rotation."""
    wall = {"stiffness": 4e4, "damping": 300.0, "gap": 0.01}
    first = rk.simulate(on_slope(SKEW, rk.Wall(side="left", **wall)), record(), engine=engine, **OPTIONS)
    assert first.peak_rotation > 0.005
    assert first.energy_closure < 1e-12
    sine, cosine, push = math.sin(SLOPE), math.cos(SLOPE), first.ground_acceleration[0]
    assert first.forces.horizontal_force[0] == pytest.approx(500.0 * (G * sine + push * cosine), rel=1e-12)
    assert first.forces.vertical_force[0] == pytest.approx(500.0 * (G * cosine - push * sine), rel=1e-12)
    mirrored = rk.Block(width=0.6, height=2.0, mass=500.0, centre=(0.38, 0.9), moment_of_inertia=170.0)
    second = rk.simulate(
        on_slope(mirrored, rk.Wall(side="right", **wall), slope=-SLOPE), record(), engine=engine, scale=-1.0, **OPTIONS
    )
    assert np.max(np.abs(first.rotation + second.rotation)) < 1e-12


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.verifies("invariant", "the level floor", within="1e-12")
def test_no_slope_changes_nothing(engine):
    """A slope of 0: the response of the body without restraints; a slope of 1e-6 changes it in proportion."""
    pulse = rk.pulses.sine(4.0, 0.9)
    alone = rk.simulate(SKEW, pulse, duration=3.0, **OPTIONS)
    level, slight = (rk.simulate(on_slope(slope=s), pulse, engine=engine, duration=3.0, **OPTIONS) for s in (0.0, 1e-6))
    count = min(alone.time.size, level.time.size)
    assert alone.peak_rotation > 0.05
    assert np.max(np.abs(level.rotation[:count] - alone.rotation[:count])) < 1e-11
    assert 1e-8 < np.max(np.abs(level.rotation - slight.rotation)) < 1e-4


@pytest.mark.verifies("second engine", "single histories", within="1e-12")
def test_many_and_maps():
    """Batches, the overturning acceleration and maps of a study use the slope."""
    body, motion = on_slope(), rk.pulses.sine(1.0, 0.8)
    many = rk.simulate_many(body, motion, scale=[2.0, 4.0, 6.0], restitution=["housner"], gravity=G)
    for k, scale in enumerate((2.0, 4.0, 6.0)):
        single = rk.simulate(body, motion, scale=scale, **OPTIONS)
        assert many["peak_rotation"].values.ravel()[k] == pytest.approx(single.trajectory.peak_rotation, rel=1e-12)
    smallest = [
        rk.fragility(
            on_slope(slope=s), [motion], [1.0, 2.0, 3.0], limit_states=[1e-9], restitution="housner", gravity=G
        )
        for s in (SLOPE, 0.0)
    ]
    # the left side lifts at g tan(alpha_left - slope), about 1.9 m/s2 instead of 2.4 m/s2
    lifts = [curves["exceeded"].values.reshape(-1, 3)[0].tolist() for curves in smallest]
    limit = G * math.tan(angle_of(SKEW, -1))
    assert 1.0 < limit < 2.0
    assert lifts[0] == [0, 1, 1]
    assert lifts[1] == [0, 0, 1]


@pytest.mark.verifies("behaviour")
def test_doors(tmp_path):
    """Files, answers, pictures, reports and refusals of slopes."""
    rk.free_rocking(on_slope(), 0.05, **OPTIONS).report(tmp_path / "slope.html")
    body = on_slope(SKEW, rk.Tendon(x=0.3, stiffness=1e5))
    path = tmp_path / "body.toml"
    for subject in (body, on_slope()):
        path.write_text(body_to_toml(subject))
        assert rk.read_body(path) == subject
    assert rk.free_rocking(body, 0.02, **OPTIONS).answer()["body"]["floor_slope"] == SLOPE
    left = SKEW.side("left").slenderness_angle
    for slope in (left, -SKEW.side("right").slenderness_angle, math.nan):
        with pytest.raises(InvalidValueError) as refused:
            on_slope(slope=slope)
        assert refused.value.parameter == "floor_slope"
    limit = brentq(lambda s: math.tan(left - s), 0.1, 0.5)  # uplift acceleration 0
    assert limit == pytest.approx(left, abs=1e-9)
    assert on_slope(slope=0.999 * limit).floor_slope < left
