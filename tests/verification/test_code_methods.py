"""Code methods: closed forms, the engine under pulses, invariances, and how often bodies called safe overturn."""

import math

import numpy as np
import pytest

import rocking as rk
from rocking.conventions import g
from rocking.decision.code_methods import CODE_METHODS, compare_code_methods
from rocking.decision.code_methods.methods import BodySides, Shaking
from rocking.studies import MotionList, SyntheticSet, minimum_overturning_acceleration

pytestmark = pytest.mark.verifies(room="studies")

RATIOS = (1.2, 2.0, 4.0, 8.0)
BLOCKS = [rk.Block(width=0.5, height=0.5 * ratio) for ratio in RATIOS]
CABINET = rk.Block(width=0.8, height=2.2, depth=1.2, mass=650.0, centre=(0.52, 0.9))
ASCE, ISHIYAMA, KANEKO, PULSE = (CODE_METHODS[n] for n in ("asce-43", "ishiyama", "kaneko-hayashi", "housner-pulse"))
LEVEL = 0.999  # of exact intervals
HEIGHTS = (0.6, 1.2, 4.0, 8.0)
FIRM, SOFT = (0.77, 0.46, 0.06, 0.0), (1.0, 0.99, 0.77, 0.43)
"""Shares of 150 motions each that overturn blocks of H/B = 5 at PGA = 2 g b/h, by a program of its own."""


class Spectrum(Shaking):
    """Motions of unit peaks whose spectral acceleration is the same at every period."""

    acceleration = velocity = np.ones((1, 1, 1))

    def spectra(self, periods, damping):
        """Return 1 m/s2 throughout."""
        return np.ones((1, periods.size))


FLAT = Spectrum((rk.GroundMotion([0.0, 1.0, 0.0], 0.1),))


@pytest.mark.verifies("closed form", "Housner's coefficient, 1 - 3/2 sin(alpha)^2", within="1e-14",
                      control="test_another_model_of_impact_has_another_coefficient")  # fmt: skip
def test_the_coefficient_of_asce_is_housners():
    """C_R of rectangles is Housner's coefficient of restitution, and the damping is that of two impacts a cycle."""
    sides = BodySides.of(BLOCKS)
    found = ASCE.restitution(sides)
    expected = [rk.coefficient_of_restitution(block, "housner") for block in BLOCKS]
    np.testing.assert_allclose(found, np.transpose([expected, expected]), rtol=1e-14)
    beta = ASCE.damping(sides)
    np.testing.assert_allclose(np.exp(-2.0 * math.pi * beta / np.sqrt(1.0 - beta**2)), found**2, rtol=1e-13)


@pytest.mark.verifies("negative control")
def test_another_model_of_impact_has_another_coefficient():
    """KED is not what ASCE's C_R says; a body so squat that C_R is not above zero has no capacity."""
    found = ASCE.restitution(BodySides.of(BLOCKS))[:, 0]
    assert (np.abs(found - [rk.coefficient_of_restitution(block, "ked") for block in BLOCKS]) > 1e-3).all()
    squat = BodySides.of([rk.Block(width=1.0, height=0.6)])
    assert np.isnan(ASCE.damping(squat)).all()
    assert np.isnan(ASCE.capacity(squat, FLAT)).all()


@pytest.mark.verifies("closed form", "the work of lifting a slender body, g alpha (2 - theta/alpha)", within="1 %",
                      control="within")  # fmt: skip
