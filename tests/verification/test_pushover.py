"""Pushover of bodies with restraints: the foot at uplift, the jump at a change of the foot, energy and picture."""

import math

import mpmath as mp
import numpy as np
import pytest
from PIL import Image

import rocking as rk

pytestmark = pytest.mark.verifies(room="rocking in the plane")

G = 9.81
WIDTH, HEIGHT, MASS = 1.0, 6.0, 4000.0
WALL = rk.Block(width=WIDTH, height=HEIGHT, mass=MASS)
SKEW = rk.Block(width=1.0, height=5.0, mass=2000.0, centre=(0.35, 2.0), moment_of_inertia=3000.0)
STIFFNESS, PRESTRESS = 500e3, 20e3
TENDON = rk.Tendon(x=0.5, stiffness=STIFFNESS, prestress=PRESTRESS)
TIED = rk.Restrained(WALL, TENDON)
SLIP = 3e3
UPLIFT = MASS * G * 0.5 * WIDTH + PRESTRESS * 0.5 * WIDTH  # moment at uplift of the wall with the tendon [N m]


def potential(angle, side):
    """Return the potential energy of the wall with the tendon after a rotation about the right (1) or left foot."""
    foot = mp.mpf(WIDTH if side > 0 else 0.0)
    cosine, sine = mp.cos(angle), mp.sin(angle)

    def turned(x, z):
        return foot + (x - foot) * cosine + z * sine, -(x - foot) * sine + z * cosine

    (ground_x, ground_z), point = TENDON.ends
    x, z = turned(*map(mp.mpf, point))
    elongation = mp.hypot(x - ground_x, z - ground_z) - mp.hypot(point[0] - ground_x, point[1] - ground_z)
    height = turned(mp.mpf(0.5 * WIDTH), mp.mpf(0.5 * HEIGHT))[1]
    return MASS * G * height + PRESTRESS * elongation + STIFFNESS * elongation**2 / 2


@pytest.mark.verifies("closed form", "derivative of the potential energy", within="1e-10")
@pytest.mark.parametrize("sign", [1, -1])
def test_the_moment_is_the_derivative_of_the_energy_about_the_foot_in_contact(sign):
    """Also at the upright position, where the foot is that of the first rotation."""
    path = sign * np.linspace(0.0, 0.15, 10)
    curve = rk.pushover(TIED, path, gravity=G)
    assert curve.rotation.tolist() == path.tolist()
    with mp.workdps(30):
        exact = [float(mp.diff(lambda t: potential(t, sign), mp.mpf(angle), direction=sign)) for angle in path]
    assert curve.restoring_moment == pytest.approx(exact, rel=1e-10)
    assert exact[0] == pytest.approx(sign * UPLIFT, rel=1e-10)
    assert curve.balancing_acceleration[0] == pytest.approx(-sign * UPLIFT / (MASS * 0.5 * HEIGHT), rel=1e-12)


@pytest.mark.verifies("closed form", "moment at uplift", within="1e-12")
@pytest.mark.parametrize("path", [[0.05, 0.0, -0.05], [0.05, -0.05], [0.05, 0.0, 0.0, -0.05]])
def test_a_change_of_the_foot_is_a_jump_at_the_upright_position(path):
    """The upright position occurs once about each foot, whether or not the path contains the upright position."""
    for sign in (1, -1):
        curve = rk.pushover(TIED, sign * np.array(path), gravity=G)
        assert curve.rotation == pytest.approx([0.05 * sign, 0.0, 0.0, -0.05 * sign], abs=0.0)
        assert curve.restoring_moment[1:3] == pytest.approx([sign * UPLIFT, -sign * UPLIFT], rel=1e-12)
        assert curve.restoring_moment[3] == pytest.approx(-curve.restoring_moment[0], rel=1e-12)


