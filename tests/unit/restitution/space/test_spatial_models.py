"""Impacts in space: interface, flags, units and everything that is refused."""

import io
import math

import numpy as np
import pytest

from rocking.bodies.solid import Corner, Edge, Part, Polyhedron, Solid, SolidMoments, box, cylinder, extrusion, voxels
from rocking.errors import GeometryError, InvalidValueError, UnknownModelError
from rocking.plots import energy_picture, slices_picture, solid_picture
from rocking.restitution import space
from rocking.restitution.space import (
    SpatialFlag,
    SpatialImpact,
    SpatialKed,
    edge_coefficient,
    impact_in_space,
    spatial_model,
    spatial_models,
    unit_energies,
)
from rocking.restitution.space.energies import lost_density

UP = np.array([0.0, 0.0, 1.0])
PRISM = Solid(box(1.0, 1.0, 4.0))
DIAGONAL = {"velocity": [-1.0, 1.0, 0.0], "pivot": (-0.5, -0.5), "onto": (0.5, 0.5)}


def test_a_model_is_called_with_its_ending_or_without():
    """KED-3D is ked-3d, and ked where the body is solid."""
    for name in spatial_models():
        assert spatial_model(name).name == spatial_model(name.removesuffix("-3d")).name == name


@pytest.mark.slow
def test_corners_and_points_mean_the_same():
    """A point (x, y), a point (x, y, z) and a Corner give one result, also far from the origin."""
    there = impact_in_space(PRISM, **DIAGONAL, model="ked-3d").velocity
    corner = impact_in_space(
        PRISM, [-1, 1, 0], pivot=Corner(np.array([-0.5, -0.5, 0.0])), onto=(0.5, 0.5, 0.0), model="ked-3d"
    )
    assert (corner.velocity == there).all()
    far = Solid(Part(box(1.0, 1.0, 4.0)).moved(1000.0, 2000.0, 30.0), ground=30.0)
    result = impact_in_space(far, [-1, 1, 0], pivot=(999.5, 1999.5), onto=(1000.5, 2000.5), model="ked-3d")
    assert result.velocity == pytest.approx(there, rel=1e-12, abs=0.0)


@pytest.mark.slow
def test_a_step_from_an_edge_begins_at_its_nearest_point():
    """From every edge of an uneven base onto every corner: as if it had stood on the nearest point of the edge."""
    corners = np.array([[-0.4, -0.3], [0.3, -0.35], [0.45, 0.15], [0.1, 0.4], [-0.35, 0.25]])
    solid, inner = Solid(extrusion(corners, 2.0)), 0
    for first, last in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        along = (last - first) / np.linalg.norm(last - first)
        start = min(solid.base.edges, key=lambda e: abs(e.direction[:2] @ along - 1.0))
        for onto in corners:
            share = np.clip((onto - first) @ along, 0.0, np.linalg.norm(last - first))
            inner += 0.0 < share < np.linalg.norm(last - first)
            turned = {"velocity": -start.direction, "onto": tuple(onto), "model": "ked-3d"}
            of_edge = impact_in_space(solid, pivot=start, **turned)
            of_point = impact_in_space(solid, pivot=tuple(first + share * along), **turned)
            np.testing.assert_allclose(of_edge.velocity, of_point.velocity, rtol=0.0, atol=1e-12)
    assert inner > 3


def test_energies():
    """Energies are the kinetic ones, and the ratio is theirs."""
    result = impact_in_space(PRISM, **DIAGONAL, model="housner")
    moments = PRISM.local_moments
    before = 0.5 * result.impact.velocity @ moments.inertia_about(np.array([-0.5, -0.5, 0.0])) @ result.impact.velocity
    assert result.energy_before == pytest.approx(before, rel=1e-13, abs=0.0)
    assert result.energy_ratio == pytest.approx((59.0 / 71.0) ** 2, rel=1e-13, abs=0.0)


def test_flags():
    """A flat slab stops on the far edge and would go through the ground beside a corner: both are said."""
    slab = Solid(box(1.0, 1.0, 0.3))
    edges = slab.base.edges
    stopped = impact_in_space(slab, -edges[0].direction, pivot=edges[0], onto=slab.base.opposite(0), model="housner")
    assert stopped.flags == (SpatialFlag.STOPS,)
    assert stopped.coefficient == stopped.energy_after == 0.0
    assert np.abs(stopped.raw_velocity).max() > 0.0
    through = impact_in_space(slab, **DIAGONAL, model="housner")
    assert through.flags == (SpatialFlag.PENETRATES,)
    slow = DIAGONAL | {"velocity": 1e-8 * np.array(DIAGONAL["velocity"])}
    assert impact_in_space(slab, **slow, model="housner").flags == (SpatialFlag.PENETRATES,)
    assert impact_in_space(PRISM, **DIAGONAL).flags == ()