def test_the_capacity_of_asce_is_a_work():
    """Of a slender block 2 g f1 / theta falls from nearly twice to once what lifts it, and f_e is that of the work."""
    sides, rotations = BodySides.of([rk.Block(width=0.02, height=1.0)]), np.linspace(0.1, 1.0, 10)
    alpha = sides.angle[0, 0]
    capacity = np.array([ASCE.oscillator(sides, ratio * sides.angle)[1][0, 0] for ratio in rotations])
    # the tolerance holds terms of alpha^2 = 4e-4
    np.testing.assert_allclose(capacity, g * alpha * (2.0 - rotations), rtol=0.01)
    assert not np.allclose(capacity, 2.0 * g * alpha, rtol=0.01)
    needle = BodySides.of([rk.MassPoints([(0.0, 1e9)], [1.0], (-1.0, 1.0))])  # no digits cancel
    assert ASCE.oscillator(needle, needle.angle)[1] == pytest.approx(g * needle.angle, rel=1e-9)
    # half the stiffness times theta^2 is the work m g R (1 - cos) that the rotation needs: K = I_O omega^2
    side, sides = CABINET.side("right"), BodySides.of([CABINET])
    alpha, size = side.slenderness_angle, side.semi_diagonal
    for theta in alpha * rotations:
        period, _ = ASCE.oscillator(sides, np.full((1, 2), theta))
        work = side.mass * g * size * (math.cos(alpha - theta) - math.cos(alpha))
        stiffness = side.moment_of_inertia * (2.0 * math.pi / period[0, 0]) ** 2
        assert 0.5 * stiffness * theta**2 == pytest.approx(work, rel=1e-12)
    flat = ASCE.capacity(BodySides.of([BLOCKS[2]]), FLAT)
    alpha = BLOCKS[2].slenderness_angle
    assert flat[0, 0] == pytest.approx(2.0 * g * (1.0 / math.cos(alpha) - 1.0) / alpha, rel=1e-12)


@pytest.mark.verifies("closed form", "both published forms of the velocity", within="2.5 %", control="within")
def test_both_forms_of_ishiyamas_velocity_agree():
    """The form with R is exact for rectangles; 10 B / sqrt(H), in cm, is its slender limit but for rounding of 10.2."""
    found = ISHIYAMA.velocity(BodySides.of(BLOCKS))[:, 0]
    for block, velocity in zip(BLOCKS, found, strict=True):
        alpha, size = block.slenderness_angle, block.semi_diagonal
        form = 0.4 * math.sqrt(8.0 * g * size / 3.0 * (1.0 - math.cos(alpha)) / math.cos(alpha) ** 2)
        assert velocity == pytest.approx(form, rel=1e-13)
    slender = rk.Block(width=0.02, height=1.0)
    in_cm = 10.0 * 2.0 / math.sqrt(100.0)
    (velocity,) = ISHIYAMA.velocity(BodySides.of([slender]))[:, 0]
    assert 100.0 * velocity == pytest.approx(in_cm, rel=0.025)  # 0.4 sqrt(2 g / 3) is 10.2 in cm and s
    assert 100.0 * velocity != pytest.approx(in_cm, rel=0.01)


@pytest.mark.slow
@pytest.mark.verifies("second engine", "the histories of the engine under an impulse", within="1e-3", control="within")
@pytest.mark.parametrize("block", BLOCKS[1:], ids=str)
def test_an_impulse_of_that_velocity_overturns(block):
    """A push so short that it is one jump of the ground's velocity overturns just above v / 0.4, and not below."""
    (velocity,) = ISHIYAMA.velocity(BodySides.of([block]))[:, 0] / 0.4
    time = 1e-5
    ends = [
        rk.simulate(block, rk.pulses.rectangular(factor * velocity / time, time), 0.0).outcome.name
        for factor in (1.0 - 1e-3, 1.0 + 1e-3)
    ]
    assert ends == ["ROCKED", "OVERTURNED"]


@pytest.mark.verifies("closed form", "cosh p t1 = 1 + 1 / (2 A (A - 1)), and the linear engine", within="1e-9",
                      control="within")  # fmt: skip
@pytest.mark.parametrize("duration", [0.05, 0.3, 1.0])
def test_housners_pulse_overturns_as_the_engine_says(duration):
    """The acceleration solves Housner's equation, and is the least that overturns in the linear equations."""
    block = BLOCKS[2]
    (found,) = PULSE.acceleration(BodySides.of([block]), np.array(duration))[:, 0]
    ratio = found / (g * block.slenderness_angle)
    assert math.cosh(block.frequency_parameter * duration) == pytest.approx(
        1.0 + 0.5 / (ratio * (ratio - 1.0)), rel=1e-12
    )
    pulse = rk.pulses.rectangular(1.0, duration)
    least = minimum_overturning_acceleration(block, pulse, 0.0, linear=True, samples=40, max_pga=4.0 * found)
    assert least.minimum == pytest.approx(found, rel=1e-9)
    assert least.minimum != pytest.approx(1.001 * found, rel=1e-9)


