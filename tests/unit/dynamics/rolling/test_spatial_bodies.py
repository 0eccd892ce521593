"""Bodies and motions in space: what is refused, closed forms, and merging of components."""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.bodies.solid import Corner, Edge
from rocking.dynamics import SpaceSettings
from rocking.dynamics.rolling import ContactMode, SpatialBody, attitude
from rocking.dynamics.rolling.complementarity import SpatialState, edge, face, forces, impulses, of_impact, rise, vertex
from rocking.dynamics.rolling.ground import ground_of
from rocking.dynamics.rolling.impact_laws import FixedSpatial, law_of
from rocking.dynamics.rolling.impact_resolution import landed, started
from rocking.errors import InvalidValueError, RockingError, UnknownModelError
from rocking.restitution.space import SpatialHousner, SpatialImpact

pytestmark = pytest.mark.verifies(room="rocking in space")

UP = np.array([0.0, 0.0, 1.0])
SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def test_a_box_is_its_closed_forms():
    """Mass, inertia, inertia about an edge (m / 3 (b^2 + h^2) of full sizes), reach and p^2 = 3 g / 4 R of a box."""
    body = SpatialBody.box(0.8, 1.1, 3.0, density=2000.0)
    mass = 2000.0 * 0.8 * 1.1 * 3.0
    assert body.mass == pytest.approx(mass)
    about = body.edges[1] @ body.inertia_about(body.vertices[1]) @ body.edges[1]  # the edge x = 0.4
    assert about == pytest.approx(mass * (0.8**2 + 3.0**2) / 3.0)
    assert body.reach == pytest.approx(0.4)
    assert body.frequency(9.81) == pytest.approx(math.sqrt(3.0 * 9.81 / (4.0 * 0.5 * math.hypot(1.1, 3.0))))
    assert body.lift == pytest.approx(math.hypot(0.4, 1.5) - 1.5)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"base": SQUARE[::-1]}, "counter-clockwise"),
        ({"base": SQUARE[[0, 1, 1, 2]]}, "convex"),
        ({"base": np.array([[0, 0], [1, 0], [0.6, 0.5], [1, 1], [0, 1.0]])}, "convex"),
        ({"centre": [1.5, 0.5, 1.0]}, "would overturn under its weight"),
        ({"centre": [0.5, 0.5, -1.0]}, "height of the centre"),
        ({"centre": [0.5, math.nan, 1.0]}, "finite"),
        ({"inertia": np.diag([1.0, 1.0, 3.0])}, "principal moments"),
        ({"inertia": np.diag([0.1, 1.0, 1.2])}, "principal moments"),
        ({"inertia": np.diag([0.0, 1.0, 1.0])}, "principal moments"),
        ({"inertia": np.eye(3) + np.triu(np.full((3, 3), 0.1), 1)}, "symmetric"),
        ({"inertia": np.ones((3, 3))}, "principal moments"),
        ({"mass": 0.0}, "mass must be > 0"),
        ({"base": -1.0}, "radius"),
    ],
)
def test_what_is_no_body_is_refused(changes, words):
    """Polygons, centres, inertias and masses that no body has: each refused in words that name the cause."""
    given = {"mass": 2.0, "centre": [0.5, 0.5, 1.0], "inertia": np.eye(3), "base": SQUARE}
    SpatialBody(**given)
    with pytest.raises(RockingError, match=words):
        SpatialBody(**(given | changes))


def test_any_object_with_the_four_attributes_serves():
    """A body given by attributes, its base at another height or a circle off the origin, is moved into place."""

    class Base:
        radius, centre, height = 0.5, np.array([3.0, 1.0]), 2.0

    class Body:
        mass, inertia, base = 5.0, np.eye(3), Base()
        centre = np.array([3.1, 1.0, 3.0])

    made = SpatialBody.of(Body())
    np.testing.assert_allclose(made.centre, [0.1, 0.0, 1.0], rtol=0.0, atol=1e-15)
    assert made.round
    assert made.reach == pytest.approx(0.4)
    plain = type(
        "Plain", (), {"mass": 5.0, "inertia": np.eye(3), "base": SQUARE - 0.5, "centre": np.array([0.1, 0.2, 1.0])}
    )
    np.testing.assert_array_equal(SpatialBody.of(plain()).centre, plain.centre)  # a base that says no height is at 0
    with pytest.raises(InvalidValueError, match="without"):
        SpatialBody.of(rk.Block(width=1.0, height=2.0))


