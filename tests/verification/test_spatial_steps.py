"""ked-3d: where the impulse acts, steps of any size, energy, pull, against REF numbers (CONTRIBUTING.md)."""

import math
import os
from itertools import pairwise

import numpy as np
import pytest

import rocking as rk
from rocking.bodies.solid import Corner, Edge, Part, Solid, box, cylinder
from rocking.dynamics import SpatialStart
from rocking.restitution.space import (
    SpatialFlag,
    SpatialImpact,
    SpatialKed,
    impact_in_space,
)
from rocking.restitution.space.impulse_position import impulse_position

pytestmark = [pytest.mark.slow, pytest.mark.verifies(room="restitution in space")]

# random steps of each body
STEPS = 4000 if os.environ.get("ROCKING_CAMPAIGN") == "1" else 1000
BENT = rk.Section.from_points([(0, 0), (1.0, 0), (0.9, 2.2), (0.5, 2.6), (0.2, 1.4)])
BODIES = {
    "bent": Solid([Part(box(0.6, 0.4, 0.3), 2400.0), Part(box(0.2, 0.3, 1.5), 2400.0).moved(0.12, 0.02, 0.3)]),
    "squat": Solid([Part(box(1.0, 1.3, 0.3)), Part(box(0.2, 0.2, 0.5), 9000.0).moved(0.3, 0.4, 0.3)]),
    "three feet": Solid(
        [Part(box(0.8, 0.8, 1.5)), Part(box(0.3, 0.3, 0.8)).moved(0.2, -0.1, 1.5)],
        base=[(-0.4, -0.3), (0.35, -0.4), (0.1, 0.4)],
    ),
}


def cross(a, b):
    """numpy's, at a tenth of its cost for single vectors."""
    (x, y, z), (u, v, w) = a.tolist(), b.tolist()
    return np.array([y * w - z * v, z * u - x * w, x * v - y * u])


def on_feet(apart):
    """A block 1 x 2 on feet some way apart."""
    return Solid(box(1.0, 1.0, 2.0), base=[(x, y) for x in (-0.5 * apart, 0.5 * apart) for y in (-0.5, 0.5)])


def over_feet(apart, model="ked-3d"):
    solid = on_feet(apart)
    start = next(i for i, edge in enumerate(solid.base.edges) if abs(edge.direction[1]) > 0.5)
    before = solid.base.edge(start)
    return impact_in_space(solid, -before.direction, pivot=before, onto=solid.base.opposite(start), model=model)


@pytest.mark.verifies("closed form", "k to 3 or 4 digits, and r of an impulse at k", within="2e-3 of k, 1e-3 of r")
@pytest.mark.parametrize(("apart", "k"), [(1.0, 0.525), (0.8, 0.621), (0.5, 1.004), (0.3, 2.10), (0.1, 15.7)])
def test_the_impulse_of_a_block_on_narrow_feet(apart, k):
    """Impulse of a block on narrow feet, REF: k before the cut; above 1 it is cut, and said: Housner's impact."""
    assert impulse_position(on_feet(apart)).at(np.array([1.0, 0.0])) == pytest.approx(k, rel=2e-3)
    assert (SpatialFlag.CUT in over_feet(apart).flags) == (k > 1.0)
    # one impulse at k of the half distance b: r = (I_C + m h^2 - m k b^2) / (I_C + m h^2 + m k b^2)
    over_base, moved = (1.0 + 4.0) / 12.0 + 1.0, min(k, 1.0) * (0.5 * apart) ** 2
    r = (over_base - moved) / (over_base + moved)
    assert over_feet(apart).coefficient == pytest.approx(r, rel=1e-9 if k > 1.0 else 1e-3, abs=0.0)


@pytest.mark.verifies("behaviour")
@pytest.mark.parametrize(("apart", "narrow"), [(0.8, False), (0.3, True)])
def test_a_history_says_where_the_base_is_too_narrow(apart, narrow):
    """All of the impacts over feet .3 apart have k above 1 and are counted, none of those over feet .8 apart."""
    found = rk.free_rocking(
        on_feet(apart), restitution="ked-3d", start=SpatialStart(0.5 * math.atan(0.5 * apart), 0.0), duration=2.0
    )
    assert found.impacts.size > 1
    assert found.cut_impacts == (found.impacts.size if narrow else 0)
    assert ("so narrow" in found.summary) == narrow
    assert (
        rk.free_rocking(on_feet(0.3), restitution="housner-3d", start=SpatialStart(0.07, 0.0), duration=2.0).cut_impacts
        == 0
    )


