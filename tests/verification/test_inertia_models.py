"""The models that see mass, centre, inertia and contact only: REF numbers, limits, independent integrals.

REF numbers: see CONTRIBUTING.md.
"""

from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

import rocking as rk
from rocking.errors import InvalidValueError
from rocking.restitution import (
    DistributedImpulse,
    Flag,
    HorizontalMomentum,
    Housner,
    ImpactGeometry,
    Ked,
    PlasticWinkler,
    ShiftedImpulse,
    implied,
)

pytestmark = pytest.mark.verifies(room="restitution in the plane")

R_Q = {
    1.0: (0.5973243702581488, 0.4774610600698219, 0.4194352347741289),
    1.5: (0.7594374201022583, 0.6839549282433063, 0.6469519129203314),
    2.0: (0.8460080431904484, 0.7965354225163898, 0.772112661065736),
    3.0: (0.9240333495597528, 0.8991500504806001, 0.8867867987599888),
    4.0: (0.9555521127616988, 0.9408847304180785, 0.9335781380819859),
    10.0: (0.9925650397567968, 0.9900908245902962, 0.9888544832321119),
}
WINKLER = {0.5: 0.19352160, 1: 0.51649094, 1.5: 0.71022691, 2: 0.81425939, 3: 0.90827424, 4: 0.94631022}


def block(ratio):
    return rk.Block(width=1.0, height=ratio)


def portal(size=1.0):
    """Frame on two legs of different width: a base that touches in two stretches."""
    outline = [(0, 0), (0.2, 0), (0.2, 1), (0.8, 1), (0.8, 0), (1.1, 0), (1.1, 1.5), (0, 1.5)]
    return rk.Section.from_points(np.array(outline) * size)


def on_stretches(stretches, ratio=2.0):
    """Mass points with centre and inertia of a 1 x ratio block, feet 1 m apart, touching on `stretches`."""
    arm = np.sqrt((1.0 + ratio**2) / 12.0)
    points = [(-arm, ratio / 2), (arm, ratio / 2)]
    return rk.MassPoints(points, [0.5, 0.5], (-0.5, 0.5), contact=stretches)


# --- Housner, horizontal momentum, shifted impulse ------------------------------------------------


@pytest.mark.verifies("closed form", "Housner's impact onto any feet, 16 digits", within="1e-14", control="within")
def test_housner_on_inner_feet():
    """Housner, REF: 1 x 4 m on feet at .1 and .7 m; swapped directions or symmetric feet do not
    pass."""
    body = block(4.0).with_feet(0.1, 0.7)
    rightward = rk.coefficient_of_restitution(body, "housner", foot="right")
    leftward = rk.coefficient_of_restitution(body, "housner", foot="left")
    assert rightward == pytest.approx(0.9780085522296884, rel=1e-14, abs=0.0)
    assert leftward == pytest.approx(0.9569635385534967, rel=1e-14, abs=0.0)
    assert leftward != pytest.approx(0.9780085522296884, rel=1e-14, abs=0.0)
    centred = block(4.0).with_feet(0.2, 0.8)
    assert rk.coefficient_of_restitution(centred, "housner") != pytest.approx(0.9780085522296884, rel=1e-14, abs=0.0)


@pytest.mark.verifies(
    "closed form",
    "Housner 1963; Eq. 5 of Mao et al. 2024",
    within="1e-12",
    control="within",
    doi="10.1785/BSSA0530020403",
)
@pytest.mark.parametrize("ratio", [0.71, 1.0, 2.0, 4.0, 30.0])
def test_housner_of_a_rectangle(ratio):
    """Housner: r = 1 - 3/2 sin^2(alpha) = (2 l^2 - 1)/(2 (l^2 + 1)) (Eq. 5, Mao et al. 2024)."""
    r = rk.coefficient_of_restitution(block(ratio), "housner")
    assert r == pytest.approx((2 * ratio**2 - 1) / (2 * (ratio**2 + 1)), rel=1e-12, abs=0.0)
    assert r != pytest.approx(1 - ratio**-2 / (1 + ratio**-2), rel=1e-5)