@pytest.mark.parametrize("azimuth", [0.0, 0.03, 0.05, 2.0])
def test_a_round_base_turned_about_its_axis_is_the_same_base(azimuth):
    """Its base sinks as fast as the fastest of a hundred thousand points of the rim, at any azimuth."""
    arm = 0.5 * np.array([math.cos(azimuth), math.sin(azimuth), 0.0])
    ahead = azimuth + 0.02
    turning = np.array([-math.sin(ahead), math.cos(ahead), 0.0])
    result = impact_in_space(Solid(cylinder(1.0, 3.0)), turning, pivot=-arm, onto=arm, model="housner-3d")
    around = np.linspace(0.0, 2.0 * math.pi, 100_001)
    rim = 0.5 * np.stack([np.cos(around), np.sin(around), 0.0 * around], axis=1)
    least = np.cross(result.raw_velocity, rim - arm)[:, 2].min()
    found = space.model.least_rise(result.impact, result.raw_velocity)
    assert found == pytest.approx(least, rel=1e-4)
    assert space.model.least_rise(result.impact, result.raw_velocity + 3.0 * UP) == found
    assert result.flags == (SpatialFlag.PENETRATES,)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"velocity": [1, -1, 0]}, "check the sign"),
        ({"velocity": [0, 0, 0]}, "must not be zero"),
        ({"velocity": [math.nan, 0, 0]}, "three finite numbers"),
        ({"velocity": [1, 0]}, "three finite numbers"),
        ({"onto": (0.5, 0.5, 0.1)}, "must lie on the ground"),
        ({"onto": (math.inf, 0.0)}, "three finite numbers"),
        ({"onto": Edge(np.zeros(3), np.array([1.0, 1.0, 0.0]))}, "unit vector"),
        ({"onto": Edge(np.zeros(3), np.array([0.0, 0.0, 1.0]))}, "unit vector"),
        ({"pivot": PRISM.base.edges[0]}, "along the edge"),
        ({"solid": box(1, 1, 1)}, "solid must be a Solid"),
    ],
)
def test_refusals(options, words):
    """What is no impact is refused in a sentence."""
    arguments = {"solid": PRISM, **DIAGONAL, **options}
    with pytest.raises((GeometryError, InvalidValueError), match=words):
        impact_in_space(**arguments)


def test_unknown_model():
    """A model that does not exist is not guessed, and is said before anything else that is wrong."""
    with pytest.raises(UnknownModelError, match="housner-3d"):
        edge_coefficient(PRISM, "newton")
    with pytest.raises(UnknownModelError, match="housner-3d"):
        impact_in_space(PRISM, [0, 0, 0], pivot=(-0.5, -0.5), onto=(0.5, 0.5), model="newton")


def shifted(solid, shift, **changes):
    """The impact over the diagonal in axes that begin at minus the shift."""
    onto = Corner(np.array([0.5, 0.5, 0.0]) + shift)
    moments = solid.local_moments
    body = SolidMoments(moments.mass, moments.centre + shift, moments.second)
    pivot = np.array([-0.5, -0.5, 0.0]) + shift
    options = {"matter": lambda: (solid, shift), "base": solid.local_base.changed(np.eye(2), shift)} | changes
    return SpatialImpact(body, np.array([-1.0, 1.0, 0.0]), pivot, onto, **options)


@pytest.mark.slow
@pytest.mark.parametrize("name", spatial_models())
@pytest.mark.parametrize("height", [0.3, 4.0])
def test_axes_may_begin_anywhere(name, height):
    """Velocity, flags and energies of units do not see where the axes of the body begin."""
    solid, model = Solid(box(1.0, 1.0, height)), spatial_model(name)
    here, there = (model.after(shifted(solid, np.array(x))) for x in ([0.0, 0.0, 0.0], [5.0, -3.0, 2.0]))
    assert here.flags == there.flags == impact_in_space(solid, **DIAGONAL, model=name).flags
    assert there.velocity == pytest.approx(here.velocity, rel=1e-9)
    near, far = unit_energies(here, 6), unit_energies(there, 6)
    for stage in ("before", "level", "left"):
        np.testing.assert_allclose(getattr(far, stage), getattr(near, stage), rtol=1e-9)
    # units of order 2 in 1/6
    assert far.before.sum() == pytest.approx(there.energy_before, rel=0.05)
    points = np.array([[0.1, 0.2, 0.2], [-0.3, 0.0, 0.1]])
    found = [lost_density(result.impact, solid.parts[0], points) for result in (here, there)]
    np.testing.assert_allclose(found[1], found[0], rtol=1e-9)


def test_a_body_that_leans_has_no_flags_and_no_units():
    """Where its base goes is not told of a leaning body or of bare moments, rather than told wrongly."""
    leaning = shifted(PRISM, np.zeros(3), up=np.array([math.sin(0.3), 0.0, math.cos(0.3)]))
    bare = shifted(PRISM, np.zeros(3), matter=None)
    model = spatial_model("housner-3d")
    for impact, words in ((leaning, "upright body"), (bare, "give the impact its matter")):
        for ask in (
            model.after,
            unit_energies,
            lambda impact: lost_density(impact, PRISM.parts[0], np.zeros((1, 3))),
            lambda impact: space.model.least_rise(impact, UP),
        ):
            with pytest.raises(InvalidValueError, match=words):
                ask(impact)
        assert np.isfinite(model.turned(impact)).all()