@pytest.mark.verifies("published", "f_b = 15.6 / sqrt(H) (1 + B/H)^-1.5 in cm and s", within="0.1 %", control="within")
def test_both_branches_of_kaneko_and_hayashi_meet():
    """A_R50 goes over from g (B/H)(1 + B/H) to the branch that grows with the frequency at f_b, without a jump."""
    for block in BLOCKS:
        ratio, height = block.width / block.height, 100.0 * block.height
        published = 15.6 / math.sqrt(height) * (1.0 + ratio) ** -1.5
        slow = g * ratio * (1.0 + ratio)
        quick = 0.01 * 10.0 * 100.0 * block.width / math.sqrt(height) * (1.0 + ratio) ** 2.5 * 2.0 * math.pi
        assert slow / quick == pytest.approx(published, rel=1e-3)
        found = [
            float(KANEKO.acceleration(BodySides.of([block]), np.array(factor * published))[0, 0])
            for factor in (0.5, 0.998, 1.002, 2.0)
        ]
        assert found[:2] == pytest.approx([slow, slow], rel=1e-13)
        assert found[2:] == pytest.approx([1.002 * quick * published, 2.0 * quick * published], rel=1e-12)


@pytest.mark.verifies("invariant", "the mirror image, scaled motions, and either side alone", within="1e-12",
                      control="within")  # fmt: skip
def test_the_worse_side_of_a_body_counts():
    """A body and its mirror image have one capacity, the lesser of both sides; motions twice as strong have half."""
    shaking = Shaking.of([rk.pulses.sine(2.0, 0.7), rk.pulses.cosine(1.5, 0.4)])
    twice = Shaking.of([motion.scaled(2.0) for motion in shaking.motions])
    sides, mirrored = (BodySides.of([body]) for body in (CABINET, CABINET.mirrored()))
    for method in CODE_METHODS.values():
        either = method.of_sides(sides, shaking)
        worse = either.min(axis=2)
        assert (either.max(axis=2) > 1.05 * worse).all()
        capacity = method.capacity(sides, shaking)
        np.testing.assert_allclose(capacity, worse if method.holds(sides, shaking).all() else np.nan, rtol=1e-15)
        np.testing.assert_allclose(method.capacity(mirrored, shaking), capacity, rtol=1e-12)
        np.testing.assert_allclose(method.capacity(sides, twice), 0.5 * capacity, rtol=1e-12)


@pytest.mark.verifies("behaviour")
def test_outside_its_domain_a_method_says_nothing():
    """By what their domains say in words: alpha, a T-section, no symmetry, a vertical motion; a slender block is in."""
    slender, squat = rk.Block(width=0.5, height=1.5), rk.Block(width=0.5, height=0.75)  # alpha = 18.4, 33.7 degrees
    stem, bar = [(-0.1, 0.0), (0.1, 0.0), (0.1, 1.0)], [(0.3, 1.0), (0.3, 1.2), (-0.3, 1.2), (-0.3, 1.0)]
    tee = rk.Section.from_points([*stem, *bar, (-0.1, 1.0)])
    bodies = [slender, squat, tee, CABINET]
    level = rk.GroundMotion([0.0, 2.0, -2.0, 0.0], 0.1)
    jolted = rk.GroundMotion([0.0, 2.0, -2.0, 0.0], 0.1, vertical=[0.0, 1.0, -1.0, 0.0])
    sides = BodySides.of(bodies)
    said = {name: ~np.isnan(each.capacity(sides, Shaking.of([level, jolted]))) for name, each in CODE_METHODS.items()}
    assert said.pop("asce-43").tolist() == [[True, True, True, False], [False] * 4]
    assert said.pop("kaneko-hayashi").tolist() == [[True, True, False, False]] * 2
    assert said.pop("housner-pulse").tolist() == [[True, False, True, True]] * 2  # CABINET's weaker side: 17.3 degrees
    assert all(each.all() for each in said.values())


