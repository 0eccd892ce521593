"""KED of point masses and of blocks on other feet: mesh convergence, the single mass, dumbbells, the spacing of feet.

REF numbers: see CONTRIBUTING.md.
"""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

import rocking as rk

pytestmark = pytest.mark.verifies(room="restitution in the plane")


def lumped(cells, ratio, corner=0.0):
    """Rectangle 1 x ratio as equal masses, one a square cell, at its middle or `corner` cells away from
    it."""
    x = (np.arange(cells) + 0.5 + corner) / cells
    y = (np.arange(int(cells * ratio)) + 0.5 + corner) / cells
    points = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    return rk.MassPoints(points, np.ones(len(points)), (0.0, 1.0))


def observed_orders(errors):
    return np.log2(np.abs(errors[:-1]) / np.abs(errors[1:]))


@pytest.mark.verifies(
    "order",
    "the closed form of the rectangle",
    within="1.95 to 2.05",
    control="test_order_criterion_rejects_corner_lumping",
)
def test_mesh_convergence_of_order_two():
    """Lumped meshes converge to the closed form at order 2, with errors known to three digits (lambda = 2)."""
    cells = [4, 8, 16, 32, 64, 128, 256]
    r = 0.830309150037216034
    errors = np.array([rk.coefficient_of_restitution(lumped(n, 2), "ked") - r for n in cells])
    # three printed digits each: half a unit of the last one
    assert np.abs(errors) == pytest.approx([1.22e-3, 3.09e-4, 7.73e-5, 1.93e-5, 4.83e-6, 1.21e-6, 3.02e-7], rel=5e-3)
    orders = observed_orders(errors)
    assert ((orders >= 1.95) & (orders <= 2.05)).all()


@pytest.mark.verifies("negative control", "masses at the corners of their cells")
def test_order_criterion_rejects_corner_lumping():
    """Negative control: masses at the upper right corner of their cells converge at order 1 only."""
    r = 0.830309150037216034
    errors = [rk.coefficient_of_restitution(lumped(n, 2, -0.5), "ked") - r for n in (16, 32, 64)]
    orders = observed_orders(np.array(errors))
    assert not ((orders >= 1.95) & (orders <= 2.05)).any()


@pytest.mark.verifies("closed form", "sin^2 of the polar angle about the new foot", within="1e-12", control="within")
@given(st.floats(0.05, np.pi - 0.05), st.floats(0.1, 50.0))
def test_point_mass_rule(angle, distance):
    """A single mass at the polar angle phi about the new foot has r = sin^2(phi), not
    sin(phi)."""
    x, y = distance * np.cos(angle), distance * np.sin(angle)
    feet = (min(x, 0.0) - 1.0 - abs(x), 0.0)
    assume(x < -1e-3)
    body = rk.MassPoints([(x, y)], [3.0], feet)
    r = rk.coefficient_of_restitution(body, "ked")
    assert r == pytest.approx(np.sin(angle) ** 2, rel=1e-12, abs=0.0)
    if abs(np.sin(angle) - 1.0) > 1e-3:
        assert r != pytest.approx(np.sin(angle), rel=1e-5)


def dumbbell(turn):
    """Two masses with the centre and inertia of a 1 x 2 m rectangle, turned from the horizontal."""
    arm = np.sqrt((1.0**2 + 2.0**2) / 12.0)
    step = arm * np.array([np.cos(turn), np.sin(turn)])
    return rk.MassPoints([np.array([0.0, 1.0]) + step, np.array([0.0, 1.0]) - step], [0.5, 0.5], (-0.5, 0.5))


@pytest.mark.verifies("closed form", "two masses, by hand", within="1e-12")
def test_dumbbells():
    """Bodies that are dynamically the 1 x 2 m block: KED .651 lying, .870 standing, Housner .7."""
    bodies = [dumbbell(turn) for turn in np.linspace(0.0, np.pi, 181)]
    ked = [rk.coefficient_of_restitution(body, "ked") for body in bodies]
    housner = [rk.coefficient_of_restitution(body, "housner") for body in bodies]
    assert (ked[0], ked[90]) == pytest.approx((0.651, 0.870), abs=5e-4)  # printed with three digits
    assert housner == pytest.approx([0.7] * len(bodies), rel=1e-12, abs=0.0)
    for turn, found in zip(np.linspace(0.0, np.pi, 181), ked, strict=True):
        masses = np.array([(1, 1), (-1, -1)]) * np.sqrt(5 / 12) * (np.cos(turn), np.sin(turn)) + (-0.5, 1.0)
        squared = (masses**2).sum(axis=1)
        assert found**2 == pytest.approx((masses[:, 1] ** 4 / squared).sum() / squared.sum(), rel=1e-12, abs=0.0)
    assert rk.coefficient_of_restitution(rk.Block(width=1, height=2), "ked") == pytest.approx(0.8303, abs=5e-5)


@pytest.mark.verifies("computed anew", "coefficients to four digits", within="5e-5", control="within")
@pytest.mark.parametrize(("spacing", "r"), [(1, 0.8303), (0.5, 0.9152), (0.1, 0.9460), (0.01, 0.9474)])
def test_feet_spacing(spacing, r):
    """KED under a 1 x 2 m block on closer and closer feet stays below 1 (four digits)."""
    body = rk.Block(width=1.0, height=2.0).with_feet(0.5 - spacing / 2, 0.5 + spacing / 2)
    assert rk.coefficient_of_restitution(body, "ked") == pytest.approx(r, abs=5e-5)
    if spacing < 1:
        # a model that counted the old foot, such as Housner's, is told apart
        assert rk.coefficient_of_restitution(body, "housner") != pytest.approx(r, abs=5e-5)


@pytest.mark.verifies("computed anew", "coefficients to five digits", within="5e-6", control="within")
def test_ordering_is_not_universal():
    """1 x 2 m on feet 0.5 m apart: KED .91517 is below Housner .91549."""
    body = rk.Block(width=1.0, height=2.0).with_feet(0.25, 0.75)
    ked, housner = (rk.coefficient_of_restitution(body, name) for name in ("ked", "housner"))
    assert (ked, housner) == pytest.approx((0.91517, 0.91549), abs=5e-6)
    assert ked < housner
    full = rk.Block(width=1.0, height=2.0)
    assert rk.coefficient_of_restitution(full, "ked") > rk.coefficient_of_restitution(full, "housner")
