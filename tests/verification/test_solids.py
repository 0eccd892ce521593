"""Solids divided into units: sums over units converge to the exact integrals with the order that they declare."""

import numpy as np
import pytest

from rocking import Section
from rocking.bodies.solid import (
    Part,
    Polyhedron,
    Solid,
    SupportPolygon,
    box,
    cylinder,
    divided,
    ellipsoid,
    frustum,
    voxels,
)
from rocking.bodies.solid.sampling import gauss_order
from rocking.bodies.solid.surfaces import TriangleSurface, gauss
from rocking.restitution.space import impact_in_space, unit_energies
from rocking.restitution.space.ked import energy_left

pytestmark = pytest.mark.verifies(room="restitution in space")

BODIES = {
    "box": Solid(box(1.0, 1.0, 4.0)),
    "cylinder": Solid(cylinder(1.0, 2.0)),
    "frustum": Solid(frustum(1.0, 0.6, 2.5)),
    "cut ellipsoid": Solid(ellipsoid(1.0, 1.0, 3.0, cut_below=0.4, cut_above=0.5)),
    "trapezoid": Solid.from_section(Section.from_trapezoid(1.0, 0.4, 2.5)),
    "polyhedron": Solid(Polyhedron(box(1.0, 1.0, 4.0).vertices, box(1.0, 1.0, 4.0).faces)),
    "two parts": Solid([Part(box(1.0, 1.0, 0.3), 2400.0), Part(cylinder(0.8, 2.0), 2700.0).moved(0, 0, 0.3)]),
}


def over_the_base(solid):
    base = solid.base
    start = base.edge(3 if isinstance(base, SupportPolygon) else 0.0)
    foot = base.opposite(3) if isinstance(base, SupportPolygon) else base.edge(np.pi)
    return impact_in_space(solid, -start.direction, pivot=start, onto=foot, model="ked-3d")


@pytest.mark.slow
@pytest.mark.verifies(
    "order",
    "the exact integral over the solid",
    within="0.08 of the order",
    control="test_lumping_elsewhere_has_order_one",
)
@pytest.mark.parametrize("name", BODIES)
def test_units_converge_with_order_two(name, agreement):
    """The energy left, summed over lumped units, converges to the exact integral with the declared order, 2."""
    solid = BODIES[name]
    impact = over_the_base(solid).impact
    exact = energy_left(impact)
    errors = [abs(unit_energies(impact, count).left.sum() / exact - 1.0) for count in (6, 12)]
    assert divided(solid, 6).declared_order == 2
    agreement(abs(np.log2(errors[0] / errors[1]) - 2.0), 0.08)


@pytest.mark.verifies("negative control", "masses at the corners of their units")
def test_lumping_elsewhere_has_order_one():
    """Negative control: masses lumped at a corner of each unit instead of its middle converge with order 1 only."""
    solid = BODIES["box"]
    impact = over_the_base(solid).impact
    errors = []
    for count in (6, 12, 24):
        units = divided(solid, count)
        moved = type(units)(units.mass, units.centre + 0.5 * np.array([1.0, 1.0, 4.0]) / count, units.part, 1)
        errors.append(abs(unit_energies(impact, moved).left.sum() / energy_left(impact) - 1.0))
    assert np.log2(errors[1] / errors[2]) == pytest.approx(1.0, abs=0.15)


@pytest.mark.verifies("computed anew", "the exact integral over the solid", within="5e-3 at 36 voxels")
def test_voxels_converge():
    """Voxels of a round body come closer as they shrink: from 12 to 36 along the height at least by a factor 3."""
    impact = over_the_base(BODIES["cylinder"]).impact
    errors = [
        abs(unit_energies(impact, voxels(impact.solid, n)).left.sum() / energy_left(impact) - 1.0) for n in (12, 36)
    ]
    assert errors[1] < errors[0] / 3.0
    assert errors[1] < 5e-3


@pytest.mark.verifies("order", "the same rule with 24 points", within="0.3 of the order")
@pytest.mark.parametrize(("order", "pair"), [(1, 4), (2, 3), (3, 2)])
def test_face_quadrature_has_its_declared_order(order, pair):
    """The Gauss rule of n x n points converges with order 2n on a face seen from a point."""
    face = np.array([[[0.2, 0.1, 1.0], [1.3, 0.0, 1.0], [0.4, 1.1, 1.0]]])
    surface = TriangleSurface(face)

    def total(cells, points):
        s, areas = surface.sample(cells, points)
        return float((s[:, 0] ** 2 / np.einsum("nd,nd->n", s, s) * np.einsum("nd,nd->n", s, areas)).sum())

    exact = total(face, 24)
    cells, errors = face, []
    for _ in range(6):
        errors.append(abs(total(cells, order) - exact))
        cells = surface.split(cells)
    assert np.log2(errors[pair] / errors[pair + 1]) == pytest.approx(2.0 * order, abs=0.3)


@pytest.mark.verifies("closed form", "arctan", within="3e-14", control="within")
def test_declared_digits_of_the_gauss_rule():
    """The order chosen for a cell gives 14 digits for the nearest pole, 1/(x^2 + d^2), at its distance."""
    for ratio in (1.0, 0.5, 0.1, 0.03):
        nodes, weights = gauss(gauss_order(ratio))
        x, d = nodes - 0.5, 1.0 / ratio
        exact = 2.0 / d * np.arctan(0.5 / d)
        assert (weights / (x * x + d * d)).sum() == pytest.approx(exact, rel=3e-14, abs=0.0)
        few, shares = gauss(2)
        if ratio == 1.0:  # negative control
            assert abs((shares / ((few - 0.5) ** 2 + d * d)).sum() / exact - 1.0) > 1e-5