@pytest.mark.verifies("closed form", "h/b = 1 / sqrt 2", within="1e-12")
def test_housner_stops_below_its_domain():
    """Below h/b = 1/sqrt 2 the equation is negative: r = 0 with Flag.STOPS, and none above."""
    below, above = (Housner().evaluate(block(ratio)) for ratio in (0.7, 0.72))
    assert below.raw == pytest.approx((2 * 0.49 - 1) / (2 * 1.49), rel=1e-12, abs=0.0)
    assert (below.coefficient, below.flags) == (0.0, (Flag.STOPS,))
    assert above.coefficient == above.raw > 0.0
    assert above.flags == ()
    assert Housner().stops([0.7, 0.72]).tolist() == [True, False]
    assert Housner().of_slenderness([0.1, 0.7]).tolist() == [0.0, 0.0]
    edge = brentq(lambda ratio: Housner().evaluate(block(ratio)).raw, 0.5, 1.0, xtol=1e-14)
    assert edge == pytest.approx(0.5**0.5, rel=1e-12, abs=0.0)


@pytest.mark.verifies("closed form", "cos^2 alpha", within="1e-13", control="within")
@pytest.mark.parametrize("ratio", [0.01, 0.5, 1.0, 4.0, 100.0])
def test_horizontal_momentum_is_cos_squared(ratio):
    """Horizontal momentum: r = cos^2(alpha) = l^2/(1 + l^2) for a rectangle, not cos(alpha)."""
    r = rk.coefficient_of_restitution(block(ratio), "horizontal-momentum")
    assert r == pytest.approx(ratio**2 / (1 + ratio**2), rel=1e-13, abs=0.0)
    assert r != pytest.approx(np.cos(block(ratio).slenderness_angle), rel=1e-5)


@pytest.mark.verifies("closed form", "(1 + 4 l^2 - 3k) / (1 + 4 l^2 + 3k)", within="1e-13", control="within")
@pytest.mark.parametrize("ratio", [0.8, 2.0, 6.0])
@pytest.mark.parametrize("k", [0.0, 0.25, 2 / 3, 1.0])
def test_shifted_impulse(ratio, k):
    """Shifted impulse: r_k = (1 + 4 l^2 - 3k)/(1 + 4 l^2 + 3k); k = 0 loses nothing, k = 1 is Housner."""
    r = rk.coefficient_of_restitution(block(ratio), "shifted-impulse", k=k)
    assert r == pytest.approx((1 + 4 * ratio**2 - 3 * k) / (1 + 4 * ratio**2 + 3 * k), rel=1e-13, abs=0.0)
    assert implied(block(ratio), r).impulse_ratio == pytest.approx(k, abs=1e-12)
    assert r != pytest.approx((1 + 4 * ratio**2 - 3 * (k + 1e-3)) / (1 + 4 * ratio**2 + 3 * k), rel=1e-6)


@pytest.mark.verifies("closed form", "1 and Housner's coefficient", within="1e-14", control="within")
def test_shifted_impulse_ends():
    """Shifted impulse: k = 0 gives 1 and k = 1 Housner also for an asymmetric body; k = 0.9 does not."""
    body = portal().with_feet(0.05, 1.0)
    for foot in ("left", "right"):
        housner = rk.coefficient_of_restitution(body, "housner", foot=foot)
        assert ShiftedImpulse(k=0.0).coefficient(body, foot) == 1.0
        assert ShiftedImpulse(k=1.0).coefficient(body, foot) == pytest.approx(housner, rel=1e-14, abs=0.0)
        assert ShiftedImpulse(k=0.9).coefficient(body, foot) != pytest.approx(housner, rel=1e-6)


@pytest.mark.verifies("computed anew", "k to four digits", within="5e-5", control="within")
@pytest.mark.parametrize(
    ("ratio", "k"),
    [
        (0.5, 0.3597),
        (1, 0.4400),
        (1.5, 0.4923),
        (2, 0.5254),
        (3, 0.5638),
        (4, 0.5856),
        (6, 0.6095),
        (9.75, 0.6298),
    ],
)
def test_impulse_position_that_ked_implies(ratio, k):
    """Impulse position k that KED implies, REF, four digits; Housner implies 1 and cos^2 something else."""
    assert implied(block(ratio), Ked().coefficient(block(ratio))).impulse_ratio == pytest.approx(k, abs=5e-5)
    momentum = HorizontalMomentum().coefficient(block(ratio))
    assert implied(block(ratio), momentum).impulse_ratio != pytest.approx(k, abs=5e-5)


