"""Solid: parts, base, placement, and every body that is refused."""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.bodies.solid import (
    Part,
    Polyhedron,
    RoundBase,
    Solid,
    SupportPolygon,
    box,
    cone,
    cylinder,
    divided,
    ellipsoid,
    extrusion,
    frustum,
    hull,
    rotation_about,
    voxels,
)
from rocking.errors import GeometryError, InvalidValueError

pytestmark = pytest.mark.verifies(room="bodies")


def pedestal():
    return Solid([Part(box(1.0, 1.0, 0.3), 2400.0), Part(cylinder(0.8, 2.0), 2700.0).moved(0.0, 0.0, 0.3)])


@pytest.mark.verifies("closed form", "sums by hand", within="1e-13")
def test_parts_add_up():
    """Mass and centre of a column on a plinth are the sums that one does by hand."""
    plinth, column = 0.3 * 2400.0, math.pi * 0.16 * 2.0 * 2700.0
    solid = pedestal()
    assert solid.mass == pytest.approx(plinth + column, rel=1e-14, abs=0.0)
    assert solid.centre == pytest.approx([0.0, 0.0, (plinth * 0.15 + column * 1.3) / (plinth + column)], abs=1e-13)
    assert solid.volume == pytest.approx(0.3 + math.pi * 0.32, rel=1e-14, abs=0.0)


def test_bases():
    """A box stands on four corners, a cylinder on a circle, a table on the hull of its legs."""
    assert len(Solid(box(1.0, 2.0, 3.0)).base.vertices) == 4
    disc = Solid(cylinder(1.0, 2.0)).base
    assert isinstance(disc, RoundBase)
    assert disc.radius == 0.5
    assert isinstance(Solid(Part(cylinder(1.0, 2.0)).moved(0.0, 0.0, 3.0), ground=3.0).base, RoundBase)
    legs = [Part(box(0.1, 0.1, 1.0)).moved(x, y, 0.0) for x in (-1.0, 1.0) for y in (-0.5, 0.5)]
    table = Solid([*legs, Part(box(2.2, 1.2, 0.1)).moved(0.0, 0.0, 1.0)])
    corners = sorted(map(tuple, table.base.vertices.round(12).tolist()))
    assert corners == [(x, y) for x in (-1.05, 1.05) for y in (-0.55, 0.55)]
    assert isinstance(pedestal().base, SupportPolygon)
    turned_over = Part(frustum(1.0, 2.0, 1.0)).turned((1, 0, 0), math.pi).moved(0, 0, 1.0)
    assert Solid(turned_over).base.radius == pytest.approx(1.0)
    assert len(Solid(ellipsoid(1.0, 2.0, 2.0, cut_below=0.5)).base.vertices) == 360


def test_an_elliptical_base_is_that_of_the_end_it_stands_on():
    """An ellipsoid cut unequally at both ends has the ellipse of the lower cut for its base, upright or turned over."""
    cut = Part(ellipsoid(1.0, 2.0, 3.0, cut_below=0.4, cut_above=1.0))
    for part, from_middle in ((cut, 1.1), (cut.turned((0, 1, 0), math.pi).moved(0.0, 0.0, 1.6), 0.5)):
        share = math.sqrt(1.0 - (from_middle / 1.5) ** 2)
        for ground in (0.0, 2.0):
            base = Solid(part.moved(0.0, 0.0, ground), ground=ground).base
            assert np.ptp(base.vertices, axis=0) == pytest.approx((1.0 * share, 2.0 * share), rel=1e-9)


def test_edges_run_round_the_base():
    """Edges are level unit vectors, counter-clockwise; turning about one lifts the rest of the base."""
    base = Solid(extrusion([(0, 0), (2, 0), (3, 1), (1, 3)], 1.0)).base
    middle = np.array([*base.vertices.mean(axis=0), 0.0])
    for edge in base.edges:
        assert np.linalg.norm(edge.direction) == pytest.approx(1.0, abs=1e-15)
        assert np.cross(edge.direction, middle - edge.point)[2] > 0.0
    with pytest.raises(GeometryError, match="No edge of the base is parallel"):
        base.opposite(0)
    tangent = RoundBase(np.array([1.0, 2.0]), 0.5).edge(math.pi / 2)
    assert tangent.point == pytest.approx([1.0, 2.5, 0.0])
    assert tangent.direction == pytest.approx([-1.0, 0.0, 0.0])


