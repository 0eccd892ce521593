"""A body turns about and lands on places of its base: others are refused, in polygons and circles."""

import math

import numpy as np
import pytest

from rocking.bodies.solid import Corner, Edge, Part, Solid, box, cylinder
from rocking.errors import GeometryError
from rocking.restitution.space import edge_coefficient, impact_in_space

PRISM, DRUM = Solid(box(1.0, 1.0, 4.0)), Solid(cylinder(1.0, 2.0))
DIAGONAL = {"velocity": [-1.0, 1.0, 0.0], "pivot": (-0.5, -0.5), "onto": (0.5, 0.5)}


@pytest.mark.parametrize(
    ("solid", "options", "words"),
    [
        (
            PRISM,
            {"pivot": (-5, -5), "onto": (5, 5)},
            r"pivot must touch the base, got \(-5, -5\) m.* at 4\.5 m or more",
        ),
        (PRISM, {"onto": (5, 5)}, r"onto must touch the base, got \(5, 5\) m"),
        (PRISM, {"onto": Corner(np.array([0.5, 0.6, 0.0]))}, "at 0.1 m or more"),
        (PRISM, {"onto": (0.5 + 1e-6, 0.5)}, "at 1e-06 m or more"),
        (PRISM, {"onto": Edge(np.array([0.7, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))}, "at 0.2 m or more"),
        (DRUM, {"pivot": (-0.5, -0.5)}, "pivot must touch the base"),
        (DRUM, {"pivot": (-0.3, -0.4), "onto": Edge(np.array([0.8, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))}, "at 0.3 m"),
    ],
)
def test_places_outside_the_base(solid, options, words):
    """A corner or an edge that passes the base is no place to turn about, whatever number would come out."""
    with pytest.raises(GeometryError, match=words):
        impact_in_space(solid, **{**DIAGONAL, **options})


def test_places_on_the_base():
    """Corners, lines through a corner and points of a rim are taken, also far from the origin of the plan."""
    assert impact_in_space(PRISM, **DIAGONAL, model="housner").coefficient * 71 == pytest.approx(
        59.0, rel=1e-13, abs=0.0
    )
    aside = np.array([1.0, -1.0, 0.0]) / math.sqrt(2.0)
    through = Edge(np.array([0.5, 0.5, 0.0]) + 3.0 * aside, aside)
    assert 0.0 < impact_in_space(PRISM, **{**DIAGONAL, "onto": through}).coefficient < 1.0
    turn = {"velocity": [-0.8, 0.6, 0.0], "pivot": (-0.3, -0.4), "onto": (0.3, 0.4)}
    assert 0.0 < impact_in_space(DRUM, **turn).coefficient < 1.0
    far = Solid(Part(box(1.0, 1.0, 4.0)).moved(1000.0, 2000.0, 0.0))
    assert edge_coefficient(far, "housner") == pytest.approx(31.0 / 34.0, rel=1e-12, abs=0.0)


def test_round_bases_are_warned_of():
    """Who asks for the edge coefficient of a drum is told that a free one rolls."""
    assert "rolls around its rim" in " ".join(edge_coefficient.__doc__.split())