@pytest.mark.verifies("behaviour")
@pytest.mark.parametrize(("diameter", "narrow"), [(1.2, False), (0.3, True)])
def test_a_round_foot_may_be_too_narrow_too(diameter, narrow):
    """A slab on a round leg that rocks in its plane of symmetry lies down from either side of the rim."""
    solid = Solid([Part(cylinder(diameter, 0.4)), Part(box(1.2, 1.0, 0.3)).moved(0.02, 0.0, 0.4)])
    assert all((impulse_position(solid).at(np.array([x, 0.0, 0.0])) > 1.0) == narrow for x in (-1.0, 1.0))
    found = rk.free_rocking(solid, restitution="ked-3d", start=SpatialStart(0.2 * diameter, 0.0), duration=2.0)
    assert found.impacts.size > 1
    assert found.cut_impacts == (found.impacts.size if narrow else 0)


@pytest.mark.verifies("order", "the square of the distance", within="0.01 of the order", control="within")
def test_no_distance_costs_nothing():
    """r -> 1 as the feet come together, 1 - r with the square of their distance; the law by points stays at .946."""
    missing = [1.0 - over_feet(apart).coefficient for apart in (0.1, 0.05, 0.025)]
    np.testing.assert_allclose(np.log2(np.array(missing[:-1]) / missing[1:]), 2.0, rtol=0.0, atol=0.01)
    assert over_feet(0.1, "ked-3d-point").coefficient < 0.95


@pytest.mark.verifies("computed anew", "energy lost in n equal steps, 13 digits", within="1e-8")
@pytest.mark.parametrize(
    ("steps", "lost"),
    [(1, 0.1024960798807509), (2, 0.0514677585548414), (4, 0.0259341370573942), (256, 0.0004097494607067)],
)
def test_a_landing_in_steps(steps, lost, agreement):
    """REF: a rectangle h/b = 4 whose landing is split into n equal steps, to 1e-8; n x loss tends to .1049."""
    solid = Solid.from_section(rk.Section.from_rectangle(1.0, 4.0))
    assert impulse_position(solid).at(np.array([1.0, 0.0])) == pytest.approx(0.5856037087878, rel=1e-10, abs=0.0)
    places, kept, along = np.linspace(-0.5, 0.5, steps + 1), 1.0, np.array([0.0, 1.0, 0.0])
    for old, new in pairwise(places):
        onto = Edge(np.array([new, 0.0, 0.0]), along)
        impact = SpatialImpact(
            solid.local_moments, along, np.array([old, 0.0, 0.0]), onto, matter=lambda: (solid, np.zeros(3))
        )
        made = SpatialKed().turned(impact)
        kept *= 0.5 * float(made @ impact.inertia @ made) / impact.energy
    agreement(abs((1.0 - kept) / lost - 1.0), 1e-8)
    if steps == 256:  # a step loses the square of its length: in all 1 / n
        assert steps * (1.0 - kept) == pytest.approx(0.1049, abs=5e-5)


def of_mass(solid, old, new, velocity, k):
    """The equations written down anew, three unknowns about X, from mass, centre and inertia."""
    found = solid.local_moments
    x = 0.5 * (old + new) + 0.5 * k * (new - old)
    arm, before, after = (found.centre - point for point in (x, old, new))
    matrix = found.inertia + found.mass * ((arm @ after) * np.eye(3) - np.outer(after, arm))
    return np.linalg.solve(matrix, found.inertia @ velocity + found.mass * cross(arm, cross(velocity, before)))


def states(solid, count, seed):
    """Random steps between corners, and velocities that bring the new one down."""
    rng = np.random.default_rng(seed)
    corners = np.column_stack([solid.local_base.vertices, np.zeros(len(solid.local_base.vertices))])
    while count:
        i, j = rng.choice(len(corners), 2, replace=False)
        velocity = rng.normal(size=3) * [1.0, 1.0, rng.uniform(0.0, 1.5)]
        if cross(velocity, corners[j] - corners[i])[2] < 0.0:
            count -= 1
            yield corners[i], corners[j], velocity


def impact_of(solid, old, new, velocity):
    return SpatialImpact(solid.local_moments, velocity, old, Corner(new), matter=lambda: (solid, np.zeros(3)))


