"""Shapes in space: volumes, centres and inertia tensors against textbook formulas, and surfaces against both."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rocking import Region, Section
from rocking.bodies.moments import combined, polyhedron_moments
from rocking.bodies.solid import (
    Polyhedron,
    Prism,
    box,
    cone,
    cylinder,
    ellipsoid,
    extrusion,
    frustum,
    revolution,
    rotation_about,
    sphere_cap,
)
from rocking.bodies.solid.sampling import samples
from rocking.errors import GeometryError, InvalidValueError

pytestmark = pytest.mark.verifies(room="bodies")

ALL = {
    "box": box(1.0, 2.0, 3.0),
    "cylinder": cylinder(1.0, 2.0),
    "frustum": frustum(2.0, 1.0, 3.0),
    "cone": cone(2.0, 4.0),
    "ellipsoid": ellipsoid(1.0, 2.0, 3.0),
    "cut ellipsoid": ellipsoid(1.0, 2.0, 3.0, cut_below=0.4, cut_above=1.0),
    "cap": sphere_cap(2.0, 0.5),
    "pot": revolution([(1.0, 0.0), (1.2, 1.0), (0.5, 2.0), (0.3, 1.5), (0.0, 1.4)]),
    "holed": extrusion([(0, 0), (3, 0), (3, 2), (0, 2)], 4.0, ([(1, 0.5), (2, 0.5), (1.5, 1)],)),
}


def inertia(shape):
    found = shape.moments()
    return found.mass, found.centre, found.inertia


@pytest.mark.verifies("closed form", "formulas of box, cylinder, cone, ellipsoid and hemisphere", within="1e-13")
@pytest.mark.parametrize(
    ("shape", "volume", "height", "about_x", "about_z"),
    [
        (box(1.0, 2.0, 3.0), 6.0, 1.5, (4.0 + 9.0) / 12.0, 5.0 / 12.0),
        (cylinder(2.0, 3.0), 3.0 * math.pi, 1.5, (3.0 + 9.0) / 12.0, 0.5),
        (cone(2.0, 4.0), 4.0 * math.pi / 3.0, 1.0, 3.0 / 20.0 + 3.0 * 16.0 / 80.0, 0.3),
        (ellipsoid(2.0, 4.0, 6.0), 8.0 * math.pi, 3.0, (4.0 + 9.0) / 5.0, (1.0 + 4.0) / 5.0),
        (sphere_cap(2.0, 1.0), 2.0 * math.pi / 3.0, 3.0 / 8.0, 83.0 / 320.0, 0.4),
    ],
    ids=["box", "cylinder", "cone", "ellipsoid", "hemisphere"],
)
def test_textbook_moments(shape, volume, height, about_x, about_z):
    """Volume, height of the centre and both principal radii of gyration squared are those of the tables."""
    mass, centre, tensor = inertia(shape)
    assert mass == pytest.approx(volume, rel=1e-14, abs=0.0)
    assert centre == pytest.approx([0.0, 0.0, height], abs=1e-14)
    assert tensor[0, 0] / mass == pytest.approx(about_x, rel=1e-13, abs=0.0)
    assert tensor[2, 2] / mass == pytest.approx(about_z, rel=1e-13, abs=0.0)
    assert np.abs(tensor - np.diag(np.diag(tensor))).max() < 1e-13 * mass


@pytest.mark.verifies("computed anew", "the divergence theorem over the sampled surface", within="1e-11")
@pytest.mark.parametrize("name", ALL)
def test_surface_integrals_give_the_closed_forms(name):
    """The divergence theorem over the sampled surface returns volume and second moments about any point to 1e-12."""
    shape, point = ALL[name], np.array([0.3, 0.2, -0.5])
    found = shape.moments()
    volume, second = 0.0, np.zeros((3, 3))
    for s, areas in samples(shape.surfaces(None, -point), lambda s: np.linalg.norm(s, axis=1), 1e-16):
        cone_ = np.einsum("nd,nd->n", s, areas)
        volume += cone_.sum() / 3.0
        second += np.einsum("n,ni,nj->ij", cone_, s, s) / 5.0
    assert volume == pytest.approx(found.mass, rel=1e-12, abs=0.0)
    assert second == pytest.approx(found.second_about(point), rel=1e-11, abs=1e-12)


@pytest.mark.parametrize("name", ALL)
def test_pictures_show_the_outside(name):
    """The drawn triangles close up around nearly the volume; inward faces would make it negative."""
    surfaces = ALL[name].surfaces()
    drawn = polyhedron_moments(np.concatenate([surface.triangles(12) for surface in surfaces]))
    # chords of 7.5 degrees lose (7.5 degrees)^2 / 6 = 0.3 % of a circle, and as much again along a meridian
    assert drawn.mass == pytest.approx(ALL[name].moments().mass, rel=8e-3)


def test_halves_of_a_ball_are_drawn_alike():
    """The upper and the lower half of an ellipsoid are the same picture turned over."""
    upper, lower = (ellipsoid(1.0, 1.4, 2.0, **{cut: 1.0}) for cut in ("cut_below", "cut_above"))
    for divisions in (1, 3):
        drawn = [
            np.concatenate([surface.triangles(divisions) for surface in half.surfaces()]) for half in (upper, lower)
        ]
        assert len(drawn[0]) == len(drawn[1])
        one, other = (polyhedron_moments(triangles) for triangles in drawn)
        assert one.mass == pytest.approx(other.mass, rel=1e-12, abs=0.0)
        assert one.centre[2] == pytest.approx(1.0 - other.centre[2], rel=1e-12, abs=0.0)


@pytest.mark.parametrize("name", ALL)
def test_contains_agrees_with_the_volume(name):
    """The share of a regular grid that lies inside is the volume over the box, to the grid's resolution."""
    shape = ALL[name]
    low, high = shape.extent(np.eye(3))
    share = (np.arange(40) + 0.5) / 40
    grid = low + (high - low) * np.stack(np.meshgrid(share, share, share, indexing="ij"), axis=-1).reshape(-1, 3)
    # 40 cells a side: the surface passes through about 6/40 of them, half of which cancels at random
    assert shape.contains(grid).mean() * np.prod(high - low) == pytest.approx(shape.moments().mass, rel=0.02)


