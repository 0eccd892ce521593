"""What a coefficient implies, the energy balance of Figure 2, and the identity report."""

import numpy as np
import pytest

import rocking as rk
from rocking.errors import InvalidValueError
from rocking.restitution import Fixed, Housner, Ked, ShiftedImpulse, energy_balance, identity_report, implied

pytestmark = pytest.mark.verifies(room="restitution in the plane")

BODY = rk.Block(width=1.0, height=2.0).with_feet(0.1, 1)
ASYMMETRIC = rk.Block(width=2.0, height=1.0).with_feet(0.8, 2.0)


def test_implied_inverts_the_shifted_impulse():
    """k of an asymmetric body comes back from its coefficient, both ways, at the right place on the
    ground."""
    for foot, sign in (("right", 1.0), ("left", -1.0)):
        for k in (0.0, 0.3, 1.0):
            r = ShiftedImpulse(k=k).coefficient(ASYMMETRIC, foot)
            result = implied(ASYMMETRIC, r, foot=foot)
            assert result.impulse_ratio == pytest.approx(k, abs=1e-12)
            place = 1.0 + sign * k * ASYMMETRIC.side(foot).half_width
            assert result.impulse_x == pytest.approx(place, abs=1e-12)
            assert result.within_base
            assert result.impulse_ratio != pytest.approx(k + 1e-6, abs=1e-12)


def test_the_base_reaches_from_foot_to_foot():
    """An impulse behind the centre is on the base down to the old foot, one ahead of it up to the new one."""
    middle_over_base = (4.0 + 1.0) / 12.0 + 0.25
    for foot, sign in (("right", 1.0), ("left", -1.0)):
        old, new = (0.2, 1.0) if foot == "right" else (1.0, 0.2)
        for arm in (-1.01 * old, -0.99 * old, -0.01, 0.01, 0.99 * new, 1.01 * new):
            r = (middle_over_base - arm * old) / (middle_over_base + arm * new)
            result = implied(ASYMMETRIC, r, foot=foot)
            assert result.impulse_arm == pytest.approx(arm, rel=1e-9)
            assert result.impulse_x == pytest.approx(1.0 + sign * arm, rel=1e-12, abs=0.0)
            assert result.within_base is (-old < arm < new)


@pytest.mark.verifies("closed form", "1 - r^2 I_new / I_old", within="1e-12")
def test_implied_energy():
    """The loss is 1 - r^2 I_O'/I_O, and a coefficient above sqrt(I_O/I_O') creates energy."""
    old, new = (ASYMMETRIC.side(foot).moment_of_inertia for foot in ("left", "right"))
    bound = np.sqrt(old / new)
    assert bound < 1.0
    result = implied(ASYMMETRIC, 0.5)
    assert result.energy_loss == pytest.approx(1 - 0.25 * new / old, rel=1e-12, abs=0.0)
    assert result.largest_coefficient == pytest.approx(bound, rel=1e-12, abs=0.0)
    assert implied(ASYMMETRIC, bound * 0.9999).within_energy
    too_much = implied(ASYMMETRIC, bound * 1.0001)
    assert not too_much.within_energy
    assert not too_much.admissible
    assert "creates energy" in " ".join(too_much.objections)
    assert "outside the base (k = " in " ".join(implied(BODY, 0.1).objections)
    assert implied(BODY, 0.8).objections == ()


@pytest.mark.parametrize("value", [-0.1, float("nan"), float("inf"), "0.9", None, True], ids=repr)
def test_implied_refuses(value):
    """A coefficient is a finite number from zero up, and lands on a foot."""
    with pytest.raises(InvalidValueError, match=r"^coefficient must be"):
        implied(BODY, value)
    with pytest.raises(InvalidValueError, match=r"left.* or .*right"):
        implied(BODY, 0.9, foot="up")


@pytest.mark.verifies(
    "closed form",
    "energies of the stages of Mao et al. 2024, Eqs. 6 to 17",
    within="1e-13",
    control="within",
    doi="10.3390/buildings14072119",
)
def test_ledger_totals():
    """Energies of the stages (Eqs. 6 to 17, Mao et al. 2024): I_O, Int y^2 dm, N, and r^2 I_O' halves."""
    block = rk.Block(width=1.0, height=2.0, density=1000.0)
    balance = energy_balance(block, angular_velocity=3.0)
    before = 0.5 * 9.0 * 2000.0 * (5 / 12 + 1.25)
    assert balance.totals["before"] == pytest.approx(before, rel=1e-13, abs=0.0)
    assert balance.totals["stage 1"] == pytest.approx(0.5 * 9.0 * 1000.0 * 8.0 / 3.0, rel=1e-13, abs=0.0)
    # REF: E sin^2 = .8, E sin^4 = .6894...
    assert balance.fractions["stage 1"] == pytest.approx(0.8, rel=1e-13, abs=0.0)
    assert balance.fractions["stage 2"] == pytest.approx(0.689413284635524127, rel=1e-13, abs=0.0)
    assert balance.fractions["after"] == pytest.approx(balance.fractions["stage 2"], rel=1e-13, abs=0.0)
    assert balance.velocity_after == pytest.approx(3.0 * 0.830309150037216034, rel=1e-13, abs=0.0)
    assert balance.fractions["stage 1"] != pytest.approx(balance.fractions["stage 2"], rel=1e-2)


