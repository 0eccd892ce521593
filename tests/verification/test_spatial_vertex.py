"""Bodies on a vertex: invariants, order of the steps, and impacts from corner to corner.

REF numbers: see CONTRIBUTING.md. With ROCKING_CAMPAIGN=1 the property tests draw ten
times as many examples.
"""

import math
import os

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import rocking as rk
from rocking.bodies.solid import Corner
from rocking.dynamics import SpatialStart
from rocking.dynamics.rolling import (
    SpatialBody,
    attitude,
)
from rocking.dynamics.rolling.impact_laws import law_of
from rocking.dynamics.rolling.rolling import PivotFlow, value
from rocking.restitution.space import SpatialHousner, SpatialImpact

pytestmark = pytest.mark.verifies(room="rocking in space")

TIMES = 10 if os.environ.get("ROCKING_CAMPAIGN") == "1" else 1
G = 9.81
TOWER = SpatialBody.box(1.0, 1.3, 4.0)
SQUARE = SpatialBody.box(1.0, 1.0, 4.0)
ANGLE = st.floats(-math.pi, math.pi)


def _still(gravity=G):
    return np.array([[0.0], [0.0], [-gravity]])


def _invariants(body, pivot, q, w):
    rotation, inertia = attitude.matrix(q), body.inertia_about(pivot)
    height = rotation[2] @ (body.centre - pivot)
    return np.array([0.5 * w @ inertia @ w + body.mass * G * height, rotation[2] @ inertia @ w])


def _drift(flow, body, pivot, q, w, steps=300, length=0.05, order=24):
    first, worst = _invariants(body, pivot, q, w), np.zeros(2)
    scale = np.array([abs(first[0]) + body.mass * G * body.size, body.mass * body.size * math.sqrt(G * body.size)])
    for _ in range(steps):
        rate = max(1.0, float(np.linalg.norm(w)))
        qs, ws, _ = flow.series(q, w, length / rate, _still(), order)
        q, w = attitude.normalised(value(qs, 1.0)), value(ws, 1.0)
        worst = np.maximum(worst, np.abs(_invariants(body, pivot, q, w) - first) / scale)
    return worst


@pytest.mark.slow
@pytest.mark.verifies(
    "invariant",
    "energy and vertical angular momentum of a heavy top",
    within="1e-12",
    control="test_a_wrong_gyroscopic_sign_is_rejected",
)
@settings(max_examples=6 * TIMES)
@given(ANGLE, st.floats(0.1, 2.5), st.tuples(*[st.floats(-3.0, 3.0)] * 3), st.floats(-0.2, 0.2))
def test_energy_and_vertical_momentum_about_a_vertex_stay(azimuth, tilt, spin, offset):
    """A heavy top on a vertex (no ground to fall on) keeps energy and vertical angular momentum to 1e-12, 300 steps."""
    inertia = TOWER.inertia + 0.1 * TOWER.mass * np.outer([0.3, offset, 0.2], [0.3, offset, 0.2])
    body = SpatialBody(TOWER.mass, np.array([0.1, offset, 2.0]), inertia + TOWER.mass * np.eye(3), TOWER.base)
    pivot = body.vertices[2]
    q = attitude.turn([-math.sin(azimuth), math.cos(azimuth), 0.0], tilt)
    assert _drift(PivotFlow(body, pivot), body, pivot, q, np.array(spin)).max() < 1e-12


@pytest.mark.slow
@pytest.mark.verifies("negative control", "the gyroscopic term with the wrong sign")
def test_a_wrong_gyroscopic_sign_is_rejected():
    """Negative control: with w x I w of the wrong sign the same check is off by more than 1e-3."""
    flow, pivot = PivotFlow(TOWER, TOWER.vertices[2]), TOWER.vertices[2]
    q, w = attitude.turn([1.0, 0.5, 0.0], 0.7), np.array([1.0, -0.5, 2.0])
    assert _drift(flow, TOWER, pivot, q, w).max() < 1e-12
    flow.gyroscopic = -flow.gyroscopic
    assert _drift(flow, TOWER, pivot, q, w).max() > 1e-3


@pytest.mark.verifies("invariant", "unit length", within="1e-15", control="within")
def test_the_quaternion_must_be_kept_at_unit_length():
    """With steps of low order the length drifts unless it is restored: 1e-6 without, rounding with."""
    flow, q, w = PivotFlow(TOWER, TOWER.vertices[0]), attitude.turn([1.0, 0.2, 0.0], 0.5), np.array([2.0, 1.0, 3.0])
    kept, left = (q, w), (q, w)
    for _ in range(50):
        kept, left = (tuple(value(c, 1.0) for c in flow.series(*s, 0.1, _still(), 4)[:2]) for s in (kept, left))
        kept = attitude.normalised(kept[0]), kept[1]
    assert abs(np.linalg.norm(kept[0]) - 1.0) < 1e-15
    assert abs(np.linalg.norm(left[0]) - 1.0) > 1e-6