@pytest.mark.verifies("computed anew", "sums over units", within="1e-13; of second order where arcs become chords")
@pytest.mark.parametrize("name", ALL)
def test_cells_fill_the_shape(name):
    """Units that conform to a shape add up to its volume and centre; arcs in chords do so to second order."""
    shape = ALL[name]
    found = shape.moments()
    errors = []
    for divisions in (3, 6):
        volumes, centres = shape.cells(divisions) or pytest.skip("voxels only")
        errors.append(
            abs(volumes.sum() / found.mass - 1.0) + np.abs(volumes @ centres / volumes.sum() - found.centre).max()
        )
    if "ellipsoid" in name or name == "cap":
        assert errors[1] < 0.3 * errors[0] < 0.05
    else:
        assert max(errors) < 1e-13


@pytest.mark.verifies("invariant", "the plane body, times its length", within="1e-13")
def test_prism_equals_section():
    """An extruded trapezoid has the plane body's mass, centre and polar moment, times its length."""
    section = Section.from_trapezoid(1.0, 0.4, 2.5, density=1.0, depth=3.0)
    found = Prism(section.regions[0], 3.0).moments()
    assert found.mass == pytest.approx(section.mass, rel=1e-14, abs=0.0)
    assert found.inertia[2, 2] == pytest.approx(section.moment_of_inertia, rel=1e-13, abs=0.0)
    general = polyhedron_moments(Prism(section.regions[0], 3.0).corners)
    assert found.second == pytest.approx(general.second, rel=1e-12, abs=1e-13)


@pytest.mark.verifies("invariant", "the same mesh at the origin", within="1e-9", control="within")
def test_polyhedron_far_away():
    """At map coordinates of 1e6 m the inertia of a mesh keeps 1e-9; integrating without centring loses it all."""
    cube = box(1.0, 2.0, 4.0)
    offset = np.array([1e6, -2e6, 5e5])
    far = Polyhedron(cube.vertices + offset, cube.faces).moments()
    assert far.inertia == pytest.approx(cube.moments().inertia, rel=1e-9, abs=1e-9)
    assert far.mass == pytest.approx(8.0, rel=1e-9)
    # negative control: the same sums about the distant origin
    a, b, c = np.moveaxis(cube.corners + offset, 1, 0)
    volumes = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6.0
    second = sum(np.einsum("n,ni,nj->ij", volumes / 20.0, v, v) for v in (a, b, c, a + b + c))
    centre = volumes @ (a + b + c) / (4.0 * volumes.sum())
    naive = second - volumes.sum() * np.outer(centre, centre)
    assert abs(naive[2, 2] / cube.moments().second[2, 2] - 1.0) > 1.0