@pytest.mark.verifies("closed form", "3 l / (1 + 4 l^2)", within="1e-12", control="within")
@pytest.mark.parametrize(("ratio", "friction"), [(0.75, 9 / 13), (1.0, 0.6), (2.0, 6 / 17)])
def test_friction_that_housner_needs(ratio, friction):
    """Friction that Housner's impact takes, REF: mu = 3 l/(1 + 4 l^2); at k = 2/3 it is two thirds of that."""
    demand = [implied(block(ratio), ShiftedImpulse(k=k).coefficient(block(ratio))).friction_demand for k in (1, 2 / 3)]
    assert demand == pytest.approx([friction, 2 * friction / 3], rel=1e-12, abs=0.0)
    assert demand[1] != pytest.approx(friction, rel=1e-2)


# --- distributed impulse --------------------------------------------------------------------------


@pytest.mark.verifies("closed form", "coefficients to 15 digits", within="1e-13", control="within")
@pytest.mark.parametrize(("ratio", "values"), R_Q.items())
def test_distributed_impulse_reference(ratio, values):
    """Distributed impulse, REF for q = 0, 1, 2, per body and vectorised; q = 1.01 does not pass for 1."""
    for q, value in enumerate(values):
        assert DistributedImpulse(q=q).coefficient(block(ratio)) == pytest.approx(value, rel=1e-13, abs=0.0)
        assert DistributedImpulse(q=q).of_slenderness([ratio, 7.0])[0] == pytest.approx(value, rel=1e-13, abs=0.0)
    assert DistributedImpulse(q=1.01).coefficient(block(ratio)) != pytest.approx(values[1], rel=1e-6)


@pytest.mark.verifies("closed form", "coefficients to 16 digits", within="1e-13", control="within")
def test_distributed_impulse_asymmetric_reference():
    """Distributed impulse, REF: I_C = 5/3, h = 2, levers .5 and 1.2, q = 1, and the way back; their product is
    below 1."""
    there = DistributedImpulse(q=1.0).of_geometry(ImpactGeometry(*map(np.asarray, (2.0, 0.5, 1.2, 1 / 3, 4 / 3))))
    back = DistributedImpulse(q=1.0).of_geometry(ImpactGeometry(*map(np.asarray, (2.0, 1.2, 0.5, 1 / 3, 4 / 3))))
    assert there == pytest.approx(0.7750563835119877, rel=1e-13, abs=0.0)
    assert back == pytest.approx(0.9374901693182466, rel=1e-13, abs=0.0)
    assert there * back < 1.0
    assert there != pytest.approx(back, rel=1e-2)


def exponent_by_quadrature(kappa, stretches, start, end, q):
    """ln(1/r) with the centre of pressure itself integrated: s_c = Int s (s-sigma)^q / Int
    (s-sigma)^q."""

    def centre(sigma):
        ahead = [(max(a, sigma), b) for a, b in stretches if b > sigma]
        if not ahead:
            return end
        force = sum(quad(lambda s: (s - sigma) ** q, a, b, epsrel=1e-12)[0] for a, b in ahead)
        return sum(quad(lambda s: s * (s - sigma) ** q, a, b, epsrel=1e-12)[0] for a, b in ahead) / force

    def slope(sigma):
        arm = kappa * centre(sigma)
        return arm / (1.0 + arm * sigma)

    cuts = sorted({start, end, *np.ravel(stretches).tolist()})
    return sum(quad(slope, a, b, epsrel=1e-11, epsabs=0.0)[0] for a, b in pairwise(cuts))


@pytest.mark.verifies("computed anew", "nested quadrature by SciPy", within="1e-10", control="within")
@pytest.mark.parametrize("foot", ["left", "right"])
@pytest.mark.parametrize("q", [0.0, 1.0, 2.5])
def test_distributed_impulse_on_two_legs(q, foot):
    """A base that touches in two stretches: against nested quadrature to 1e-10; filling the gap does not
    pass."""
    body = portal()
    side, x = body.side(foot), body.centre[0]
    flip = 1.0 if foot == "right" else -1.0
    stretches = sorted(tuple(sorted(flip * (s - x) for s in ends)) for ends in ((0.0, 0.2), (0.8, 1.1)))
    start, end = stretches[0][0], stretches[1][1]
    kappa = side.mass / (side.moment_of_inertia - side.mass * side.half_width**2)
    r = DistributedImpulse(q=q).coefficient(body, foot)
    assert r == pytest.approx(np.exp(-exponent_by_quadrature(kappa, stretches, start, end, q)), rel=1e-10, abs=0.0)
    assert r != pytest.approx(np.exp(-exponent_by_quadrature(kappa, [(start, end)], start, end, q)), rel=1e-3)