def test_a_round_base_turned_and_enlarged():
    """Turned by 30 degrees it keeps its radius, twice as large it doubles; the centre and the height go with it."""
    base, (c, s) = RoundBase(np.array([1.0, 2.0]), 0.5, 0.2), (math.cos(math.pi / 6), math.sin(math.pi / 6))
    turned = base.changed(2.0 * np.array([[c, -s], [s, c]]), np.array([0.1, 0.2, 0.3]))
    assert turned.radius == pytest.approx(1.0, rel=1e-15, abs=0.0)
    assert turned.centre == pytest.approx([2.0 * (c - 2.0 * s) + 0.1, 2.0 * (s + 2.0 * c) + 0.2], rel=1e-15, abs=0.0)
    assert turned.height == pytest.approx(0.7, rel=1e-15, abs=0.0)


def test_place_does_not_matter():
    """At map coordinates a body keeps its inertia to rounding, and says where it stands."""
    near = pedestal()
    far = Solid([part.moved(1e6, -2e6, 100.0) for part in near.parts], ground=100.0)
    assert far.inertia == pytest.approx(near.inertia, rel=1e-9)
    assert far.centre - near.centre == pytest.approx([1e6, -2e6, 100.0], rel=1e-14, abs=0.0)
    assert far.base.vertices.mean(axis=0) == pytest.approx([1e6, -2e6], rel=1e-12, abs=0.0)
    assert far.box[0] == pytest.approx([1e6 - 0.5, -2e6 - 0.5, 100.0], rel=1e-14, abs=0.0)


@pytest.mark.verifies("invariant", "another size and density, turned and mirrored", within="1e-12")
def test_similar_bodies():
    """Size, density, turn and mirror change mass and inertia as they must, the base with them."""
    solid = Solid(Part(extrusion([(0, 0), (2, 0), (0, 1)], 1.0), 1000.0))
    large = solid.scaled(size=2.0, density=3.0)
    assert large.mass == pytest.approx(24.0 * solid.mass, rel=1e-13, abs=0.0)
    assert large.inertia == pytest.approx(96.0 * solid.inertia, rel=1e-12, abs=1e-9)
    assert large.base.size == pytest.approx(2.0 * solid.base.size)
    turn = rotation_about((0, 0, 1), 0.7)
    assert solid.turned(0.7).inertia == pytest.approx(turn @ solid.inertia @ turn.T, rel=1e-12, abs=1e-10)
    mirrored = solid.mirrored()
    assert mirrored.inertia[0, 1] == pytest.approx(-solid.inertia[0, 1], rel=1e-12, abs=0.0)
    assert mirrored.local_base.margin(mirrored.local_moments.centre[:2]) == pytest.approx(
        solid.local_base.margin(solid.local_moments.centre[:2]), rel=1e-12, abs=0.0
    )


def test_plane_bodies_stand_up():
    """A section becomes prisms with its mass, centre, polar moment and feet."""
    section = rk.Section(
        [rk.Region([(0, 0), (1, 0), (1, 2), (0, 2)], 2400.0), rk.Region([(0.2, 2), (0.6, 2), (0.4, 3)], 7800.0)],
        feet=(0.1, 0.8),
        depth=0.5,
    )
    solid = Solid.from_section(section)
    assert solid.mass == pytest.approx(section.mass, rel=1e-13, abs=0.0)
    assert solid.centre[[0, 2]] == pytest.approx(section.centre, rel=1e-13, abs=0.0)
    assert solid.inertia[1, 1] == pytest.approx(section.moment_of_inertia, rel=1e-12, abs=0.0)
    assert set(solid.base.vertices[:, 0].round(12)) == {0.1, 0.8}


def test_hull_drops_what_is_not_a_corner():
    """Points inside and on straight edges are no corners; the hull runs counter-clockwise."""
    found = hull([(0, 0), (1, 0), (2, 0), (2, 2), (0, 2), (1, 1), (0, 1), (0, 0)]).vertices
    assert len(found) == 4
    x, y = found.T
    assert 0.5 * (x * np.roll(y, -1) - np.roll(x, -1) * y).sum() == 4.0


def test_units_of_several_parts():
    """Units know their part and add up; voxels come close."""
    units = divided(pedestal(), 6)
    assert units.mass.sum() == pytest.approx(pedestal().mass, rel=1e-13, abs=0.0)
    assert units.mass[units.part == 0].sum() == pytest.approx(720.0, rel=1e-13, abs=0.0)
    assert units.declared_order == 2
    rough = voxels(pedestal(), 20)
    assert rough.declared_order == 1
    # cells of a ninth of the radius in the grid: a round section within some per cent
    assert rough.mass.sum() == pytest.approx(pedestal().mass, rel=0.03)