@pytest.mark.slow
def test_edges_by_number_and_direction():
    """Polygons count their edges, circles take directions; a triangle has no opposite edge."""
    assert edge_coefficient(PRISM, start=1, model="ked-3d") == pytest.approx(
        edge_coefficient(PRISM, start=0, model="ked-3d"), rel=1e-12, abs=0.0
    )
    disc = Solid(cylinder(1.0, 2.0))
    assert edge_coefficient(disc, "housner", start=0.3) == pytest.approx(
        edge_coefficient(disc, "housner"), rel=1e-13, abs=0.0
    )
    triangle = Solid(extrusion([(0, 0), (1, 0), (0.5, 0.8)], 3.0))
    with pytest.raises(GeometryError, match="parallel"):
        edge_coefficient(triangle, model="ked-3d")


def test_units_lose_what_the_body_loses():
    """Energies of units are additive, by units and by layers, and none gains."""
    result = impact_in_space(PRISM, **DIAGONAL, model="ked-3d")
    energies = unit_energies(result, 10)
    assert (energies.lost >= -1e-12 * energies.before).all()
    assert (energies.before >= energies.level - 1e-12).all()
    ends, lost = energies.layers(5, 4.0)
    assert ends == pytest.approx([0.0, 0.8, 1.6, 2.4, 3.2, 4.0])
    assert lost.sum() == pytest.approx(energies.lost.sum(), rel=1e-13, abs=0.0)
    assert energies.density.shape == energies.lost.shape
    rough = unit_energies(result.impact, voxels(PRISM, 16))
    # voxels of an eighth of the width err by (1/4)^2/24 of the width's share and the like
    assert rough.lost.sum() == pytest.approx(result.energy_before - result.energy_after, rel=0.03)
    with pytest.raises(InvalidValueError, match="count"):
        energies.layers(0)


def test_own_model():
    """A subclass with one method is a model."""

    class Half(SpatialKed):
        name = "half"

        def angular_velocity(self, impact):
            return 0.5 * impact.velocity

    assert edge_coefficient(PRISM, Half()) == 0.5


pytest.importorskip("matplotlib")
STATUE = Solid([Part(box(1.0, 1.0, 0.3), 2400.0), Part(cylinder(0.8, 2.0), 2700.0).moved(0.0, 0.0, 0.3)])


def fallen(solid):
    start = solid.base.edge(0)
    return impact_in_space(solid, -start.direction, pivot=start, onto=solid.base.opposite(0), model="ked-3d")


@pytest.mark.slow
def test_energy_picture_names_its_units():
    """Units and a slice in J/m3 of one scale, the loss over the height in J/m; its area is what the impact costs."""
    result = fallen(STATUE)
    figure = energy_picture(result, divisions=8)
    labels = {axes.get_ylabel() for axes in figure.axes} | {axes.get_xlabel() for axes in figure.axes}
    assert {"energy lost [J/m$^3$]", "energy lost [J/m]", "height [m]"} <= labels
    assert "0.8678" in figure.axes[2].get_title(loc="left")
    x, z = figure.axes[2].collections[0].get_paths()[0].vertices.T
    area = 0.5 * abs(float(x @ np.roll(z, 1) - z @ np.roll(x, 1)))
    # 32 heights: the first and last half of a layer are not drawn, and the neck of the statue is a jump
    assert area == pytest.approx(result.energy_before - result.energy_after, rel=0.03)
    figure.savefig(io.BytesIO(), format="png", dpi=40)


@pytest.mark.slow
@pytest.mark.parametrize(
    "solid", [STATUE, Solid(cylinder(1.0, 2.0)), Solid(Polyhedron(box(1, 1, 4).vertices, box(1, 1, 4).faces))]
)
def test_solid_picture_fills_its_frame(solid):
    """What is drawn lies within the body's box, seen along the rays."""
    (axes,) = solid_picture(solid).axes
    paths = axes.collections[0].get_paths()
    points = np.concatenate([path.vertices for path in paths])
    assert np.ptp(points, axis=0).max() <= 1.001 * np.linalg.norm(np.ptp(solid.box, axis=0))
    assert np.ptp(points, axis=0)[1] >= 0.9 * np.ptp(solid.box, axis=0)[2]


@pytest.mark.slow
def test_slices():
    """One panel a slice; outside the body there is nothing, and a slice above it is refused."""
    figure = slices_picture(fallen(STATUE), np.array([0.2, 1.0]), divisions=6)
    image = figure.axes[1].images[0].get_array()
    assert np.ma.getmaskarray(image).any() or np.isnan(np.asarray(image)).any()
    with pytest.raises(InvalidValueError, match="misses the body"):
        slices_picture(fallen(STATUE), np.array([3.0]))
