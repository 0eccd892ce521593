"""`assess` of solids: where they are weakest, how they fall, what is said and drawn of them, what is refused."""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.bodies.solid import Part, Solid, box
from rocking.decision.assessment._assess import SPACE_DIRECTIONS
from rocking.errors import InvalidValueError
from rocking.reports import report

# nearer to the edge towards -x, which is the only one of its kind
TOWER = Solid([Part(box(0.5, 0.9, 1.2), 400.0), Part(box(0.2, 0.9, 0.4), 900.0).moved(-0.12, 0.0, 1.2)])
PULSE = rk.pulses.sine(amplitude=3.2, period=0.9)
QUICK = {"count": 8, "contributions": False}


@pytest.fixture(scope="module")
def found():
    """Under a pulse of one component, of which the direction is not known."""
    return rk.assess(TOWER, PULSE, ["ked", "calibrated"], **QUICK)


@pytest.mark.slow
def test_where_it_is_weakest(found):
    """The plane body stands over the nearest edge, and code methods and remedies are its."""
    standing, centre = found.standing, TOWER.centre
    assert standing.is_weakest
    assert abs(standing.plane_azimuth) == pytest.approx(math.pi)
    assert standing.edge_distance == pytest.approx(0.25 + centre[0], rel=1e-12)
    assert standing.edge_distance < 0.25  # negative control: the other edge is farther
    assert found.body.side("right").half_width == pytest.approx(standing.edge_distance, rel=1e-12)
    assert found.uplift_factors.min() == pytest.approx(9.80665 * standing.edge_distance / centre[2] / 3.2, rel=1e-4)
    static = found.capacities["static"]
    assert np.unique(static.round(12)).size == 1  # the plane may lie along the pulse, whichever way it is turned
    assert static[0] == pytest.approx(found.uplift_factors.min(), rel=1e-3)


@pytest.mark.slow
def test_uplift_under_vertical_motion():
    """Uplift with a vertical component is not that of the horizontal component alone."""
    time = np.arange(0.0, 1.6, 0.01)
    level = rk.GroundMotion(6.0 * np.sin(2.0 * math.pi * time / 0.8), 0.01, name="level")
    up = rk.GroundMotion(np.full(time.size, -2.0), 0.01, name="up")
    moved, alone = (rk.assess(TOWER, each, 0.9, azimuth=0.0, **QUICK) for each in ({"x": level, "z": up}, level))
    reach, height = moved.standing.edge_distance, TOWER.centre[2]
    limit = f"{reach / height:.3g} g"
    assert moved.uplift_factors[0] == pytest.approx(9.80665 * reach / (6.0 * height + 2.0 * reach), rel=2e-3)  # samples
    assert (
        f"Without vertical acceleration, uplift begins at {limit}. With the vertical acceleration of level"
        in moved.governing_factors[0]
    )
    assert f"Uplift begins at {limit}, at" in alone.governing_factors[0]


def test_it_falls_over_that_edge(found):
    """At its margin it falls towards its nearest edge, and just below it stands."""
    factor, _, motion, _ = found.lowest
    assert math.cos(found.standing.overturning_direction - found.standing.plane_azimuth) > 0.9
    turned = TOWER.turned(found.standing.azimuth)
    ends = [
        rk.simulate(turned, found.motions[motion].parts, found.standing.restitution, friction=found.friction,
                    scale=k * factor, tolerance=1e-8).outcome
        for k in (0.99, 1.003)
    ]  # fmt: skip
    assert ends[0] is not rk.Outcome.OVERTURNED
    assert ends[1] is rk.Outcome.OVERTURNED


def test_directions_and_ways(found):
    """It is turned into directions over a whole turn; one that is the same half round has one way less."""
    assert len(found.motions) == SPACE_DIRECTIONS
    assert found.motion_count == f"1 motion (in {SPACE_DIRECTIONS} directions)"
    assert {each.min_factors_by_polarity.shape for each in found.models.values()} == {(2, SPACE_DIRECTIONS)}
    even = rk.assess(Solid(box(0.5, 0.9, 1.2)), PULSE, 0.9, azimuth=0.4, **QUICK)
    assert even.models["r = 0.9"].min_factors_by_polarity.shape == (1, 1)
    assert len(even.motions) == 1


def test_what_is_said(found):
    """The sentences name edge, direction, barrier and plane body; plain values hold the same."""
    said = " ".join(found.sentences)
    for words in ("weakest direction is 180 deg", "overturns towards", "requires a rise", "The plane body along"):
        assert words in said
    values = found.answer().plain()
    assert values["body"] == repr(TOWER)
    assert values["solid"]["barrier"] == pytest.approx(TOWER.equilibria().settling((0.0, 0.0, -1.0)).barrier)
    assert values["with_friction"]["min_factor"] == found.lowest.factor
    assert list(values["models"]) == ["ked", "calibrated", "calibrated, low", "calibrated, high"]


def test_a_report_draws_it_in_space(found, tmp_path):
    """The report has the landscape of the solid, the plane body's table and the history in space."""
    path = report(found, tmp_path / "tower.html", name="tower", date="1 May")
    text = path.read_text(encoding="utf-8")
    for words in ("The plane body of 180 deg", "all vertices of its hull", "The solid, its x axis at", "into pose"):
        assert words in text


@pytest.mark.slow
def test_models_that_know_no_solids_are_refused():
    """A model of the plane alone says nothing of a solid, and why; alone it is an error; so is a polarity."""
    both = rk.assess(TOWER, PULSE, ["ked", "horizontal-momentum"], azimuth=0.0, **QUICK)
    assert "of a 3D body must be one of" in both.refused["horizontal-momentum"]
    with pytest.raises(InvalidValueError, match="no restitution model applies"):
        rk.assess(TOWER, PULSE, "horizontal-momentum", azimuth=0.0, **QUICK)
    with pytest.raises(InvalidValueError, match="polarity applies to plane bodies"):
        rk.assess(TOWER, PULSE, 0.9, azimuth=0.0, polarity=1.0, **QUICK)


def test_components_of_other_steps_are_refused():
    """Two components of different steps are never taken as if they had one."""
    time = np.arange(0.0, 1.8, 0.01)
    one = rk.GroundMotion(3.0 * np.sin(2.0 * math.pi * time / 0.9), 0.01)
    with pytest.raises(InvalidValueError, match="step"):
        rk.assess(TOWER, {"x": one, "y": rk.GroundMotion(one.acceleration[::2], 0.02)}, 0.9, **QUICK)