@pytest.mark.verifies("order", "the same steps with 30 terms", within="0.35 of the order")
@pytest.mark.parametrize("order", [3, 5, 8])
def test_the_order_of_the_steps_is_the_declared_one(order):
    """Halving the steps divides the error by 2^order, within .35 of an order."""
    pivot, q, w = SQUARE.vertices[0], attitude.turn([1.0, -0.6, 0.0], 0.4), np.array([0.8, -0.5, 1.5])
    flow = PivotFlow(SQUARE, pivot)
    field = np.array([[0.5, 1.0], [-0.3, 0.2], [-G, 0.1]])

    def end(count, order):
        state = q, w
        for k in range(count):
            part = np.column_stack([field[:, 0] + field[:, 1] * k / count, field[:, 1] / count])
            state = tuple(value(c, 1.0) for c in flow.series(*state, 0.8 / count, part, order)[:2])
        return np.concatenate(state)

    exact = end(8, 30)
    errors = [np.abs(end(count, order) - exact).max() for count in (4, 8, 16)]
    assert np.log2(errors[1] / errors[2]) == pytest.approx(order, abs=0.35)  # the slope itself converges as 1 / count


@pytest.mark.slow
@pytest.mark.verifies("closed form", "59/71 and 64/71, coefficients by KED to 13 digits", within="1e-9")
@pytest.mark.parametrize(
    ("law", "ratio"),
    [
        ("housner-3d", 59.0 / 71.0),
        ("horizontal-momentum-3d", 64.0 / 71.0),
        ("ked-3d-point", 0.9132455302034),
        ("ked-3d", 0.9125115342467),
    ],
)
def test_the_diagonal_impact_of_a_prism_is_the_reference(law, ratio):
    """Corner to opposite corner, symmetric for ever: 59/71 by projection, 64/71 by horizontal momentum, KED's REF."""
    run = rk.free_rocking(SQUARE, restitution=law, start=SpatialStart(0.12, 0.25 * math.pi), duration=2.5)
    assert set(run.impacts["vertices"]) == {"0", "2"}
    left = run.impacts["energy_after"] / run.impacts["energy_before"]
    np.testing.assert_allclose(np.sqrt(left), ratio, rtol=1e-9)
    np.testing.assert_allclose(run.centre[:, 0], run.centre[:, 1], rtol=0.0, atol=1e-12)


@pytest.mark.verifies("computed anew", "angular velocities to 8 digits", within="5e-9")
def test_the_impact_on_an_adjacent_corner_is_the_reference():
    """REF: corner to adjacent corner with omega = (.3, 1, .1), by projection and by horizontal momentum."""
    omega, (first, second) = np.array([0.3, 1.0, 0.1]), SQUARE.vertices[:2]
    impact = SpatialImpact(SQUARE.moments, omega, first, Corner(second))
    made = SpatialHousner().turned(impact)
    np.testing.assert_allclose(made, [0.18824672, 0.90893638, 0.05603448], rtol=0.0, atol=5e-9)
    made = law_of("horizontal-momentum-3d").velocity_after(SQUARE, impact)
    np.testing.assert_allclose(made, [0.22073822, 0.91728995, 0.01982759], rtol=0.0, atol=5e-9)


@pytest.mark.verifies("invariant", "Carnot's theorem, by sums over particles", within="1e-12")
def test_the_projection_loses_the_energy_of_the_lost_velocities():
    """Carnot: the energy lost is that of the difference of the velocity fields, by sums over particles of the body."""
    rng = np.random.default_rng(5)
    points = rng.uniform(-1.0, 1.0, (40, 3)) * [0.4, 0.5, 1.5] + [0.0, 0.0, 1.6]
    mass = rng.uniform(1.0, 2.0, 40)
    centre = mass @ points / mass.sum()
    arms = points - centre
    inertia = np.einsum("n,nij->ij", mass, np.einsum("nk,nk->n", arms, arms)[:, None, None] * np.eye(3))
    inertia -= np.einsum("n,ni,nj->ij", mass, arms, arms)
    body = SpatialBody(mass.sum(), centre, inertia, SQUARE.base)
    before, after, omega = body.vertices[0], body.vertices[1], np.array([0.2, -0.9, 0.3])
    old = np.cross(omega, points - before)
    new = np.cross(SpatialHousner().turned(SpatialImpact(body.moments, omega, before, Corner(after))), points - after)
    energy = [0.5 * mass @ np.square(v).sum(axis=1) for v in (old, new, old - new)]
    assert energy[0] - energy[1] == pytest.approx(energy[2], rel=1e-12, abs=0.0)