@pytest.mark.verifies("behaviour")
def test_a_slab_on_two_strips_stops():
    """Where the impulse of the strips alone would throw the slab back, as Housner's does, it stops: r = 0."""
    outline = [(-0.5, 0), (-0.45, 0), (-0.45, 0.02), (0.4, 0.02), (0.4, 0), (0.5, 0), (0.5, 0.2), (-0.5, 0.2)]
    slab = rk.Section.from_points(outline)
    for foot in ("left", "right"):
        assert Housner().raw_coefficient(slab, foot) < 0.0
        for q in (0.0, 1.0, 2.5):
            assert DistributedImpulse(q=q).coefficient(slab, foot) == 0.0
    # on its whole base it goes on
    assert DistributedImpulse(q=0.0).coefficient(rk.Block(width=1.0, height=0.2)) > 0.1


@pytest.mark.verifies("closed form", "the closed form of an unbroken base", within="1e-9", control="within")
@pytest.mark.parametrize("q", [0.0, 0.5, 1.0, 3.0])
@pytest.mark.parametrize("levers", [(0.5, 0.5), (0.3, 0.7)])
def test_quadrature_route_equals_closed_form(q, levers):
    """Stretches that tile the base, sent through the quadrature, give the closed form; with a gap they do
    not."""
    model, (back, ahead) = DistributedImpulse(q=q), levers
    geometry = ImpactGeometry(*map(np.asarray, (1.0, back, ahead, 1 / 12, 4 / 12)))
    closed = float(model.of_geometry(geometry))
    for stretches in ([(-back, ahead)], [(-back, -0.1), (-0.1, 0.25), (0.25, ahead)]):
        assert model._by_quadrature(np.array(stretches), geometry) == pytest.approx(closed, rel=1e-9, abs=0.0)
    gap = [(-back, -0.1), (0.25, ahead)]
    assert model._by_quadrature(np.array(gap), geometry) != pytest.approx(closed, rel=1e-4)


def by_definition(ratio, q):
    """The integral for a rectangle in 30 digits, levers in units of b."""
    with mp.workdps(30):
        mu, q = 3 / (1 + 4 * mp.mpf(ratio) ** 2), mp.mpf(q)
        arm = lambda s: mu * ((q + 1) + s) / (q + 2)  # noqa: E731
        return mp.exp(-mp.quad(lambda s: arm(s) / (1 + arm(s) * s), [-1, -0.5, 0, 1]))


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "30-digit quadrature by mpmath", within="1e-12", control="within")
@pytest.mark.parametrize("q", [0.0, 0.3, 1.0, 2.5, 3.0, 6.0, 100.0])
def test_closed_form_across_the_zero_discriminant(q, agreement):
    """Both forms (arctangent, logarithm) and the series between them, to 1e-12 of 30-digit quadrature."""
    ratios = [0.3, 0.8, 1.0, 2.0, 20.0, 1000.0]
    mu = 4 * (q + 2) / (q + 1) ** 2
    if mu < 3:
        turning = np.sqrt((3 / mu - 1) / 4)
        ratios += [turning * (1 + step) for step in (0.0, 1e-12, 1e-8, -1e-7, 1e-6, 1e-5, -1e-4, 1e-3)]
    ratios = [ratio for ratio in ratios if 1 + 4 * ratio**2 > 3.01 * q / (q + 2)]
    found = DistributedImpulse(q=q).of_slenderness(ratios)
    expected = [float(by_definition(ratio, q)) for ratio in ratios]
    agreement(np.abs(found / expected - 1.0).max(), 1e-12)
    assert found != pytest.approx(
        [float(by_definition(ratio, q * 1.001 + 1e-3)) for ratio in ratios], rel=1e-12, abs=0.0
    )


@pytest.mark.verifies("closed form", "Housner's coefficient", within="3.0 / q", control="within")
@pytest.mark.parametrize("q", [1e2, 1e4, 1e5, 1e6])
def test_distributed_impulse_tends_to_housner(q):
    """q to infinity is Housner exactly; at finite q it differs by about 3/q, whatever the size
    of q."""
    for ratio in (0.8, 1.0, 2.0, 4.0):
        housner = Housner().coefficient(block(ratio))
        assert DistributedImpulse(q=q).coefficient(block(ratio)) == pytest.approx(housner, abs=3.0 / q + 1e-12)
    assert DistributedImpulse(q=10.0).coefficient(block(2.0)) != pytest.approx(0.7, abs=1e-2)


