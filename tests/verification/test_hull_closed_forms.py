"""The reference engine of a body on its hull against closed forms: time of overturning, friction along an edge."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.spatial.transform import Rotation

import rocking as rk
from rocking.bodies.solid import Solid, box
from rocking.dynamics import SpatialStart
from rocking.dynamics.frictional import histories
from rocking.dynamics.frictional.body import HullBody
from rocking.dynamics.frictional.contact_problem import HullContact, Problem, linear, outline, solve, valid
from rocking.dynamics.frictional.engine import HullEngine
from rocking.dynamics.frictional.ground import (
    HullGround,
    added,
    applied,
    back,
    cross,
    dot,
    frame,
    length,
    product,
    scaled,
)
from rocking.dynamics.frictional.histories import hull_histories, results_of, start_of
from rocking.dynamics.frictional.history import HullHistory
from rocking.dynamics.frictional.motion import levelled, point_velocity, standing
from rocking.dynamics.frictional.settings import HullSettings
from rocking.motions import GroundMotion
from rocking.outcome import Outcome

pytestmark = pytest.mark.verifies(room="rocking in space")

G = rk.conventions.g


def pushed(body, speed):
    """The standing body with an angular velocity about the edge of its base at the largest x, which is at rest."""
    state = standing(body)
    axes = frame(state.attitude)
    points = [applied(axes, p) for p in body.points]
    edge = max(points, key=lambda p: (round(p[0] - p[2], 9), p[1]))
    spin = (0.0, speed, 0.0)
    return state._replace(spin=back(axes, spin), velocity=cross(spin, scaled(-1.0, edge)))


@pytest.mark.slow
@pytest.mark.verifies("closed form", "quadrature of the energy integral", within="1e-5", control="within")
@pytest.mark.parametrize("push", [1.02, 1.3])
@pytest.mark.parametrize("offset", [-0.1, 0.15])
def test_a_pushed_block_overturns_when_its_centre_is_above_the_edge(push, offset):
    """An eccentric block with an initial velocity: t is the integral of 1 / theta' from 0 to the slenderness angle.

    Energy gives the speed, theta'^2 = w^2 - 2 m g R (cos(alpha - theta) - cos(alpha)) / I. The control takes the other
    side of the body.
    """
    width, height, mass = 0.8, 2.4, 700.0
    solid = Solid(box(width, 0.7, height), mass=mass)
    inertia = solid.local_moments.inertia
    corners = [(x, y, z) for x in (-0.4, 0.4) for y in (-0.35, 0.35) for z in (0.0, height)]
    body = HullBody(corners, mass, (offset, 0.0, 1.1), inertia)

    def passing(lever):
        alpha, radius = math.atan2(lever, 1.1), math.hypot(lever, 1.1)
        about = inertia[1, 1] + mass * radius**2
        barrier = 2.0 * mass * G * radius * (1.0 - math.cos(alpha)) / about
        square = push**2 * barrier

        def slowness(theta):
            rise = 2.0 * mass * G * radius * (math.cos(alpha - theta) - math.cos(alpha)) / about
            return 1.0 / math.sqrt(square - rise)

        return math.sqrt(square), quad(slowness, 0.0, alpha, epsrel=1e-12)[0]

    speed, wanted = passing(0.4 - offset)
    found = HullEngine(body, HullGround(), settings=HullSettings(tolerance=1e-13)).run(pushed(body, speed), 0.1)
    assert found.outcome is Outcome.OVERTURNED
    assert found.overturning_time == pytest.approx(wanted, rel=1e-5)
    assert found.overturning_time != pytest.approx(passing(0.4 + offset)[1], rel=1e-3)


def edge_of(rng):
    """Return a body that leans on an edge under a random field, and the two vertices of the edge."""
    points = [(x, y, z) for x in (-0.3, 0.5) for y in (-0.4, 0.25) for z in (0.0, 1.1)]
    inertia = np.diag(rng.uniform(30.0, 60.0, 3))
    body = HullBody(points, 300.0, (0.02, rng.uniform(-0.25, 0.15), 0.5), inertia)
    state = standing(body, tilt=0.2, azimuth=0.0)
    axes = frame(state.attitude)
    heights = [dot(axes[2], p) for p in body.points]
    edge = tuple(i for i, h in enumerate(heights) if h < min(heights) + 1e-9)
    field = (*rng.uniform(-4.0, 4.0, 2), -G)
    turned = back(axes, field)
    return Problem(body, axes, turned, (0.0, 0.0, 0.0), rng.uniform(0.3, 1.0)), edge


def cones(problem, edge, found):
    """Return the room along the edge in each cone; None where the force across leaves none."""
    a, b = (problem.body.points[i] for i in edge)
    along = scaled(1.0 / length(added(b, -1.0, a)), added(b, -1.0, a))
    across = {i: added(pull, -dot(pull, along), along) for i, pull in found.pulls.items()}
    squares = [(problem.friction * found.normals[i]) ** 2 - dot(across[i], across[i]) for i in edge]
    total = sum(dot(found.pulls[i], along) for i in edge)
    return along, squares, total


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "whether the cones of both ends hold the sum along an edge", within="0 of 400",
                      control="within")  # fmt: skip
def test_an_edge_sticks_wherever_some_forces_hold_it():
    """Only the sum along an edge is known: the engine's shares obey Coulomb's law wherever any shares do.

    The control shares the sum as the normal forces are shared: edges slide that forces could hold.
    """
    rng = np.random.default_rng(256)
    held = missed = 0
    for _ in range(400):
        problem, edge = edge_of(rng)
        assert len(edge) == 2
        found = linear(problem, HullContact(edge, edge), list(edge), {})
        if found is None or min(found.normals.values()) <= 0.0:
            continue
        along, squares, total = cones(problem, edge, found)
        possible = False
        if min(squares) > 0.0:
            room = np.sqrt(squares)
            possible = abs(total) <= room.sum()
        assert valid(problem, found, edge, 1e-9 * G) == possible
        held += possible
        weights = [found.normals[i] for i in edge]
        plain = [total * w / sum(weights) for w in weights]
        missed += possible and any(part**2 > square for part, square in zip(plain, squares, strict=True))
        # the parts take the same share of the room in both cones
        if possible:
            shares = [dot(found.pulls[i], along) / r for i, r in zip(edge, room, strict=True)]
            assert shares[0] == pytest.approx(shares[1], rel=1e-9, abs=1e-12)
    assert 50 < held < 350
    assert missed > 5


def tower():
    """An asymmetric body on a base of five corners."""
    base = np.array([[-0.2, -0.15], [0.25, -0.2], [0.3, 0.1], [0.05, 0.25], [-0.15, 0.2]])
    points = np.concatenate([np.column_stack([base, np.zeros(5)]), np.column_stack([1.2 * base, np.full(5, 1.1)])])
    return HullBody(points, 200.0, (0.03, -0.02, 0.5), np.diag([25.0, 22.0, 8.0]))


@pytest.mark.verifies("computed anew", "rotations of SciPy", within="1e-14", control="within")
def test_quaternions_turn_one_after_the_other():
    """The product of two quaternions is the rotation by the second and then by the first; not the other way round."""
    rng = np.random.default_rng(80)
    for _ in range(20):
        one, two = (Rotation.from_rotvec(rng.normal(size=3)) for _ in range(2))
        p, q = (tuple(np.roll(each.as_quat(), 1).tolist()) for each in (one, two))
        found = Rotation.from_quat(np.roll(product(p, q), -1))
        assert (found.inv() * one * two).magnitude() < 1e-14
        assert (found.inv() * two * one).magnitude() > 1e-3


@pytest.mark.verifies("invariant", "vertices of one height, no turn about the vertical", within="1e-12")
@pytest.mark.parametrize("corners", [2, 3, 5])
def test_drift_out_of_a_plane_is_turned_back(corners):
    """An edge or a facet that is off the level by 1e-5 is turned onto it about a level axis."""
    body = tower()
    for turned in ((1e-5, 0.0, 0.0), (-4e-6, 7e-6, 0.0), (0.0, -1e-5, 0.0)):
        start = Rotation.from_rotvec(turned)
        attitude = tuple(np.roll(start.as_quat(), 1).tolist())
        members = tuple(i for i, p in enumerate(body.points) if p[2] < 0.0)[:corners]
        assert len(members) == corners
        found = levelled(body, levelled(body, attitude, members), members)
        axes = frame(found)
        heights = [applied(axes, body.points[i])[2] for i in members]
        assert np.ptp(heights) < 1e-12
        change = Rotation.from_quat(np.roll(found, -1)) * start.inv()
        assert abs(change.as_rotvec()[2]) < 1e-9
        assert change.magnitude() < 1.5e-5


@pytest.mark.verifies("invariant", "the lowest vertex of a start is at rest on the ground", within="1e-12")
@pytest.mark.parametrize("spin", [(0.3, 0.0, 0.0), (0.0, -0.4, 0.0), (0.0, 0.0, 0.5), (0.3, -0.4, 0.5)])
def test_the_lowest_vertex_of_a_start_is_at_rest(spin):
    """At the start the lowest vertex is on the ground and has no velocity."""
    body = tower()
    state = start_of(body, SpatialStart(tilt=0.2, azimuth=0.7, yaw=0.4, angular_velocity=spin))
    axes = frame(state.attitude)
    heights = [state.position[2] + dot(axes[2], p) for p in body.points]
    low = int(np.argmin(heights))
    assert heights[low] == pytest.approx(0.0, abs=1e-12)
    assert length(point_velocity(body, state, low)) < 1e-12
    assert length(state.spin) == pytest.approx(math.hypot(*spin), rel=1e-12)
    assert max(length(point_velocity(body, state, i)) for i in range(len(heights))) > 0.01


@pytest.mark.verifies("closed form", "hypotenuse of 3 and 4", within="1e-15")
def test_a_body_is_displaced_by_the_straight_distance():
    """The displacement of a history is the horizontal distance between its ends."""
    history, start = HullHistory(), standing(tower())
    history.states = [start._replace(position=(1.0, 2.0, 0.5)), start._replace(position=(4.0, 6.0, 0.7))]
    history.time = [0.0, 1.0]
    assert 5.0 in results_of(history)[0]


@pytest.mark.verifies("closed form", "statics of a base that pushes where a linear pressure is above zero",
                      within="1e-9", control="within")  # fmt: skip
@pytest.mark.parametrize("corners", [6, 12, 40])
def test_a_base_presses_only_where_its_pressure_pushes(corners):
    """A prism pulled aside: normal forces hold weight and moment, are linear where they push, and none pulls.

    The control takes one linear pressure over all corners, which pulls at those behind.
    """
    turn = np.linspace(0.0, 2.0 * np.pi, corners, endpoint=False)
    ring = np.column_stack([0.5 * np.cos(turn), 0.4 * np.sin(turn)])
    points = np.concatenate([np.column_stack([ring, np.full(corners, z)]) for z in (0.0, 1.0)])
    mass, height = 200.0, 0.5
    body = HullBody(points, mass, (0.03, -0.02, height), np.diag([25.0, 22.0, 8.0]))
    axes = frame(standing(body).attitude)
    heights = [dot(axes[2], p) for p in body.points]
    touching = tuple(i for i, h in enumerate(heights) if h < min(heights) + 1e-9)
    assert len(touching) == corners
    for pull in ((5.5, 0.0), (-5.0, 3.0), (1.0, -5.5)):
        problem = Problem(body, axes, back(axes, (*pull, -G)), (0.0, 0.0, 0.0), math.inf)
        members = outline(problem, touching)
        contact = HullContact(members, members)
        found = solve(problem, contact, {})
        normal = np.array([found.normals[i] for i in members])
        place = np.array([[dot(axis, body.points[i]) for axis in axes[:2]] for i in members])
        assert length(found.linear) < 1e-9 * G
        assert normal.sum() == pytest.approx(mass * G, rel=1e-9)
        np.testing.assert_allclose(normal @ place, mass * height * np.array(pull), rtol=1e-9, atol=1e-9 * mass * G)
        assert normal.min() >= 0.0
        pushes = normal > 0.0
        if pushes.sum() > 3:
            table = np.column_stack([np.ones(corners), place])
            linear_pressure = table @ np.linalg.lstsq(table[pushes], normal[pushes])[0]
            np.testing.assert_allclose(linear_pressure[pushes], normal[pushes], atol=1e-9 * mass * G)
            assert (linear_pressure[~pushes] < 1e-9 * mass * G).all()
        plain = linear(problem, contact, list(members), {})
        assert min(plain.normals.values()) < -0.01 * mass * G / corners


def shaken_tower(size, gravity, scale, engine):
    """Peak tilt, sliding over size, times over sqrt(size g / gravity), and all, of a tower that slides."""
    pace = math.sqrt(size * G / gravity)
    time, body = 0.02 * np.arange(36), tower()
    x, y = (GroundMotion(a * scale * gravity / G * np.sin(w * time), 0.02 * pace) for a, w in ((5.5, 9.0), (3.0, 6.0)))
    inertia = size**5 * np.diag([25.0, 22.0, 8.0])
    body = HullBody(size * np.array(body.vertices), body.mass * size**3, size * np.array([0.03, -0.02, 0.5]), inertia)
    ground = HullGround(x, y, gravity=gravity)
    batch = hull_histories(body, ground, 0.8, 0.45, engine=engine)
    names = "peak_tilt", "sliding_distance", "peak_time", "first_uplift", "outcome", "steps"
    found = {name: batch[name].item() for name in names}
    lasts = [found["peak_time"] / pace, found["first_uplift"] / pace]
    return np.array([found["peak_tilt"], found["sliding_distance"] / size, *lasts]), found


@pytest.mark.slow
@pytest.mark.verifies("invariant", "similar bodies under similar motions", within="1e-7", control="within")
def test_similar_bodies_rock_alike():
    """A tower of another size, or on another planet, moves alike in times of sqrt(size / g), by either engine.

    The control is a motion of 1 % more.
    """
    plain, first = shaken_tower(1.0, G, 1.0, "reference")
    assert first["outcome"] == Outcome.ROCKED_AND_SLID.code
    for size, gravity in ((1e-4, G), (1e4, G), (1.0, 0.5)):
        similar, other = shaken_tower(size, gravity, 1.0, "reference")
        np.testing.assert_allclose(similar, plain, rtol=1e-7)
        assert other["steps"] == pytest.approx(first["steps"], rel=0.02)  # rounding adds or spares one or two
    assert np.abs(shaken_tower(1.0, G, 1.01, "reference")[0] / plain - 1.0).max() > 1e-3
    if histories.available():
        compiled, other = shaken_tower(1.0, G, 1.0, "fast")
        np.testing.assert_allclose(compiled, plain, rtol=1e-7)
        # each engine has its own way to try a step again
        assert other["steps"] == pytest.approx(first["steps"], rel=0.2)