LEG = box(0.2, 0.2, 1.0)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Solid([]), "at least one Part"),
        (lambda: Solid("box"), "at least one Part"),
        (lambda: Part("box"), "A Part needs a shape"),
        (lambda: Part(LEG, -1.0), "density must be > 0"),
        (lambda: Part(LEG, rotation=np.diag([-1.0, 1.0, 1.0])), "orthogonal without reflection"),
        (lambda: Part(LEG, translation=(0, 0)), "three finite numbers"),
        (lambda: Solid(Part(LEG).moved(0, 0, 0.5)), "is above the ground"),
        (lambda: Solid(Part(LEG).moved(0, 0, -0.5)), "is below the ground"),
        (lambda: Solid(ellipsoid(1, 1, 1)), "The base has 0 point"),
        (lambda: Solid(Part(cone(1.0, 2.0)).turned((1, 0, 0), math.pi).moved(0, 0, 2.0)), "The base has 0 point"),
        (lambda: Solid([Part(LEG), Part(LEG).moved(0.1, 0.0, 0.0)]), "parts 0 and 1 overlap over about 0.02 m3"),
        (lambda: Solid([Part(LEG), Part(box(3.0, 0.2, 0.2)).moved(2.0, 0.0, 1.0)]), "not stable"),
        (lambda: Solid(LEG, base=[(0, 0), (1, 0), (0, 1)]), "not stable"),
        (lambda: Solid(LEG, base=[(0, 0), (1, 0)]), "base with an area"),
        (lambda: Solid(LEG, base=[(0, 0, 0)]), "base points"),
        (lambda: Solid(LEG).base.edge(4), "edge must be a whole number"),
        (lambda: divided(Solid(LEG), 0), "divisions must be a whole number"),
        (lambda: divided(Solid(LEG), 10_000), r"divisions must be a whole number in \[1, 271\]"),
    ],
)
def test_refusals(make, words):
    """What is no body is refused in a sentence that names the reason."""
    with pytest.raises((GeometryError, InvalidValueError), match=words):
        make()


def test_touching_parts_are_welcome():
    """Parts may share faces, and a part may fill the hole of another."""
    hole = [(-0.25, -0.25), (0.25, -0.25), (0.25, 0.25), (-0.25, 0.25)]
    tube = extrusion([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)], 2.0, (hole,))
    filled = Solid([Part(tube, 2400.0), Part(box(0.5, 0.5, 2.0), 7800.0)])
    assert filled.mass == pytest.approx(0.75 * 2 * 2400.0 + 0.25 * 2 * 7800.0, rel=1e-13, abs=0.0)


def test_voxels_are_filled_by_twenty_sevenths():
    """27 points decide how full each is: the fullest are whole, none is filled by a part between."""
    mass = voxels(Solid(frustum(1.0, 0.6, 1.7)), 8).mass
    filled = 27.0 * mass / mass.max()
    np.testing.assert_allclose(filled, filled.round(), rtol=0.0, atol=1e-9)
    assert len(set(filled.round())) > 9  # of 8 points there were no more


def test_concave_meshes_become_voxels():
    """A mesh that its centre does not see whole is divided into voxels, of order 1, and that is said."""
    angle = extrusion([(0, 0), (1, 0), (1, 0.1), (0.1, 0.1), (0.1, 1), (0, 1)], 1.0)
    solid = Solid(Part(Polyhedron(angle.vertices, angle.faces), 1000.0))
    units = divided(solid, 20)
    assert units.declared_order == 1
    assert units.mass.sum() == pytest.approx(190.0, rel=0.01)
    assert "faces" in repr(solid.parts[0].shape)


def test_round_faces_and_corners():
    """Corners within a circle leave the circle, a circle within corners the corners; crossing ones ask for points."""
    disc = Part(cylinder(1.0, 0.2))
    beam = Part(box(0.2, 2.0, 0.2)).moved(2.0, 0.0, 0.0)
    cross = [disc, Part(box(0.3, 0.3, 0.2)).moved(0.7, 0.0, 0.0)]
    assert isinstance(Solid([disc, Part(box(0.2, 0.2, 0.2)).moved(0.0, 0.0, 0.2)]).base, RoundBase)
    with pytest.raises(GeometryError, match="Use base= with points"):
        Solid([*cross, beam])
    assert len(Solid(cross, base=[(-0.3, -0.3), (0.3, -0.3), (0.3, 0.3), (-0.3, 0.3)]).base.vertices) == 4