@pytest.mark.verifies("closed form", "the lever rule", within="1e-12")
def test_the_ground_bears_a_body_at_rest_by_the_lever_rule():
    """Off the middle the edge bears (L - s) / L and s / L of the weight; outside the base a face is refused."""
    body = SpatialBody(3.0, np.array([0.5, 0.2, 1.0]), np.eye(3), SQUARE)
    field = np.array([0.0, 0.0, -10.0])
    # tilted until the centre is over the edge x = 1, which runs from (1, 0) to (1, 1): static, so nothing turns
    turned = attitude.matrix(attitude.turn([0.0, 1.0, 0.0], math.atan2(0.5, 1.0)))
    rate, push = forces(body, edge(body, 1), np.zeros(3), turned[2], turned.T @ field)
    np.testing.assert_allclose(rate, 0.0, rtol=0.0, atol=1e-14)
    np.testing.assert_allclose(push, [0.8 * 30.0, 0.2 * 30.0], rtol=1e-12)
    level = forces(body, face(body), np.zeros(3), UP, field)[1]
    assert level.min() > 0.0
    assert forces(body, face(body), np.zeros(3), UP, field + np.array([2.1, 0.0, 0.0]))[1].min() > 0.0
    assert forces(body, face(body), np.zeros(3), UP, field + np.array([0.0, -2.1, 0.0]))[1].min() < 0.0


def test_components_with_different_steps_are_one_motion():
    """Records of 0.02 and 0.03 s and a pulse, merged: the values of each at any time to 1e-12, zero after its end."""
    x = rk.GroundMotion(np.sin(np.arange(50) * 0.3), 0.02)
    y = rk.GroundMotion(np.cos(np.arange(20) * 0.7), 0.03)
    pulse = rk.pulses.sine(amplitude=2.0, period=0.5)
    ground = ground_of(x, y, pulse, scale=2.0)
    time = np.linspace(0.001, 0.9, 200)
    found = ground.at(time)
    np.testing.assert_allclose(found[:, 0], 2.0 * np.interp(time, x.time, x.acceleration), rtol=0.0, atol=1e-12)
    inside = time < 0.57
    np.testing.assert_allclose(
        found[inside, 1], 2.0 * np.interp(time[inside], y.time, y.acceleration), rtol=0.0, atol=1e-12
    )
    assert not found[~inside, 1].any()
    np.testing.assert_allclose(found[:, 2], 2.0 * pulse.acceleration(time), rtol=0.0, atol=1e-10)
    with pytest.raises(InvalidValueError, match="the component x must not have a vertical part"):
        ground_of(rk.GroundMotion(x.acceleration, 0.02, x.acceleration))
    with pytest.raises(InvalidValueError, match="GroundMotion"):
        ground_of([1.0, 2.0])


@pytest.mark.parametrize(("start", "length"), [(0.0, 1.0), (0.25, 1.0), (0.5, 0.5), (0.3, 0.2)])
def test_part_of_a_stretch_is_the_motion_there(start, length):
    """The line of a record with samples 1 s apart, from any instant on and over any unit of time."""
    ground = ground_of(rk.GroundMotion([0.0, 1.0, -2.0, 0.0], 1.0), rk.GroundMotion([0.5, -1.0, 4.0, 0.0], 1.0))
    found = ground.segment(1, 1.0 + start, length)
    np.testing.assert_allclose(found[0, :2], [1.0 - 3.0 * start, -3.0 * length], rtol=0.0, atol=1e-14)
    np.testing.assert_allclose(found[1, :2], [-1.0 + 5.0 * start, 5.0 * length], rtol=0.0, atol=1e-14)
    assert not found[:, 2:].any()
    assert not found[2].any()
    assert not ground.segment(3, 3.0, length).any()