@pytest.mark.verifies(
    "computed anew", "the equations written anew, and energy", within="1e-9; 1e-12 in energy", control="within"
)
@pytest.mark.parametrize("name", BODIES)
def test_steps_keep_momentum_about_the_impulse_and_create_no_energy(name):
    """Random steps of each asymmetric body, 4,000 or 1,000: energy never rises; the equations written anew, to 1e-9.

    Wherever Housner's impulse pushes, so does this one: those are the only steps that the engine takes. Negative
    control: k of the wrong sign, which mirrors X, creates energy in a quarter of the steps.
    """
    solid, gains, pulls, moved = BODIES[name], 0, 0, 0
    for old, new, velocity in states(solid, STEPS, 7):
        impact, k = impact_of(solid, old, new, velocity), min(impulse_position(solid).at(new - old), 1.0)
        made = SpatialKed().turned(impact)
        energy = 0.5 * made @ impact.inertia @ made
        assert energy <= impact.energy * (1.0 + 1e-12)
        push = [
            (cross(w, impact.moments.centre) - cross(velocity, solid.local_moments.centre - old))[2]
            for w in (made, of_mass(solid, old, new, velocity, 1.0))
        ]
        pulls += push[1] < 0.0
        assert push[0] >= -1e-12 or push[1] < 0.0
        if push[1] >= 0.0 and energy < impact.energy * (1.0 - 1e-9):
            expected = of_mass(solid, old, new, velocity, k)
            back = cross(velocity, solid.local_moments.centre - old)[2]
            if cross(expected, impact.moments.centre)[2] < back:  # it would pull: taken at the new corner
                expected, moved = of_mass(solid, old, new, velocity, 1.0), moved + 1
            np.testing.assert_allclose(made, expected, rtol=1e-9, atol=1e-9)
            wrong = of_mass(solid, old, new, velocity, -k)
            gains += 0.5 * wrong @ impact.inertia @ wrong > impact.energy
    assert gains > 0.25 * STEPS
    assert pulls < (0.12 if name == "squat" else 0.06) * STEPS  # as docs/theory/space_impacts.md says
    assert moved < 0.02 * STEPS


@pytest.mark.verifies("invariant", "energy before the step", within="1e-12")
def test_a_step_that_would_gain_energy_keeps_it():
    """A low weight at one end of the base and a mast at the other: k is below 0, and a short step loses nothing.

    The equations about X alone would gain energy there; what is left of them is their direction.
    """
    weight, mast = Part(box(0.2, 0.4, 0.2), 8000.0), Part(box(0.05, 0.3, 1.0), 500.0)
    solid = Solid([weight.moved(-0.4, 0.0, 0.0), mast.moved(0.475, 0.0, 0.0)])
    k = impulse_position(solid).at(np.array([1.0, 0.0]))
    assert k < -0.05
    old, new, velocity = np.array([-0.4, 0.0, 0.0]), np.array([-0.3, 0.0, 0.0]), np.array([0.2, 1.0, 0.1])
    impact, free = impact_of(solid, old, new, velocity), of_mass(solid, old, new, velocity, k)
    assert 0.5 * free @ impact.inertia @ free > 1.001 * impact.energy
    made = SpatialKed().turned(impact)
    assert 0.5 * made @ impact.inertia @ made == pytest.approx(impact.energy, rel=1e-12, abs=0.0)
    np.testing.assert_allclose(made / np.linalg.norm(made), free / np.linalg.norm(free), rtol=1e-9)


@pytest.mark.verifies("computed anew", "the exact integrals", within="1e-6")
@pytest.mark.parametrize("name", BODIES)
def test_few_nodes_give_the_position_everywhere(name):
    """Between the azimuths at which a foot changes k is a polynomial to 1e-6 of the exact integrals."""
    position = impulse_position(BODIES[name])
    for angle in np.random.default_rng(2).uniform(-math.pi, math.pi, 12):
        direction = np.array([math.cos(angle), math.sin(angle)])
        assert position.at(direction) == pytest.approx(position.exact(angle), abs=1e-6)


@pytest.mark.verifies("second engine", "the reference engine of the plane", within="1e-9 s")
@pytest.mark.parametrize("r", [0.7, 0.9])
def test_a_given_coefficient_is_a_ratio_of_velocities_as_in_the_plane(r):
    """An asymmetric prism let go: six impacts at the times of the plane engine, to 1e-9 s.

    Moments of inertia about the two feet differ by more than 2 % in root: r as a ratio of energies would be another r.
    """
    plane = rk.free_rocking(BENT, 0.1, r, engine="reference", duration=3.0)
    space = rk.free_rocking(Solid.from_section(BENT), restitution=r, start=SpatialStart(0.1, 0.0), duration=3.0)
    np.testing.assert_allclose(space.impacts["time"][:6], plane.impacts["time"][:6], rtol=0.0, atol=1e-9)
    left, right = (BENT.side(foot).moment_of_inertia for foot in ("left", "right"))
    assert abs(math.sqrt(left / right) - 1.0) > 0.02
