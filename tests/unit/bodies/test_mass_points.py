"""MassPoints: sums over points, and what is no set of mass points."""

import numpy as np
import pytest

import rocking as rk
from rocking.errors import GeometryError, InvalidValueError

pytestmark = pytest.mark.verifies(room="bodies")

POINTS, MASSES, FEET = [(-0.5, 1.0), (0.5, 1.0), (0.0, 3.0)], [1.0, 1.0, 2.0], (-1.0, 1.0)


@pytest.mark.verifies("closed form", "sums by hand", control="within")
def test_sums():
    """Mass, centre, inertia, box and contact of three points, by hand."""
    body = rk.MassPoints(POINTS, MASSES, FEET)
    assert body.mass == 4.0
    assert body.centre == (0.0, 2.0)
    assert body.moment_of_inertia == pytest.approx(0.5 + 4.0)
    assert body.local_box == (-1.0, 0.0, 1.0, 3.0)
    assert body.local_contact == ((-1.0, 1.0),)
    assert body.side("left").moment_of_inertia == pytest.approx(4.5 + 4.0 * 5.0)
    assert body.moment_of_inertia != pytest.approx(4.0 + 4.0 * 5.0)


def test_copies():
    """Scaling, mirroring and other feet, with contact stretches cut at the feet."""
    body = rk.MassPoints(POINTS, MASSES, FEET, contact=[(0.5, 2.0), (-1.0, -0.9)])
    assert body.local_contact == ((-1.0, -0.9), (0.5, 1.0))
    assert body.mirrored().local_contact == ((-1.0, -0.5), (0.9, 1.0))
    assert body.scaled(size=2.0).local_contact == ((-2.0, -1.8), (1.0, 2.0))
    assert body.scaled(density=3.0).mass == 12.0
    assert body.with_feet(-0.2, 0.6).local_contact == ((0.5, 0.6),)
    assert body.with_feet(-0.2, 0.6).feet == (-0.2, 0.6)
    assert body.feet == FEET


@pytest.mark.parametrize(
    ("points", "masses", "words"),
    [
        ([(0, -0.1)], [1.0], "point 0 must be finite with y >= 0 m"),
        ([(0, 1), (0, float("nan"))], [1.0, 1.0], "point 1 must be finite"),
        ([(0, float("inf"))], [1.0], "finite|within"),
        ([(0, 1e10)], [1.0], "wrong unit"),
        ([(0, 1)], [1.0, 1.0], r"shape \(2, 2\)"),
        ([0, 1], [1.0, 1.0], "shape"),
        ([], [], "shape"),
        ("ab", [1.0], "points must be a list"),
        (None, [1.0], "points must"),
        ([(0, 1)], [0.0], "masses must be finite and > 0 kg, got 0 at index 0"),
        ([(0, 1), (0, 2)], [1.0, -2.0], "-2 at index 1"),
        ([(0, 1)], [float("nan")], "masses must be finite"),
        ([(0, 1)], ["heavy"], "masses must be numbers"),
        ([(0, 1)], [True], "masses must be numbers"),
        ([(0, 1), (0, 2)], [[1.0, 1.0], [1.0, 1.0]], "masses|points"),
    ],
)
def test_points_and_masses_that_are_none(points, masses, words):
    """Points below the ground or not finite, masses not above zero, and shapes that do not match are
    refused."""
    with pytest.raises(InvalidValueError, match=words):
        rk.MassPoints(points, masses, FEET)


NO_FEET = [(1.0, -1.0), (0.0, 1.0), (0.1, 1.0), (-1.0, -0.5), (-1.0,), 3, None, "ab", (np.nan, 1.0)]
NO_CONTACT = [[(0, "a")], [(0.0, np.nan)], [(0.5, -0.5)], [1.0], "ab", [(0, 1, 2)], 3]


@pytest.mark.parametrize(
    ("feet", "contact", "words"),
    [*((feet, None, r"feet|foot") for feet in NO_FEET), *((FEET, contact, "contact") for contact in NO_CONTACT)],
    ids=repr,
)
def test_feet_and_contact_that_are_none(feet, contact, words):
    """Feet swapped, beside the centre or malformed, and stretches that are no growing pairs are refused at once."""
    with pytest.raises(InvalidValueError, match=words):
        rk.MassPoints(POINTS, MASSES, feet, contact=contact)


def test_single_point_above_the_foot_loses_nothing_and_on_the_ground_all():
    """A mass above the new foot has r = 1, on the ground r = 0; no division by zero on the
    foot."""
    body = rk.MassPoints([(-1.0, 0.0), (1.0, 2.0), (1.0, 0.0), (-1.0, 1e-3)], [1.0, 1.0, 1.0, 1.0], FEET)
    expected = np.sqrt((4.0 + 1e-12 / (4.0 + 1e-6)) / (4.0 + 4.0 + 4.0 + 1e-6))
    assert rk.coefficient_of_restitution(body, "ked") == pytest.approx(expected, rel=1e-13, abs=0.0)
    assert expected != pytest.approx(1.0, rel=1e-3)
    assert isinstance(GeometryError("x"), InvalidValueError)
