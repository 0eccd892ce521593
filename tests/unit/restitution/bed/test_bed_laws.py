"""Laws of a contact point against their formulas, written with branches, point by point."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from rocking.bodies import Block
from rocking.errors import InvalidValueError
from rocking.restitution.bed import ContactBed, KelvinVoigt
from rocking.restitution.bed.laws import LawKind, LawNumbers, force, stored
from rocking.restitution.bed.setup import setup_of

K, C, CHI, N = 3.0e5, 700.0, 1.7, 1.5
LAWS = {
    "kelvin-voigt": LawNumbers(LawKind.KELVIN_VOIGT, K, C, 1.0, 0.0, 0.0),
    "hunt-crossley": LawNumbers(LawKind.HUNT_CROSSLEY, K, 0.0, N, CHI, 0.0),
    "plastic": LawNumbers(LawKind.PLASTIC, K, 0.0, 1.0, 0.0, 0.6),
    "without rebound": LawNumbers(LawKind.PLASTIC, K, 0.0, 1.0, 0.0, 0.0),
}


def by_branches(name: str, d: float, v: float, deepest: float) -> float:
    """Return the force of one point (docs/theory.md, Section 13; plastic unloading after Walton & Braun 1986)."""
    if d <= 0.0:
        return 0.0
    if name == "kelvin-voigt":
        return max(0.0, K * d + C * v)
    if name == "hunt-crossley":
        return K * d**N * max(0.0, 1.0 + CHI * v)
    if name == "without rebound":
        # only new ground resists
        return K * d if d >= deepest and v > 0.0 else 0.0
    if d >= deepest:
        return K * d
    return max(0.0, min(K * d, K / 0.36 * (d - 0.64 * deepest)))


@pytest.mark.parametrize("name", LAWS)
def test_force_of_every_branch(name: str) -> None:
    """Above and in the ground, sinking and rising, on new ground, at its edge and on ground already pressed."""
    depth, speed, deepest = (
        part.ravel()
        for part in np.meshgrid([-1e-3, 0.0, 2e-3, 5e-3, 7e-3], [-9.0, -0.3, 0.0, 0.3], [2e-3, 5e-3, 6.5e-3])
    )
    found = force(LAWS[name], depth, speed, deepest)
    wanted = [by_branches(name, *each) for each in zip(depth, speed, deepest, strict=True)]
    assert found == pytest.approx(np.array(wanted), rel=1e-14)
    assert np.count_nonzero(wanted) >= 6


@pytest.mark.parametrize("name", LAWS)
def test_stored_energy_is_what_unloading_at_rest_gives_back(name: str) -> None:
    """The integral of the force over the way out, without damping; nothing where there is no rebound."""
    law, deepest = LAWS[name], 5e-3
    depth = np.linspace(0.0, 4e-3, 400_001)
    out = force(
        LawNumbers(law.kind, K, 0.0, law.exponent, 0.0, law.rebound), depth, 0.0 * depth, np.full(depth.size, deepest)
    )
    given = np.trapezoid(out, depth)
    assert stored(law, np.array([4e-3]), np.array([deepest])) == pytest.approx([given], rel=1e-8, abs=1e-12)
    assert (given == 0.0) == (name == "without rebound")


@pytest.mark.parametrize(("kinematics", "along"), [("exact", True), ("small", False)])
def test_a_body_that_starts_on_a_raised_foot_turns_about_it(kinematics: Any, along: bool) -> None:
    """The old foot, 40 mm above the base line, is at rest: v_B + omega x (s, zeta) = 0; small angles leave zeta out."""
    body = Block(width=1.0, height=4.0)
    rows = ContactBed.uniform(body, 3, KelvinVoigt(1e7, 1e4)).with_profile([0.04, 0.0, 0.02])
    bed = replace(rows, kinematics=kinematics)
    start = setup_of(body, bed, angular_velocity=9.0).start
    _, _, u, w, omega = start.state
    s, zeta = float(bed.positions[start.old_foot]), float(bed.heights[start.old_foot])
    assert omega > 1.0
    assert zeta != 0.0
    assert w - s * omega == pytest.approx(0.0, abs=1e-12)
    assert u + zeta * omega * along == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(
    "numbers", [{"damping": -0.5}, {"damping_ratio": -0.5}, {"damping": 1.0, "damping_ratio": 1.0}]
)
def test_dashpots_that_push_are_refused(numbers):
    """Damping is positive, and stated once."""
    with pytest.raises(InvalidValueError, match="damping"):
        KelvinVoigt(1e6, **numbers).numbers(1000.0)