@pytest.mark.verifies("computed anew", "a midpoint mesh of 120 cells", within="3e-4", control="within")
@pytest.mark.parametrize("foot", ["left", "right"])
def test_ledger_fields_integrate_to_totals(foot):
    """Each field's energy density, integrated by a midpoint mesh, is the total; O(1/n^2) = 1e-4 for n =
    120."""
    section = rk.Section([
        rk.Region([(5, 1), (6, 1), (6, 2), (5, 2)], 2000.0),
        rk.Region([(5.25, 2), (5.75, 2), (5.75, 3), (5.25, 3)], 500.0),
    ], (5.1, 5.9), ground=1.0)  # fmt: skip
    balance = energy_balance(section, foot=foot, angular_velocity=2.0)
    n = 120
    x, y = np.meshgrid(5 + (np.arange(n) + 0.5) / n, 1 + (np.arange(2 * n) + 0.5) / n)
    for stage, density in balance.energy_density(x, y).items():
        assert density.sum() / n**2 == pytest.approx(balance.totals[stage], rel=3e-4)
        assert density.sum() / n**2 * 1.001 != pytest.approx(balance.totals[stage], rel=3e-4)
    speeds = balance.velocities(np.array([5.5]), np.array([3.0]))
    assert np.sign(speeds["before"][0, 0]) == (1.0 if foot == "right" else -1.0)
    assert speeds["stage 1"][0, 1] == 0.0


@pytest.mark.parametrize("value", [0.0, -1.0, float("nan"), "fast"], ids=repr)
def test_ledger_refuses(value):
    """The angular velocity is above zero; mass points have no density field."""
    with pytest.raises(InvalidValueError, match=r"^angular_velocity must be"):
        energy_balance(BODY, angular_velocity=value)
    lumped = rk.MassPoints([(0, 2)], [1.0], (-1, 1))
    with pytest.raises(InvalidValueError, match="MassPoints body has no density field"):
        energy_balance(lumped).energy_density(np.zeros(1), np.zeros(1))


def broken(body, model):
    return {check.name for check in identity_report(body, model) if not check.holds}


@pytest.mark.verifies("behaviour")
def test_identity_report():
    """The report finds KED's two breaches, clears Housner, and catches what creates energy."""
    assert broken(BODY, Ked()) == {"coincident pivots", "inertia alone"}
    assert broken(BODY, Housner()) == set()
    assert "energy bound" in broken(ASYMMETRIC, Fixed(r=0.99))
    assert "energy bound" in broken(ASYMMETRIC, ShiftedImpulse(k=0.0))
    assert "energy bound" not in broken(ASYMMETRIC, ShiftedImpulse(k=0.6))
    assert "impulse on the base" in broken(BODY, Fixed(r=0.2))
    sentences = [check.sentence for check in identity_report(BODY, Ked())]
    assert "scale: holds" in sentences
    assert any(words.startswith("inertia alone: violated for this body (") for words in sentences)


@pytest.mark.verifies("negative control", "a model that sees metres, kilograms and direction")
def test_identity_report_catches_a_broken_model():
    """Negative control: a model that sees metres, kilograms and direction fails scale, density, mirror, round
    trip."""

    class Bad(rk.restitution.RestitutionModel):
        """Sees what it should not."""

        name = "bad"

        def raw_coefficient(self, body, foot):
            return 1.0 + 1e-6 * body.mass + (0.1 if foot == "right" else 0.0)

    assert {"scale", "density", "mirror", "round trip", "energy bound"} <= broken(BODY, Bad())


def test_twins_have_the_same_mass_centre_and_inertia():
    """A model that sees nothing but mass, centre, inertia and feet holds "inertia alone", for a heavy body too."""

    class Seen(rk.restitution.RestitutionModel):
        """Sees mass, height, inertia and feet."""

        name = "seen"

        def raw_coefficient(self, body, foot):
            new = body.side(foot)
            gyration = new.moment_of_inertia / new.mass
            return 0.4 + 0.1 / (1.0 + body.mass) + 0.01 * gyration + 0.1 * new.half_width + 0.02 * new.centre_height

    for body in (rk.Block(width=1.0, height=2.0, density=0.3), ASYMMETRIC.scaled(density=40.0)):
        for foot in ("left", "right"):
            checks = {check.name: check for check in identity_report(body, Seen(), foot=foot)}
            assert checks["inertia alone"].holds
            # negative control: KED sees where the mass is
            assert not {check.name: check for check in identity_report(body, Ked(), foot=foot)}["inertia alone"].holds
