"""Code methods beside histories: what a comparison holds, its statistics, and what is refused."""

import math

import numpy as np
import pytest
from scipy.stats import binom

import rocking as rk
from rocking.conventions import g
from rocking.decision import compare_code_methods
from rocking.decision.code_methods import CODE_METHODS
from rocking.decision.code_methods.comparison import CodeComparison
from rocking.decision.code_methods.methods import BodySides, Shaking, VerticalMotion
from rocking.decision.remedies import Margins
from rocking.errors import InvalidValueError
from rocking.motions.components import with_vertical

SMALL, LARGE = (rk.Block(width=0.2 * height, height=height) for height in (0.6, 6.0))
PULSES = [rk.pulses.sine(1.0, period) for period in (0.3, 0.4, 0.5, 0.6, 0.8, 1.2)]


@pytest.fixture(scope="module")
def found():
    return compare_code_methods([SMALL, LARGE], PULSES, "housner", levels=[1.5, 1.9])


def test_shapes_and_words(found):
    assert found.capacity.shape == (len(CODE_METHODS), 6, 2)
    assert found.overturning.shape == (6, 2)
    assert found.overturned.shape == found.factors.shape == (6, 2, 2)
    assert found.levels == ("pga/(g tan alpha) = 1.5", "pga/(g tan alpha) = 1.9")
    assert found.bodies == (repr(SMALL), repr(LARGE))


def test_what_is_called_safe_is_counted(found):
    """Counts of all cases are those of single ones; a case is safe where its demand is no more than the capacity."""
    for name in CODE_METHODS:
        every = [found.called_safe(name, k, j) for k in (0, 1) for j in (0, 1)]
        whole = found.called_safe(name)
        assert (whole.safe, whole.overturned) == (sum(e.safe for e in every), sum(e.overturned for e in every))
    called = found.called_safe("italian-linear", 0, 1)
    assert called.safe == 6
    assert called.overturned == int(found.overturned[:, 0, 1].sum())
    assert called.ratio == pytest.approx(1.9 / 2.0, rel=1e-12)
    assert math.isnan(found.called_safe("static").fraction)
    assert found.called_safe("static").interval is None


def test_bias_is_the_median_ratio(found):
    """By hand: the mean of the third and fourth of six ratios; motions that never overturn are below all others."""
    ratios = np.sort(found.capacity[1, :, 0] / found.overturning[:, 0])
    bias = found.bias("italian-linear", 0)
    assert bias.median == pytest.approx(0.5 * (ratios[2] + ratios[3]), rel=1e-15)
    assert bias.median != pytest.approx(ratios[2], rel=1e-3)  # not the lower middle value
    assert bias.interval[0] <= bias.median <= bias.interval[1]
    assert bias.count == 6
    assert bias.censored == int(np.isinf(found.overturning[:, 0]).sum())
    several = compare_code_methods(SMALL, PULSES[:2], "housner")
    assert math.isnan(several.bias("static").scatter)  # too few motions to say


def comparison(truth, factors=1.0, fell=0.0):
    """Return one method of capacity 1 beside intensities that overturn, one row per motion."""
    truth = np.array(truth, dtype=np.float64)
    return CodeComparison(
        (CODE_METHODS["static"],), tuple("b" * truth.shape[1]), tuple("m" * len(truth)), ("as recorded",),
        np.ones((1, *truth.shape)), truth, factors * np.ones((*truth.shape, 1)), fell * np.ones((*truth.shape, 1)),
        np.zeros(truth.shape[1], dtype=bool), "",
    )  # fmt: skip


def test_the_median_of_two_is_their_mean():
    """Ratios 0.5 and 2 have the median 1.25; a ratio that is only known to be small leaves the median unknown, 0."""
    assert comparison([[2.0], [0.5]]).bias("static").median == 1.25
    assert comparison([[2.0], [math.inf]]).bias("static").median == 0.0
    assert comparison([[2.0], [0.5], [math.inf]]).bias("static").median == 0.5
    assert math.isnan(comparison([[math.nan]]).bias("static").median)