@settings(max_examples=25, deadline=None)
@given(
    st.floats(-3.0, 3.0),
    st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=3).filter(lambda v: np.linalg.norm(v) > 0.1),
)
def test_rotation_keeps_what_it_must(angle, axis):
    """A rotation is orthogonal, keeps its axis, and leaves trace and principal moments of a tensor alone."""
    turn = rotation_about(axis, angle)
    assert turn @ turn.T == pytest.approx(np.eye(3), abs=1e-14)
    assert turn @ axis == pytest.approx(np.array(axis), abs=1e-14)
    moments = box(1.0, 2.0, 3.0).moments()
    turned = moments.placed(turn, np.array([5.0, 6.0, 7.0]))
    assert np.linalg.eigvalsh(turned.second) == pytest.approx(np.linalg.eigvalsh(moments.second), rel=1e-12, abs=0.0)


@pytest.mark.verifies("invariant", "halves, and differences of two boxes", within="1e-13")
def test_moments_add_up():
    """A box is the sum of its halves, and a holed one the difference of two boxes."""
    whole, half = box(1.0, 2.0, 4.0).moments(), box(1.0, 2.0, 2.0).moments()
    both = combined([half, half.placed(np.eye(3), np.array([0.0, 0.0, 2.0]))])
    assert both.mass == whole.mass
    assert both.second == pytest.approx(whole.second, rel=1e-14, abs=1e-15)
    core = box(0.5, 1.0, 4.0).moments()
    ring = extrusion(
        [(-0.5, -1), (0.5, -1), (0.5, 1), (-0.5, 1)], 4.0, ([(-0.25, -0.5), (0.25, -0.5), (0.25, 0.5), (-0.25, 0.5)],)
    )
    assert combined([whole, core.times(-1.0)]).second == pytest.approx(ring.moments().second, rel=1e-13, abs=1e-15)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: box(1.0, 0.0, 1.0), "depth must be > 0"),
        (lambda: box(math.nan, 1.0, 1.0), "width must be finite"),
        (lambda: cylinder(1e10, 1.0), "check the unit"),
        (lambda: ellipsoid(1, 1, 1, cut_below=0.6, cut_above=0.5), "remove the complete ellipsoid"),
        (lambda: sphere_cap(1.0, 1.5), "height must be in"),
        (lambda: revolution([(1, 0), (-1, 1)]), "radii"),
        (lambda: revolution([(1, 1), (1, 0)]), "must end above its start"),
        (lambda: revolution([(1, 0), (1, 2), (0.2, 2), (1.5, 1), (0, 2.5)]), "crosses"),
        (lambda: extrusion([(0, 0), (1, 1), (1, 0), (0, 1)], 1.0), "crosses"),
        (lambda: Prism("x", 1.0), "Region"),
        (lambda: Polyhedron([(0, 0, 0)] * 3, [(0, 1, 2)]), "at least 4 points"),
        (lambda: Polyhedron(box(1, 1, 1).vertices, box(1, 1, 1).faces[:-1]), "must be closed"),
        (lambda: Polyhedron(box(1, 1, 1).vertices, box(1, 1, 1).faces[:, ::-1]), "partly inverted"),
        (lambda: Polyhedron(box(1, 1, 1).vertices * [1, 1, 0], box(1, 1, 1).faces), "no volume"),
        (lambda: Polyhedron(box(1, 1, 1).vertices, box(1, 1, 1).faces + 1), "vertex indices"),
        (lambda: Polyhedron(box(1, 1, 1).vertices * np.nan, box(1, 1, 1).faces), "finite"),
        (lambda: rotation_about([0, 0, 0], 1.0), "nonzero vector"),
    ],
)
def test_refusals(make, words):
    """What is no shape is refused in a sentence that names the reason."""
    with pytest.raises((GeometryError, InvalidValueError), match=words):
        make()


@pytest.mark.verifies("invariant", "twice the size, and the mirror image", within="1e-12")
def test_scaling_and_mirror():
    """Twice the size is eight times the volume and 32 times the second moment; a mirror image keeps them."""
    for shape in ALL.values():
        found, large, seen = shape.moments(), shape.scaled(2.0).moments(), shape.mirrored().moments()
        assert large.mass == pytest.approx(8.0 * found.mass, rel=1e-13, abs=0.0)
        assert large.second == pytest.approx(32.0 * found.second, rel=1e-12, abs=1e-11)
        assert seen.centre == pytest.approx(found.centre * [-1, 1, 1], abs=1e-13)
    assert Prism(Region([(0, 0), (1, 0), (0, 1)]), 2.0).mirrored().moments().mass == 1.0
