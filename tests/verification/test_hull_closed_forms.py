"""The reference engine of a body on its hull against closed forms: time of overturning, friction along an edge."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

import rocking as rk
from rocking.bodies.solid import Solid, box
from rocking.dynamics.hull.body import HullBody
from rocking.dynamics.hull.contact_problem import HullContact, Problem, linear, valid
from rocking.dynamics.hull.engine import HullEngine
from rocking.dynamics.hull.ground import HullGround, added, applied, back, cross, dot, frame, length, scaled
from rocking.dynamics.hull.history import HullSettings
from rocking.dynamics.hull.motion import standing
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