def test_the_median_of_demand_over_capacity_is_that_of_all_cases():
    """Demands .5, .8, .6 and 2 of a capacity of 1: the mean of .6 and .8, and three of four are called safe."""
    called = comparison([[2.0]] * 4, np.array([0.5, 0.8, 0.6, 2.0])[:, None, None]).called_safe("static")
    assert called.ratio == pytest.approx(0.7, rel=1e-15)
    assert (called.total, called.safe) == (4, 3)


def test_the_interval_of_a_share_draws_whole_motions():
    """10 of 40 motions overturn: shares of motions drawn again are binomial; twins under each motion change nothing."""
    fell = (np.arange(40.0) < 10.0)[:, None, None]
    alone = comparison(np.full((40, 1), 2.0), 0.5, fell).called_safe("static")
    assert (alone.safe, alone.overturned) == (40, 10)
    wanted = binom.ppf([0.025, 0.975], 40, 0.25) / 40.0
    np.testing.assert_allclose(alone.interval, wanted, rtol=0.0, atol=1.5 / 40.0)  # 1000 draws of whole numbers
    twins = comparison(np.full((40, 2), 2.0), 0.5, np.repeat(fell, 2, axis=1)).called_safe("static")
    assert twins.interval == pytest.approx(alone.interval, rel=1e-12)


@pytest.mark.parametrize(("count", "known"), [(4, False), (5, True), (6, True)])
def test_intervals_need_five_motions(count, known):
    truth = np.exp(-0.1 * np.arange(count))[:, None]
    found = comparison(truth, 0.5, (np.arange(count) < 2.0)[:, None, None])
    assert (found.called_safe("static").interval is not None) is known
    assert math.isfinite(found.bias("static").scatter) is known
    assert math.isfinite(found.bias("static").interval[0]) is known


def test_scatter_is_half_the_distance_of_the_outer_quantiles():
    """Ratios exp(k/10), k = 0 to 100: ln q84 = 8.4 and ln q16 = 1.6 fall on values, so that the scatter is 3.4."""
    bias = comparison(np.exp(-0.1 * np.arange(101.0))[:, None]).bias("static")
    assert bias.scatter == pytest.approx(3.4, rel=1e-12)
    assert bias.median == pytest.approx(math.exp(5.0), rel=1e-12)
    # 20 of 101 do not overturn: the 16 % quantile is unknown
    some = np.exp(-0.1 * np.arange(101.0))[:, None]
    some[:20] = math.inf
    assert comparison(some).bias("static").scatter == math.inf


def test_the_interval_of_the_median_draws_whole_motions():
    """Two bodies alike under each motion count as one: the interval of n motions is the binomial one of the median.

    The median of 41 drawn again exceeds the value of rank k where at most 20 draws are of rank k or less.
    """
    values = np.exp(-0.01 * np.arange(41.0))[:, None]
    low, high = comparison(values).bias("static").interval
    ranks = np.arange(41) + 1.0
    share = binom.cdf(20, 41, ranks / 41.0)  # probability that the median is above the rank
    wanted = [math.exp(0.01 * np.flatnonzero(share <= 1.0 - level)[0]) for level in (0.025, 0.975)]
    np.testing.assert_allclose(np.log([low, high]), np.log(wanted), rtol=0.0, atol=0.021)  # 1000 draws: 2 ranks
    twins = comparison(np.repeat(values, 2, axis=1)).bias("static").interval
    np.testing.assert_allclose(twins, (low, high), rtol=1e-12)
    # negative control: cells drawn one by one would give an interval narrower by the root of two
    apart = binom.cdf(40, 82, ranks / 41.0)
    ends = [math.exp(0.01 * np.flatnonzero(apart <= 1.0 - level)[0]) for level in (0.025, 0.975)]
    assert math.log(ends[1] / ends[0]) < 0.8 * math.log(twins[1] / twins[0])