@pytest.mark.verifies("damage", "exponents beyond 1e6")
@pytest.mark.parametrize("q", [1.1e6, 1e12, 1e100])
def test_distributed_impulse_refuses_what_is_housner_to_its_digits(q):
    """Beyond q = 1e6 the closed form would lose digits: refused, with the model that it has become."""
    with pytest.raises(InvalidValueError, match="Housner"):
        DistributedImpulse(q=q)


@pytest.mark.verifies("invariant", "the same portal of another size", within="1e-9")
@pytest.mark.parametrize("size", [0.01, 1.0, 100.0, 1000.0])
@pytest.mark.parametrize("q", [1.0, 50.0, 200.0])
def test_quadrature_route_does_not_see_the_metre(size, q):
    """A portal of any size has one coefficient, also for steep pressure laws (no overflow of metres to the
    q)."""
    expected = DistributedImpulse(q=q).coefficient(portal())
    assert DistributedImpulse(q=q).coefficient(portal(size)) == pytest.approx(expected, rel=1e-9, abs=0.0)


@pytest.mark.verifies("closed form", "k = (q + 1) / (q + 2)", within="1e-6", control="within")
@pytest.mark.parametrize("q", [0.0, 1.0, 2.0, 5.0])
def test_distributed_impulse_slender_limit(q):
    """Slender bodies imply k = (q + 1)/(q + 2): 1 - r = (3 k/2)/l^2; another q is told
    apart."""
    ratio = 1e3
    k = implied(block(ratio), DistributedImpulse(q=q).coefficient(block(ratio))).impulse_ratio
    assert k == pytest.approx((q + 1) / (q + 2), rel=1e-6)
    assert k != pytest.approx((q + 1.1) / (q + 2.1), rel=1e-3)


# --- plastic Winkler bed --------------------------------------------------------------------------


@pytest.mark.verifies("computed anew", "coefficients to 8 digits", within="8 digits", control="within")
@pytest.mark.parametrize(("ratio", "value"), WINKLER.items())
def test_plastic_winkler_reference(ratio, value):
    """Plastic Winkler bed: coefficients of rectangles are REF in all 8 digits; another slenderness is not."""
    assert round(PlasticWinkler().coefficient(block(ratio)), 8) == value
    assert round(PlasticWinkler().coefficient(block(ratio * 1.0001)), 8) != value


@pytest.mark.verifies("computed anew", "k = 0.60428, five digits", within="1e-5", control="within")
def test_plastic_winkler_slender_limit():
    """Slender bodies imply k = .60428 (five digits), neither 2/3 nor 3/5."""
    k = implied(block(1e3), PlasticWinkler().coefficient(block(1e3))).impulse_ratio
    assert k == pytest.approx(0.60428, abs=1e-5)
    assert abs(k - 0.6) > 1e-3


@pytest.mark.verifies("invariant", "the same values one by one", within="1e-9", control="within")
def test_plastic_winkler_long_arrays():
    """An array longer than 64 gives what its elements give one by one, to 1e-9, squat and slender alike."""
    ratios = np.geomspace(1e-2, 1e3, 101)
    at_once = PlasticWinkler().of_slenderness(ratios)
    picked = slice(None, None, 4)
    one_by_one = [PlasticWinkler().coefficient(block(ratio)) for ratio in ratios[picked]]
    assert at_once[picked] == pytest.approx(one_by_one, rel=1e-9, abs=0.0)
    assert np.roll(at_once, 1)[picked][1:] != pytest.approx(one_by_one[1:], rel=1e-9, abs=0.0)


@pytest.mark.verifies("computed anew", "coefficients to 8 digits", within="6e-9", control="within")
def test_plastic_winkler_long_arrays_keep_the_printed_digits():
    """Plastic Winkler bed, REF to 8 digits also where they come out of an array of 100 values."""
    ratios = np.concatenate([list(WINKLER), np.linspace(0.5, 5.0, 94)])
    found = PlasticWinkler().of_slenderness(ratios)[: len(WINKLER)]
    assert found == pytest.approx(list(WINKLER.values()), abs=6e-9)
    assert found * (1 + 1e-6) != pytest.approx(list(WINKLER.values()), abs=6e-9)