@pytest.mark.verifies("closed form", "moment at uplift", within="1e-12")
def test_each_foot_of_an_asymmetric_body():
    """Each foot has its own lever arms of the weight and of the tendon."""
    body = rk.Restrained(SKEW, rk.Tendon(x=0.2, stiffness=1e5, prestress=1e4))
    right = 2000.0 * G * 0.65 + 1e4 * 0.8
    left = 2000.0 * G * 0.35 + 1e4 * 0.2
    curve = rk.pushover(body, [0.0, 0.02, 0.0, -0.02, 0.0], gravity=G)
    assert curve.rotation.tolist() == [0.0, 0.02, 0.0, 0.0, -0.02, 0.0]
    assert curve.restoring_moment[[0, 2, 3, 5]] == pytest.approx([right, right, -left, -left], rel=1e-12)
    assert rk.pushover(body, [0.0, -0.02], gravity=G).restoring_moment[0] == pytest.approx(-left, rel=1e-12)


@pytest.mark.verifies("closed form", "moment at uplift", within="1e-12")
def test_a_friction_damper_slips_at_uplift_about_each_foot():
    """The damper opposes the motion before and after the change of the foot."""
    body = rk.Restrained(WALL, rk.FrictionDamper(x=0.5, length=0.5, slip_force=SLIP))
    curve = rk.pushover(body, [0.0, 0.05, -0.05], gravity=G)
    own, damper = MASS * G * 0.5, SLIP * 0.5
    assert curve.rotation.tolist() == [0.0, 0.05, 0.0, 0.0, -0.05]
    assert curve.restoring_moment[[0, 2, 3]] == pytest.approx([own + damper, own - damper, -own - damper], rel=1e-12)
    assert curve.force[:, 0].tolist() == [SLIP, SLIP, -SLIP, SLIP, SLIP]


@pytest.mark.verifies("invariant", "no dissipation of an elastic tendon", within="exact")
@pytest.mark.parametrize("points", [7, 10, 100, 1001])
def test_rounding_is_not_dissipation(points):
    """An elastic tendon dissipates 0 J, and a fuse dissipates more than the limit of rounding."""
    up = np.linspace(0.0, 0.15, points)
    path = np.concatenate([up, up[::-1], -up, -up[::-1]])
    assert rk.pushover(TIED, path).dissipated.tolist() == [0.0]
    response = rk.simulate(TIED, rk.pulses.sine(amplitude=5.0, period=1.0))
    assert response.restraints.columns["dissipated_energy"] == [0.0]
    many = rk.simulate_many([TIED], rk.pulses.sine(amplitude=5.0, period=1.0))
    assert many.dissipated_energy.values.ravel().tolist() == [0.0]
    fuse = rk.Fuse(x=0.5, length=0.5, stiffness=2e6, yield_force=8e3)
    yielded = rk.pushover(rk.Restrained(WALL, fuse), [0.0, 0.008001])
    plastic = yielded.elongation[1, 0] - 8e3 / 2e6
    assert 0.0 < plastic < 1e-6  # m
    assert yielded.dissipated[0] == pytest.approx(8e3 * plastic, rel=1e-6)


@pytest.mark.verifies("behaviour")
def test_text_and_picture(tmp_path):
    """The text states the path and the largest moment; the picture is written to the given file."""
    curve = rk.pushover(TIED, np.linspace(0.0, 0.15, 10), gravity=G)
    assert str(curve) == (
        f"<Pushover: rotation 0 to {math.degrees(0.15):.4g} deg, largest restoring moment "
        f"{curve.restoring_moment[-1]:.4g} N m at {math.degrees(0.15):.4g} deg, 0 J dissipated>"
    )
    figure = curve.plot(tmp_path / "pushover.png")
    with Image.open(tmp_path / "pushover.png") as picture:
        assert min(picture.size) > 500
    drawn = figure.axes[0].lines[0].get_ydata()
    assert drawn == pytest.approx(1e-3 * curve.restoring_moment)


@pytest.mark.verifies("behaviour")
@pytest.mark.parametrize("rotation", [[], [[0.1]], [math.nan], [2.0]])
def test_paths_that_are_refused(rotation):
    """A path is a list of rotations below a quarter turn."""
    with pytest.raises(rk.errors.InvalidValueError, match="rotation"):
        rk.pushover(TIED, rotation)
