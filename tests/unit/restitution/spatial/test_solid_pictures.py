"""Pictures of solids: what is drawn, with which units, and what is refused."""

import io

import numpy as np
import pytest

from rocking.bodies.solid import Part, Polyhedron, Solid, box, cylinder
from rocking.errors import InvalidValueError
from rocking.plots.solid import energy_picture, slices_picture, solid_picture
from rocking.restitution.spatial import impact_in_space

pytest.importorskip("matplotlib")
STATUE = Solid([Part(box(1.0, 1.0, 0.3), 2400.0), Part(cylinder(0.8, 2.0), 2700.0).moved(0.0, 0.0, 0.3)])


def fallen(solid):
    start = solid.base.edge(0)
    return impact_in_space(solid, -start.direction, pivot=start, onto=solid.base.opposite(0))


def test_energy_picture_names_its_units():
    """Cubes in J a unit, a slice in J/m3, layers in J a layer; the layers add up to the cubes."""
    figure = energy_picture(fallen(STATUE), divisions=8)
    labels = {axes.get_ylabel() for axes in figure.axes} | {axes.get_xlabel() for axes in figure.axes}
    assert {"energy lost [J a unit]", "energy lost [J/m$^3$]", "energy lost [J a layer]", "height [m]"} <= labels
    assert "0.8678" in figure.axes[2].get_title(loc="left")
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