def bed_of_points(kappa, back, stretches, count=300):
    """The same bed point by point: `count` springs a stretch, each holding while it descends, gone once it
    rises."""
    springs = np.concatenate([a + (b - a) * (np.arange(count) + 0.5) / count for a, b in stretches])
    weights = np.concatenate([np.full(count, (b - a) / count) for a, b in stretches])

    def rates(_, state):
        v, omega, indentation = state[0], state[1], state[2:]
        down = omega * springs - v
        pressure = np.where(down > 0.0, weights * indentation, 0.0)
        return np.concatenate([[pressure.sum(), -kappa * (springs @ pressure)], np.maximum(down, 0.0)])

    start = np.concatenate([[-back, 1.0], np.zeros(len(springs))])
    longest = 200.0 / np.sqrt(weights.sum())
    return solve_ivp(rates, (0.0, longest), start, rtol=1e-7, atol=1e-9).y[1, -1]


@pytest.mark.verifies("computed anew", "300 single springs a stretch, by SciPy", within="1e-3", control="within")
@pytest.mark.parametrize(
    "stretches", [[(-1.0, 1.0)], [(-1.0, -0.5), (0.2, 1.0)], [(-1.0, -0.9), (-0.2, 0.3), (0.8, 1.0)]]
)
def test_plastic_winkler_against_single_springs(stretches):
    """The moment form equals a bed of single springs; 300 of them a stretch are within 1e-3 of the
    continuum."""
    body = on_stretches([(0.5 * a, 0.5 * b) for a, b in stretches])
    found = PlasticWinkler().coefficient(body)
    assert found == pytest.approx(bed_of_points(3 / 17, 1.0, stretches), abs=1e-3)
    assert found != pytest.approx(bed_of_points(3 / 17, 1.0, [(-0.6, 1.0)]), abs=1e-3)


# --- bases between full contact and two points ----------------------------------------------------


@pytest.mark.verifies("closed form", "Housner's coefficient", within="1e-9", control="within")
@pytest.mark.parametrize("name", ["distributed-impulse", "plastic-winkler"])
@pytest.mark.parametrize("stretches", [[], [(-0.5, -0.5 + 1e-12), (0.5 - 1e-12, 0.5)]])
def test_two_points_are_housner(name, stretches):
    """A base that touches in its two feet only takes the impulse at the new foot: Housner."""
    body = on_stretches(stretches)
    assert rk.coefficient_of_restitution(body, name) == pytest.approx(0.7, abs=1e-9)
    assert rk.coefficient_of_restitution(on_stretches([(-0.5, 0.5)]), name) != pytest.approx(0.7, abs=1e-2)


@pytest.mark.verifies("closed form", "Housner's coefficient", within="the width of the pads, and 1e-9")
@pytest.mark.parametrize("width", [1e-2, 1e-4, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-12])
@pytest.mark.parametrize("name", ["distributed-impulse", "plastic-winkler"])
def test_small_feet_tend_to_housner(name, width):
    """Pads of a width w at both feet: r within w of Housner's for every w, without a jump anywhere."""
    r = rk.coefficient_of_restitution(on_stretches([(-0.5, -0.5 + width), (0.5 - width, 0.5)]), name)
    assert r == pytest.approx(0.7, abs=width + 1e-9)


@pytest.mark.verifies("closed form", "one midpoint between the feet", within="1e-4", control="within")
@pytest.mark.parametrize("name", ["distributed-impulse", "plastic-winkler"])
def test_pad_between_pointed_feet(name):
    """A pad in the middle and two feet that are points: one midpoint, r = .85 at lambda = 2."""
    body = on_stretches([(-1e-5, 1e-5)])
    assert rk.coefficient_of_restitution(body, name) == pytest.approx(0.85, abs=1e-4)
    # the same as a polygon: spikes of no width at the feet, a pad on the middle
    outline = [
        (-0.5, 0),
        (-0.4, 0.01),
        (-1e-5, 0.01),
        (-1e-5, 0),
        (1e-5, 0),
        (1e-5, 0.01),
        (0.4, 0.01),
        (0.5, 0),
    ]
    section = rk.Section.from_points([*outline, (0.5, 2), (-0.5, 2)])
    side = section.side("right")
    kappa = side.mass * 0.25 / (side.moment_of_inertia - side.mass * 0.25)
    assert rk.coefficient_of_restitution(section, name) == pytest.approx(1 / (1 + kappa), abs=1e-4)
    housner = (1 - kappa) / (1 + kappa)
    assert housner != pytest.approx(1 / (1 + kappa), abs=1e-4)
