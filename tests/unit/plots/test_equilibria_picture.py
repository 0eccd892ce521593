"""The picture of equilibria: a mark for each, where it is, and the support polygon with its nearest edge."""

import math

import numpy as np
import pytest

from rocking.bodies.solid import Solid, box, cylinder, extrusion
from rocking.plots import equilibria_picture


def marks(figure):
    """Tilts [deg] and azimuths [rad] of the marks on the map, by kind."""
    polar = next(axes for axes in figure.axes if axes.name == "polar")
    offsets = [np.asarray(each.get_offsets()) for each in polar.collections if len(each.get_offsets()) > 1]
    return dict(zip(("summit", "saddle", "stable"), offsets[-3:], strict=True))


@pytest.mark.slow
def test_every_equilibrium_is_marked_where_it_is():
    """Of a box: its own pose in the middle, the opposite one at half a turn, saddles over its edges."""
    found = marks(equilibria_picture(Solid(box(1.0, 2.0, 3.0))))
    assert {kind: len(places) for kind, places in found.items()} == {"summit": 8, "saddle": 12, "stable": 6}
    assert sorted(found["stable"][:, 1]) == pytest.approx([0.0, 90.0, 90.0, 90.0, 90.0, 180.0], abs=1e-6)
    lowest = found["saddle"][np.argsort(found["saddle"][:, 1])][:2]
    assert lowest[:, 1] == pytest.approx([math.degrees(math.atan2(0.5, 1.5))] * 2, abs=1e-6)
    assert np.abs(np.cos(lowest[:, 0])) == pytest.approx([1.0, 1.0], abs=1e-9)


@pytest.mark.slow
def test_another_pose_stands_in_the_middle():
    """The map is that around the pose, and the panels say its height and the nearest edge of its support."""
    solid = Solid(box(1.0, 2.0, 3.0))
    figure = equilibria_picture(solid, solid.equilibria().stable[0])
    titles = " ".join(axes.get_title(loc="left") for axes in figure.axes)
    assert "nearest edge at 1e+03 mm" in titles
    assert "centre 0.5 m high" in titles


@pytest.mark.slow
def test_rings_are_said():
    """A drum has circles of equilibria, which bear no marks."""
    figure = equilibria_picture(Solid(cylinder(1.0, 2.0)))
    assert "3 rings, not marked" in [text.get_text() for text in figure.legends[0].get_texts()]


@pytest.mark.slow
def test_the_standing_pose_is_not_covered():
    """Its mark lies over all others, and marks of many equilibria shrink; those of few keep their size."""
    few = equilibria_picture(Solid(box(1.0, 2.0, 3.0)))
    polar = next(axes for axes in few.axes if axes.name == "polar")
    *others, pose = [each for each in polar.collections if len(each.get_offsets())]
    assert np.asarray(pose.get_offsets()).tolist() == [[0.0, 0.0]]
    assert pose.get_zorder() > max(each.get_zorder() for each in others)
    assert {float(each.get_sizes()[0]) for each in others if len(each.get_offsets()) > 1} == {22.0}
    angles = np.linspace(0.0, 2.0 * math.pi, 40, endpoint=False)
    drum = Solid(extrusion(np.column_stack([np.cos(angles), 1.1 * np.sin(angles)]), 2.0))
    polar = next(axes for axes in equilibria_picture(drum).axes if axes.name == "polar")
    crowded = [each for each in polar.collections if len(each.get_offsets()) > 48]
    assert crowded
    assert all(float(each.get_sizes()[0]) <= 11.0 for each in crowded)
