"""KED and its relatives as laws of histories in space: the plane, attitudes, and what a body must know.

REF numbers: see CONTRIBUTING.md.
"""

import math
import pickle

import numpy as np
import pytest

import rocking as rk
from rocking.bodies.solid import Corner, Part, Solid, box, cylinder, frustum
from rocking.dynamics import SpatialStart
from rocking.dynamics.rolling import SpatialBody, attitude
from rocking.dynamics.rolling.impact_laws import law_of
from rocking.errors import InvalidValueError
from rocking.restitution.space import (
    SpatialImpact,
    SpatialKed,
    SpatialKedPoint,
    edge_coefficient,
    impact_in_space,
    spatial_models,
)

pytestmark = pytest.mark.verifies(room="rocking in space")

UP = np.array([0.0, 0.0, 1.0])
TOWER = SpatialBody.box(1.0, 1.3, 4.0)
SQUARE = SpatialBody.box(1.0, 1.0, 4.0)
TRAPEZOID = rk.Section.from_trapezoid(1.0, 0.4, 2.5)
LAWS = sorted(spatial_models())


def left_of_points(body, pivot, landing, velocity, up):
    """T'' of the box TOWER by Richardson from 16,000 and 128,000 equal mass points, straight from the two stages."""
    energies = []
    for count in (20, 40):
        grids = [(np.arange(n) + 0.5) / n for n in (count, count, 2 * count)]
        points = np.stack(np.meshgrid(*grids, indexing="ij"), axis=-1).reshape(-1, 3)
        points = (points - [0.5, 0.5, 0.0]) * [1.0, 1.3, 4.0]
        field = np.cross(velocity, points - pivot)
        field = field - np.outer(field @ up, up)
        arm = points - landing
        along = np.einsum("nd,nd->n", arm, field) ** 2 / np.einsum("nd,nd->n", arm, arm)
        energies.append(0.5 * body.mass * float(np.mean(np.einsum("nd,nd->n", field, field) - along)))
    return energies[1] + (energies[1] - energies[0]) / 3.0


# ---- the plane -------------------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.verifies("second engine", "the reference engine of the plane", within="1e-9")
@pytest.mark.parametrize("amplitude", [4.6, -5.2])
def test_ked_under_a_pulse_in_a_plane_is_that_of_the_plane(amplitude, agreement):
    """A prism over a trapezoid under a sine pulse: rotation and impacts of the plane engine with KED, to 1e-9."""
    pulse = rk.pulses.sine(amplitude=amplitude, period=0.8)
    plane = rk.simulate(TRAPEZOID, pulse, "ked", engine="reference", duration=4.0, rest_speed=1e-6)
    space = rk.simulate(Solid.from_section(TRAPEZOID), pulse, "ked-3d", duration=4.0)
    count = min(len(plane.impacts), 6)
    assert count >= 4
    np.testing.assert_allclose(space.impacts["time"][:count], plane.impacts["time"][:count], rtol=0.0, atol=1e-9)
    time = np.linspace(0.0, plane.impacts["time"][count - 1], 101)
    rotation = space.at(time).rotation
    agreement(np.abs(np.arctan2(rotation[:, 0, 2], rotation[:, 2, 2]) - plane.at(time)).max(), 1e-9)
    ratio = space.impacts["energy_after"][:count] / space.impacts["energy_before"][:count]
    np.testing.assert_allclose(ratio, 0.8704740952680223**2, rtol=1e-9)  # REF


# ---- corners and rims ------------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.verifies("invariant", "the impact of the upright body onto the far point", within="1e-7")
@pytest.mark.parametrize("model", LAWS)
def test_a_round_base_that_falls_flat_has_the_impact_of_its_far_side(model):
    """A cylinder let go over its rim: each impact is that of the upright body onto the far point, to 1e-7.

    The engine lets the rim roll down to tilts of 1e-11, where rounding turns the last bit of the motion sideways.
    """
    solid = Solid(Part(cylinder(1.0, 3.0)).moved(4.0, -2.0, 0.0))
    run = rk.free_rocking(SpatialBody.of(solid), restitution=model, start=SpatialStart(0.08, 0.7), duration=2.0)
    before, far = np.array([math.cos(0.7), math.sin(0.7)]), np.array([4.0, -2.0])
    impact = impact_in_space(
        solid, [before[1], -before[0], 0.0], pivot=far + 0.5 * before, onto=far - 0.5 * before, model=model
    )
    assert run.impacts.size > 2
    ratio = run.impacts["energy_after"] / run.impacts["energy_before"]
    np.testing.assert_allclose(ratio[:3], impact.energy_ratio, rtol=1e-7)