@pytest.mark.slow
def test_where_nothing_stays_without_a_pull_the_least_pull_is_taken():
    """Bodies that spin fast as they fall flat on their base: no gap closes after it, and the face, on which a body
    stops, would be pulled at least as much; for some it is the face."""
    law, random, faces, none = law_of("housner-3d"), np.random.default_rng(1), 0, 0
    for _ in range(40):
        count = int(random.integers(3, 7))
        angle = np.sort((np.arange(count) + random.uniform(-0.3, 0.3, count)) * 2.0 * np.pi / count)
        base, every = np.column_stack([np.cos(angle), np.sin(angle)]), tuple(range(count))
        centre = np.append(base.mean(axis=0) + 0.03 * random.normal(size=2), random.uniform(1.5, 3.0))
        arms = random.normal(size=(6, 3)) * random.uniform(0.05, 2.0, 3)
        arms -= arms.mean(axis=0)
        body = SpatialBody(6.0, centre, np.square(arms).sum() * np.eye(3) - arms.T @ arms, base)
        for _ in range(30):
            pivot, velocity = body.vertices[random.integers(count)], random.normal(size=3) * [1.0, 1.0, 30.0]
            state = SpatialState(pivot, velocity, UP, -9.81 * UP)
            if (np.cross(velocity, body.vertices - pivot) @ UP).max() > 0.0 or of_impact(body, state, every, law):
                continue
            none += 1
            found = landed(body, state, every, law)
            opens = np.cross(found.velocity, body.vertices - found.contact.pivot) @ UP
            assert opens.min() >= -1e-8 * np.abs(velocity).max()
            assert found.supports.min() < 0.0
            assert found.supports.min() >= impulses(body, state, face(body), np.zeros(3)).min()
            if found.contact.mode is ContactMode.REST:
                faces += 1
                np.testing.assert_array_equal(found.velocity, np.zeros(3))
    assert none > 30
    assert faces > 5


def test_a_coefficient_of_nothing_is_nothing():
    """A body without velocity has none after an impact by a coefficient."""
    body, none = SpatialBody.box(0.8, 1.1, 3.0), np.zeros(3)
    for onto in (Corner(body.vertices[1]), Edge(body.vertices[1], body.edges[1])):
        impact = SpatialImpact(body.moments, none, body.vertices[0], onto)
        found = FixedSpatial(0.9).velocity_after(body, impact)
        np.testing.assert_array_equal(found, none)


def test_laws_by_name_by_number_and_by_interface():
    """Names, coefficients and objects are laws; others are refused with what there is."""
    assert law_of("housner-3d").label == law_of("housner").label == law_of(SpatialHousner()).label == "housner-3d"
    assert isinstance(law_of(0.9), FixedSpatial)
    with pytest.raises(UnknownModelError, match="horizontal-momentum-3d"):
        law_of("newton")
    for bad in (1.2, -0.1, math.nan, None, FixedSpatial):
        with pytest.raises(InvalidValueError):
            law_of(bad)


@pytest.mark.parametrize("bad", [{"order": 1}, {"tolerance": 0.0}, {"rest_speed": 1.0}, {"most_events": True}])
def test_settings_out_of_range_are_refused(bad):
    """Each setting has a range, and says so."""
    with pytest.raises(InvalidValueError, match="must be"):
        SpaceSettings(**bad)


@pytest.mark.slow
def test_of_two_contact_sets_the_larger_stays():
    """A box that spins on a corner as it falls flat may land on an edge or on one of its corners, both without pull and
    with different velocities: what more points of the ground hold is taken, as the docstring says."""
    body, law, random = SpatialBody.box(0.8, 1.1, 3.0), law_of("housner-3d"), np.random.default_rng(3)
    every, two = (0, 1, 2, 3), 0
    for _ in range(1500):
        pivot, velocity = body.vertices[random.integers(4)], random.normal(size=3)
        state = SpatialState(pivot, velocity, UP, -9.81 * UP)
        if (np.cross(velocity, body.vertices - pivot) @ UP).max() > 0.0:
            continue
        found = of_impact(body, state, every, law)
        if len(found) > 1 and np.abs(found[0].velocity - found[1].velocity).max() > 0.01 * np.abs(velocity).max():
            two += 1
            chosen = landed(body, state, every, law).contact
            assert len(chosen.points) == max(len(each.contact.points) for each in found)
            assert len(chosen.points) > min(len(each.contact.points) for each in found)
    assert two > 5