def test_methods_are_chosen_by_name():
    one = compare_code_methods(SMALL, PULSES[0], methods=["ishiyama"], restitution="ked")
    assert [each.name for each in one.methods] == ["ishiyama"]
    assert one.levels == ("as recorded",)


@pytest.mark.parametrize("method", CODE_METHODS.values(), ids=list(CODE_METHODS))
def test_every_method_says_where_it_stands(method):
    assert all((method.title, method.reference, method.domain, method.reading, method.example))
    assert type(method).__doc__


def test_what_is_refused():
    box = rk.dynamics.SpatialBody.box(width=0.3, depth=0.3, height=1.0)
    with pytest.raises(InvalidValueError, match="code methods need plane bodies"):
        BodySides.of([box])
    with pytest.raises(InvalidValueError, match="code methods need plane bodies"):
        compare_code_methods(box, PULSES, restitution="ked")
    with pytest.raises(InvalidValueError, match="at least one body"):
        compare_code_methods([], PULSES, restitution="ked")
    with pytest.raises(InvalidValueError, match="method"):
        compare_code_methods(SMALL, PULSES, methods=["eurocode"], restitution="ked")
    with pytest.raises(InvalidValueError, match="> 0"):
        compare_code_methods(SMALL, rk.GroundMotion([0.0, 0.0, 0.0], 0.1), restitution="ked")


@pytest.mark.slow
def test_a_symmetric_body_with_two_coefficients_has_two_ways_round():
    """A lopsided pulse overturns it less early the one way round than the other: the worse one counts."""
    time = np.arange(0.0, 3.0, 0.01)
    push = np.where(time < 0.9, np.sin(2.0 * np.pi * time / 0.9) * (1.0 + time), 0.0)
    pushes = [rk.GroundMotion(sign * push, 0.01) for sign in (1.0, -1.0)]
    pair = {"left": 0.55, "right": 0.98}
    one, twin = compare_code_methods([LARGE], pushes, pair), compare_code_methods([LARGE], pushes[::-1], pair)
    assert np.array_equal(one.overturning, twin.overturning)
    assert one.asymmetric.all()
    assert one.overturning[0] == one.overturning[1]
    ways = [Margins.of(LARGE, pushes, r, "pga", None, {}).min_factors_by_polarity for r in (pair, 0.9)]
    assert [len(each) for each in ways] == [2, 1]
    assert ways[0][0][0] != pytest.approx(ways[0][1][0], rel=0.01)


F3 = np.linspace(0.0, 1.0, 1001)
WIDE_BLOCK = rk.Block(width=0.6096, height=0.9144)


def with_fall(along, up):
    """A motion of two components at 1 kHz."""
    return with_vertical(rk.GroundMotion(along, 1e-3), rk.GroundMotion(up, 1e-3))


@pytest.mark.verifies("closed form", "moments about the foot at each instant", within="1e-12", room="studies")
def test_a_falling_ground_is_in_the_static_limit():
    """0.6 g along and 0.2 g down at once: demand over capacity (0.6 + 0.2 b/h) / (b/h) = 1.1, not 0.9."""
    along, up = np.where((F3 > 0.3) & (F3 < 0.6), 0.6 * g, 0.0), np.where(F3 > 0.2, -0.2 * g, 0.0)
    slope = 0.6096 / 0.9144
    static, sides = CODE_METHODS["static"], BodySides.of([WIDE_BLOCK])
    motions = {
        "down": with_fall(along, up), "up": with_fall(along, -up), "alone": rk.GroundMotion(along, 1e-3),
        "apart": with_fall(along, np.where(F3 > 0.7, -0.2 * g, 0.0)),
    }  # fmt: skip
    demand = {name: 1.0 / float(static.capacity(sides, Shaking.of([motion]))[0, 0]) for name, motion in motions.items()}
    assert demand["down"] == pytest.approx((0.6 + 0.2 * slope) / slope, rel=1e-12)
    assert demand["up"] == pytest.approx((0.6 - 0.2 * slope) / slope, rel=1e-12)
    assert demand["apart"] == pytest.approx(0.6 / slope, rel=1e-12)
    assert demand["alone"] == pytest.approx(0.6 / slope, rel=1e-12)
    # moments at the limit itself: the scaled motion just lifts the weaker side of a leaning body
    leaning = rk.Block(width=0.8, height=2.2, centre=(0.52, 0.9), mass=650.0, depth=1.2)
    factor = float(static.capacity(BodySides.of([leaning]), Shaking.of([with_fall(along, up)]))[0, 0])
    assert factor * 0.6 * g * 0.9 == pytest.approx((g - factor * 0.2 * g) * 0.28, rel=1e-12)


