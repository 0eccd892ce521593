"""Units, base, centre, energies and pictures of a solid stand in one frame: that of the user."""

import math

import numpy as np
import pytest

from rocking import Region
from rocking.bodies.solid import Part, Prism, Solid, divided, voxels
from rocking.restitution.space import impact_in_space, unit_energies
from rocking.restitution.space.energies import lost_density
from rocking.restitution.space.ked import energy_left

pytestmark = pytest.mark.verifies(room="bodies")

WIDTH, HEIGHT, PLACE, GROUND = 0.78, 3.0, np.array([104.0, -37.0, 7.5]), 7.5


def wedge(*, turn=0.0):
    """A wall in the shape of a right-angled triangle, upright at x = 0 of its corner, far from the origin."""
    upright = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    shape = Prism(Region([(0.0, 0.0), (WIDTH, 0.0), (0.0, HEIGHT)]), 1.2)
    return Solid(Part(shape, 2400.0, rotation=upright, translation=PLACE), ground=GROUND).turned(turn)


@pytest.mark.slow
@pytest.mark.verifies("closed form", "a third of the base of a triangle", within="0.01", control="within")
@pytest.mark.parametrize("units", [lambda solid: divided(solid, 24), lambda solid: voxels(solid, 60)])
def test_slenderness_from_units_and_base(units):
    """The centre of a triangle is a third from its upright side: atan(B/H) = 14.6 degrees from units and base.

    Units of order 1 or 2 in 1/24 and 1/60 meet the closed form within 1 %.
    """
    solid = wedge()
    pieces = units(solid)
    x, _, z = pieces.mass @ pieces.centre / pieces.mass.sum()
    angle = math.degrees(math.atan2(x - solid.base.vertices[:, 0].min(), z - solid.ground))
    assert angle == pytest.approx(math.degrees(math.atan(WIDTH / HEIGHT)), rel=0.01)
    # negative control: in the frame of the solid, which begins at the middle of its box, a sixth of B is missing
    aside = x - solid.origin[0] + 0.5 * WIDTH
    assert math.atan2(aside - WIDTH / 6.0, z - GROUND) < 0.6 * math.radians(angle)


@pytest.mark.verifies("invariant", "the centre of the solid", within="1e-9")
@pytest.mark.parametrize("turn", [0.0, 0.7])
def test_units_balance_about_the_centre(turn):
    """Mass times place of the units is mass times `Solid.centre`, of a body that was turned too."""
    solid = wedge(turn=turn)
    pieces = divided(solid, 6)
    assert pieces.mass @ pieces.centre / pieces.mass.sum() == pytest.approx(solid.centre, abs=1e-9)
    low, high = solid.box
    assert (pieces.centre > low).all()
    assert (pieces.centre < high).all()


def over(solid):
    """From the left edge, at the upright side of the wedge, onto the right one."""
    old, new = sorted((e for e in solid.base.edges if abs(e.direction[0]) < 1e-9), key=lambda e: e.point[0])
    down = 1.0 if np.cross(old.direction, new.point - old.point)[2] < 0.0 else -1.0
    return impact_in_space(solid, down * old.direction, pivot=old, onto=new, model="ked-3d")


@pytest.mark.verifies("computed anew", "the exact integral over the solid", within="2e-3")
def test_energies_of_units_far_from_the_origin():
    """Energies of the units add up to the exact integral (order 2, 24 divisions), and layers begin at the ground."""
    result = over(wedge())
    energies = unit_energies(result, 24)
    assert energies.left.sum() == pytest.approx(energy_left(result.impact), rel=2e-3)
    heights, lost = energies.layers(5)
    assert heights[0] == 0.0
    assert 0.9 * HEIGHT < heights[-1] < HEIGHT
    assert lost.sum() == pytest.approx(energies.lost.sum(), rel=1e-12, abs=0.0)
    assert energies.layers(3, HEIGHT)[0] == pytest.approx([0.0, 1.0, 2.0, 3.0])


@pytest.mark.verifies("closed form", "the two stages of KED at a point", within="1e-9")
def test_energy_lost_at_a_point_in_closed_form():
    """At (x, z) from the old foot KED takes omega^2/2 (r^2 - z^4/rho^2) of a unit mass, rho from the new foot."""
    result = over(wedge())
    x, z = np.array([0.1, 0.3]), np.array([0.4, 1.1])
    points = PLACE + np.stack([x, np.full(2, -0.2), z], axis=1)
    found = lost_density(result.impact, result.impact.solid.parts[0], points)
    expected = 0.5 * 2400.0 * (x**2 + z**2 - z**4 / (z**2 + (WIDTH - x) ** 2))
    assert found == pytest.approx(expected, rel=1e-9, abs=0.0)


@pytest.mark.slow
@pytest.mark.verifies("behaviour")
def test_slices_are_drawn_where_the_body_stands():
    """Axes of level slices are x and y of the user; heights are over the ground."""
    pytest.importorskip("matplotlib")
    from rocking.plots import energy_picture, slices_picture

    solid = wedge()
    result, ((left, front, _), (right, back, _)) = over(solid), solid.box
    axes = slices_picture(result, np.array([1.0]), divisions=6).axes[0]
    assert axes.images[0].get_extent() == pytest.approx((left, right, front, back))
    assert "1 m above the ground" in axes.get_title(loc="left")
    drawn = np.ma.masked_invalid(axes.images[0].get_array())
    # the section at 1 m of 3 m is two thirds of the base wide
    assert 1.0 - np.ma.getmaskarray(drawn).mean() == pytest.approx(2.0 / 3.0, abs=0.05)
    figure = energy_picture(result, divisions=12)
    assert figure.axes[1].images[0].get_extent()[2:] == pytest.approx((0.0, HEIGHT))
    assert figure.axes[2].collections[0].get_paths()[0].vertices[:, 1].max() == pytest.approx(HEIGHT, rel=0.02)
