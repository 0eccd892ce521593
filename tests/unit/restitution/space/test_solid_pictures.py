"""Pictures of solids: what is drawn, with which units, and what is refused."""

import io

import numpy as np
import pytest

from rocking.bodies.solid import Part, Polyhedron, Solid, box, cylinder
from rocking.errors import InvalidValueError
from rocking.plots import energy_picture, slices_picture, solid_picture
from rocking.restitution.space import impact_in_space

pytest.importorskip("matplotlib")
STATUE = Solid([Part(box(1.0, 1.0, 0.3), 2400.0), Part(cylinder(0.8, 2.0), 2700.0).moved(0.0, 0.0, 0.3)])


def fallen(solid):
    start = solid.base.edge(0)
    return impact_in_space(solid, -start.direction, pivot=start, onto=solid.base.opposite(0))


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


def test_slices():
    """One panel a slice; outside the body there is nothing, and a slice above it is refused."""
    figure = slices_picture(fallen(STATUE), np.array([0.2, 1.0]), divisions=6)
    image = figure.axes[1].images[0].get_array()
    assert np.ma.getmaskarray(image).any() or np.isnan(np.asarray(image)).any()
    with pytest.raises(InvalidValueError, match="misses the body"):
        slices_picture(fallen(STATUE), np.array([3.0]))