@pytest.mark.verifies("closed form", "the two load combinations, moment by moment", within="1e-12", room="studies")
@pytest.mark.parametrize(("name", "force", "dead"), [("asce-7-strength", 1.0, 0.9), ("asce-7-allowable", 0.7, 0.6)])
def test_asce_7_balances_its_combination(name, force, dead):
    """At the factor that it allows the moments of F_p and of the reduced weight are equal, by the worse side."""
    body = rk.Block(width=0.8, height=2.2, centre=(0.52, 0.9), mass=650.0, depth=1.2)
    motion = rk.GroundMotion([0.0, 2.0, -3.0, 0.0], 0.1)
    factor = float(CODE_METHODS[name].capacity(BodySides.of([body]), Shaking.of([motion]))[0, 0])
    design = 2.5 * factor * 3.0 / g  # S_DS
    pushes = force * 0.4 * design * 650.0 * g * 0.9
    assert pushes == pytest.approx((dead - force * 0.2 * design) * 650.0 * g * 0.28, rel=1e-12)
    assert factor < float(CODE_METHODS["static"].capacity(BodySides.of([body]), Shaking.of([motion]))[0, 0])


def test_each_method_states_its_treatment_of_vertical_motion():
    """What considers vertical motion changes with the vertical part; what does not, is marked; the rest is outside."""
    along, up = np.where((F3 > 0.3) & (F3 < 0.6), 0.6 * g, 0.0), np.where(F3 > 0.2, -0.2 * g, 0.0)
    sides = BodySides.of([rk.Block(width=0.3, height=0.9144)])
    flat, falling = Shaking.of([rk.GroundMotion(along, 1e-3)]), Shaking.of([with_fall(along, up)])
    for name, method in CODE_METHODS.items():
        before, after = (float(method.capacity(sides, each)[0, 0]) for each in (flat, falling))
        if name == "static":
            assert method.vertical is VerticalMotion.CONSIDERED
            assert after < before
        elif name == "asce-43":
            assert method.vertical is VerticalMotion.EXCLUDED
            assert method.outside(sides, falling) == "vertical motion"
            assert math.isnan(after)
        else:
            assert before == after
            own_rule = name.startswith("asce-7")
            assert method.vertical is (VerticalMotion.OWN_RULE if own_rule else VerticalMotion.NOT_CONSIDERED)
        assert method.vertical_motion.startswith(method.vertical.value)
        assert method.outside(sides, flat) == ""


def test_what_is_outside_has_a_reason():
    """Each exclusion has its name, and a body inside has none."""
    leaning = rk.Block(width=0.8, height=2.2, centre=(0.52, 0.9), mass=650.0, depth=1.2)
    shaking = Shaking.of([rk.GroundMotion([0.0, 1.0, 0.0], 0.1)])
    words = {name: method.outside(BodySides.of([leaning]), shaking) for name, method in CODE_METHODS.items()}
    assert {name: why for name, why in words.items() if why} == {
        "asce-43": "unequal sides", "kaneko-hayashi": "not a rectangle",
    }  # fmt: skip
    wide = BodySides.of([WIDE_BLOCK])
    assert CODE_METHODS["housner-pulse"].outside(wide, shaking) == "slenderness angle above 20 degrees"