@pytest.mark.slow
@pytest.mark.verifies(
    "computed anew",
    "the search for all crossings",
    within="0.1 % below, one step of the levels above",
    control="within",
)
def test_what_overturns_is_the_least_of_either_way_round():
    """The least factor is the minimum acceleration of the body or of its mirror image, whichever is less."""
    # above by one step of the levels, as the finer search finds stretches that are thinner
    pulses = [rk.pulses.sine(1.0, 0.9), rk.pulses.cosine(1.0, 1.4)]
    found = compare_code_methods([BLOCKS[2], CABINET], pulses, "housner")
    assert found.asymmetric.tolist() == [False, True]
    for k, pulse in enumerate(pulses):
        least = [
            minimum_overturning_acceleration(body, pulse, "housner", samples=100).minimum
            for body in (BLOCKS[2], CABINET, CABINET.mirrored())
        ]
        over = found.overturning[k] / [least[0], min(least[1:])]
        assert ((over > 1.0 - 1e-3) & (over < 1.07)).all()
        assert least[1] / least[2] > 1.07 or least[2] / least[1] > 1.07


@pytest.mark.slow
@pytest.mark.verifies("computed anew", "shares of 150 motions by another program", within="the exact interval",
                      control="test_other_blocks_have_other_shares")  # fmt: skip
@pytest.mark.parametrize(("family", "shares"), [("firm-ground", FIRM), ("soft-ground", SOFT)])
def test_blocks_that_the_italian_check_calls_safe_overturn(family, shares, tables):
    """At PGA = 2 g b/h all four blocks are called safe; how many overturn falls with their size, as it should."""
    found = tables(family)
    for k, share in enumerate(shares):
        low, high = interval(found, k)
        assert low <= share <= high
    fell = [found.called_safe("italian-linear", k, 0).fraction for k in range(4)]
    assert fell == sorted(fell, reverse=True)
    assert found.called_safe("static").safe == 0


@pytest.mark.slow
@pytest.mark.verifies("negative control")
def test_other_blocks_have_other_shares(tables):
    """The shares of the smallest block are not those of the largest, nor those of firm ground those of soft."""
    firm, soft = tables("firm-ground"), tables("soft-ground")
    low, _ = interval(firm, 0)
    assert low > FIRM[3]
    assert interval(firm, 2)[1] < SOFT[2]
    assert interval(soft, 3)[0] > FIRM[3]


@pytest.mark.slow
@pytest.mark.verifies("published", "half of the bodies overturn at A_R50", within="20 %", control="within")
def test_who_knows_the_velocity_is_nearer(tables):
    """Kaneko and Hayashi's median ratio is near 1 on either ground; that of acceleration alone changes with size."""
    for family in ("firm-ground", "soft-ground"):
        found = tables(family)
        assert found.bias("kaneko-hayashi").median == pytest.approx(1.0, abs=0.2)  # its motions were others
        assert found.bias("housner-pulse").median != pytest.approx(1.0, abs=0.2)
        assert found.bias("kaneko-hayashi").scatter < 0.6 * found.bias("italian-linear").scatter + 0.1
        alone = [found.bias("italian-linear", k).median for k in range(4)]
        assert alone[0] > 1.3 * alone[3]


@pytest.mark.slow
@pytest.mark.verifies("behaviour")
def test_real_records_show_the_same(shared_records):
    """Under real records too, small blocks that the check calls safe overturn more often than large ones."""
    motions = [rk.read_motion(path) for path in sorted((shared_records / "peer").iterdir())]
    blocks = [rk.Block(width=height / 5.0, height=height) for height in HEIGHTS]
    found = compare_code_methods(blocks, motions, "housner", levels=[2.0])
    fell = [found.called_safe("italian-linear", k, 0).overturned for k in range(4)]
    assert fell == sorted(fell, reverse=True)
    assert fell[0] > fell[3]


def interval(found, k):
    """Exact interval of the share of one block that overturns."""
    from rocking.statistics import share_interval

    called = found.called_safe("italian-linear", k, 0)
    assert called.safe == called.total
    return share_interval(called.overturned, called.safe, LEVEL)


@pytest.fixture(scope="module")
def tables():
    """Return what gives the comparison of both families, each computed once."""
    found = {}

    def of(family):
        if family not in found:
            blocks = [rk.Block(width=height / 5.0, height=height) for height in HEIGHTS]
            motions = SyntheticSet(family, count=40, seed=3)
            kept = MotionList([motions[k] for k in range(40)])
            found[family] = compare_code_methods(blocks, kept, "housner", levels=[2.0])
        return found[family]

    return of