@pytest.mark.verifies("computed anew", "mass points, extrapolated", within="1e-6", control="within")
def test_an_impact_on_a_leaning_body_asks_the_true_vertical():
    """From corner to corner while it leans by 0.02: the energy after each impact is that of mass points, to 1e-6.

    Negative control: with the ground frozen to the axes of the body the mass points say 1e-4 and more besides.
    """
    run = rk.free_rocking(TOWER, restitution="ked-3d-point", start=SpatialStart(0.15, 0.9), duration=2.0)
    supports = [points[0] for _, _, _, points in run.intervals]
    assert [str(number) for number in supports[1:]] == run.impacts["vertices"].tolist() == ["1", "0", "3", "2"]
    frozen = []
    for impact, old, new in zip(run.impacts, supports, supports[1:], strict=False):
        state = run.at([impact["time"] - 1e-9])
        places = TOWER.vertices[old], TOWER.vertices[new], state.body_velocity[0]
        assert impact["energy_after"] == pytest.approx(left_of_points(TOWER, *places, state.rotation[0, 2]), rel=1e-6)
        frozen.append(left_of_points(TOWER, *places, UP) / impact["energy_after"] - 1.0)
    assert attitude.tilt(run.at(run.impacts["time"]).quaternion).max() > 0.02
    assert np.abs(frozen).max() > 1e-4


# ---- what a body must know -------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.verifies("invariant", "the same column a kilometre off", within="1e-9")
def test_a_solid_far_from_the_origin_is_the_same_body():
    """A column described on ground at 30 m, a kilometre off, rocks by KED as the one at the origin, to 1e-9.

    The inertia of a body so far away keeps 9 digits or more.
    """
    near, far = (
        Solid(
            [Part(box(1.0, 1.2, 0.3)).moved(x, y, z), Part(frustum(0.8, 0.5, 2.5)).moved(x + 0.05, y, z + 0.3)],
            ground=z,
        )
        for x, y, z in ((0.0, 0.0, 0.0), (1000.0, 500.0, 30.0))
    )
    first, second = (
        rk.free_rocking(solid, restitution="ked-3d", start=SpatialStart(0.1, 0.4), duration=1.0)
        for solid in (near, far)
    )
    count = 3
    for name in ("time", "energy_after"):
        np.testing.assert_allclose(second.impacts[name][:count], first.impacts[name][:count], rtol=1e-9)


def between_corners(body, velocity=(0.3, 1.0, 0.1), **more):
    """An impact from a corner onto the next one."""
    first, second = body.vertices[:2]
    return SpatialImpact(body.moments, np.array(velocity), first, Corner(second), **more)


@pytest.mark.verifies("damage", "bodies that do not say where their mass is")
@pytest.mark.parametrize("law", ["ked-3d", "ked", SpatialKed(), "ked-3d-point", SpatialKedPoint()])
def test_a_body_of_moments_alone_is_refused_by_ked(law):
    """Mass, centre and inertia do not say where the mass is: refused at the door with what is needed."""
    bare = SpatialBody(TOWER.mass, TOWER.centre, TOWER.inertia, TOWER.base)
    with pytest.raises(InvalidValueError, match=r"distribution of mass.*SpatialBody.of\(solid\)"):
        rk.free_rocking(bare, restitution=law, start=SpatialStart(0.1))
    with pytest.raises(InvalidValueError, match="distribution of mass"):
        law_of(law).velocity_after(bare, between_corners(bare))
    for other in ("housner-3d", "horizontal-momentum-3d", 0.9):
        rk.free_rocking(bare, restitution=other, start=SpatialStart(0.1), duration=0.5)


@pytest.mark.verifies("computed anew", "the coefficient of a prism, 14 digits", within="1e-12; 1e-11 by quadrature")
def test_a_body_takes_its_matter_along():
    """A box knows its solid after pickling; the edge coefficient by KED is REF, .94736683503237, to 1e-12."""
    body = pickle.loads(pickle.dumps(SQUARE))
    solid, origin = body.matter.placed
    assert solid.mass == pytest.approx(body.mass, rel=1e-14, abs=0.0)
    assert solid.inertia == pytest.approx(body.inertia, rel=1e-13, abs=1e-9)
    assert not origin.any()
    assert edge_coefficient(solid, "ked-3d-point") == pytest.approx(0.94736683503237, rel=1e-12, abs=0.0)
    assert edge_coefficient(solid, model="ked-3d") == pytest.approx(
        0.94736683503237, rel=1e-11, abs=0.0
    )  # by quadrature


@pytest.mark.verifies("damage", "vectors that are no vertical")
def test_what_is_no_vertical_is_refused():
    """An up that is no unit vector, or not finite, is an error and no number."""
    for up in (np.array([0.0, 0.0, 2.0]), np.array([0.0, math.nan, 1.0])):
        with pytest.raises(InvalidValueError, match="unit vector"):
            between_corners(SQUARE, up=up)
    with pytest.raises(InvalidValueError, match="rad/s"):
        law_of("housner-3d").velocity_after(SQUARE, between_corners(SQUARE, (0.3, math.nan, 0.1)))