@pytest.mark.parametrize("tilt", [0.0, 1e-9, 0.4, 0.5 * math.pi, 2.0, 3.1])
def test_rise_at_any_tilt(tilt):
    """Height of the centre over a corner of the ground, upside down too: the arm turned by Rodrigues's formula."""
    body = SpatialBody(700.0, np.array([0.07, -0.05, 1.1]), np.diag([400.0, 450.0, 90.0]), SQUARE - 0.5)
    axis = np.array([0.6, -0.8, 0.0])
    for pivot in np.column_stack([body.base, np.zeros(len(body.base))]):
        arm = body.centre - pivot
        turned = (
            arm * math.cos(tilt) + np.cross(axis, arm) * math.sin(tilt) + axis * (axis @ arm) * (1.0 - math.cos(tilt))
        )
        up = UP * math.cos(tilt) - np.cross(axis, UP) * math.sin(tilt)
        assert rise(body, pivot, up) == pytest.approx(turned[2] - arm[2], rel=1e-9, abs=1e-15)


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e4])
def test_a_start_that_turns_about_an_edge_stands_on_it(size):
    """Of a base of five sides that lies flat, of any size: a turn about an edge stands on that edge, and one that is
    askew to it by a thousandth on the one of its two corners that does not rise."""
    angle = np.array([0.3, 1.1, 2.9, 4.0, 5.2])
    base = size * np.column_stack([np.cos(angle), 0.8 * np.sin(angle)])
    body = SpatialBody(700.0, size * np.array([0.07, -0.05, 1.1]), size**2 * np.diag([400.0, 450.0, 90.0]), base)
    for number, axis in enumerate(body.edges):
        contact, touching = started(body, 0.7 * axis, UP)
        assert touching == (0, 1, 2, 3, 4)
        assert (contact.mode, contact.points) == (ContactMode.EDGE, (number, (number + 1) % 5))
        for askew in (1e-3, -1e-3):
            contact, _ = started(body, 0.7 * axis + askew * np.cross(UP, axis), UP)
            # the turn about the inward normal lowers the far end of the edge, or lifts it
            stays = (number + 1) % 5 if askew > 0.0 else number
            assert (contact.mode, contact.points) == (ContactMode.VERTEX, (stays,))


def test_the_point_at_rest_that_is_nearest_to_a_new_stance():
    """Of an edge that lies on the ground the point nearest to a corner, or to the middle of another edge, is as near
    as the nearest of ten thousand points along it; of a corner it is the corner."""
    angle = np.array([0.3, 1.1, 2.9, 4.0, 5.2])
    base = np.column_stack([2.0 + np.cos(angle), 0.8 * np.sin(angle) - 1.0])
    body = SpatialBody(700.0, np.array([2.07, -1.05, 1.1]), np.diag([400.0, 450.0, 90.0]), base)
    share, inside = np.linspace(0.0, 1.0, 10_001)[:, None], 0
    for number in range(5):
        old = edge(body, number)
        state = SpatialState(old.pivot, np.zeros(3), UP, -9.81 * UP, old.length * old.axis)
        for other in range(5):
            for new in (edge(body, other), vertex(body, other)):
                target = new.pivot if new.axis is None else new.pivot + 0.5 * new.length * new.axis
                least = np.linalg.norm(old.pivot + share * state.along - target, axis=1).min()
                found = state.impact(body, new).pivot
                assert np.linalg.norm(found - target) == pytest.approx(least, abs=1e-7)
                part = (found - old.pivot) @ old.axis / old.length
                assert found == pytest.approx(old.pivot + min(max(part, 0.0), 1.0) * state.along, abs=1e-14)
                inside += 0.01 < part < 0.99
        alone = SpatialState(old.pivot, np.zeros(3), UP, -9.81 * UP)
        assert alone.impact(body, edge(body, (number + 2) % 5)).pivot == pytest.approx(old.pivot, abs=0.0)
    assert inside > 10
